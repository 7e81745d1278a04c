// Samples of motions for plots: columns at common times, with both limits at each event.

import { problemOf } from "./checks";
import {
  type Core,
  CoreError,
  type Motion,
  type QuantityName,
  type Segment,
  type StopTransition,
  type Transition,
} from "./core";
import { coreInput, plateVelocity, settlingBand, valueFor } from "./design";
import type { Values } from "./friction";

export type EventKind = Exclude<Transition | StopTransition, "none">;
export type ContactName = "plate" | "finger" | "both" | "stop";
export interface ContactEvent {
  readonly time: number;
  readonly contact: ContactName;
  readonly kind: EventKind;
  readonly position: number;
  readonly velocity: number;
}
export type PhaseKind = "carried" | "resting" | "gripping";
export interface Phase {
  readonly kind: PhaseKind;
  readonly begin: number;
  readonly end: number;
}

/** One motion: its numbers, its events in the window, and columns at the times of the window. */
export interface Curves {
  readonly times: Float64Array;
  readonly columns: Partial<Record<QuantityName, Float64Array>>;
  readonly events: readonly ContactEvent[];
  readonly phases: readonly Phase[];
  readonly numbers: Readonly<Record<string, number>>;
  readonly energy: Readonly<Record<string, number>>;
  readonly certificate: Readonly<Record<string, number>>;
  readonly end: string;
  readonly status: number;
  /** Observation time of the numbers of the motion, s. */
  readonly duration: number;
  readonly compliant: boolean;
}

/** A motion that exists, or why it does not. */
export type Simulated = { readonly curves: Curves } | { readonly problem: string };

export const SAMPLES = 801;
const EVENTS = 400; // markers that a plot can show

interface Made {
  readonly motion: Motion;
  readonly values: Values;
  readonly duration: number;
  readonly events: readonly ContactEvent[];
}

/** Motions of several designs over one window: the longest of their windows, unless given. */
export function simulateAll(
  core: Core,
  designs: readonly Values[],
  windowEnd: number | null,
  samples = SAMPLES,
): { end: number; found: Simulated[] } {
  const made = designs.map((values): Made | string => {
    try {
      return begin(core, values);
    } catch (error) {
      if (error instanceof CoreError) return error.message;
      throw error;
    }
  });
  const good = made.filter((one): one is Made => typeof one !== "string");
  try {
    const end = windowEnd ?? good.reduce((most, { duration }) => Math.max(most, duration), 1e-3);
    const grid = commonTimes(good, end, samples);
    const found = made.map(
      (one): Simulated => (typeof one === "string" ? { problem: one } : { curves: sampled(one, grid, end) }),
    );
    return { end, found };
  } finally {
    for (const { motion } of good) motion.free();
  }
}

function begin(core: Core, values: Values): Made {
  const problem = problemOf(values);
  if (problem) throw new CoreError(problem);
  const motion = core.simulate(coreInput(values));
  const given = valueFor(values, "motion.duration");
  const known = motion.outcome.knownUntil;
  const long = typeof given === "number" ? given : motion.duration(settlingBand(values));
  const duration = Math.min(long, known);
  return { motion, values, duration, events: eventsOf(motion, duration) };
}

/**
 * Changes at the ends of modes, with the state right after, in Python's order; cycles are expanded.
 */
function eventsOf(motion: Motion, until: number): ContactEvent[] {
  const found: ContactEvent[] = [];
  for (const { segment, next, shift } of expanded(motion, motion.segments(until), until)) {
    const time = segment.end + shift;
    if (time > until || found.length >= EVENTS) break;
    const { plateEvent: plate, fingerEvent: finger, stopEvent: stop } = segment;
    const friction = plate === finger ? { both: plate } : { plate, finger };
    const [position, velocity] = next
      ? [next.position, next.velocity]
      : (["position", "velocity"] as const).map((name) => motion.evaluate(name, Float64Array.of(time))[0]!);
    for (const [contact, kind] of Object.entries({ ...friction, stop })) {
      if (kind === "none") continue;
      found.push({ time, contact: contact as ContactName, kind, position: position!, velocity: velocity! });
    }
  }
  return found;
}

