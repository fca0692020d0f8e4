import { describe, expect, it } from "vitest";
import { chosenLanguage, languageOf, LANGUAGES } from "../src/texts/language";
import { TABLE } from "../src/texts/table";
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

describe("the language", () => {
  it("is that of the first wish that can be met", () => {
    expect(chosenLanguage([null, "fr-CH", "zh-TW", "en"])).toBe("zh-Hant");
    expect(chosenLanguage(["en", "zh"])).toBe("en");
    expect(chosenLanguage(["de", null])).toBe("en");
    expect(languageOf("EN_us")).toBe("en");
    expect(languageOf("english")).toBeNull();
  });
});
