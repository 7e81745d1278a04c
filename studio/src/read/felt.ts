// The tactile image: each pin paints how far it was dragged where its spot was.

import type { Row } from "../core";
import type { Hand } from "./hand";
import { HEIGHT, RESOLUTION } from "./paper";
import type { Sample } from "./session";

const FULL = 1.1e-3; // m, deflection of the full colour
const SWING = 5e-5; // m past the rest from which a way back is painted
const SHORTEST = 4e-6; // m of way that is painted
const WHITE = [255, 255, 255] as const;
const DRAGGED = [0, 98, 160] as const;
const THROWN = [160, 86, 154] as const;
const STEPS = 32;

function shades(color: readonly number[], power: number): string[] {
  return Array.from({ length: STEPS + 1 }, (_, i) => {
    const part = (i / STEPS) ** power;
    return `rgb(${WHITE.map((white, k) => Math.round(white + (color[k]! - white) * part)).join(" ")})`;
  });
}
const FORWARD = shades(DRAGGED, 1.15);
const BACK = shades(THROWN, 0.8);

export class Felt {
  readonly canvas: OffscreenCanvas;
  private readonly pen: OffscreenCanvasRenderingContext2D;
  private last: { readonly x: number; readonly y: number }[] | null = null;
  /** Half the width of a stroke, mm. */
  private half = 1.22;

  constructor(
    width: number,
    private spots: readonly Row[],
  ) {
    this.canvas = new OffscreenCanvas(Math.round(width * RESOLUTION), Math.round(HEIGHT * RESOLUTION));
    this.pen = this.canvas.getContext("2d")!;
    this.setSpots(spots);
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
  }

  paint(samples: readonly Sample[], hand: Hand): void {
    for (const { time, values } of samples) {
      const { x, y, vx } = hand.at(time);
      const places = this.spots.map(([dx, dy]) => ({ x: (x + dx) * 1e3, y: (y + dy) * 1e3 }));
      const before = this.last;
      if (!before) {
        this.last = places;
        continue;
      }
      const moved = Math.abs(places[0]!.x - before[0]!.x) + Math.abs(places[0]!.y - before[0]!.y);
      if (moved * 1e-3 < SHORTEST) continue;
      places.forEach((at, pin) => {
        this.stroke(before[pin]!, at, values.position[pin]! * (vx < 0 ? -1 : 1));
      });
      this.last = places;
    }
  }

  private stroke(from: { x: number; y: number }, to: { x: number; y: number }, dragged: number): void {
    const { pen, half } = this;
    const size = dragged < 0 && dragged > -SWING ? 0 : Math.abs(dragged);
    const step = Math.min(STEPS, Math.round((size / FULL) * STEPS));
    pen.fillStyle = dragged >= 0 ? FORWARD[step]! : BACK[Math.min(STEPS, 3 * step)]!;
    pen.fillRect(
      (Math.min(from.x, to.x) - 0.05) * RESOLUTION,
      (Math.min(from.y, to.y) - half) * RESOLUTION,
      (Math.abs(to.x - from.x) + 0.1) * RESOLUTION,
      (2 * half + Math.abs(to.y - from.y)) * RESOLUTION,
    );
  }
}
