// Elements made in one call, and files given to the person at the page.

type Child = Node | string | null | false;
type Properties = Readonly<Record<string, unknown>>;

/** An element with properties ("class", "on…" listeners, "aria-…" attributes) and children. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Properties = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) {
      element.addEventListener(name.slice(2), value as EventListener);
    } else {
      element.setAttribute(name, value === true ? "" : String(value));
    }
  }
  element.append(...children.filter((child) => child !== null && child !== false));
  return element;
}

export function button(text: string, title: string, action: () => void): HTMLButtonElement {
  return h("button", { type: "button", title, onclick: action }, text);
}

export function option(value: string, text: string, selected = false): HTMLOptionElement {
  return h("option", { value, selected }, text);
}

/** A button that opens a menu; `action` is called with the name of the chosen entry. */
export function menu(
  text: string,
  entries: readonly (readonly [string, string])[],
  action: (name: string) => void,
): HTMLElement {
  const made = h("details", { class: "menu" }, h("summary", {}, text));
  const items = entries.map(([name, words]) => {
    const choose = (): void => {
      made.open = false;
      action(name);
    };
    return h("li", {}, h("button", { type: "button", "data-name": name, onclick: choose }, words));
  });
  made.append(h("ul", {}, ...items));
  made.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !made.open) return;
    made.open = false;
    made.querySelector("summary")!.focus();
  });
  made.addEventListener("focusout", ({ relatedTarget }) => {
    if (relatedTarget instanceof Node && !made.contains(relatedTarget)) made.open = false;
  });
  return made;
}

const typed = new WeakSet<HTMLInputElement>();

/** A field for a text. What is typed there stays until it is given: see `show`. */
export function textField(properties: Properties): HTMLInputElement {
  const field = h("input", { type: "text", ...properties });
  field.addEventListener("input", () => typed.add(field));
  for (const given of ["change", "blur"]) field.addEventListener(given, () => typed.delete(field));
  return field;
}

/** Shows a text in such a field, unless somebody has begun to type another: a page is drawn at any time. */
export function show(field: HTMLInputElement, text: string): void {
  if (!typed.has(field) && field.value !== text) field.value = text;
}

/** A card: a part of the page with its heading. */
export function card(name: string, title: string, ...children: Node[]): HTMLElement {
  const id = `${name}-title`;
  return h("section", { class: `card ${name}`, "aria-labelledby": id }, h("h2", { id }, title), ...children);
}

/** A symbol of the table, "F_p,s", with its index below. */
export function symbol(text: string): HTMLElement {
  const [, base, index, rest] = /^([^_(]*)(?:_([^(]*))?(.*)$/.exec(text)!;
  return h("i", {}, base!, index ? h("sub", {}, index) : null, rest!);
}

/** Replaces the children, if their text or number is another. */
export function refill(parent: Element, children: readonly Node[]): void {
  parent.replaceChildren(...children);
}

/** Gives a file to the person at the page. */
export function download(name: string, content: BlobPart, type: string): void {
  const url = URL.createObjectURL(new Blob([content], { type }));
  const link = h("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** Lets the browser answer before the next chunk of work. */
export function pause(): Promise<void> {
  return new Promise((go) => setTimeout(go));
}

/** A name of a file from a title. */
export function fileName(title: string): string {
  return (
    title
      .trim()
      .toLowerCase()
      .replace(/[^\p{L}\p{N}]+/gu, "-")
      .replace(/^-+|-+$/g, "") || "design"
  );
}
