// The aim of the hand over time: a pointer, the arrow keys, or a demonstration.
import { HEIGHT, type Spot } from "./paper";

/** Time after which the way of a pointer is known, ms. */
const DELAY = 16;
const EDGE = 0.5; // mm of the page that the hand does not enter
const STROKE = 60; // mm/s of the device, of the demonstration and of the arrow keys

interface Aim extends Spot {
  /** ms of the wall clock. */
  readonly wall: number;
}

/** Place of a pointer, linear between its events. */
export class Pointer {
  private events: Aim[] = [];
  private last: Spot;

  constructor(at: Spot) {
    this.last = at;
  }

  add(at: Spot, wall: number): void {
    this.events.push({ ...at, wall });
  }

  /** Puts it at a place, wherever it was. */
  put(at: Spot, wall: number): void {
    [this.last, this.events] = [at, [{ ...at, wall }]];
  }

  at(time: number): Spot {
    const { events } = this;
    const wall = time - DELAY;
    while (events.length > 1 && events[1]!.wall <= wall) events.shift();
    const [from, to] = events;
    if (!from || wall < from.wall) return this.last;
    const part = to ? (wall - from.wall) / (to.wall - from.wall) : 0;
    this.last = to ? { x: from.x + part * (to.x - from.x), y: from.y + part * (to.y - from.y) } : from;
    return this.last;
  }
}

/** Strokes of the demonstration, to and fro at an even speed. */
export class Demonstration {
  constructor(
    private readonly width: number,
    private readonly begin: number,
    private readonly slowness: number,
  ) {}

  /** True after a stroke to and fro. */
  ended(wall: number): boolean {
    return this.strokes(wall) >= 2;
  }

  static readonly start: Spot = { x: 4, y: HEIGHT / 2 };

  private get way(): number {
    return this.width - 2 * Demonstration.start.x;
  }
  private strokes(wall: number): number {
    return (Math.max(0, wall - this.begin) * 1e-3 * STROKE) / this.slowness / this.way;
  }

  at(wall: number): Spot {
    const strokes = this.strokes(wall);
    const x = strokes < 1 ? strokes : Math.max(0, 2 - strokes);
    return { x: Demonstration.start.x + x * this.way, y: Demonstration.start.y };
  }
}

/** Arrow keys, which move an aim at an even speed. */
export class Keys {
  private readonly down = new Set<string>();
  private at: Spot = { x: 0, y: 0 };

  get held(): boolean {
    return this.down.size > 0;
  }
  /** True if the hand keeps its height. */
  get straight(): boolean {
    return !this.down.has("ArrowUp") && !this.down.has("ArrowDown");
  }

  press(key: string, from: Spot): void {
    if (!this.held) this.at = from;
    this.down.add(key);
  }
  release(key: string): void {
    this.down.delete(key);
  }

  /** Aim after some more time, ms of the wall clock. */
  next(lasts: number, slowness: number, width: number): Spot {
    const step = (STROKE / slowness) * lasts * 1e-3;
    const sign = (more: string, less: string): number =>
      Number(this.down.has(more)) - Number(this.down.has(less));
    this.at = limited(
      {
        x: this.at.x + step * sign("ArrowRight", "ArrowLeft"),
        y: this.at.y + step * sign("ArrowDown", "ArrowUp"),
      },
      width,
    );
    return this.at;
  }
}

/** A place on the page, a little within. */
export function limited({ x, y }: Spot, width: number): Spot {
  const within = (value: number, most: number): number => Math.min(Math.max(value, EDGE), most - EDGE);
  return { x: within(x, width), y: within(y, HEIGHT) };
}
