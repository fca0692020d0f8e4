/** Small helpers for the page's elements. */

/** The element with this id; a missing one is a mistake in index.html. */
export function byId<T extends HTMLElement>(id: string, type: new () => T): T {
  const element = document.getElementById(id);
  if (!(element instanceof type)) throw new Error(`index.html has no ${type.name} with id "${id}"`);
  return element;
}

/** A new element with text or children. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Readonly<Record<string, string>> = {}, ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** Replaces a list's options and keeps the page quiet when nothing changed. */
export function setOptions(select: HTMLSelectElement, options: readonly (readonly [string, string])[]): void {
  const same =
    select.options.length === options.length &&
    options.every(([value, title], i) => select.options[i]?.value === value && select.options[i]?.text === title);
  if (same) return;
  const { value } = select;
  select.replaceChildren(...options.map(([id, title]) => new Option(title, id)));
  select.value = value;
}

/** Shows what an input stands for, unless a hand is on it: what one types or drags is not taken away. */
export function showValue(input: HTMLInputElement, value: string): void {
  const typing = input.type === "number" && document.activeElement === input;
  if (!typing && !input.matches(":active")) input.value = value;
}
