/** What the server says, in Traditional Chinese, by its English: values stand in braces. */

import { filled, spoken, text } from "./texts";

export const SAYINGS: Readonly<Record<string, string>> = {
  // places to go to
  "{0}; steps of {1} cm are the highest for such legs": "{0}；這樣的腿最高只能踏上 {1} 公分的台階",
  "nobody can stand at {0}: {1} m of room are needed there": "{0} 處無法站立：需要 {1} 公尺的空間",
  "nobody can stand at {0}: {1} m of room are needed there; the nearest place to stand is {2}":
    "{0} 處無法站立：需要 {1} 公尺的空間；最近可站立的位置是 {2}",
  "{0} lies off the ground, which ends at {1}": "{0} 在地面之外，地面到 {1} 為止",
  "no way leads from {0} to {1}": "從 {0} 到 {1} 沒有路",
  "there is no way out of {0}: there is less than {1} m of room": "無法離開 {0}：空間不足 {1} 公尺",
  "the way is blocked at {0}": "路在 {0} 被擋住",
  // sessions
  "this server is about to end; try again in a moment": "伺服器即將關閉，請稍後再試",
  "your machine has {0} sessions here already": "你的電腦在此已開啟 {0} 個工作階段",
  "this server has {0} sessions already, as many as it can show in time; try again later": "伺服器已有 {0} 個工作階段，無法再容納，請稍後再試",
  "the client reads too slowly": "連線太慢",
  "the session failed inside the server; its log says more": "伺服器內部發生錯誤，詳見其記錄",
  "too many steps: at most 240 a second are taken": "步數太多：每秒最多 240 步",
  "only the first {0} steps are read: more would not fit into memory": "只讀取前 {0} 步：更多步會超出記憶體",
  "too many wrong messages; the last: {0}": "錯誤訊息太多，最後一則：{0}",
  "That page may not talk to this server.": "該頁面不得與此伺服器連線。",
  "configure: too many changes at once; wait until those before are done": "一次變更太多，請等先前的變更完成",
  "that change failed inside the server; its log says more": "變更在伺服器內失敗，詳見其記錄",
  // files on their way
  "other files are being read; try again in a moment": "正在讀取其他檔案，請稍後再試",
  "the file is larger than {0}": "檔案大於 {0}",
  "the file did not arrive whole, or too slowly": "檔案未完整送達，或傳送太慢",
  "there is no space left on the server's disk; try again later": "伺服器磁碟空間不足，請稍後再試",
  "the file could not be read; the server's log says more": "無法讀取檔案，詳見伺服器記錄",
  "all files that this server has place for are in use; try again later": "伺服器可容納的檔案都在使用中，請稍後再試",
  "what was sent takes {0} MiB here; there are {1} for all files": "送出的檔案需要 {0} MiB，伺服器的上限為 {1} MiB",
  "{0}: takes more than {1} s": "{0}：處理超過 {1} 秒",
  "{0}: unpacks to more than {1} MiB": "{0}：解開後超過 {1} MiB",
  "{0}: takes more than {1} s of a processor, or more memory than there is": "{0}：處理時間超過 {1} 秒，或記憶體不足",
  "{0}: cannot be read: it ends its reader ({1})": "{0}：無法讀取，讀取程式已中止（{1}）",
  "{0}: takes more than {1} MiB of memory": "{0}：處理需要超過 {1} MiB 的記憶體",
  // scenes and what is in them
  "that scene is not here any more; open it in build mode and walk it again": "該場景已不在伺服器上；請在建造模式開啟後再行走",
  "that place is not here any more; drop its file on the page again": "該場所已不在伺服器上；請重新拖放其檔案",
  "scene {0} is not known here; there are {1}, dropped models, and {2}":
    "沒有場景 {0}；可用的有 {1}、拖放到頁面的場所模型，以及隨機關卡 {2}",
  "clip {0} is not known here (any more); drop its file on the page again": "動作片段 {0} 已不在伺服器上；請重新拖放其檔案",
  "avatar {0} is not known here (any more); drop its file on the page again": "角色 {0} 已不在伺服器上；請重新拖放其檔案",
  "{0} is not read yet": "{0} 尚未讀取完成",
  "a course is being made already; try again in a moment": "正在產生另一個關卡，請稍後再試",
  "{0} is the model of a place: build mode edits no models": "{0} 是場所模型：建造模式無法編輯模型",
  "{0}: byte {1} is not UTF-8 text; save the file as UTF-8": "{0}：第 {1} 個位元組不是 UTF-8 文字；請存成 UTF-8",
  "{0}: $.place names the model of a place; drop the model itself on the page": "{0}：$.place 指向場所模型；請直接拖放該模型",
  "scene {0}, start: {1} touches an obstacle at {2}": "場景 {0}：{1} 在起點 {2} 就碰到障礙物",
  "queue size: {0} is not a whole number from {1} key frames": "預先規劃的關鍵影格數 {0} 不是 {1} 之間的整數",
  "planner {0} is unknown; there are {1}": "沒有規劃器 {0}；可用的有 {1}",
  "scene {0}: a course is named {1}": "場景 {0}：隨機關卡的名稱格式是 {1}",
  "style {0} is none of {1}": "沒有走路風格 {0}；可用的有 {1}",
  "walking speed {0}: allowed are {1}": "步行速度 {0} 不可用；允許的範圍是 {1}",
  "obstacle {0} of scene {1}: there is nothing that can be pushed by this number": "場景 {1} 中沒有編號 {0} 的可推物件",
  "obstacle {0} of scene {1}: only what is upright, small and no ground can be pushed": "場景 {1} 的 {0} 無法推動：只有直立、小型且非地面的物件可以",
  "obstacle {0} of scene {1}: the avatar stands on it": "場景 {1} 的 {0} 無法推動：角色正站在上面",
  "push: {0} is no place on the ground": "{0} 不在地面上",
  "push: a recorded motion plays; walk first": "正在播放動作片段：請先行走",
  // runs
  "no walk is recorded: a recorded motion plays; walk first": "沒有行走紀錄：正在播放動作片段，請先行走",
  "this walk is not recorded: the avatar's file is not here any more": "此次行走沒有紀錄：角色檔案已不在伺服器上",
  "this page has no walk here": "此頁面在伺服器上沒有行走紀錄",
  "no recording is shown here": "此處沒有播放紀錄",
  "the recording could not be read; the server's log says more": "無法讀取紀錄，詳見伺服器記錄",
  "{0}: is no recording of this format ({1})": "{0}：不是此格式的紀錄（{1}）",
  "{0}: holds no frames": "{0}：沒有任何影格",
  "{0}: holds no frames ({1})": "{0}：沒有任何影格（{1}）",
  "{0}: was recorded by another version of Elbowroom: its format is {1}": "{0}：由其他版本的 Elbowroom 記錄，其格式為 {1}",
  "{0}: header of {1} bytes, allowed are 1 to {2}": "{0}：檔頭為 {1} 位元組，允許 1 到 {2}",
  "{0}: the header is damaged or cut off": "{0}：檔頭已損壞或被截斷",
  "{0}: the header does not describe a run ({1})": "{0}：檔頭沒有描述一次行走（{1}）",
  "the file was cut off or is damaged: what follows step {0} is missing": "檔案被截斷或已損壞：第 {0} 步之後的內容遺失",
  "the file ends without its end mark: what follows step {0} is missing": "檔案沒有結尾標記：第 {0} 步之後的內容遺失",
  "the file was cut off in its last bytes: whether anything is missing after step {0} is not known":
    "檔案末尾被截斷：第 {0} 步之後是否有遺失無從得知",
  "the file was changed: it holds {0} of {1} steps": "檔案被更改過：僅有 {1} 步中的 {0} 步",
  "the file was changed: its {0} steps are not those that were recorded": "檔案被更改過：其 {0} 步與當時記錄的不同",
  "the file goes on after its end": "檔案在結尾之後還有內容",
  "run: what was sent is no run": "送來的內容不是行走紀錄",
  "run: its head is longer than {0} bytes": "紀錄的開頭超過 {0} 位元組",
  "run: its numbers are out of range": "紀錄中的數值超出範圍",
  "run: its frames are not of this avatar": "紀錄的影格不屬於此角色",
  "run: its frames are damaged": "紀錄的影格已損壞",
  "run: the avatar's file cannot be put in, and the frames were kept without its capsules": "無法放入角色檔案，且影格未保留其膠囊體",
  "format: {0}, there are {1}": "沒有格式 {0}；可用的有 {1}",
  "motion: {0} bytes, for this avatar 1 to {1} frames of {2} bytes": "動作為 {0} 位元組；此角色需要 1 到 {1} 格、每格 {2} 位元組",
  "motion: the numbers are out of range, or time goes backwards": "動作的數值超出範圍，或時間倒退",
  // what is handed out
  "this avatar has no file": "此角色沒有檔案",
  "there is no such place here": "沒有這個場所",
  "{0}; it is shown on the machine that has its file": "{0}；僅在擁有該檔案的電腦上顯示",
};

/** Those with the most of their own first: "{0}; …" must not take what another says more exactly. */
const PATTERNS = Object.entries(SAYINGS)
  .map(([english, words]) => ({ own: english.replace(/\{\d\}/g, "").length, pattern: patternOf(english), words }))
  .sort((a, b) => b.own - a.own);

/** What the server says, in the page's language; what the table does not know stays English, and the page says whose it is. */
export function heard(sentence: string): string {
  if (spoken() === "en") return sentence;
  const known = inChinese(sentence);
  return known ?? (/[\u4e00-\u9fff]/.test(sentence) ? sentence : text("server.says", sentence));
}

/** A sentence of the server in Chinese, with what it quotes of others; null for one that the table does not know. */
export function inChinese(sentence: string): string | null {
  for (const { pattern, words } of PATTERNS) {
    const found = pattern.exec(sentence.trim());
    if (found) return filled(words, found.slice(1).map((value) => inChinese(value) ?? value));
  }
  return null;
}

function patternOf(english: string): RegExp {
  const plain = english.replace(/[.*+?^$()|[\]\\]/g, "\\$&");
  return new RegExp(`^${plain.replace(/\{\d\}/g, "(.*)")}$`, "s");
}
