// The core as WebAssembly: the functions of capi/pindrive.h on JavaScript's arrays. SI units throughout.

import { valueAt } from "./pieces";

export type Row = readonly [number, number];
export type Rows = readonly Row[];
/** Term (cosine, sine, decay, frequency) of a piece: (cosine cos Ωτ + sine sin Ωτ) e^(−δτ). */
export type Term = readonly [number, number, number, number];
/** Part of a function of time from its begin (s) on: a polynomial and terms. */
export interface Piece {
  readonly begin: number;
  readonly polynomial: readonly number[];
  readonly terms: readonly Term[];
}
/** Function of time: its pieces, and the parameters from which they were made, by name. */
export interface Part {
  readonly parameters?: Readonly<Record<string, number>>;
  readonly pieces: readonly Piece[];
}
/** Sum of functions of time. */
export interface TimeFunction {
  readonly parts: readonly Part[];
}
/** Sizes of pindrive_piece and pindrive_term, and the place of the terms in a piece. */
export const PIECE_BYTES = 64;
export const TERM_BYTES = 32;
const TERMS_AT = 56;

/** A drive and a release in the names of pindrive.h; a rate along which they change looks alike. */
export interface Input {
  readonly drive: Readonly<Record<string, number>>;
  readonly curves: Readonly<Record<string, Rows>>;
  readonly release: Readonly<Record<string, number>>;
  readonly profiles: Readonly<Record<string, Rows>>;
  readonly functions: Readonly<Record<string, TimeFunction>>;
}

export const QUANTITIES = [
  "position",
  "velocity",
  "acceleration",
  "plate_force",
  "finger_force",
  "stretch",
  "stretch_rate",
  "stop_force",
] as const;
export type QuantityName = (typeof QUANTITIES)[number];
export type Side = "left" | "right";

const ENDS = [
  "moving",
  "resting",
  "decaying",
  "free",
  "grazing",
  "stick_slip",
  "limit_cycle",
  "driven",
  "irregular",
  "drifting",
  "growing",
  "approaching",
] as const;
export type End = (typeof ENDS)[number];
const TRANSITIONS = ["none", "stick", "slip", "reverse"] as const;
export type Transition = (typeof TRANSITIONS)[number];
/** Contact numbers of an end stop: impact, release, rebound. */
const AT_STOP = ["none", "stop", "leave", "stop"] as const;
export type StopTransition = (typeof AT_STOP)[number];
const CONTACT_STATES: Readonly<Record<number, ContactState>> = {
  [-1]: "slips backward",
  0: "sticks",
  1: "slips forward",
  2: "absent",
  3: "grips",
  4: "slips across",
};
export type ContactState =
  | "slips backward"
  | "sticks"
  | "slips forward"
  | "absent"
  | "grips"
  | "slips across";

export interface Outcome {
  readonly status: number;
  readonly end: End;
  readonly steadySince: number;
  readonly period: number;
  readonly knownUntil: number;
  readonly simulated: number;
  readonly cycleBegin: number;
  readonly segments: number;
}

export interface Segment {
  readonly begin: number;
  readonly end: number;
  /** At its begin, m and m/s. */
  readonly position: number;
  readonly velocity: number;
  readonly plate: ContactState;
  readonly finger: ContactState;
  /** True for an end stop in contact with a pin without velocity and acceleration. */
  readonly atStop: boolean;
  readonly still: boolean;
  /** Events at its end. */
  readonly plateEvent: Transition;
  readonly fingerEvent: Transition;
  readonly stopEvent: StopTransition;
}

/** Change of contacts, with the state right after. */
export interface Event {
  readonly time: number;
  readonly position: number;
  readonly velocity: number;
  readonly plate: Transition;
  readonly finger: Transition;
  readonly stop: StopTransition;
}

/** Error of the core, in its words. */
export class CoreError extends Error {}

type Exports = { readonly memory: WebAssembly.Memory } & Readonly<
  Record<string, (...given: number[]) => number>
>;

const MORE = 1; // PINDRIVE_MORE: there was more than fitted
const INTERFACE = 2; // PINDRIVE_INTERFACE that this file is written for
const TEXT_BYTES = 1 << 13;
const OUTCOME_BYTES = 56;
const SEGMENT_BYTES = 80;
const EVENT_BYTES = 40;
/** Largest number of events, and of extrema, of one motion. */
const MOST = 1 << 16;

