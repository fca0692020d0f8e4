/** Draws fields; one that is being typed into keeps what stands in it. */

import { text } from "../texts/texts";
import { make } from "../ui/dom";
import { shownColour, shownTheme } from "./colours";
import type { Editor } from "./editor";
import { fieldsOf, type Field } from "./fields";

export class Form {
  readonly element = make("div", { class: "fields", role: "group", "aria-label": text("build.fields") });
  private shown = "";
  private inputs: (HTMLInputElement | HTMLSelectElement)[] = [];

  constructor(private readonly editor: Editor) {}

  draw(): void {
    const fields = fieldsOf(this.editor);
    const shape = JSON.stringify([this.editor.selected, fields.map(({ name }) => name)]);
    if (shape !== this.shown) this.build(fields);
    this.shown = shape;
    fields.forEach((field, i) => {
      const input = this.inputs[i];
      if (input && document.activeElement !== input) input.value = this.shownValue(field);
    });
  }

  private build(fields: readonly Field[]): void {
    this.inputs = fields.map((field, i) => this.input(field, i));
    this.element.replaceChildren(...fields.map((field, i) => make("label", { class: field.kind }, make("span", {}, text(field.name)), this.inputs[i] as Node)));
  }

  private input(field: Field, i: number): HTMLInputElement | HTMLSelectElement {
    const input = field.kind === "choice"
      ? make("select", {})
      : make("input", { type: field.kind, ...(field.kind === "number" ? { step: String(field.step), inputmode: "decimal" } : { maxlength: "100" }) });
    if (field.kind === "choice" && input instanceof HTMLSelectElement) input.replaceChildren(...field.choices.map(([value, title]) => new Option(title, value)));
    input.addEventListener("change", () => this.take(i, input.value));
    return input;
  }

  /** The field as it is now: the plan may have changed since it was drawn. */
  private take(i: number, value: string): void {
    const field = fieldsOf(this.editor)[i];
    if (field?.kind === "number") {
      const number = Number(value), empty = value.trim() === "";
      if (!empty && Number.isFinite(number)) this.editor.put(field.set(number));
      else if (empty && field.unset) this.editor.put(field.unset());
    } else if (field) this.editor.put(field.set(value));
    const now = fieldsOf(this.editor)[i], input = this.inputs[i];
    if (now && input) input.value = this.shownValue(now);
  }

  private shownValue(field: Field): string {
    if (field.kind === "number") return field.value === null ? "" : String(Math.round(field.value * 1000) / 1000);
    return field.kind === "color" ? shownColour(this.editor.plan, this.editor.index ?? 0, shownTheme()) : field.value;
  }
}
