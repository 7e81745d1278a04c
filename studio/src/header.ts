// The head of the page, for both views: what opens, keeps, undoes and explains.
import { button, h, menu, option } from "./dom";
import { showHelp } from "./help";
import type { ViewName } from "./keeper";
import { TABLES } from "./table";
import { currentScheme, type Scheme, setScheme } from "./theme";

export interface HeaderActions {
  readonly open: () => void;
  readonly save: (kind: string) => void;
  readonly share: () => void;
  readonly undo: () => void;
  readonly redo: () => void;
  readonly reset: () => void;
  readonly example: (name: string) => void;
}

type Entries = readonly (readonly [string, string])[];

export class Header {
  readonly element: HTMLElement;
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;
  private readonly links: Readonly<Record<ViewName, HTMLAnchorElement>>;
  private readonly menus = h("span", { class: "menus" });
  private readonly panel: HTMLElement;
  private readonly more: HTMLButtonElement;

  constructor(
    private readonly actions: HeaderActions,
    private readonly entries: Readonly<
      Record<ViewName, { readonly save: Entries; readonly examples: Entries }>
    >,
  ) {
    this.undo = button("Undo", "Undo (Ctrl+Z)", actions.undo);
    this.redo = button("Redo", "Redo (Ctrl+Shift+Z)", actions.redo);
    this.links = { read: link("read", "Read"), release: link("release", "One release") };
    this.panel = h(
      "div",
      { class: "buttons panel", id: "menu" },
      this.menus,
      button(
        "Open …",
        "A device file (TOML), a recording (CSV), a saved reading (JSON) or a picture",
        actions.open,
      ),
      button("Share", "A link to what you see, in the clipboard", actions.share),
      button("Reset", "Begin anew; Undo brings everything back", actions.reset),
    );
    this.more = h(
      "button",
      { type: "button", class: "more", "aria-expanded": "false", "aria-controls": "menu" },
      "Menu",
    );
    this.more.addEventListener("click", () => this.unfold(!this.unfolded));
    this.panel.addEventListener("click", ({ target }) => {
      if ((target as HTMLElement).closest("button, select")) this.unfold(false);
    });
    this.element = h(
      "header",
      {},
      skip(),
      h("h1", { title: `pindrive ${TABLES.version}` }, "pindrive studio"),
      h("nav", { "aria-label": "views" }, this.links.read, this.links.release),
      h("div", { class: "buttons" }, this.undo, this.redo),
      this.panel,
      this.more,
    );
  }

  /** The head of a view. */
  show(view: ViewName): void {
    for (const [name, link] of Object.entries(this.links)) {
      if (name === view) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
    const { save, examples } = this.entries[view];
    this.menus.replaceChildren(
      menu("Examples", examples, this.actions.example),
      menu("Save as", save, this.actions.save),
      button("Help", "What this view can do", () => showHelp(view)),
      schemes(),
    );
  }

  update(canUndo: boolean, canRedo: boolean): void {
    [this.undo.disabled, this.redo.disabled] = [!canUndo, !canRedo];
  }

  private get unfolded(): boolean {
    return this.panel.classList.contains("unfolded");
  }
  private unfold(on: boolean): void {
    this.panel.classList.toggle("unfolded", on);
    this.more.setAttribute("aria-expanded", String(on));
  }
}

function link(view: ViewName, text: string): HTMLAnchorElement {
  return h("a", { href: `#${view}` }, text);
}

function skip(): HTMLElement {
  const go = (event: Event): void => {
    event.preventDefault();
    const main = [...document.querySelectorAll("main")].find((one) => one.offsetParent);
    main?.scrollIntoView();
  };
  return h("a", { class: "skip", href: "#main", onclick: go }, "To the content");
}

function schemes(): HTMLElement {
  const now = currentScheme();
  const names = ["auto", "light", "dark"].map((name) => option(name, name, name === now));
  const select = h("select", { id: "scheme", "aria-label": "colours" }, ...names);
  select.addEventListener("change", () => setScheme(select.value as Scheme));
  return select;
}