export class Core {
  readonly numberNames: readonly string[];
  readonly energyNames: readonly string[];
  readonly certificateNames: readonly string[];

  private constructor(readonly wasm: Exports) {
    wasm._initialize?.();
    const found = wasm.pindrive_interface!();
    if (found !== INTERFACE) throw new CoreError(`the core has interface ${found}, not ${INTERFACE}`);
    const names = (of: string): string[] =>
      Array.from({ length: wasm[`pindrive_${of}_count`]!() }, (_, i) =>
        this.text(wasm[`pindrive_${of}_name`]!(i)),
      );
    this.numberNames = names("number");
    this.energyNames = names("energy");
    this.certificateNames = names("certificate");
  }

  static async load(compiled: WebAssembly.Module): Promise<Core> {
    const imports: Record<string, Record<string, () => number>> = {};
    for (const { module: from, name } of WebAssembly.Module.imports(compiled)) {
      imports[from] = { ...imports[from], [name]: () => 8 }; // EBADF: the core has no files
    }
    const instance = await WebAssembly.instantiate(compiled, imports);
    return new Core(instance.exports as unknown as Exports);
  }

  statusText(status: number): string {
    return this.text(this.wasm.pindrive_status_text!(status));
  }

  /**
   * Problems of values of a device file, SI, in a line each: the bounds of each value, and what they require of
   * each other; `whole`: of a device with magnet, control block and array. Null: given, but not known.
   */
  problems(values: Readonly<Record<string, number | Rows | TimeFunction | null>>, whole = false): string[] {
    // A function contradicts others by its first value.
    const given = Object.fromEntries(
      Object.entries(values).map(([key, value]) => [
        key,
        typeof value === "object" && value !== null && "parts" in value ? valueAt(value, 0) : value,
      ]),
    ) as Record<string, number | Rows | null>;
    const keys = Object.keys(given);
    const columns = keys.map((key) => {
      const value = given[key]!;
      return value === null ? [] : typeof value === "number" ? [value] : value.flat();
    });
    const numbers = columns.reduce((sum, { length }) => sum + length, 0);
    return this.borrowed(8 * numbers + 12 * keys.length + TEXT_BYTES, (at) =>
      this.named(keys, (addresses) => {
        const [table, text] = [at + 8 * numbers, at + 8 * numbers + 12 * keys.length];
        let next = at;
        columns.forEach((column, i) => {
          new Float64Array(this.buffer, next, column.length).set(column);
          const rows = typeof given[keys[i]!] === "number" ? 0 : column.length / 2;
          [addresses[i]!, column.length ? next : 0, rows].forEach((word, j) => {
            this.view().setUint32(table + 12 * i + 4 * j, word, true);
          });
          next += 8 * column.length;
        });
        this.wasm.pindrive_check_values!(table, keys.length, Number(whole), text, TEXT_BYTES);
        const said = this.text(text);
        return said ? said.split("\n") : [];
      }),
    );
  }

  /** Unit vector at an angle, rad, with the bits that Python has. */
  direction(angle: number): Row {
    return this.borrowed(16, (at) => {
      this.wasm.pindrive_direction!(angle, at, at + 8);
      const [x, y] = new Float64Array(this.buffer, at, 2);
      return [x!, y!];
    });
  }

  /** The pieces of a function of a few numbers, SI. Throws CoreError on numbers out of range. */
  functionPieces(kind: string, numbers: readonly number[]): Piece[] {
    const most = 3; // pieces, and terms
    const termsAt = most * PIECE_BYTES;
    const numbersAt = termsAt + most * TERM_BYTES;
    return this.borrowed(numbersAt + 8 * numbers.length + 4, (at) =>
      this.named([kind], ([address]) => {
        const count = at + numbersAt + 8 * numbers.length;
        new Float64Array(this.buffer, at + numbersAt, numbers.length).set(numbers);
        this.call("function", address!, at + numbersAt, numbers.length, at, at + termsAt, count);
        return this.piecesAt(at, this.view().getUint32(count, true));
      }),
    );
  }

