import { expect, test } from "vitest";
import { lengthWords } from "../src/texts/length";

test("what is near is told in centimetres, what is far in metres", () => {
  expect(lengthWords(0.0842)).toBe("8.4 cm");
  expect(lengthWords(0.39, 0)).toBe("39 cm");
  expect(lengthWords(-0.012)).toBe("-1.2 cm");
  expect(lengthWords(1.805)).toBe("1.8 m");
  expect(lengthWords(18.345)).toBe("18.3 m");
});
