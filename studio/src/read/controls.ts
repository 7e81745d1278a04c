// Controls of the device under the hand: the number of its pins, and sliders.
import type { Design } from "../design";
import { withValue } from "../design";
import { h, option } from "../dom";
import type { Values } from "../friction";
import { DRIVE, INPUTS } from "../table";
import { fieldText, written } from "../write";
import { valuesOf } from "./device";

/** Keys with a slider, and their words. */
const SLIDERS = [
  ["magnet.hold_force", "Pull of the magnet"],
  ["magnet.fall_time", "Magnet lets go in"],
  ["control.latency", "Delay of the control block"],
  ["drive.stiffness", "Stiffness of the spring"],
  ["drive.damping_ratio", "Damping ratio"],
  ["drive.damping", "Damping"],
  ["finger.touch_force", "Touch of the finger"],
] as const;
/** Factor from a value to the ends of its slider. */
const RANGE = 8;
const PINS = [1, 2, 3, 4, 5]; // in a row or a column

export class Controls {
  readonly element = h("div", { class: "sliders" });
  private design: Design | null = null;

  /** `changed` gets another design, and what was changed. */
  constructor(private readonly changed: (design: Design, kind: string) => void) {}

  /** Shows a design, unless it is the one that was set here last. */
  update(design: Design): void {
    if (design === this.design) return;
    this.design = design;
    const values = valuesOf(design);
    this.element.replaceChildren(
      ...this.pins(values),
      ...SLIDERS.flatMap(([key, words]) => {
        const value = values[key];
        return typeof value === "number" && value > 0 ? [this.slider(key, words, value)] : [];
      }),
    );
  }

  /** The numbers of columns and rows of pins; none for pins at places of their own. */
  private pins(values: Values): HTMLElement[] {
    if ("array.places" in values) return [];
    const select = (key: string, label: string): HTMLElement => {
      const now = (values[key] as number | undefined) ?? 1;
      const counts = PINS.includes(now) ? PINS : [...PINS, now];
      const made = h(
        "select",
        { "aria-label": label },
        ...counts.map((count) => option(String(count), String(count), count === now)),
      );
      made.addEventListener("change", () => this.set(key, Number(made.value), ""));
      return made;
    };
    const columns = select("array.columns", "columns of pins");
    const rows = select("array.rows", "rows of pins");
    return [h("p", { class: "pins" }, h("span", {}, "Pins"), h("span", {}, columns, " × ", rows))];
  }

  private set(key: string, value: number, kind: string): void {
    const next = withSetting(this.design!, key, value);
    if (kind) this.design = next; // the slider that is dragged stays
    this.changed(next, kind);
  }

  private slider(key: string, words: string, value: number): HTMLElement {
    const quantity = INPUTS.get(key)!;
    const said = (now: number): string =>
      `${fieldText(quantity, Number(now.toPrecision(3)))} ${quantity.displayUnit ?? ""}`;
    const shown = h("output", {}, said(value));
    const input = h("input", { type: "range", min: -1, max: 1, step: "any", value: 0 });
    input.setAttribute("aria-valuetext", said(value));
    input.addEventListener("input", () => {
      const now = Number((value * RANGE ** Number(input.value)).toPrecision(3));
      shown.textContent = said(now);
      input.setAttribute("aria-valuetext", said(now));
      this.set(key, now, key);
    });
    return h("label", {}, h("span", {}, words), input, shown);
  }
}

/** A design with another value of a key, SI. */
function withSetting(design: Design, key: string, value: number): Design {
  if (DRIVE.has(key)) return { ...design, values: withValue(design.values, key, value) };
  const [table, name] = key.split(".") as [string, string];
  const text = written(INPUTS.get(key)!, value);
  return { ...design, around: { ...design.around, [table]: { ...design.around[table], [name]: text } } };
}