  /** The pieces that the core has written. */
  piecesAt(address: number, count: number): Piece[] {
    const view = this.view();
    const read = (from: number, length: number): number[] =>
      Array.from({ length }, (_, i) => view.getFloat64(from + 8 * i, true));
    return Array.from({ length: count }, (_, i): Piece => {
      const from = address + PIECE_BYTES * i;
      const [begin, ...polynomial] = read(from, 7) as [number, ...number[]];
      const terms = view.getUint32(from + TERMS_AT, true);
      const length = view.getUint32(from + TERMS_AT + 4, true);
      return {
        begin,
        polynomial: polynomial.slice(0, Math.max(polynomial.findLastIndex((p) => p !== 0) + 1, 1)),
        terms: Array.from({ length }, (_, j) => read(terms + TERM_BYTES * j, 4) as unknown as Term),
      };
    });
  }

  /** The motion of a release; to be freed. Throws CoreError on what the core cannot follow. */
  simulate(input: Input): Motion {
    return this.withInput(input, (drive, release) =>
      this.borrowed(4, (out) => {
        this.call("simulate", drive, release, 0, 0, out);
        return new Motion(this, this.view().getUint32(out, true));
      }),
    );
  }

  /** Exact derivatives of the motion along a direction; missing rows are 0. */
  differentiate(input: Input, direction: Input): Motion {
    const { wasm } = this;
    return this.withInput(input, (drive, release) => {
      const driveRate = wasm.pindrive_drive_rate_new!(drive);
      const releaseRate = wasm.pindrive_release_rate_new!(release);
      try {
        this.fill(driveRate, releaseRate, direction);
        return this.borrowed(4, (out) => {
          this.call("differentiate", drive, release, driveRate, releaseRate, 0, 0, out);
          return new Motion(this, this.view().getUint32(out, true));
        });
      } finally {
        wasm.pindrive_drive_free!(driveRate);
        wasm.pindrive_release_free!(releaseRate);
      }
    });
  }

  /** Numbers of many releases, a row of `outputs` for each point; NaN where a point cannot be. */
  batch(
    input: Input,
    varied: Readonly<Record<string, Float64Array>>,
    outputs: readonly string[],
    points: number,
    band: number,
  ): Float64Array {
    const names = Object.keys(varied);
    const width = outputs.length;
    const bytes = names.length * (8 + 8 * points) + 8 * points * width + 4 * width;
    return this.withInput(input, (drive, release) =>
      this.borrowed(bytes, (at) => {
        const numbersAt = at;
        let next = at + 8 * points * width;
        const columns = names.map((name) => {
          const column = next;
          new Float64Array(this.buffer, column, points).set(varied[name]!);
          next += 8 * points;
          return column;
        });
        const table = next;
        const asked = table + 8 * names.length;
        return this.named([...names, ...outputs], (addresses) => {
          const view = this.view();
          addresses.slice(0, names.length).forEach((address, i) => {
            view.setUint32(table + 8 * i, address, true);
            view.setUint32(table + 8 * i + 4, columns[i]!, true);
          });
          addresses.slice(names.length).forEach((address, i) => {
            view.setUint32(asked + 4 * i, address, true);
          });
          this.call(
            "batch",
            drive,
            release,
            table,
            names.length,
            points,
            band,
            asked,
            width,
            0,
            0,
            numbersAt,
            0,
            0,
            0,
            0,
          );
          return new Float64Array(this.buffer, numbersAt, points * width).slice();
        });
      }),
    );
  }

  // ---- memory of the core: what a call takes and gives lies there, and is given back after it ----

  get buffer(): ArrayBuffer {
    return this.wasm.memory.buffer as ArrayBuffer;
  }

  view(): DataView {
    return new DataView(this.buffer);
  }

  /** Calls a function that may fail; whether there was more than fitted. */
  call(name: string, ...given: number[]): boolean {
    const error = this.wasm[`pindrive_${name}`]!(...given);
    if (error > MORE) throw new CoreError(this.text(this.wasm.pindrive_last_error!()));
    return error === MORE;
  }

  borrowed<T>(bytes: number, use: (address: number) => T): T {
    const address = this.wasm.malloc!(Math.max(bytes, 8));
    if (!address) throw new CoreError("out of memory");
    try {
      return use(address);
    } finally {
      this.wasm.free!(address);
    }
  }

  free(motion: number): void {
    this.wasm.pindrive_motion_free!(motion);
  }

