// Samples of motions for plots: columns at common times, with both limits at each event.

import type { Core } from "./core";
import { coreInput, plateVelocity, settlingBand, valueFor } from "./design";
import type { Values } from "./friction";
import { CoreError } from "./memory";
import type { Motion, QuantityName, Segment, StopTransition, Transition } from "./motion";

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

/** Times from and to, s. */
export type Span = readonly [number, number];

export const SAMPLES = 801;
const ROUNDS = 2000; // rounds of a cycle with drawn phases
const BINS = 1500; // parts of the window in which the curves keep their extremes
const JUMPS = 1500; // events whose both sides are drawn

interface Made {
  readonly motion: Motion;
  readonly values: Values;
  readonly duration: number;
  readonly events: readonly ContactEvent[];
}

/** Motions of several designs over the longest of their durations, with more samples in a span, s. */
export function simulateAll(
  core: Core,
  designs: readonly Values[],
  span: Span | null,
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
    const end = good.reduce((most, { duration }) => Math.max(most, duration), 1e-3);
    const spans: Span[] = [[0, end], ...(span ? [[span[0], Math.min(span[1], end)] as const] : [])];
    const grid = commonTimes(good, spans, samples);
    const found = made.map(
      (one): Simulated => (typeof one === "string" ? { problem: one } : { curves: sampled(one, grid, end) }),
    );
    return { end, found };
  } finally {
    for (const { motion } of good) motion.free();
  }
}

function begin(core: Core, values: Values): Made {
  const [problem] = core.problems(values);
  if (problem) throw new CoreError(problem);
  const motion = core.simulate(coreInput(values));
  const given = valueFor(values, "motion.duration");
  const known = motion.outcome.knownUntil;
  const long = typeof given === "number" ? given : motion.duration(settlingBand(values));
  const duration = Math.min(long, known);
  return { motion, values, duration, events: eventsOf(motion, duration) };
}

/** Events up to a time in Python's order. */
function eventsOf(motion: Motion, until: number): ContactEvent[] {
  return motion.events(until).events.flatMap(({ time, position, velocity, plate, finger, stop }) => {
    const friction = plate === finger ? { both: plate } : { plate, finger };
    return Object.entries({ ...friction, stop }).flatMap(([contact, kind]) =>
      kind === "none" ? [] : [{ time, contact: contact as ContactName, kind, position, velocity }],
    );
  });
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
  for (let shift = 0, rounds = 0; rounds < ROUNDS; ++rounds, shift += round) {
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

/** Even times, both sides of the events, and the turns of position and velocity: curves follow the motion. */
function commonTimes(made: readonly Made[], spans: readonly Span[], samples: number): Grid {
  const events = made.flatMap(({ events }) => events.map(({ time }) => time));
  const jumps = spans.flatMap(([from, to]) =>
    sortedOf(events.filter((time) => time > from && time < to)).slice(0, JUMPS),
  );
  const even = spans.flatMap(([from, to]) =>
    Array.from({ length: samples }, (_, i) =>
      i === samples - 1 ? to : from + ((to - from) * i) / (samples - 1),
    ),
  );
  const turns = made.flatMap(({ motion }) =>
    (["position", "velocity"] as const).flatMap((quantity) => extremesOf(motion, quantity, spans)),
  );
  const sides = new Set(jumps);
  const times: number[] = [];
  const left: number[] = [];
  for (const time of sortedOf([...even, ...jumps, ...turns])) {
    if (sides.has(time)) {
      left.push(times.length);
      times.push(time);
    }
    times.push(time);
  }
  return { times: Float64Array.from(times), left };
}

function sortedOf(times: readonly number[]): number[] {
  return [...new Set(times)].sort((a, b) => a - b);
}

/** Times of the least and the largest value in each part of each span. */
function extremesOf(motion: Motion, quantity: QuantityName, spans: readonly Span[]): number[] {
  const [, end] = spans[0]!;
  const { times, values } = motion.extrema(quantity, Math.min(end, motion.outcome.knownUntil));
  return spans.flatMap(([from, to]) => {
    const found: number[] = [];
    const binOf = (time: number): number => Math.floor(((time - from) / (to - from)) * BINS);
    let i = times.findIndex((time) => time >= from);
    while (i >= 0 && i < times.length && times[i]! < to) {
      const bin = binOf(times[i]!);
      let [least, most] = [i, i];
      for (; i < times.length && binOf(times[i]!) === bin; ++i) {
        if (values[i]! < values[least]!) least = i;
        if (values[i]! > values[most]!) most = i;
      }
      found.push(times[least]!, times[most]!);
    }
    return found.filter((time) => time < to);
  });
}

function sampled({ motion, values, duration, events }: Made, grid: Grid, end: number): Curves {
  const compliant = values["finger.stiffness"] !== undefined;
  const names: QuantityName[] = [
    "position",
    "velocity",
    "acceleration",
    "plate_force",
    "finger_force",
    "housing_force",
  ];
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
