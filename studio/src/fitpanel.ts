// A recording beside the curves: its time offset, which parameters are fitted to it, and what came of it.

import { variedKeys } from "./design";
import { button, h, refill, show, textField } from "./dom";
import type { FitReport } from "./fit";
import type { Values } from "./friction";
import { EXAMPLE } from "./recording";
import { nameOf } from "./results";
import type { Simulation } from "./simulation";
import { currentDesign, type Overlay, type ReleaseState, withDesign } from "./state";
import type { Store } from "./store";
import { DRIVE, digits, text } from "./table";

const MORE = 1.3; // times the noise of a recording that is left by a fit of the wrong model

export class FitPanel {
  readonly element = h("div", { class: "fit" });
  private shown = "";

  constructor(
    private readonly store: Store<ReleaseState>,
    private readonly simulation: Simulation,
    private readonly say: (problem: string) => void,
    private readonly open: () => void,
  ) {}

  update(state: ReleaseState): void {
    const { values } = currentDesign(state);
    const { overlay } = state;
    const { offset: _, recording, ...rest } = overlay ?? {};
    const structure = JSON.stringify([recording?.name, recording?.times.length, rest, variedKeys(values)]);
    if (structure !== this.shown) {
      this.shown = structure;
      refill(this.element, overlay ? this.parts(values, overlay) : this.invitation());
    }
    const field = this.element.querySelector<HTMLInputElement>("#offset");
    if (field && overlay) show(field, String(Number((1e3 * overlay.offset).toPrecision(8))));
  }

  private invitation(): Node[] {
    return [
      h(
        "p",
        { class: "note" },
        "Drop a recording of a release anywhere on the page: a CSV whose header names columns with units, such as ",
        h("code", {}, EXAMPLE),
        ". Two are among the examples.",
      ),
      button("Open a recording …", "A CSV of a recording", this.open),
    ];
  }

  private parts(values: Values, overlay: Overlay): Node[] {
    const { recording, report } = overlay;
    const offset = textField({ id: "offset", inputmode: "decimal" });
    offset.addEventListener("change", () => {
      const value = Number(offset.value.replace("−", "-"));
      if (Number.isFinite(value)) this.change({ offset: value / 1e3, report: null });
    });
    const box = (id: string, words: string, title: string, on: boolean, set: (on: boolean) => void): Node => {
      const input = h("input", { type: "checkbox", id, checked: on });
      input.addEventListener("change", () => set(input.checked));
      return h("label", { title }, input, words);
    };
    const keys = variedKeys(values).map((key) =>
      box(
        `fit-${key.replace(".", "-")}`,
        nameOf(key),
        DRIVE.get(key)!.meaning,
        overlay.keys.includes(key),
        (on) => {
          const others = this.store.now.overlay!.keys.filter((other) => other !== key);
          this.change({ keys: on ? [...others, key] : others });
        },
      ),
    );
    return [
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
        button("by least squares", "The time offset with the least squares", () => void this.fitOffset()),
      ),
      h(
        "fieldset",
        {},
        h("legend", {}, "Fit these"),
        ...keys,
        box(
          "fit-offset",
          "time of the release",
          "The recorded time of the release",
          overlay.freeOffset,
          (on) => this.change({ freeOffset: on }),
        ),
      ),
      h(
        "div",
        { class: "buttons" },
        button("Fit", "Least squares by exact derivatives, from many starts", () => void this.fit()),
        button("Remove", "Take the recording away", () =>
          this.store.change({ ...this.store.now, overlay: null }),
        ),
      ),
      h(
        "p",
        { class: "note", id: "fit-words", role: "status" },
        report ? words(report, values, overlay) : "",
      ),
    ];
  }

  private change(change: Partial<Overlay>): void {
    const { now } = this.store;
    this.store.change({ ...now, overlay: { ...now.overlay!, ...change } });
  }

  private async fitOffset(): Promise<void> {
    const { now } = this.store;
    const { recording } = now.overlay!;
    const offset = await this.simulation.answer("offset", { recording, values: currentDesign(now).values });
    if (offset !== null && this.store.now.overlay) this.change({ offset, report: null });
  }

  private async fit(): Promise<void> {
    const { now } = this.store;
    const { recording, offset, freeOffset, ...rest } = now.overlay!;
    const { values } = currentDesign(now);
    const keys = rest.keys.filter((key) => variedKeys(values).includes(key));
    if (!keys.length && !freeOffset) {
      this.say("Choose at least one parameter, or the time of the release, to be fitted.");
      return;
    }
    const found = await this.simulation.answer("fit", { recording, values, keys, offset, freeOffset });
    const overlay = this.store.now.overlay;
    if (!found || !overlay) return;
    this.say("");
    this.store.change({
      ...withDesign(this.store.now, { values: found.values }),
      overlay: { ...overlay, offset: found.offset, report: found.report },
    });
  }
}

/** The outcome of a fit in words. */
function words(report: FitReport, values: Values, { keys, freeOffset, offset }: Overlay): string {
  const { misfit, noise, converged, starts, undetermined } = report;
  const found = keys.map((key) => {
    const value = values[key];
    return typeof value === "number" ? `${nameOf(key)} ${text(DRIVE.get(key)!, value)}` : nameOf(key);
  });
  if (freeOffset) found.push(`release at ${digits(1e3 * offset, 4)} ms`);
  const part = (of: number): string => `${digits(100 * of, 2)} %`;
  const left = `${part(misfit)} of the recording is left (root mean square), and its noise is ${part(noise)}.`;
  const sentences = [
    converged
      ? `The best of ${starts} starts converged: ${found.join(", ")}; ${left}`
      : `Did not converge: these are the values at which the search ended. ${found.join(", ")}; ${left}`,
  ];
  if (misfit > MORE * noise) {
    sentences.push(
      `That is ${digits(misfit / noise, 2)} times the noise: the model with these parameters does not describe the recording.`,
    );
  }
  if (undetermined.length) {
    const names = undetermined.map(nameOf).join(", ");
    sentences.push(`The recording does not determine ${names}: a change of one is made up for by others.`);
  }
  return sentences.join(" ");
}