  private text(address: number): string {
    const bytes = new Uint8Array(this.buffer, address);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  private named<T>(names: readonly string[], use: (addresses: number[]) => T): T {
    const texts = names.map((name) => new TextEncoder().encode(`${name}\0`));
    return this.borrowed(
      texts.reduce((sum, text) => sum + text.length, 0),
      (at) => {
        let next = at;
        const addresses = texts.map((text) => {
          new Uint8Array(this.buffer, next).set(text);
          next += text.length;
          return next - text.length;
        });
        return use(addresses);
      },
    );
  }

  private withInput<T>(input: Input, use: (drive: number, release: number) => T): T {
    const drive = this.wasm.pindrive_drive_new!();
    const release = this.wasm.pindrive_release_new!();
    try {
      this.fill(drive, release, input);
      return use(drive, release);
    } finally {
      this.wasm.pindrive_drive_free!(drive);
      this.wasm.pindrive_release_free!(release);
    }
  }

  private fill(drive: number, release: number, input: Input): void {
    for (const [contact, rows] of Object.entries(input.curves)) {
      this.setRows("drive_set_curve", drive, contact, rows);
    }
    // Kinetic friction sets the static one too, so it comes first.
    const last = (name: string): number => (name.endsWith(".static") ? 1 : 0);
    const drives = Object.entries(input.drive).sort(([a], [b]) => last(a) - last(b));
    for (const [name, value] of drives) this.setNumber("drive_set", drive, name, value);
    for (const [name, value] of Object.entries(input.release)) {
      this.setNumber("release_set", release, name, value);
    }
    for (const [name, rows] of Object.entries(input.profiles)) {
      this.setRows("release_set_profile", release, name, rows);
    }
    for (const [name, { parts }] of Object.entries(input.functions)) {
      parts.forEach(({ pieces }, i) => {
        this.setPieces(i ? "release_add_function" : "release_set_function", release, name, pieces);
      });
    }
  }

  setNumber(setter: string, target: number, name: string, value: number): void {
    this.named([name], ([address]) => this.call(setter, target, address!, value));
  }

  private setPieces(setter: string, release: number, name: string, pieces: readonly Piece[]): void {
    const terms = pieces.reduce((sum, piece) => sum + piece.terms.length, 0);
    this.borrowed(PIECE_BYTES * pieces.length + TERM_BYTES * terms, (at) =>
      this.named([name], ([address]) => {
        const view = this.view();
        const numbers = (from: number, values: readonly number[]): void =>
          values.forEach((value, i) => {
            view.setFloat64(from + 8 * i, value, true);
          });
        let next = at + PIECE_BYTES * pieces.length;
        pieces.forEach((piece, i) => {
          const from = at + PIECE_BYTES * i;
          numbers(from, [piece.begin, ...Array.from({ length: 6 }, (_, n) => piece.polynomial[n] ?? 0)]);
          view.setUint32(from + TERMS_AT, next, true);
          view.setUint32(from + TERMS_AT + 4, piece.terms.length, true);
          for (const term of piece.terms) {
            numbers(next, term);
            next += TERM_BYTES;
          }
        });
        this.call(setter, release, address!, at, pieces.length);
      }),
    );
  }

  setRows(setter: string, target: number, name: string, rows: Rows): void {
    this.borrowed(16 * rows.length, (at) =>
      this.named([name], ([address]) => {
        const columns = new Float64Array(this.buffer, at, 2 * rows.length);
        rows.forEach(([first, second], i) => {
          columns[i] = first;
          columns[rows.length + i] = second;
        });
        this.call(setter, target, address!, at, at + 8 * rows.length, rows.length);
      }),
    );
  }
}

/** Motion in the core, or its derivatives, with exact values. */
export class Motion {
  readonly outcome: Outcome;

  constructor(
    private readonly core: Core,
    private readonly handle: number,
  ) {
    this.outcome = core.borrowed(OUTCOME_BYTES, (at) => {
      core.call("outcome_of", handle, at);
      const view = core.view();
      const [steadySince, period, knownUntil, simulated, cycleBegin] = [8, 16, 24, 32, 40].map((offset) =>
        view.getFloat64(at + offset, true),
      ) as [number, number, number, number, number];
      return {
        status: view.getInt32(at, true),
        end: ENDS[view.getInt32(at + 4, true)]!,
        steadySince,
        period,
        knownUntil,
        simulated,
        cycleBegin,
        segments: view.getUint32(at + 48, true),
      };
    });
  }

  free(): void {
    this.core.free(this.handle);
  }

