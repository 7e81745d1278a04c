// A recording fitted: its time offset, and parameters by least squares with exact derivatives, from many starts.

import type { Core } from "./core";
import { coreInput, direction, isFunction, isRows, withValue } from "./design";
import type { Values } from "./friction";
import { CoreError } from "./memory";
import type { Motion, QuantityName } from "./motion";
import type { Channel, Recording } from "./recording";
import { DRIVE } from "./table";

/** Outcome of a fit; parts are of the root mean square of the recording, each channel by its own. */
export interface FitReport {
  /** Part that is left. */
  readonly misfit: number;
  /** Part that is noise, by the second differences of the samples. */
  readonly noise: number;
  readonly converged: boolean;
  readonly starts: number;
  readonly steps: number;
  /** Keys without a value of their own in the recording: others make up for any change of them. */
  readonly undetermined: readonly string[];
}
export interface FitResult {
  readonly values: Values;
  readonly offset: number;
  readonly report: FitReport;
}

/** Parameters of a fit: keys of a design, and the time of the release, s. */
interface Point {
  readonly values: Values;
  readonly offset: number;
}
interface Free {
  readonly keys: readonly string[];
  readonly offset: boolean;
}
/** A point with its residuals, and how the search for it ended. */
interface Found extends Point {
  readonly rest: Float64Array;
  readonly cost: number;
  readonly steps: number;
  readonly converged: boolean;
}

const [ALL, ROUGH, COARSE] = [2000, 250, 60]; // samples of a recording: of the end, of refined and of compared starts
const CANDIDATES = 600;
const REFINED = 8; // candidates that are refined, of those for the whole recording and for its beginning
const BEGINNING = 0.35; // part of a recording that is fitted first: a pin that sticks too early is far off afterwards
const FINISHED = 3; // candidates that are refined on all samples
const [FEW, MANY] = [25, 80]; // steps
const SMALL = 1e-10; // relative decrease of the squares that ends a search
const LEVEL = 1e-3; // cosine of residuals and derivatives below which a point is an optimum
const ROUNDS = 6; // better optima beyond kinks that are followed
const DRAWN = 40; // points about an optimum
const SIZES = [0.5, 2, 8]; // distances of these points, in standard errors
const SHARED = 1e9; // factor by which other keys widen the variance of one that is not determined
const [NARROW, WIDE] = [3, 10]; // factors of the candidates either way

interface Data {
  readonly times: Float64Array;
  readonly channels: readonly { name: Channel; values: Float64Array; weight: number }[];
}

/** Every so-many-th sample of a part of a recording, weighed by the size of its channel. */
function thinned(recording: Recording, count: number, part = 1): Data {
  const { times } = recording;
  const end = times[0]! + part * (times[times.length - 1]! - times[0]!);
  const kept = part < 1 ? times.filter((time) => time <= end).length : times.length;
  const step = Math.max(1, Math.ceil(kept / count));
  const thin = (column: Float64Array): Float64Array =>
    column.subarray(0, kept).filter((_, i) => i % step === 0);
  const names = Object.keys(recording.channels) as Channel[];
  const channels = names.map((name) => {
    const whole = recording.channels[name]!;
    const values = thin(whole);
    return { name, values, weight: 1 / (sizeOf(whole) * Math.sqrt(values.length * names.length)) };
  });
  return { times: thin(times), channels };
}

function sizeOf(values: Float64Array): number {
  return Math.sqrt(squares(values) / values.length) || 1;
}

/** Part of a recording that is noise: of a smooth motion second differences are small. */
export function noiseOf({ channels }: Recording): number {
  const parts = Object.values(channels).map((values) => {
    const second = values.slice(2).map((y, i) => Math.abs(y - 2 * values[i + 1]! + values[i]!));
    const spread = (1.4826 * second.sort()[second.length >> 1]!) / Math.sqrt(6);
    return (spread / sizeOf(values)) ** 2;
  });
  return Math.sqrt(parts.reduce((sum, part) => sum + part, 0) / parts.length);
}

