// The state of "One release".
import type { Core } from "./core";
import type { Design } from "./design";
import { readDevice } from "./device";
import type { FitReport } from "./fit";
import type { Values } from "./friction";
import type { Recording } from "./recording";
import { TABLES } from "./table";

/** A limit that a number must keep, SI. */
export interface Limit {
  readonly atMost?: number;
  readonly atLeast?: number;
}

/** A recording over the curves. */
export interface Overlay {
  readonly recording: Recording;
  /** Recorded time of the release, s. */
  readonly offset: number;
  /** Keys to be fitted, and whether the time of the release is. */
  readonly keys: readonly string[];
  readonly freeOffset: boolean;
  readonly report: FitReport | null;
}

export interface ReleaseState {
  readonly designs: readonly Design[];
  readonly current: number;
  /** Values of the curve in the background. */
  readonly ghost: Values | null;
  readonly map: { readonly x: string; readonly y: string };
  /** The number of which the map and the bars of derivatives are. */
  readonly number: string;
  readonly specification: Readonly<Record<string, Limit>>;
  readonly overlay: Overlay | null;
  readonly cursor: number;
}

/** A change, from the newest state: two may come before anything is drawn anew. */
export type Step = (now: ReleaseState) => ReleaseState;

export function initialRelease(core: Core): ReleaseState {
  const device = readDevice(core, TABLES.template, "the template");
  return {
    designs: [{ ...device, shown: true }],
    current: 0,
    ghost: null,
    map: { x: "motion.mouse_velocity", y: "plate.kinetic" },
    number: "transient.settling_time",
    specification: { "transient.settling_time": { atMost: 0.1 } },
    overlay: null,
    cursor: 0,
  };
}

export function currentDesign(state: ReleaseState): Design {
  return state.designs[state.current]!;
}

export function withDesign(
  state: ReleaseState,
  change: Partial<Design>,
  index = state.current,
): ReleaseState {
  const designs = state.designs.map((design, i) => (i === index ? { ...design, ...change } : design));
  return { ...state, designs };
}
