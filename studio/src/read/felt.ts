// The tactile image: each pin paints how far it was dragged where its spot was. A pin that friction holds off its
// rest moves no skin, and paints nothing.

import type { Row } from "../input";
import type { Hand } from "./hand";
import { HEIGHT, RESOLUTION } from "./paper";
import type { Sample } from "./session";

const FULL = 1.1e-3; // m, deflection of the full colour
const SWING = 5e-5; // m past the rest from which a way back is painted
const SHORTEST = 4e-6; // m of way that is painted
const MOVING = 1e-3; // m/s of a pin in the housing, above which it moves the skin
const PULLED = 1e-3; // N from which a magnet pulls
const STEPS = 32;
/** Colours of a drag and of a way past the rest, on light and on dark paper. */
const COLORS = {
  light: [
    [0, 98, 160],
    [160, 86, 154],
  ],
  dark: [
    [90, 180, 238],
    [213, 146, 207],
  ],
} as const;

function shades(color: readonly number[], power: number): string[] {
  return Array.from(
    { length: STEPS + 1 },
    (_, i) => `rgb(${color.join(" ")} / ${((i / STEPS) ** power).toFixed(3)})`,
  );
}

export class Felt {
  readonly canvas: OffscreenCanvas;
  private readonly pen: OffscreenCanvasRenderingContext2D;
  private last: { readonly x: number; readonly y: number }[] | null = null;
  private lastTime = 0;
  private positions: ArrayLike<number> = [];
  /** Side of its rest to which each pin was dragged last: 1, -1, or 0 before it was dragged. */
  private sides: number[] = [];
  /** Place off its rest where friction holds each pin since it was dragged; NaN: it has not stopped yet. */
  private bases: number[] = [];
  private forward: string[] = [];
  private back: string[] = [];
  /** Half the width of a stroke, mm. */
  private half = 1.22;

  constructor(
    width: number,
    private spots: readonly Row[],
  ) {
    this.canvas = new OffscreenCanvas(1, Math.round(HEIGHT * RESOLUTION));
    this.pen = this.canvas.getContext("2d")!;
    this.setWidth(width);
    this.setSpots(spots);
  }

  /** The width of the page, mm. */
  setWidth(width: number): void {
    const columns = Math.round(width * RESOLUTION);
    if (columns !== this.canvas.width) this.canvas.width = columns;
  }

  setDark(dark: boolean): void {
    const [forward, back] = COLORS[dark ? "dark" : "light"];
    [this.forward, this.back] = [shades(forward, 1.15), shades(back, 0.8)];
  }

  setSpots(spots: readonly Row[]): void {
    this.spots = spots;
    const heights = [...new Set(spots.map(([, y]) => Math.round(y * 1e6)))].sort((a, b) => a - b);
    const apart = heights.slice(1).map((y, i) => y - heights[i]!);
    this.half = apart.length ? 0.49 * Math.min(...apart) * 1e-3 : 1.22;
    this.clear();
  }

  clear(): void {
    this.pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    this.last = null;
    this.sides = this.spots.map(() => 0);
    this.bases = this.spots.map(() => 0);
  }

  paint(samples: readonly Sample[], hand: Hand): void {
    for (const { time, values } of samples) {
      const { x, y } = hand.at(time);
      const places = this.spots.map(([dx, dy]) => ({ x: (x + dx) * 1e3, y: (y + dy) * 1e3 }));
      const [before, lasts] = [this.last, time - this.lastTime];
      const moved = before
        ? Math.abs(places[0]!.x - before[0]!.x) + Math.abs(places[0]!.y - before[0]!.y)
        : Infinity;
      if (moved * 1e-3 < SHORTEST) continue;
      if (before) {
        places.forEach((at, pin) => {
          this.stroke(before[pin]!, at, this.dragged(pin, values, lasts));
        });
      }
      [this.last, this.lastTime, this.positions] = [places, time, values.position];
    }
  }

  /** Distance by which a pin is dragged now, or thrown past its rest, m; 0 while nothing moves the skin. */
  private dragged(pin: number, values: Sample["values"], lasts: number): number {
    const position = values.position[pin]!;
    if (values.pull[pin]! > PULLED) {
      [this.sides[pin], this.bases[pin]] = [Math.sign(position), NaN];
      return Math.abs(position);
    }
    if (Math.abs(position - this.positions[pin]!) < MOVING * lasts) this.bases[pin] = position;
    return (position - (this.bases[pin] || 0)) * this.sides[pin]!;
  }

  private stroke(from: { x: number; y: number }, to: { x: number; y: number }, dragged: number): void {
    const { pen, half } = this;
    const step = Math.min(STEPS, Math.round((Math.abs(dragged) / FULL) * STEPS));
    // Whole pixels: edges that are drawn twice would show.
    const low = (mm: number): number => Math.floor(mm * RESOLUTION);
    const [left, top] = [low(Math.min(from.x, to.x)), low(Math.min(from.y, to.y) - half)];
    const [right, bottom] = [low(Math.max(from.x, to.x)) + 1, low(Math.max(from.y, to.y) + half)];
    const place = [left, top, right - left, bottom - top] as const;
    pen.clearRect(...place);
    if (!step || (dragged < 0 && dragged > -SWING)) return;
    pen.fillStyle = (dragged > 0 ? this.forward : this.back)[step]!;
    pen.fillRect(...place);
  }
}
