// Sliders of the device under the hand.
import type { Design } from "../design";
import { withValue } from "../design";
import { h } from "../dom";
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

export class Controls {
  readonly element = h("div", { class: "sliders" });

  constructor(
    private design: Design,
    private readonly changed: (design: Design) => void,
  ) {
    this.fill();
  }

  setDesign(design: Design): void {
    this.design = design;
    this.fill();
  }

  private fill(): void {
    const values = valuesOf(this.design);
    this.element.replaceChildren(
      ...SLIDERS.flatMap(([key, words]) => {
        const value = values[key];
        return typeof value === "number" && value > 0 ? [this.slider(key, words, value)] : [];
      }),
    );
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
      this.design = withSetting(this.design, key, now);
      this.changed(this.design);
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
