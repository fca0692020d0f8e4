/**
 * Who clicks and chooses with a pointer steers on at once: the keys stay with the view.
 *
 * A control that was reached with the Tab key keeps the focus, as anyone who works without a pointer expects.
 */

import { isOpen, takesText } from "../input/keyboard";

const PRESSED = "button, summary, label, input[type=checkbox], input[type=radio]";
const CHOSEN = "select, input[type=range]";

/** Lets no pointer take the focus away from the view for longer than it needs. */
export function keepKeysOnView(view: HTMLElement): void {
  let byPointer = false;
  const isChosen = (target: EventTarget | null): target is HTMLElement => target instanceof HTMLElement && target.matches(CHOSEN);
  window.addEventListener("pointerdown", () => (byPointer = true), true);
  // What is only pressed need not be focused for it; who presses it has done with writing elsewhere.
  document.addEventListener("mousedown", (event) => {
    const { target } = event, { activeElement } = document;
    const pressed = target instanceof Element && !target.closest(CHOSEN) ? target.closest(PRESSED) : null;
    if (!pressed) return;
    event.preventDefault();
    if (activeElement instanceof HTMLElement && takesText(activeElement) && !pressed.contains(activeElement)) activeElement.blur();
  });
  document.addEventListener("change", (event) => {
    if (byPointer && event.target instanceof HTMLElement) view.focus();
  });
  // A list that was closed without a choice.
  window.addEventListener("keydown", (event) => {
    const { activeElement } = document;
    const closed = !(activeElement instanceof HTMLSelectElement && isOpen(activeElement));
    if (byPointer && event.code !== "Tab" && isChosen(activeElement) && closed) view.focus();
    byPointer = false;
  }, true);
}
