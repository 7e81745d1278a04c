// The device of a page, simulated live: tasks of a worker, and its answers.
import type { Core } from "../core";
import type { Piece } from "../input";
import { type Arm, LedHand } from "./arm";
import { SPEEDS, TIMES } from "./hand";
import { Device, type DeviceInput, type Line, type Raster, Scan, type SpeedLimit, type Start } from "./scan";

/** Quantities of each sample, in their order. */
export const SAMPLED = ["position", "stretch", "force", "pull", "command", "luminance"] as const;
/** Time between two samples, s of the device. */
const SAMPLING = 1e-3;
const HANDS = [0.005, 1] as const; // m/s

export interface Opened {
  readonly open: {
    readonly device: DeviceInput;
    readonly page: Raster;
    readonly start: Start;
    /** Arm that leads the hand along its rows; without one the rows are those of the hand. */
    readonly arm?: Arm | null;
  };
}
/** Rows of time, vx and vy that follow the rows before, and the time to advance to: with an arm that of the last row. */
export interface Moved {
  readonly rows: Float64Array;
  readonly until: number;
}
/** A whole hand whose lines are to be evaluated. */
export interface Judged {
  readonly judge: Omit<Opened["open"], "arm"> & { readonly rows: Float64Array };
}
export interface Limited {
  readonly limits: { readonly device: DeviceInput; readonly pitches: readonly number[] };
}
/** A pin whose load is requested, under a whole hand. */
export interface Loaded {
  readonly load: Judged["judge"] & { readonly pin: number };
}
export type Task = Opened | Moved | Judged | Limited | Loaded;

/** Samples until a time: `values` holds, for each time, the sampled quantities of all pins. */
export interface Samples {
  readonly until: number;
  readonly times: Float64Array;
  readonly values: Float64Array;
  /** Rows of the hand that an arm leads, in whole units; empty without one. */
  readonly rows: Float64Array;
  /** Time that it took, ms. */
  readonly took: number;
}
export interface Verdict {
  readonly lines: readonly Line[];
}
export interface Limits {
  /** Largest speeds by pitch, in the order of the task. */
  readonly limits: readonly SpeedLimit[];
}
/** Rows of the factor of the plate friction of a pin: time, s, and factor. */
export interface Load {
  readonly load: readonly Piece[];
}
export interface Failure {
  readonly failed: string;
}
export type Answer = Samples | Verdict | Limits | Load | Failure | null;

export class Engine {
  private device: Device | null = null;
  private scan: Scan | null = null;
  private pins = 0;
  private now = 0;
  private led: LedHand | null = null;
  private forces = new Float64Array(0);

  constructor(private readonly core: Core) {}

  /** The answer to a task; a device that cannot be is a failure in words. */
  answer(task: Task): Answer {
    try {
      if ("open" in task) this.open(task.open);
      else if ("until" in task) return this.advance(task);
      else if ("judge" in task) return this.withHand(task.judge, (scan) => ({ lines: scan.lines() }));
      else if ("load" in task)
        return this.withHand(task.load, (scan) => ({ load: scan.load(task.load.pin) }));
      else return this.limits(task.limits);
      return null;
    } catch (error) {
      return { failed: error instanceof Error ? error.message : String(error) };
    }
  }

  private open({ device, page, start, arm }: Opened["open"]): void {
    this.scan?.free();
    this.device?.free();
    [this.scan, this.device, this.now] = [null, null, 0];
    this.device = new Device(this.core, device);
    this.pins = device.spots.length;
    this.led = arm ? new LedHand(arm) : null;
    this.forces = new Float64Array(this.pins);
    this.scan = new Scan(this.core, this.device, this.pins, start);
    this.scan.setPage(page);
  }

  private advance({ rows, until }: Moved): Samples {
    const began = performance.now();
    const { scan, led } = this;
    if (!scan) throw new Error("no device is open");
    const times: number[] = [];
    const values: number[] = [];
    const own: number[] = [];
    let next = Math.floor(this.now / SAMPLING) + 1;
    const sample = (time: number): void => {
      times.push(time);
      values.push(...this.sampled(scan));
      this.now = time;
      while (next * SAMPLING <= time) ++next;
    };
    for (let i = 0; i < rows.length; i += 3) {
      const [time, vx, vy] = [rows[i]!, rows[i + 1]!, rows[i + 2]!];
      if (!led) scan.move(time, vx, vy);
      led?.follow(
        time,
        vx,
        () => this.force(scan),
        (end, speed) => {
          scan.move(end, speed, 0);
          scan.advance(end);
          own.push(Math.round(end * TIMES), Math.round(speed * SPEEDS), 0);
          if (end >= next * SAMPLING) sample(end);
        },
      );
    }
    while (!led && next * SAMPLING < until) {
      scan.advance(next * SAMPLING);
      sample(next * SAMPLING);
    }
    const end = led?.time ?? until;
    if (end > this.now) {
      if (!led) scan.advance(end);
      sample(end);
    }
    const took = performance.now() - began;
    const [at, all] = [Float64Array.from(times), Float64Array.from(values)];
    return { until: end, times: at, values: all, rows: Float64Array.from(own), took };
  }

  /** The sampled quantities of all pins now. */
  private sampled(scan: Scan): Float64Array {
    const values = new Float64Array(SAMPLED.length * this.pins);
    SAMPLED.forEach((name, q) => {
      scan.read(name, values, q * this.pins);
    });
    return values;
  }
  /** Force of all pins against the hand now, N. */
  private force(scan: Scan): number {
    scan.read("force", this.forces, 0);
    return this.forces.reduce((sum, force) => sum + force, 0);
  }

  /** Uses a scan of a whole hand, before its first advance. */
  private withHand<T>({ device: input, page, start, rows }: Judged["judge"], use: (scan: Scan) => T): T {
    const device = new Device(this.core, input);
    try {
      const scan = new Scan(this.core, device, input.spots.length, start);
      try {
        scan.setPage(page);
        for (let i = 0; i < rows.length; i += 3) scan.move(rows[i]!, rows[i + 1]!, rows[i + 2]!);
        return use(scan);
      } finally {
        scan.free();
      }
    } finally {
      device.free();
    }
  }

  private limits({ device: input, pitches }: Limited["limits"]): Limits {
    const device = new Device(this.core, input);
    try {
      return { limits: pitches.map((pitch) => device.speedLimit(pitch, ...HANDS)) };
    } finally {
      device.free();
    }
  }
}
