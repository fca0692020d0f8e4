/** What the line under the board says. */

import { stuckWords } from "../texts/stuck_words";
import { text } from "../texts/texts";
import type { Verdict } from "./checker";
import type { Tool } from "./editor";

/** A tool in hand explains itself; else what the live check has found. */
export function verdictWords(verdict: Verdict, tool: Tool): string {
  if (verdict.state === "opening") return text("build.opening");
  if (tool === "track") return text("build.trackHow");
  if (tool === "stop") return text("build.stopHow");
  if (tool !== "select") return text("build.placeHow");
  switch (verdict.state) {
    case "off":
      return text("build.checkOff");
    case "waiting":
    case "walking":
      return text("build.walking");
    case "wrong":
      return verdict.words;
    case "walked": {
      const { decided, passed, seconds, stuck } = verdict.walk;
      if (!decided) return text("build.undecided");
      return passed ? text("build.feasible", seconds.toFixed(1), stuckWords(stuck)) : text("build.infeasible", seconds.toFixed(0), stuckWords(stuck));
    }
  }
}