  /** The values of a quantity at times in [0, knownUntil]. */
  evaluate(quantity: QuantityName, times: Float64Array, side: Side = "right"): Float64Array {
    return this.core.borrowed(16 * times.length, (at) => {
      const values = at + 8 * times.length;
      new Float64Array(this.core.buffer, at, times.length).set(times);
      const which = [QUANTITIES.indexOf(quantity), at, times.length, side === "left" ? 0 : 1] as const;
      this.core.call("evaluate", this.handle, ...which, values);
      return new Float64Array(this.core.buffer, values, times.length).slice();
    });
  }

  /** Modes that begin before `until`; modes of a cycle occur once. */
  segments(until = Infinity): Segment[] {
    return this.core.borrowed(SEGMENT_BYTES, (at) => {
      const found: Segment[] = [];
      for (let i = 0; i < this.outcome.segments; ++i) {
        this.core.call("segment_of", this.handle, i, at);
        const view = this.core.view();
        const begin = view.getFloat64(at, true);
        if (begin > until) break;
        found.push({
          begin,
          end: view.getFloat64(at + 8, true),
          position: view.getFloat64(at + 16, true),
          velocity: view.getFloat64(at + 24, true),
          plate: CONTACT_STATES[view.getInt32(at + 48, true)]!,
          finger: CONTACT_STATES[view.getInt32(at + 52, true)]!,
          atStop: view.getInt32(at + 72, true) !== 0,
          still: view.getFloat64(at + 24, true) === 0 && view.getFloat64(at + 32, true) === 0,
          plateEvent: TRANSITIONS[view.getInt32(at + 64, true)]!,
          fingerEvent: TRANSITIONS[view.getInt32(at + 68, true)]!,
          stopEvent: AT_STOP[view.getInt32(at + 76, true)]!,
        });
      }
      return found;
    });
  }

  /** Events in [0, until], cycles expanded; `whole` is false if there are more than the largest number. */
  events(until: number): { readonly events: readonly Event[]; readonly whole: boolean } {
    return this.core.borrowed(8 + MOST * EVENT_BYTES, (at) => {
      const more = this.core.call("events", this.handle, 0, until, at + 8, MOST, at);
      const view = this.core.view();
      const events = Array.from({ length: view.getUint32(at, true) }, (_, i): Event => {
        const from = at + 8 + i * EVENT_BYTES;
        return {
          time: view.getFloat64(from, true),
          position: view.getFloat64(from + 8, true),
          velocity: view.getFloat64(from + 16, true),
          plate: TRANSITIONS[view.getInt32(from + 24, true)]!,
          finger: TRANSITIONS[view.getInt32(from + 28, true)]!,
          stop: AT_STOP[view.getInt32(from + 32, true)]!,
        };
      });
      return { events, whole: !more };
    });
  }

  /** Times and values between which a quantity goes one way, in [0, until]. */
  extrema(
    quantity: QuantityName,
    until: number,
  ): { readonly times: Float64Array; readonly values: Float64Array } {
    return this.core.borrowed(8 + 16 * MOST, (at) => {
      const [times, values] = [at + 8, at + 8 + 8 * MOST];
      this.core.call("extrema", this.handle, QUANTITIES.indexOf(quantity), until, times, values, MOST, at);
      const count = this.core.view().getUint32(at, true);
      const column = (from: number): Float64Array => new Float64Array(this.core.buffer, from, count).slice();
      return { times: column(times), values: column(values) };
    });
  }

  /** All numbers over [0, duration], by name; NaN for a duration long enough to see the ending. */
  numbers(duration: number, band: number): Record<string, number> {
    return this.named(this.core.numberNames, (at) =>
      this.core.call("numbers", this.handle, duration, band, at),
    );
  }

  energy(duration: number): Record<string, number> {
    return this.named(this.core.energyNames, (at) => this.core.call("energy", this.handle, duration, at));
  }

  certificate(duration: number): Record<string, number> {
    return this.named(this.core.certificateNames, (at) =>
      this.core.call("certificate", this.handle, duration, at),
    );
  }

  /** Observation time that shows the ending, s. */
  duration(band: number): number {
    return this.core.borrowed(8, (at) => {
      this.core.call("duration", this.handle, band, at);
      return this.core.view().getFloat64(at, true);
    });
  }

  private named(names: readonly string[], ask: (address: number) => void): Record<string, number> {
    return this.core.borrowed(8 * names.length, (at) => {
      ask(at);
      const values = new Float64Array(this.core.buffer, at, names.length);
      return Object.fromEntries(names.map((name, i) => [name, values[i]!]));
    });
  }
}