/** A channel at times since the release, s; before it the pin moves on at its initial velocity. */
function measured(
  motion: Motion,
  name: Channel,
  times: Float64Array,
  { knownUntil } = motion.outcome,
): Float64Array {
  const inside = times.map((time) => Math.min(Math.max(time, 0), knownUntil));
  if (name === "force") {
    const plate = motion.evaluate("plate_force", inside);
    return motion.evaluate("finger_force", inside).map((force, i) => force + plate[i]!);
  }
  const found = motion.evaluate(name as QuantityName, inside);
  const velocity = name === "position" ? motion.evaluate("velocity", Float64Array.of(0))[0]! : 0;
  return found.map((y, i) => (times[i]! >= 0 ? y : name === "acceleration" ? 0 : y + velocity * times[i]!));
}

function since(data: Data, offset: number): Float64Array {
  return data.times.map((time) => time - offset);
}

function residuals(core: Core, data: Data, values: Values, offset: number): Float64Array | null {
  let motion: Motion;
  try {
    motion = core.simulate(coreInput(values));
  } catch (error) {
    if (error instanceof CoreError) return null;
    throw error;
  }
  try {
    const times = since(data, offset);
    const found = new Float64Array(data.times.length * data.channels.length);
    data.channels.forEach(({ name, values: given, weight }, c) => {
      const model = measured(motion, name, times);
      model.forEach((y, i) => {
        found[c * times.length + i] = (given[i]! - y) * weight;
      });
    });
    return found;
  } finally {
    motion.free();
  }
}

function squares(column: Float64Array | null): number {
  return column ? dot(column, column) : Infinity;
}

/** The time offset with the least squares, s: on a grid, then by halving about the best. */
export function fitOffset(core: Core, recording: Recording, values: Values): number {
  const data = thinned(recording, 600);
  const span = data.times[data.times.length - 1]! - data.times[0]!;
  const at = (offset: number): number => squares(residuals(core, data, values, offset));
  let step = span / 100;
  let best = data.times[0]!;
  let least = at(best);
  for (let i = -100; i <= 100; ++i) {
    const offset = data.times[0]! + i * step;
    const found = at(offset);
    if (found < least) [least, best] = [found, offset];
  }
  while (step > span * 1e-9) {
    step /= 2;
    for (const offset of [best - step, best + step]) {
      const found = at(offset);
      if (found < least) [least, best] = [found, offset];
    }
  }
  return best;
}

/** The values of `keys`, and the offset if it is free, with the least squares near where they are or far off. */
export function fit(
  core: Core,
  recording: Recording,
  start: Values,
  keys: readonly string[],
  offset: number,
  freeOffset: boolean,
): FitResult {
  const free = { keys, offset: freeOffset };
  const own = { values: start, offset };
  if (!residuals(core, thinned(recording, COARSE), start, offset)) {
    throw new CoreError("the design has no motion to begin with");
  }
  const candidates = [own, ...candidatesAbout(own, free, recording)];
  const rough = thinned(recording, ROUGH);
  const starts = [1, BEGINNING].flatMap((part) => {
    const best = bestOf(core, thinned(recording, COARSE, part), candidates);
    const beginning = thinned(recording, ROUGH, part);
    return part < 1 ? best.map((point) => refined(core, beginning, point, free, FEW)) : best;
  });
  const ends = [own, ...starts].map((point) => refined(core, rough, point, free, FEW));
  const whole = thinned(recording, ALL);
  const finished = byCost(ends)
    .slice(0, FINISHED)
    .map((end) => refined(core, whole, end, free, MANY));
  const found = polished(core, whole, byCost(finished)[0]!, free);
  return {
    values: found.values,
    offset: found.offset,
    report: {
      misfit: Math.sqrt(found.cost),
      noise: noiseOf(recording),
      converged: found.converged,
      starts: candidates.length,
      steps: found.steps,
      undetermined: undetermined(derivatives(core, whole, found, free), keys),
    },
  };
}

function byCost(ends: readonly Found[]): Found[] {
  return [...ends].sort((a, b) => a.cost - b.cost);
}

/** The candidates with the least squares. */
function bestOf(core: Core, data: Data, candidates: readonly Point[]): Point[] {
  const costs = candidates.map(({ values, offset }) => squares(residuals(core, data, values, offset)));
  const order = [...candidates.keys()].filter((i) => costs[i]! < Infinity);
  order.sort((i, j) => costs[i]! - costs[j]!);
  return order.slice(0, REFINED).map((i) => candidates[i]!);
}

