// The device of a page, simulated live: tasks of a worker, and its answers.
import type { Core } from "../core";
import type { Piece } from "../input";
import { Device, type DeviceInput, type Line, type Raster, Scan, type SpeedLimit, type Start } from "./scan";

/** Quantities of each sample, in their order. */
export const SAMPLED = ["position", "stretch", "pull", "command", "luminance"] as const;
/** Time between two samples, s of the device. */
const SAMPLING = 1e-3;
const HANDS = [0.005, 1] as const; // m/s

export interface Opened {
  readonly open: { readonly device: DeviceInput; readonly page: Raster; readonly start: Start };
}
/** Rows of time, vx and vy that follow the rows before, and the time to advance to. */
export interface Moved {
  readonly rows: Float64Array;
  readonly until: number;
}
/** A whole hand whose lines are to be evaluated. */
export interface Judged {
  readonly judge: Opened["open"] & { readonly rows: Float64Array };
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

  private open({ device, page, start }: Opened["open"]): void {
    this.scan?.free();
    this.device?.free();
    [this.scan, this.device, this.now] = [null, null, 0];
    this.device = new Device(this.core, device);
    this.pins = device.spots.length;
    this.scan = new Scan(this.core, this.device, this.pins, start);
    this.scan.setPage(page);
  }

  private advance({ rows, until }: Moved): Samples {
    const began = performance.now();
    const { scan, pins } = this;
    if (!scan) throw new Error("no device is open");
    for (let i = 0; i < rows.length; i += 3) scan.move(rows[i]!, rows[i + 1]!, rows[i + 2]!);
    const times: number[] = [];
    for (let k = Math.floor(this.now / SAMPLING) + 1; k * SAMPLING < until; ++k) times.push(k * SAMPLING);
    if (until > this.now) times.push(until);
    const values = new Float64Array(times.length * SAMPLED.length * pins);
    times.forEach((time, i) => {
      scan.advance(time);
      SAMPLED.forEach((name, q) => {
        scan.read(name, values, (i * SAMPLED.length + q) * pins);
      });
    });
    this.now = until;
    return { until, times: Float64Array.from(times), values, took: performance.now() - began };
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
