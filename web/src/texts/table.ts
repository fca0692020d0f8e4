/** Every text of the page by name, in both languages: one table, so that none is forgotten. */

import type { Language } from "./language";

type Texts = Readonly<Record<Language, string>>;

const said = (en: string, zhHant: string): Texts => ({ en, "zh-Hant": zhHant });

export const TABLE = {
  "replay.title": said("Replay", "重播"),
  "replay.open": said("Replay the last walk", "重播上一次行走"),
  "replay.none": said("Nothing to replay yet: walk a few steps first", "還沒有可重播的內容：請先走幾步"),
  "replay.run": said("Run", "紀錄"),
  "replay.against": said("Compare with", "比較對象"),
  "replay.nothing": said("nothing", "無"),
  "replay.ghost": said("as a ghost", "以虛影疊合"),
  "replay.beside": said("side by side", "並排"),
  "replay.play": said("Play", "播放"),
  "replay.pause": said("Pause", "暫停"),
  "replay.back": said("One step back", "後退一格"),
  "replay.forward": said("One step on", "前進一格"),
  "replay.begin": said("To the beginning", "回到開頭"),
  "replay.speed": said("Speed", "速度"),
  "replay.loop": said("Loop", "循環"),
  "replay.close": said("Close the replay", "關閉重播"),
  "replay.moment": said("Moment", "時間點"),
  "replay.film": said("Record a film of it", "錄製影片"),
  "replay.filming": said("Recording; press again to end", "錄製中；再按一次結束"),
  "replay.noFilm": said("This browser records no films", "此瀏覽器無法錄製影片"),
  "replay.clearance": said("Clearance", "間距"),
  "replay.joints": said("Turned from the start", "相對起始的轉角"),
  "replay.near": said("nothing near", "附近無障礙"),
  "replay.noAssist": said("no assist", "無輔助"),
  "replay.standIn": said("{0} is not here: the stock avatar stands in, and clearance is its own", "找不到 {0}：以內建角色代替，間距亦為其數值"),
  "replay.reading": said("Reading {0} …", "正在讀取 {0}…"),
  "replay.save": said("Save motion", "儲存動作"),
  "replay.saveAs": said("as …", "格式…"),
  "replay.notSaved": said("The motion was not saved: {0}", "動作未能儲存：{0}"),
  "mark.plan": said("plan", "規劃"),
  "mark.contact": said("contact", "接觸"),
  "mark.stuck": said("stuck", "受困"),
  "mark.crossed": said("crossed", "通過"),
  "joint.trunk": said("trunk", "軀幹"),
  "joint.leftShoulder": said("left shoulder", "左肩"),
  "joint.leftElbow": said("left elbow", "左肘"),
  "joint.rightShoulder": said("right shoulder", "右肩"),
  "joint.rightElbow": said("right elbow", "右肘"),
} as const satisfies Readonly<Record<string, Texts>>;

export type TextName = keyof typeof TABLE;
