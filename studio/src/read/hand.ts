// The hand: it follows a pointer as on a critically damped spring, in ticks, and has a velocity that is linear
// in each. Times, places and velocities are whole numbers of small units, so that a saved hand is exact.

import type { Start } from "./scan";

/** Part of a second, of a metre and of a metre per second in which a hand is kept. */
export const TIMES = 5000;
export const PLACES = 1e6;
export const SPEEDS = 1e6;

/** Times by which the device runs slower than the wall clock. */
export const SLOWNESS = [40, 10, 1] as const;
export type Slowness = (typeof SLOWNESS)[number];
/** A tick of the wall clock, ms. */
export const TICK = 8;
/** Time constant with which the hand follows the pointer, ms of the wall clock: a slower clock raises the
 * accelerations of the device by its square. */
const FOLLOWS: Readonly<Record<Slowness, number>> = { 40: 60, 10: 30, 1: 14 };
/** Distance, m, and motion in a tick, m, below which the hand stops at its aim. */
const ARRIVED = 2e-6;
/** Time, s of the device, after which a hand at rest needs no more rows: the pins have settled. */
const RESTS = 0.25;

/** A hand from a begin at rest: rows of time, vx and vy in whole units. */
export interface HandRows {
  readonly start: readonly [number, number];
  readonly rows: readonly (readonly [number, number, number])[];
}

export interface Place {
  readonly x: number;
  readonly y: number;
}

/** Place and velocity, m and m/s. */
export interface Motion extends Place {
  readonly vx: number;
  readonly vy: number;
}

export class Hand {
  private ticks = 0;
  /** Time of the last row with a velocity, in units. */
  private moved = 0;
  private startUnits: [number, number];
  private units: [number, number, number][] = [];
  /** Place at each row, m; the first is the start. */
  private places: Place[];

  constructor(
    start: Place,
    readonly slowness: Slowness,
  ) {
    this.startUnits = [Math.round(start.x * PLACES), Math.round(start.y * PLACES)];
    this.places = [this.start];
  }

  /** The hand that was saved, from its begin. */
  static of(saved: HandRows, slowness: Slowness): Hand {
    const hand = new Hand({ x: saved.start[0] / PLACES, y: saved.start[1] / PLACES }, slowness);
    for (const [time, vx, vy] of saved.rows) hand.add(time, vx, vy);
    return hand;
  }

  get start(): Start {
    return { x: this.startUnits[0] / PLACES, y: this.startUnits[1] / PLACES };
  }
  /** Time of the last row, s of the device. */
  get end(): number {
    return this.ticks / TIMES;
  }
  get count(): number {
    return this.units.length;
  }
  /** Place at the last row, m. */
  get last(): Place {
    return this.places[this.places.length - 1]!;
  }
  get saved(): HandRows {
    return { start: this.startUnits, rows: this.units };
  }

  /** Rows from an index on: time, vx and vy of each, SI. */
  rowsFrom(first: number): Float64Array {
    return Float64Array.from(
      this.units.slice(first).flatMap(([time, vx, vy]) => [time / TIMES, vx / SPEEDS, vy / SPEEDS]),
    );
  }

  /** True if the hand has rested at an aim for long enough, s, that nothing changes any more. */
  rests(aim: Place, straight: boolean, lasts = RESTS): boolean {
    const { x, y } = this.last;
    const arrived = Math.abs(aim.x - x) < ARRIVED && (straight || Math.abs(aim.y - y) < ARRIVED);
    return arrived && this.ticks - this.moved > lasts * TIMES;
  }

  /** Goes on by rows in whole units. */
  extend(rows: Float64Array): void {
    for (let i = 0; i < rows.length; i += 3) this.add(rows[i]!, rows[i + 1]!, rows[i + 2]!);
  }

  /** A tick towards an aim; `straight`: along a ruler, at an even height. */
  follow(aim: Place, straight: boolean): void {
    const lasts = (TICK * 1e-3) / this.slowness;
    const { x, y } = this.last;
    const [, vx, vy] = this.units[this.units.length - 1] ?? [0, 0, 0];
    const across = straight ? y : aim.y;
    this.add(
      this.ticks + Math.round(lasts * TIMES),
      this.next(x, vx / SPEEDS, aim.x, lasts),
      this.next(y, vy / SPEEDS, across, lasts),
    );
  }

  /** Velocity after a tick, in units: the exact motion of a critically damped follower, with an even
   * acceleration. */
  private next(x: number, v: number, aim: number, lasts: number): number {
    const left = Math.exp(-TICK / FOLLOWS[this.slowness]);
    const pull = (1 - left) ** 2 / lasts ** 2;
    const damp = ((1 - left) * (3 + left)) / 2 / lasts;
    const arrived = Math.abs(x - aim) < ARRIVED && Math.abs(v) * lasts < ARRIVED;
    return arrived ? 0 : Math.round((v - lasts * (pull * (x - aim) + damp * v)) * SPEEDS);
  }

  private add(time: number, vx: number, vy: number): void {
    const [, wx, wy] = this.units[this.units.length - 1] ?? [0, 0, 0];
    const lasts = (time - this.ticks) / TIMES;
    const { x, y } = this.last;
    this.places.push({
      x: x + 0.5 * (vx / SPEEDS + wx / SPEEDS) * lasts,
      y: y + 0.5 * (vy / SPEEDS + wy / SPEEDS) * lasts,
    });
    this.units.push([time, vx, vy]);
    this.ticks = time;
    if (vx || vy) this.moved = time;
  }

  /** Place and velocity at a time, s of the device, until the end. */
  at(time: number): Motion {
    const { units, places } = this;
    let [low, high] = [0, units.length]; // row i ends stretch i, which begins at places[i]
    while (low < high) {
      const middle = (low + high) >> 1;
      if (units[middle]![0] / TIMES < time) low = middle + 1;
      else high = middle;
    }
    const to = units[Math.min(low, units.length - 1)];
    if (!to) return { ...this.start, vx: 0, vy: 0 };
    const i = Math.min(low, units.length - 1);
    const from = units[i - 1] ?? [0, 0, 0];
    const lasts = (to[0] - from[0]) / TIMES;
    const since = Math.min(Math.max(time - from[0] / TIMES, 0), lasts);
    const part = since / lasts;
    const { x, y } = places[i]!;
    const [vx, wx] = [from[1] / SPEEDS, to[1] / SPEEDS];
    const [vy, wy] = [from[2] / SPEEDS, to[2] / SPEEDS];
    return {
      x: x + since * (vx + 0.5 * (wx - vx) * part),
      y: y + since * (vy + 0.5 * (wy - vy) * part),
      vx: vx + (wx - vx) * part,
      vy: vy + (wy - vy) * part,
    };
  }
}
