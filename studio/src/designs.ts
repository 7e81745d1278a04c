// The named designs: tabs, one of them current; which others are drawn; the ghost.
import { button, h, refill } from "./dom";
import { currentDesign, type ReleaseState, type Step, withDesign } from "./state";
import type { Look } from "./theme";

export class Designs {
  readonly element = h("div", { class: "designs" });
  private shown = "";

  constructor(private readonly change: (step: Step) => void) {}

  update(state: ReleaseState, look: Look): void {
    const structure = JSON.stringify([
      state.current,
      state.ghost !== null,
      look.dark,
      state.designs.map(({ name, shown }) => [name, shown]),
    ]);
    if (structure === this.shown) return;
    this.shown = structure;
    const { designs, current } = state;
    const rows = designs.map((design, i) => {
      const own = look.curves[i % look.curves.length]!;
      const sample = h("span", { class: "sample", "aria-hidden": "true" });
      sample.style.borderTop = `3px ${own.dash.length ? "dashed" : "solid"} ${own.color}`;
      const choose = h("input", { type: "radio", name: "design", id: `design-${i}`, checked: i === current });
      choose.addEventListener("change", () => this.change((now) => ({ ...now, current: i })));
      const see = h("input", {
        type: "checkbox",
        checked: i === current || design.shown,
        disabled: i === current,
        "aria-label": `draw ${design.name} beside the current design`,
      });
      see.addEventListener("change", () => this.change((now) => withDesign(now, { shown: see.checked }, i)));
      return h(
        "li",
        {},
        choose,
        h(
          "label",
          { for: `design-${i}` },
          sample,
          h("span", { class: "design-name" }, design.name || "unnamed"),
        ),
        see,
      );
    });
    const name = h("input", {
      type: "text",
      id: "design-name",
      value: currentDesign(state).name,
      "aria-label": "name of the current design",
    });
    name.addEventListener("change", () => this.change((now) => withDesign(now, { name: name.value })));
    refill(this.element, [
      h("ul", { "aria-label": "designs; the box draws one beside the current one" }, ...rows),
      name,
      h(
        "div",
        { class: "buttons" },
        button("Copy", "A new design like this one", () =>
          this.change((now) => {
            const copy = {
              ...currentDesign(now),
              name: `${currentDesign(now).name} ${now.designs.length + 1}`,
              shown: true,
            };
            return { ...now, designs: [...now.designs, copy], current: now.designs.length };
          }),
        ),
        this.removal(state),
        button(
          state.ghost ? "Drop ghost" : "Keep ghost",
          "Keep this curve behind the others to compare with",
          () => this.change((now) => ({ ...now, ghost: now.ghost ? null : currentDesign(now).values })),
        ),
      ),
    ]);
  }

  private removal(state: ReleaseState): HTMLButtonElement {
    const found = button("Delete", "Delete this design", () =>
      this.change((now) => ({
        ...now,
        designs: now.designs.filter((_, i) => i !== now.current),
        current: Math.max(0, now.current - 1),
      })),
    );
    found.disabled = state.designs.length < 2;
    return found;
  }
}
