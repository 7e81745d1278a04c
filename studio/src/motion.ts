// A motion in the core, with exact values.
import type { Memory, Named } from "./memory";

export const QUANTITIES = [
  "position",
  "velocity",
  "acceleration",
  "plate_force",
  "finger_force",
  "stretch",
  "stretch_rate",
  "housing_force",
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

const OUTCOME_BYTES = 56;
const SEGMENT_BYTES = 80;
const EVENT_BYTES = 40;
/** Largest number of events, and of extrema, of one motion. */
const MOST = 1 << 16;

/** Motion in the core, or its derivatives, with exact values. */
export class Motion {
  readonly outcome: Outcome;

  constructor(
    private readonly core: Memory,
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
    this.core.wasm.pindrive_motion_free!(this.handle);
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
    return this.named("number", (at) => this.core.call("numbers", this.handle, duration, band, at));
  }

  energy(duration: number): Record<string, number> {
    return this.named("energy", (at) => this.core.call("energy", this.handle, duration, at));
  }

  certificate(duration: number): Record<string, number> {
    return this.named("certificate", (at) => this.core.call("certificate", this.handle, duration, at));
  }

  /** Observation time that shows the ending, s. */
  duration(band: number): number {
    return this.core.borrowed(8, (at) => {
      this.core.call("duration", this.handle, band, at);
      return this.core.view().getFloat64(at, true);
    });
  }

  private named(of: Named, ask: (address: number) => void): Record<string, number> {
    const names = this.core.names(of);
    return this.core.borrowed(8 * names.length, (at) => {
      ask(at);
      const values = new Float64Array(this.core.buffer, at, names.length);
      return Object.fromEntries(names.map((name, i) => [name, values[i]!]));
    });
  }
}
