// A recording fitted: its time offset, and parameters by Gauss-Newton steps with exact derivatives.

import { type Core, CoreError, type Motion, type QuantityName } from "./core";
import { coreInput, direction, isFunction, isRows, withValue } from "./design";
import type { Values } from "./friction";
import type { Channel, Recording } from "./recording";

export interface FitResult {
  readonly values: Values;
  readonly offset: number;
  /** Root of the mean square of what is left, of each channel's own root mean square. */
  readonly misfit: number;
  readonly steps: number;
}

const SAMPLES = 2000; // samples of a recording that are fitted
const STEPS = 40;
const SMALL = 1e-10;

interface Data {
  readonly times: Float64Array;
  readonly channels: readonly { name: Channel; values: Float64Array; weight: number }[];
}

/** Every so-many-th sample, weighed by the size of its channel. */
function thinned(recording: Recording, count = SAMPLES): Data {
  const step = Math.max(1, Math.ceil(recording.times.length / count));
  const thin = (column: Float64Array): Float64Array => column.filter((_, i) => i % step === 0);
  const times = thin(recording.times);
  const names = Object.keys(recording.channels) as Channel[];
  const channels = names.map((name) => {
    const values = thin(recording.channels[name]!);
    const size = Math.sqrt(values.reduce((sum, y) => sum + y * y, 0) / values.length) || 1;
    return { name, values, weight: 1 / (size * Math.sqrt(values.length * names.length)) };
  });
  return { times, channels };
}

function measured(motion: Motion, name: Channel, times: Float64Array): Float64Array {
  if (name !== "force") return motion.evaluate(name as QuantityName, times);
  const plate = motion.evaluate("plate_force", times);
  return motion.evaluate("finger_force", times).map((force, i) => force + plate[i]!);
}

/** Times of the motion at the samples; samples outside take the times of its ends. */
function motionTimes(data: Data, offset: number, motion: Motion): Float64Array {
  const { knownUntil } = motion.outcome;
  return data.times.map((time) => Math.min(Math.max(time - offset, 0), knownUntil));
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
    const times = motionTimes(data, offset, motion);
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
  return column ? column.reduce((sum, r) => sum + r * r, 0) : Infinity;
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

/** The values of `keys`, and the offset if it is free, with the least squares near where they are. */
export function fit(
  core: Core,
  recording: Recording,
  start: Values,
  keys: readonly string[],
  offset: number,
  freeOffset: boolean,
): FitResult {
  const data = thinned(recording);
  let [values, shift] = [start, offset];
  let rest = residuals(core, data, values, shift);
  if (!rest) throw new CoreError("the design has no motion to begin with");
  let damping = 1e-3;
  let steps = 0;
  for (; steps < STEPS; ++steps) {
    const jacobian = derivatives(core, data, values, shift, keys, freeOffset);
    let better = false;
    for (let trial = 0; trial < 12 && !better; ++trial, damping *= 4) {
      const change = solve(jacobian, rest, damping);
      if (!change) continue;
      const next = keys.reduce((now, key, i) => scaled(now, key, Math.exp(clamped(change[i]!))), values);
      const nextShift = shift + (freeOffset ? change[keys.length]! : 0);
      if (core.problems(next).length) continue;
      const left = residuals(core, data, next, nextShift);
      const [before, after] = [squares(rest), squares(left)];
      if (!(after < before)) continue;
      [values, shift, rest, better] = [next, nextShift, left!, true];
      damping = Math.max(damping / 40, 1e-12);
      if (before - after < SMALL * before) return { values, offset: shift, misfit: Math.sqrt(after), steps };
    }
    if (!better) break;
  }
  return { values, offset: shift, misfit: Math.sqrt(squares(rest)), steps };
}

function clamped(change: number): number {
  return Math.min(Math.max(change, -1), 1);
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
  values: Values,
  offset: number,
  keys: readonly string[],
  freeOffset: boolean,
): Float64Array[] {
  const input = coreInput(values);
  const motion = core.simulate(input);
  const times = motionTimes(data, offset, motion);
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
        return column((name) => measured(derivative, name, times));
      } finally {
        derivative.free();
      }
    });
    if (freeOffset) {
      // Velocity is the rate of position, acceleration of velocity; of others over a short step.
      const rate = (name: Channel): Float64Array => {
        if (name === "position") return motion.evaluate("velocity", times);
        if (name === "velocity") return motion.evaluate("acceleration", times);
        const step = 1e-6 * (data.times[data.times.length - 1]! - data.times[0]!);
        const later = measured(
          motion,
          name,
          times.map((t) => t + step),
        );
        return measured(motion, name, times).map((y, i) => (later[i]! - y) / step);
      };
      columns.push(column((name) => rate(name).map((y, i) => (data.times[i]! > offset ? -y : 0))));
    }
    return columns;
  } finally {
    motion.free();
  }
}

/** The change that solves the normal equations with the diagonal enlarged; null: singular. */
function solve(columns: readonly Float64Array[], rest: Float64Array, damping: number): number[] | null {
  const n = columns.length;
  const dot = (a: Float64Array, b: Float64Array): number => a.reduce((sum, y, i) => sum + y * b[i]!, 0);
  const rows = columns.map((a, i) => [
    ...columns.map((b, j) => dot(a, b) * (i === j ? 1 + damping : 1)),
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