/** Modes in order with their successors; modes of a cycle repeat, later by `shift`. */
function* expanded<T extends Segment>(
  motion: Motion,
  segments: readonly T[],
  until: number,
): Generator<{ segment: T; next: T | undefined; shift: number }> {
  const { cycleBegin, simulated } = motion.outcome;
  const round = simulated - cycleBegin;
  const first = round > 0 ? segments.find(({ begin }) => begin >= cycleBegin) : undefined;
  for (let shift = 0, rounds = 0; rounds < 200; ++rounds, shift += round) {
    for (const [i, segment] of segments.entries()) {
      if (rounds > 0 && segment.begin < cycleBegin) continue;
      yield { segment, next: segments[i + 1] ?? first, shift };
    }
    if (!(round > 0) || simulated + shift >= until) return;
  }
}

interface Grid {
  readonly times: Float64Array;
  /** Indices with a left limit. */
  readonly left: readonly number[];
}

function commonTimes(made: readonly Made[], end: number, samples: number): Grid {
  const events = made.flatMap(({ events }) => events.map(({ time }) => time));
  const jumps = [...new Set(events.filter((time) => time > 0 && time < end))].sort((a, b) => a - b);
  const times = new Float64Array(samples + 2 * jumps.length);
  const left: number[] = [];
  let [at, next] = [0, 0];
  for (let i = 0; i < samples; ++i) {
    const time = i === samples - 1 ? end : (end * i) / (samples - 1);
    for (; next < jumps.length && jumps[next]! <= time; ++next) {
      left.push(at);
      times[at++] = jumps[next]!;
      times[at++] = jumps[next]!;
    }
    times[at++] = time;
  }
  return { times, left };
}

function sampled({ motion, values, duration, events }: Made, grid: Grid, end: number): Curves {
  const compliant = values["finger.stiffness"] !== undefined;
  const names: QuantityName[] = ["position", "velocity", "acceleration", "plate_force", "finger_force"];
  if (compliant) names.push("stretch", "stretch_rate");
  const { knownUntil } = motion.outcome;
  const known = grid.times.findIndex((time) => time > knownUntil);
  const asked = known < 0 ? grid.times : grid.times.subarray(0, known);
  const left = grid.left.filter((index) => index < asked.length);
  const before = Float64Array.from(left, (index) => grid.times[index]!);
  const columns: Partial<Record<QuantityName, Float64Array>> = {};
  for (const name of names) {
    const column = new Float64Array(grid.times.length).fill(NaN);
    column.set(motion.evaluate(name, asked));
    const limits = motion.evaluate(name, before, "left");
    left.forEach((index, i) => {
      column[index] = limits[i]!;
    });
    columns[name] = column;
  }
  return {
    times: grid.times,
    columns,
    events: events.filter(({ time }) => time <= end),
    phases: phasesOf(motion, values, Math.min(end, knownUntil)),
    numbers: motion.numbers(duration, settlingBand(values)),
    energy: motion.energy(duration),
    certificate: motion.certificate(duration),
    end: motion.outcome.end,
    status: motion.outcome.status,
    duration,
    compliant,
  };
}

/** Times of stick: on the moving plate, at rest on finger, plate or stop, and of sticking skin. */
function phasesOf(motion: Motion, values: Values, end: number): Phase[] {
  const found: Phase[] = [];
  const add = (kind: PhaseKind, begin: number, until: number): void => {
    const last = found.findLast((phase) => phase.kind === kind);
    if (last && last.end === begin) found[found.indexOf(last)] = { ...last, end: until };
    else found.push({ kind, begin, end: until });
  };
  const segments = motion.segments(end).map((segment) => {
    const times = [segment.begin, segment.begin + Math.min(segment.end - segment.begin, 1) / 2];
    return { ...segment, stands: times.every((time) => plateVelocity(values, time) === 0) };
  });
  for (const { segment, shift } of expanded(motion, segments, end)) {
    const [begin, until] = [segment.begin + shift, Math.min(segment.end + shift, end)];
    if (begin >= end || until <= begin) continue;
    const rests =
      (segment.atStop && segment.still) ||
      segment.finger === "sticks" ||
      (segment.plate === "sticks" && segment.stands);
    if (rests) add("resting", begin, until);
    else if (segment.plate === "sticks") add("carried", begin, until);
    if (segment.finger === "grips") add("gripping", begin, until);
  }
  return found;
}

/** The value of a column at any time of the window, between its neighbours. */
export function columnAt(curves: Curves, name: QuantityName, time: number): number {
  const { times } = curves;
  const column = curves.columns[name];
  if (!column) return NaN;
  let [low, high] = [0, times.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle]! <= time) low = middle;
    else high = middle;
  }
  const span = times[high]! - times[low]!;
  const part = span > 0 ? Math.min(Math.max((time - times[low]!) / span, 0), 1) : 0;
  return column[low]! + part * (column[high]! - column[low]!);
}
