/** What the address that opens the page asks for, besides what the server is asked for. */

import { oddities, type SessionWishes } from "../preferences";
import { text } from "../texts/texts";
import type { Notices } from "../ui/notices";
import type { Arrivals } from "./arrivals";
import type { Modes } from "./modes";
import type { Taste } from "./taste";

export interface OpeningParts {
  readonly query: URLSearchParams;
  readonly wishes: SessionWishes;
  readonly taste: Taste;
  readonly notices: Notices;
  readonly arrivals: Arrivals;
  readonly modes: Modes;
}

/** Shows camera and panels as the address asks, the run or the built scene that it names, and says what in it is odd. */
export function showWhatIsAsked({ query, wishes, taste, notices, arrivals, modes }: OpeningParts): void {
  taste.showCamera(wishes.camera);
  taste.setBare(!wishes.showUi);
  const odd = oddities(query);
  if (odd.length > 0) notices.show("warning", text("address.odd", odd.join(text("list.comma"))));
  if (query.has("replay")) arrivals.shownRun();
  void modes.buildAddress(location.hash);
  window.addEventListener("hashchange", () => void modes.buildAddress(location.hash)); // a link opened in this very tab
}
