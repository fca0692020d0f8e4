/** The keys: what each does, the help that tells it, the buttons that name it, and the dialog that changes it. */

import { KeyMap } from "../input/key_map";
import { byId } from "../ui/dom";
import { Help } from "../ui/help";
import { KeyDialog } from "../ui/key_dialog";
import { showKeys } from "../ui/key_hints";
import { localStore } from "./local_store";

export class Keys {
  readonly map = new KeyMap(localStore());
  readonly help = new Help(this.map);
  /** Made when it is first opened. */
  private dialog: KeyDialog | null = null;

  constructor() {
    showKeys(this.map);
    byId("keys-open", HTMLButtonElement).addEventListener("click", () => this.change());
  }

  private change(): void {
    this.dialog ??= new KeyDialog(this.map, () => showKeys(this.map));
    this.dialog.open();
  }
}
