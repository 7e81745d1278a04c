// A device under a hand in the core: the functions of capi/pindrive.h for scans. SI units throughout.
import type { Core } from "../core";
import type { Piece, Row, Rows } from "../input";
import { CoreError, PIECE_BYTES, TERM_BYTES } from "../memory";

/** A device by the keys of a device file, with the spots of its pins from the hand, m. */
export interface DeviceInput {
  readonly numbers: Readonly<Record<string, number>>;
  readonly rows: Readonly<Record<string, Rows>>;
  readonly spots: readonly Row[];
}

/** Luminance from 0 (black) to 255 (white), row by row from the top left corner at (0, 0). */
export interface Raster {
  readonly grey: Uint8Array;
  readonly rows: number;
  readonly columns: number;
  /** Size of a pixel, m. */
  readonly pixel: number;
}

/** Begin of a hand at rest, m. */
export interface Start {
  readonly x: number;
  readonly y: number;
}

/** Quantities of the pins that a picture shows, by their numbers in pindrive.h. */
export const SHOWN = { position: 0, stretch: 5, force: 7, pull: 9, command: 12, luminance: 13 } as const;
export type Shown = keyof typeof SHOWN;

const OUTCOMES = ["shown", "unseen", "merged", "faint", "false"] as const;
export type Outcome = (typeof OUTCOMES)[number];

/** A printed line under a pin, or a swing of a pin that feels like one. */
export interface Line {
  readonly pin: number;
  readonly outcome: Outcome;
  /** Time at which its begin is under the spot, or of the swing, s. */
  readonly time: number;
  /** Place of the spot then, m. */
  readonly x: number;
  readonly y: number;
  /** Way of the hand until the response, m. */
  readonly lag: number;
  /** Displacement of the pin, m. */
  readonly stroke: number;
}

/** Speeds at which two lines are distinct, m/s; NaN: none. */
export interface SpeedLimit {
  readonly from: number;
  readonly to: number;
  readonly settled: number;
}

// Bytes of the structures of pindrive.h with 32-bit pointers.
const LINE_BYTES = 200;
const LIMIT_BYTES = 32;

/** Device in the core; to be freed. */
export class Device {
  readonly handle: number;

  constructor(
    readonly core: Core,
    input: DeviceInput,
  ) {
    this.handle = core.wasm.pindrive_device_new!();
    if (!this.handle) throw new CoreError("out of memory");
    for (const [key, value] of Object.entries(input.numbers)) {
      core.setNumber("device_set", this.handle, key, value);
    }
    for (const [key, rows] of Object.entries(input.rows)) {
      core.setRows("device_set_rows", this.handle, key, rows);
    }
    const { spots } = input;
    core.borrowed(16 * spots.length, (at) => {
      const columns = new Float64Array(core.buffer, at, 2 * spots.length);
      spots.forEach(([x, y], i) => {
        columns[i] = x;
        columns[spots.length + i] = y;
      });
      core.call("device_set_pins", this.handle, at, at + 8 * spots.length, spots.length);
    });
  }

  free(): void {
    this.core.wasm.pindrive_device_free!(this.handle);
  }

  /** Largest hand speeds over two lines, half as wide as their pitch, m. Throws CoreError. */
  speedLimit(pitch: number, slowest: number, fastest: number): SpeedLimit {
    return this.core.borrowed(LIMIT_BYTES, (at) => {
      const { core, handle } = this;
      core.call("device_speed_limit", handle, pitch, 0.5 * pitch, slowest, fastest, 0, 0, at);
      const [from, to, settled] = [0, 8, 16].map((offset) => core.view().getFloat64(at + offset, true));
      return { from: from!, to: to!, settled: settled! };
    });
  }
}

/** Pins of a device under a hand that is given row by row; to be freed. */
export class Scan {
  private readonly handle: number;

  /** Pins at rest under a hand at rest at time 0. Throws CoreError for a device that cannot be. */
  constructor(
    private readonly core: Core,
    device: Device,
    private readonly pins: number,
    start: Start,
  ) {
    this.handle = core.borrowed(4, (at) => {
      core.call("scan_new", device.handle, 0, start.x, start.y, 0, 0, 1, at);
      return core.view().getUint32(at, true);
    });
  }

  free(): void {
    this.core.wasm.pindrive_scan_free!(this.handle);
  }

  setPage(page: Raster): void {
    const { grey, rows, columns, pixel } = page;
    this.core.borrowed(8 * grey.length, (at) => {
      const luminance = new Float64Array(this.core.buffer, at, grey.length);
      for (let i = 0; i < grey.length; ++i) luminance[i] = grey[i]! / 255;
      this.core.call("scan_set_page", this.handle, at, rows, columns, pixel, 0, 0);
    });
  }

  /** Moves the hand on to a later time, s, at which it has a velocity, m/s. */
  move(time: number, vx: number, vy: number): void {
    this.core.call("scan_move", this.handle, time, vx, vy, 1);
  }

  /** Advances the pins to a time, s, until which the hand is known. */
  advance(until: number): void {
    this.core.call("scan_advance", this.handle, until, 0, 0);
  }

  /** A quantity of all pins now, into an array from an index on. */
  read(quantity: Shown, into: Float64Array, from: number): void {
    this.core.borrowed(8 * this.pins, (at) => {
      this.core.call("scan_evaluate", this.handle, SHOWN[quantity], at);
      into.set(new Float64Array(this.core.buffer, at, this.pins), from);
    });
  }

  /** Factor of the plate friction of one pin over the time since the begin, before the first advance. */
  load(pin: number): Piece[] {
    const { core, handle } = this;
    const ask = (pieces: number, terms: number, capacity: number): number =>
      core.borrowed(4, (at) => {
        core.call("scan_load", handle, pin, pieces, terms, capacity, at);
        return core.view().getUint32(at, true);
      });
    const count = ask(0, 0, 0);
    return core.borrowed((PIECE_BYTES + 2 * TERM_BYTES) * count, (at) => {
      ask(at, at + PIECE_BYTES * count, count);
      return core.piecesAt(at, count);
    });
  }

  /** Lines under the hand as given so far, and false lines, before the first advance. */
  lines(): Line[] {
    const { core, handle } = this;
    const ask = (lines: number, capacity: number): number =>
      core.borrowed(8, (at) => {
        core.call("scan_lines", handle, 0, 0, lines, capacity, at, at + 4);
        return core.view().getUint32(at, true);
      });
    let capacity = 128;
    for (;;) {
      const found = core.borrowed(capacity * LINE_BYTES, (at) => {
        const count = ask(at, capacity);
        if (count > capacity) return count;
        const view = core.view();
        return Array.from({ length: count }, (_, i) => lineAt(view, at + i * LINE_BYTES));
      });
      if (typeof found !== "number") return found;
      capacity = found;
    }
  }
}

function lineAt(view: DataView, at: number): Line {
  const number = (offset: number): number => view.getFloat64(at + offset, true);
  return {
    pin: view.getUint32(at, true),
    outcome: OUTCOMES[view.getInt32(at + 4, true)]!,
    time: number(8),
    x: number(16),
    y: number(24),
    lag: number(48),
    stroke: number(136),
  };
}
