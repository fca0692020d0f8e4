/** How often someone was stuck, in words. */

import { text } from "./texts";

export function stuckWords(times: number): string {
  return times === 0 ? text("stuck.never") : times === 1 ? text("stuck.once") : text("stuck.times", times);
}