/** Points about one, evenly spread by a Halton sequence. */
function candidatesAbout(
  { values, offset }: Point,
  { keys, offset: free }: Free,
  { times }: Recording,
): Point[] {
  const span = times[times.length - 1]! - times[0]!;
  return Array.from({ length: CANDIDATES }, (_, i) => {
    const range = Math.log(i % 2 ? NARROW : WIDE);
    const at = (k: number): number => halton(i + 1, PRIMES[k % PRIMES.length]!);
    const near = keys.reduce((now, key, k) => {
      const factor = isSigned(key) ? 4 * at(k) - 2 : Math.exp(range * (2 * at(k) - 1));
      return scaled(now, key, factor);
    }, values);
    return { values: near, offset: free ? offset + span * (0.3 * at(keys.length) - 0.05) : offset };
  });
}

const PRIMES = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];

function halton(i: number, base: number): number {
  let [part, sum] = [1 / base, 0];
  for (let rest = i; rest > 0; rest = Math.floor(rest / base), part /= base) sum += part * (rest % base);
  return sum;
}

/** True for displacements and velocities, which may have either sign. */
function isSigned(key: string): boolean {
  return DRIVE.get(key)!.bounds![0]!.lower === undefined;
}

/** The optimum near a point, by Levenberg and Marquardt. */
function refined(core: Core, data: Data, start: Point, free: Free, most: number): Found {
  let point = start;
  let rest = residuals(core, data, point.values, point.offset);
  if (!rest) return { ...start, rest: new Float64Array(0), cost: Infinity, steps: 0, converged: false };
  let damping = 1e-3;
  let [steps, converged] = [0, false];
  for (; steps < most && !converged; ++steps) {
    const columns = derivatives(core, data, point, free);
    const before = squares(rest);
    let better = false;
    for (let trial = 0; trial < 16 && !better; ++trial, damping *= 4) {
      const change = solve(columns, rest, damping);
      const next = change && moved(point, free, change);
      if (!next || core.problems(next.values).length) continue;
      const left = residuals(core, data, next.values, next.offset);
      if (!left || !(squares(left) < before)) continue;
      [point, rest, better] = [next, left, true];
      damping = Math.max(damping / 40, 1e-12);
    }
    converged = !better || before - squares(rest) < SMALL * before;
  }
  const level = converged && steepness(derivatives(core, data, point, free), rest) < LEVEL;
  return { ...point, rest, cost: squares(rest), steps, converged: level };
}

function moved({ values, offset }: Point, { keys, offset: free }: Free, change: readonly number[]): Point {
  const next = keys.reduce((now, key, i) => {
    const by = Math.min(Math.max(change[i]!, -1), 1);
    return scaled(now, key, isSigned(key) ? 1 + by : Math.exp(by));
  }, values);
  return { values: next, offset: free ? offset + change[keys.length]! : offset };
}

/** The largest cosine of the angle between residuals and a derivative. */
function steepness(columns: readonly Float64Array[], rest: Float64Array): number {
  const size = Math.sqrt(squares(rest));
  const cosines = columns.map((a) => Math.abs(dot(a, rest)) / (Math.sqrt(dot(a, a)) * size || 1));
  return Math.max(0, ...cosines);
}

/** A better optimum near one, if there is any beyond a kink of the squares, where the order of events changes. */
function polished(core: Core, data: Data, best: Found, free: Free): Found {
  const random = generator();
  for (let round = 0; round < ROUNDS; ++round) {
    const columns = derivatives(core, data, best, free);
    const count = Math.max(1, best.rest.length - columns.length);
    const errors = columns.map((a) => Math.sqrt(best.cost / count / (dot(a, a) || Infinity)));
    const near = Array.from({ length: DRAWN }, (_, i) =>
      moved(
        best,
        free,
        errors.map((error) => 3 * SIZES[i % SIZES.length]! * error * (2 * random() - 1)),
      ),
    );
    const ends = bestOf(core, data, near)
      .slice(0, FINISHED)
      .map((point) => refined(core, data, point, free, FEW));
    const end = byCost(ends)[0];
    if (!end || !(end.cost < best.cost * (1 - 1e-7))) break;
    best = refined(core, data, end, free, MANY);
  }
  return best;
}

