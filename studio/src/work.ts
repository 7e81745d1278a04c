// The computations beside the page: kinds of tasks, and their answers.
import type { Core } from "./core";
import { type Effect, effects } from "./effects";
import { type FitResult, fit, fitOffset } from "./fit";
import type { Values } from "./friction";
import { computeMap, type MapResult, type MapTask } from "./mapgrid";
import { Engine, type Answer as Reading, type Task as ReadTask } from "./read/engine";
import type { Recording } from "./recording";
import { type Simulated, type Span, simulateAll } from "./sample";

/** Motions of several designs, and the derivatives of a number of the first. */
export interface Motions {
  readonly designs: readonly Values[];
  readonly number: string;
  /** Span of more samples, s; null: none. */
  readonly span: Span | null;
}
export interface MotionsFound {
  readonly end: number;
  readonly found: readonly Simulated[];
  readonly effects: readonly Effect[];
}
/** A fit of some keys to a recording. */
export interface Fit {
  readonly recording: Recording;
  readonly values: Values;
  readonly keys: readonly string[];
  readonly offset: number;
  readonly freeOffset: boolean;
}

/** Task and answer of each kind. */
export interface Work {
  readonly map: readonly [MapTask, MapResult];
  readonly motions: readonly [Motions, MotionsFound];
  readonly fit: readonly [Fit, FitResult];
  readonly offset: readonly [Pick<Fit, "recording" | "values">, number];
  readonly read: readonly [ReadTask, Reading];
}
export type Kind = keyof Work;
export type Task<K extends Kind> = Work[K][0];
export type Answer<K extends Kind> = Work[K][1];
type Answers = { readonly [K in Kind]: (task: Task<K>) => Answer<K> };

export function answersOf(core: Core): Answers {
  const engine = new Engine(core);
  return {
    map: (task) => computeMap(core, task),
    motions: (task) => motions(core, task),
    fit: ({ recording, values, keys, offset, freeOffset }) =>
      fit(core, recording, values, keys, offset, freeOffset),
    offset: ({ recording, values }) => fitOffset(core, recording, values),
    read: (task) => engine.answer(task),
  };
}

function motions(core: Core, { designs, number, span }: Motions): MotionsFound {
  const { end, found } = simulateAll(core, designs, span);
  const first = found[0]!;
  const changes = "curves" in first ? effects(core, designs[0]!, number, first.curves.duration) : [];
  return { end, found, effects: changes };
}
