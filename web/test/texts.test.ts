import { describe, expect, it } from "vitest";
import html from "../index.html?raw";
import { VIEWS } from "../src/camera/views";
import { OVERLAY_TITLES } from "../src/overlays/overlay_names";
import { chosenLanguage, languageOf, LANGUAGES } from "../src/texts/language";
import { PHRASES } from "../src/texts/phrases";
import { TABLE } from "../src/texts/table";
import { licenceName } from "../src/ui/avatar_about";
import { helpSections } from "../src/ui/help_sections";
import { sceneTitle } from "../src/texts/scene_titles";
import { inChinese, SAYINGS } from "../src/texts/sayings";
import { filled } from "../src/texts/texts";

const places = (pattern: string) => [...pattern.matchAll(/\{\d\}/g)].map(String).sort();

describe("the table of texts", () => {
  it("has every text in every language, with the same values in it", () => {
    for (const [name, texts] of Object.entries(TABLE)) {
      for (const language of LANGUAGES) {
        expect(texts[language].trim(), name).not.toBe("");
        expect(places(texts[language]), name).toEqual(places(texts.en));
      }
    }
  });

  it("puts values in their places", () => {
    expect(filled("{1} of {0}", ["ten", 3])).toBe("3 of ten");
  });
});

interface StockScene {
  readonly title: string;
  readonly obstacles: readonly { readonly name: string }[];
  readonly moving?: readonly { readonly name: string }[];
}

/** What a page of HTML says: the texts between its tags, and those of its attributes that are read out or shown. */
function textsOf(page: string): string[] {
  const body = page.replace(/<head>[\s\S]*<\/head>/, "").replace(/<script[\s\S]*?<\/script>/g, "");
  const attributes = [...body.matchAll(/\s(?:title|aria-label|placeholder)="([^"]+)"/g)].map((found) => found[1] ?? "");
  const between = body.replace(/<[^>]+>/g, "\n").split("\n");
  return [...attributes, ...between].map((one) => one.trim()).filter((one) => /[A-Za-z]{2}/.test(one));
}

