// View of the page: its state and the computed results.
import type { Values } from "./friction";
import type { ContactName, Curves, EventKind, Simulated, Span } from "./sample";
import { currentDesign, type ReleaseState } from "./state";

/** Curve of the plots: the current design first, the ghost, then all other shown designs. */
export interface Line {
  readonly name: string;
  readonly kind: "current" | "ghost" | "other";
  readonly values: Values;
  readonly result: Simulated;
  /** Its place among the designs, for its colour. */
  readonly index: number;
}

export interface View {
  readonly state: ReleaseState;
  readonly lines: readonly Line[];
  /** The end of the motions, s. */
  readonly end: number;
  /** Shown span of the time axis, s. */
  readonly span: Span;
}

export function curvesOf(line: Line | undefined): Curves | null {
  return line && "curves" in line.result ? line.result.curves : null;
}

/** Motion of the current design; null without one. */
export function currentCurves(view: View): Curves | null {
  return curvesOf(view.lines[0]);
}

export function currentValues(view: View): Values {
  return currentDesign(view.state).values;
}

/** The shape of an event: a square sticks, a triangle slips, a diamond reverses; at an end stop a bar. */
export function eventPath(
  kind: EventKind,
  x: number,
  y: number,
  size: number,
): readonly (readonly [number, number])[] {
  if (kind === "stick") {
    return [
      [x - size, y - size],
      [x + size, y - size],
      [x + size, y + size],
      [x - size, y + size],
    ];
  }
  if (kind === "slip") {
    return [
      [x, y - 1.25 * size],
      [x + 1.15 * size, y + 0.85 * size],
      [x - 1.15 * size, y + 0.85 * size],
    ];
  }
  if (kind === "stop" || kind === "leave") {
    const [half, long] = [0.2 * size, 2 * size];
    const [a, b] = kind === "stop" ? [half, long] : [long, half];
    return [
      [x - a, y - b],
      [x + a, y - b],
      [x + a, y + b],
      [x - a, y + b],
    ];
  }
  return [
    [x, y - 1.35 * size],
    [x + 1.35 * size, y],
    [x, y + 1.35 * size],
    [x - 1.35 * size, y],
  ];
}

/** Filled at the plate, open at the finger. */
export function isOpen(contact: ContactName): boolean {
  return contact === "finger";
}