/** Generator of numbers from 0 to 1, always with one seed. */
function generator(): () => number {
  let state = 1;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** Keys whose variance other keys widen without bound. */
function undetermined(columns: readonly Float64Array[], keys: readonly string[]): string[] {
  const sizes = columns.map((a) => Math.sqrt(dot(a, a)));
  const units = columns.map((a, i) => a.map((y) => y / (sizes[i]! || 1)));
  return keys.filter((_, i) => {
    if (!sizes[i]) return true;
    const others = units.filter((_, j) => j !== i && sizes[j]);
    const change = solve(others, units[i]!, 1e-14);
    if (!change) return others.length > 0;
    const left = units[i]!.map((y, k) => y - others.reduce((sum, a, j) => sum + a[k]! * change[j]!, 0));
    return squares(left) * SHARED < 1;
  });
}

function dot(a: Float64Array, b: Float64Array): number {
  let sum = 0;
  for (let i = 0; i < a.length; ++i) sum += a[i]! * b[i]!;
  return sum;
}

/** A value times a factor: of rows, all of their values. */
function scaled(values: Values, key: string, factor: number): Values {
  const value = values[key]!;
  return withValue(
    values,
    key,
    isFunction(value)
      ? value
      : isRows(value)
        ? value.map(([x, y]) => [x, y * factor] as const)
        : value * factor,
  );
}

/** Columns: what the residuals lose as a key grows by a part of itself, and as the offset grows. */
function derivatives(
  core: Core,
  data: Data,
  { values, offset }: Point,
  { keys, offset: freeOffset }: Free,
): Float64Array[] {
  const input = coreInput(values);
  const motion = core.simulate(input);
  const times = since(data, offset);
  const column = (of: (name: Channel) => Float64Array): Float64Array => {
    const found = new Float64Array(times.length * data.channels.length);
    data.channels.forEach(({ name, weight }, c) => {
      of(name).forEach((y, i) => {
        found[c * times.length + i] = y * weight;
      });
    });
    return found.map((y) => (Number.isFinite(y) ? y : 0));
  };
  try {
    const columns = keys.map((key) => {
      const derivative = core.differentiate(input, direction(values, key, 1));
      try {
        return column((name) => measured(derivative, name, times, motion.outcome));
      } finally {
        derivative.free();
      }
    });
    if (freeOffset) {
      // Velocity is the rate of position, acceleration of velocity; of others over a short step.
      const rate = (name: Channel): Float64Array => {
        if (name === "position") return measured(motion, "velocity", times);
        if (name === "velocity") return measured(motion, "acceleration", times);
        const step = 1e-6 * (data.times[data.times.length - 1]! - data.times[0]!);
        const later = measured(
          motion,
          name,
          times.map((t) => t + step),
        );
        return measured(motion, name, times).map((y, i) => (later[i]! - y) / step);
      };
      columns.push(column((name) => rate(name).map((y) => -y)));
    }
    return columns;
  } finally {
    motion.free();
  }
}

/** The change that solves the normal equations with the diagonal enlarged; null: singular. */
function solve(columns: readonly Float64Array[], rest: Float64Array, damping: number): number[] | null {
  const n = columns.length;
  const rows = columns.map((a, i) => [
    // A key that only decides between orders of events has no derivative, and stays where it is.
    ...columns.map((b, j) => (i === j ? (1 + damping) * dot(a, a) || 1 : dot(a, b))),
    dot(a, rest),
  ]);
  for (let i = 0; i < n; ++i) {
    let pivot = i;
    for (let j = i + 1; j < n; ++j) if (Math.abs(rows[j]![i]!) > Math.abs(rows[pivot]![i]!)) pivot = j;
    if (!(Math.abs(rows[pivot]![i]!) > 0)) return null;
    [rows[i], rows[pivot]] = [rows[pivot]!, rows[i]!];
    for (let j = 0; j < n; ++j) {
      if (j === i) continue;
      const factor = rows[j]![i]! / rows[i]![i]!;
      for (let k = i; k <= n; ++k) rows[j]![k]! -= factor * rows[i]![k]!;
    }
  }
  const found = rows.map((row, i) => row[n]! / row[i]!);
  return found.every(Number.isFinite) ? found : null;
}