describe("the phrases", () => {
  const NAMES = new Set(["Elbowroom", "English", "K", "U"]);

  it("word all of index.html", () => {
    const said = textsOf(html).filter((english) => !NAMES.has(english));
    expect(said.length).toBeGreaterThan(50);
    expect(said.filter((english) => !(english in PHRASES))).toEqual([]);
  });

  it("word the help, the cameras and the overlays", () => {
    const caps = (keys: readonly string[]) => keys.filter((key) => /^[a-z ]{3,}$/.test(key));
    const help = helpSections({ touch: false, gamepad: false })
      .flatMap(({ title, rows }) => [title, ...rows.flatMap(([keys, meaning]) => [...caps(keys), meaning])]);
    const said = [...help, ...Object.values(VIEWS).map(({ title }) => title), ...Object.values(OVERLAY_TITLES)];
    expect(said.filter((english) => !(english in PHRASES))).toEqual([]);
  });

  it("word every phrase of the code", () => {
    const sources = import.meta.glob<string>("../src/**/*.ts", { query: "?raw", import: "default", eager: true });
    const said = Object.values(sources).flatMap((source) => [...source.matchAll(/worded\("([^"]+)"\)/g)].map((found) => found[1] ?? ""));
    expect(said.length).toBeGreaterThan(20);
    expect(said.filter((english) => !(english in PHRASES))).toEqual([]);
  });

  it("word the titles of the scenes that come along and the things in them, and courses", () => {
    const scenes = import.meta.glob<StockScene>("../../src/elbowroom/world/data/scenes/*.json", { import: "default", eager: true });
    const titles = Object.values(scenes).map(({ title }) => title);
    const things = Object.values(scenes).flatMap(({ obstacles, moving = [] }) => [...obstacles, ...moving]).flatMap(({ name }) => name.split(", "));
    expect(things.length).toBeGreaterThan(20);
    expect(things.filter((english) => !(english in PHRASES))).toEqual([]);
    expect(titles.length).toBeGreaterThan(5);
    const course = import.meta.glob<string>("../../src/elbowroom/experiment/gauntlet/course.py", { query: "?raw", import: "default", eager: true });
    const kinds = [...(/_TITLES = (.*)/.exec(Object.values(course)[0] ?? "")?.[1] ?? "").matchAll(/"([^"]+)"/g)].map((found) => found[1] ?? "");
    expect(kinds.length).toBe(5);
    expect([...titles, ...kinds].filter((english) => !(english in PHRASES))).toEqual([]);
    expect(sceneTitle("Gauntlet, level 5 (hardly any room), seed 9")).toBe("Gauntlet, level 5 (hardly any room), seed 9");
    expect(sceneTitle("My own")).toBe("My own");
  });

  it("word what an avatar's file permits, and how a plan went", () => {
    const sources = import.meta.glob<string>(
      ["../../src/elbowroom/body/loading/permissions.py", "../../src/elbowroom/planning/result.py", "../../src/elbowroom/planning/root/plan.py", "../../src/elbowroom/control/frame.py"],
      { query: "?raw", import: "default", eager: true },
    );
    const [permissions = "", ...states] = Object.entries(sources).sort(([a], [b]) => a.localeCompare(b)).map(([, source]) => source);
    const permitted = [...permissions.matchAll(/: "([a-z][a-z, ]+)"|"([a-z][a-z ]+)": self|(?:True|False): "([a-z]+)"/g)].map(([, ...found]) => found.find(Boolean) ?? "");
    const kinds = states.flatMap((source) => [...source.matchAll(/class (?:PlanStatus|RootPlanKind|Phase)\(Enum\):([\s\S]*?)\n\n\n/g)])
      .flatMap(([, body = ""]) => [...body.matchAll(/ = "([^"]+)"/g)].map((found) => found[1] ?? ""));
    expect(permitted.length).toBeGreaterThan(15);
    expect(kinds.length).toBe(11);
    expect([...permitted, ...kinds].filter((english) => !(english in PHRASES))).toEqual([]);
  });

  it("are no longer English", () => {
    for (const [english, words] of Object.entries(PHRASES)) expect(words, english).toMatch(/[\u4e00-\u9fff]/);
  });
});

describe("errors", () => {
  const sources = import.meta.glob<string>(["../src/**/*.ts", "!../src/generated/**"], { query: "?raw", import: "default", eager: true });
  /** Of what only who writes the page, or nobody, gets to read. */
  const OWN = new Set(["../src/ui/dom.ts", "../src/replay/store.ts"]);

  it("that the page makes itself are worded", () => {
    const made = Object.entries(sources).filter(([path]) => !OWN.has(path))
      .flatMap(([path, source]) => [...source.matchAll(/new Error\((.*)/g)].map((found) => [path, found[1] ?? ""] as const));
    expect(made.length).toBeGreaterThan(3);
    expect(made.filter(([, what]) => !/^(text\(|worded\(|refusal\)|error \? heard\(error\) : text\()/.test(what))).toEqual([]);
  });

  it("and notices are said in no bare English", () => {
    const said = Object.entries(sources).flatMap(([path, source]) =>
      [...source.matchAll(/(?:\.say|notices\.show|listener\.notice)\("(?:info|warning|error)", (.*)/g)].map((found) => [path, found[1] ?? ""] as const));
    expect(said.length).toBeGreaterThan(20);
    expect(said.filter(([, what]) => /^["`]|^String\(|\.message\b/.test(what))).toEqual([]);
  });
});

/** The sentences for users in a Python source: those of errors, refusals and notices, with a value in place of each field. */
function sentencesOf(source: string): string[] {
  const joined = source.replace(/"\s*\n\s*f?"/g, "");
  const heads = /(?:InputError|NoWayError|_refused|_DoneError|_give_up)\(\s*(?:\d+, |_POLICY, )?f?"((?:[^"\\]|\\.)+)"|(?:"error": |why = |_INTERNAL, |_TRY_AGAIN_LATER, |\d{3}, |self\.note = |super\(\).__init__\(|return )f?"((?:[^"\\]|\\.)+)"/g;
  return [...joined.matchAll(heads)].map(([, one, other]) => one ?? other ?? "")
    .map((english) => english.replace(/\{[^}]*\}/g, "7")).filter((english) => english.split(" ").length > 3);
}

describe("what the server says", () => {
  const told = import.meta.glob<string>([
    "../../src/elbowroom/server/**/{app,reception,changes,session,admission,library,built_scenes,recent,clip_store,avatar_store,clip_walk,walk_log}.py",
    "../../src/elbowroom/server/**/{packed_run,saved_motion,walk}.py", "../../src/elbowroom/server/apart/{jobs,process}.py",
    "../../src/elbowroom/planning/names.py", "../../src/elbowroom/experiment/gauntlet/names.py",
    "../../src/elbowroom/planning/navigation/{way,navigator}.py", "../../src/elbowroom/control/**/{journey,loose,recording}.py",
  ], { query: "?raw", import: "default", eager: true });
  /** What only programs get to hear, or the command line. */
  const NOT_HERE = /^(7 nor |7: (cannot be|exists and)|goto: |message: |its licence)/;

  it("is known to the page", () => {
    const sentences = Object.values(told).flatMap(sentencesOf).filter((english) => !NOT_HERE.test(english));
    expect(sentences.length).toBeGreaterThan(45);
    expect(sentences.filter((english) => inChinese(english) === null)).toEqual([]);
  });

  it("is told whole where one sentence quotes another", () => {
    const told = inChinese("no way leads from 0.00, 0.00 to 1.00, 4.00; steps of 3 cm are the highest for such legs");
    expect(told).toBe("從 0.00, 0.00 到 1.00, 4.00 沒有路；這樣的腿最高只能踏上 3 公分的台階");
  });

  it("keeps its values, and the longer sentence is found first", () => {
    expect(inChinese("no way leads from 1.00, 2.00 to 3.00, 4.00")).toBe("從 1.00, 2.00 到 3.00, 4.00 沒有路");
    expect(inChinese("nobody can stand at 1, 2: 0.52 m of room are needed there; the nearest place to stand is 3, 4")).toContain("最近可站立的位置是 3, 4");
    expect(inChinese("cat.vrm: unpacks to more than 512 MiB")).toBe("cat.vrm：解開後超過 512 MiB");
    expect(inChinese("nobody has ever said this")).toBeNull();
    for (const [english, words] of Object.entries(SAYINGS)) expect(places(words), english).toEqual(places(english));
  });
});

describe("licences", () => {
  it("are called as people call them", () => {
    expect(licenceName("https://vrm.dev/licenses/1.0/")).toBe("VRM Public License 1.0");
    expect(licenceName("https://creativecommons.org/licenses/by-nc/4.0/")).toBe("CC BY-NC 4.0");
    expect(licenceName("http://creativecommons.org/publicdomain/zero/1.0/")).toBe("CC0 1.0");
    expect(licenceName("Redistribution_Prohibited")).toBe("Redistribution_Prohibited");
  });
});

describe("the language", () => {
  it("is that of the first wish that can be met", () => {
    expect(chosenLanguage([null, "fr-CH", "zh-TW", "en"])).toBe("zh-Hant");
    expect(chosenLanguage(["en", "zh"])).toBe("en");
    expect(chosenLanguage(["de", null])).toBe("en");
    expect(languageOf("EN_us")).toBe("en");
    expect(languageOf("english")).toBeNull();
  });
});
