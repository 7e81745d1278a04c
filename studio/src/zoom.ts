// Zoom and pan of the time axis: the shown span, and its buttons.
import { button, h } from "./dom";
import type { Span } from "./sample";

const CLOSEST = 1e-6; // part of the whole axis that is shown at the least

export class Zoom {
  /** Shown part of the axis, s; null: the whole axis. */
  span: Span | null = null;
  readonly element: HTMLElement;
  private readonly all = button("All", "The whole motion (double click in the curves)", () =>
    this.show(null),
  );
  private readonly pans = [
    button("‹", "Earlier", () => this.move(-0.5)),
    button("›", "Later", () => this.move(0.5)),
  ];
  private end = 1;
  private middle = 0;

  constructor(private readonly changed: () => void) {
    const closer = button("+", "Closer to the cursor (or drag in the curves)", () => this.scale(0.5));
    const away = button("−", "Farther", () => this.scale(2));
    const group = { class: "buttons zoom", role: "group", "aria-label": "time axis" };
    this.element = h("div", group, closer, away, ...this.pans, this.all);
    this.update(1, 0);
  }

  /** The shown span of an axis to `end`, with the cursor at a time, s. */
  update(end: number, cursor: number): Span {
    [this.end, this.middle] = [end, cursor];
    if (this.span && this.span[0] >= end) this.span = null;
    for (const one of [this.all, ...this.pans]) one.disabled = this.span === null;
    return this.span ? [this.span[0], Math.min(this.span[1], end)] : [0, end];
  }

  show(span: Span | null): void {
    if (span) {
      const wide = Math.min(Math.max(span[1] - span[0], CLOSEST * this.end), this.end);
      const from = Math.min(Math.max(span[0], 0), this.end - wide);
      span = [from, from + wide];
      if (wide >= this.end) span = null;
    }
    this.span = span;
    this.changed();
  }

  private scale(factor: number): void {
    const [from, to] = this.span ?? [0, this.end];
    const middle = this.middle >= from && this.middle <= to ? this.middle : (from + to) / 2;
    this.show([middle + (from - middle) * factor, middle + (to - middle) * factor]);
  }

  private move(part: number): void {
    const [from, to] = this.span!;
    this.show([from + part * (to - from), to + part * (to - from)]);
  }
}
