import { describe, expect, it } from "vitest";
import html from "../index.html?raw";
import { VIEWS } from "../src/camera/views";
import { OVERLAY_TITLES } from "../src/overlays/overlay_names";
import { chosenLanguage, languageOf, LANGUAGES } from "../src/texts/language";
import { PHRASES } from "../src/texts/phrases";
import { TABLE } from "../src/texts/table";
import { helpSections } from "../src/ui/help_sections";
import { sceneTitle } from "../src/texts/scene_titles";
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

  it("word the titles of the scenes that come along, and of courses", () => {
    const scenes = import.meta.glob<{ title: string }>("../../src/elbowroom/world/data/scenes/*.json", { import: "default", eager: true });
    const titles = Object.values(scenes).map(({ title }) => title);
    expect(titles.length).toBeGreaterThan(5);
    const course = import.meta.glob<string>("../../src/elbowroom/experiment/gauntlet/course.py", { query: "?raw", import: "default", eager: true });
    const kinds = [...(/_TITLES = (.*)/.exec(Object.values(course)[0] ?? "")?.[1] ?? "").matchAll(/"([^"]+)"/g)].map((found) => found[1] ?? "");
    expect(kinds.length).toBe(5);
    expect([...titles, ...kinds].filter((english) => !(english in PHRASES))).toEqual([]);
    expect(sceneTitle("Gauntlet, level 5 (hardly any room), seed 9")).toBe("Gauntlet, level 5 (hardly any room), seed 9");
    expect(sceneTitle("My own")).toBe("My own");
  });

  it("are no longer English", () => {
    for (const [english, words] of Object.entries(PHRASES)) expect(words, english).toMatch(/[\u4e00-\u9fff]/);
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
