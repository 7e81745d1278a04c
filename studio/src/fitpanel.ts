// A recording beside the curves: its time offset, and which parameters are fitted to it.

import { variedKeys } from "./design";
import { button, h, refill, show, textField } from "./dom";
import type { FitResult } from "./fit";
import type { Values } from "./friction";
import { EXAMPLE } from "./recording";
import { nameOf } from "./results";
import { DRIVE, digits, text } from "./table";
import type { Overlay } from "./view";

export interface FitActions {
  readonly open: () => void;
  readonly remove: () => void;
  readonly offset: (offset: number) => void;
  readonly fitOffset: () => void;
  readonly fit: (keys: readonly string[], freeOffset: boolean) => void;
}

export class FitPanel {
  readonly element = h("div", { class: "fit" });
  private readonly free = new Set<string>();
  private freeOffset = false;
  private last: FitResult | null = null;
  private shown = "";

  constructor(private readonly actions: FitActions) {}

  setResult(result: FitResult | null): void {
    this.last = result;
    this.shown = "";
  }

  update(values: Values, overlay: Overlay | null): void {
    const structure = JSON.stringify([
      overlay?.recording.name,
      overlay?.recording.times.length,
      variedKeys(values),
    ]);
    if (structure !== this.shown) {
      this.shown = structure;
      this.build(values, overlay);
    }
    const field = this.element.querySelector<HTMLInputElement>("#offset");
    if (field && overlay) show(field, String(Number((1e3 * overlay.offset).toPrecision(8))));
  }

  private build(values: Values, overlay: Overlay | null): void {
    const { actions } = this;
    if (!overlay) {
      refill(this.element, [
        h(
          "p",
          { class: "note" },
          "Drop a recording of a release here or anywhere on the page: a CSV whose header names columns with units, such as ",
          h("code", {}, EXAMPLE),
          ".",
        ),
        button("Open a recording …", "A CSV of a recording", actions.open),
      ]);
      return;
    }
    const { recording } = overlay;
    const offset = textField({ id: "offset", inputmode: "decimal" });
    offset.addEventListener("change", () => {
      const value = Number(offset.value.replace("−", "-"));
      if (Number.isFinite(value)) actions.offset(value / 1e3);
    });
    const keys = variedKeys(values).map((key) => {
      const box = h("input", {
        type: "checkbox",
        id: `fit-${key.replace(".", "-")}`,
        checked: this.free.has(key),
      });
      box.addEventListener("change", () => {
        if (box.checked) this.free.add(key);
        else this.free.delete(key);
      });
      return h("label", { title: DRIVE.get(key)!.meaning }, box, nameOf(key));
    });
    const withOffset = h("input", { type: "checkbox", id: "fit-offset", checked: this.freeOffset });
    withOffset.addEventListener("change", () => (this.freeOffset = withOffset.checked));
    const fitted = this.last
      ? [...this.free]
          .map((key) => {
            const value = this.last!.values[key];
            return typeof value === "number" ? `${nameOf(key)} ${text(DRIVE.get(key)!, value)}` : nameOf(key);
          })
          .join(", ")
      : "";
    refill(this.element, [
      h(
        "p",
        { class: "note", id: "recording-words" },
        `${recording.name}: ${recording.times.length} samples of ${Object.keys(recording.channels).join(", ")}`,
      ),
      h(
        "div",
        { class: "buttons" },
        h("label", { for: "offset" }, "release at"),
        h("span", { class: "value" }, offset, h("span", { class: "unit" }, "ms")),
        button("by least squares", "The time offset with the least squares", actions.fitOffset),
      ),
      h(
        "fieldset",
        {},
        h("legend", {}, "Fit these"),
        ...keys,
        h("label", {}, withOffset, "time of the release"),
      ),
      h(
        "div",
        { class: "buttons" },
        button("Fit", "Least squares by exact derivatives", () =>
          actions.fit(
            [...this.free].filter((key) => variedKeys(values).includes(key)),
            this.freeOffset,
          ),
        ),
        button("Remove", "Take the recording away", actions.remove),
      ),
      h(
        "p",
        { class: "note", id: "fit-words", role: "status" },
        this.last
          ? `Fitted in ${this.last.steps} steps: ${fitted}${fitted ? "; " : ""}what is left is ${digits(100 * this.last.misfit, 3)} % of the recording (root mean square).`
          : "",
      ),
    ]);
  }
}
