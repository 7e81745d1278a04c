// A map computed: the numbers of each point, and whether they keep the limits.
import type { Core, Input, Rows } from "./core";

export const SIZE = 64;

export interface MapTask {
  readonly input: Input;
  readonly varied: Readonly<Record<string, Float64Array>>;
  /** Of friction curves that grow with an axis: what their forces are multiplied by at each point. */
  readonly curves: Readonly<Record<string, Float64Array>>;
  readonly band: number;
  /** The place of the number among the core's, and the limits on others. */
  readonly number: number;
  readonly limits: readonly { readonly number: number; readonly atMost: number; readonly atLeast: number }[];
}

export interface MapResult {
  readonly values: Float64Array;
  /** 1 where every limit is kept. */
  readonly met: Uint8Array;
  /** What it took, ms. */
  readonly took: number;
}

/** Computes a map. */
export function computeMap(core: Core, task: MapTask): MapResult {
  const begin = performance.now();
  const points = SIZE * SIZE;
  const width = core.numberNames.length;
  const numbers = Object.keys(task.curves).length
    ? pointByPoint(core, task, points)
    : core.batch(task.input, task.varied, points, task.band).numbers;
  const values = new Float64Array(points);
  const met = new Uint8Array(points);
  for (let p = 0; p < points; ++p) {
    values[p] = numbers[p * width + task.number]!;
    const kept = task.limits.every(({ number, atMost, atLeast }) => {
      const value = numbers[p * width + number]!;
      return value <= atMost && value >= atLeast;
    });
    met[p] = kept ? 1 : 0;
  }
  return { values, met, took: performance.now() - begin };
}

/** A batch varies no curves: there each point is a batch of its own. */
function pointByPoint(core: Core, task: MapTask, points: number): Float64Array {
  const width = core.numberNames.length;
  const numbers = new Float64Array(points * width);
  for (let p = 0; p < points; ++p) {
    const curves: Record<string, Rows> = { ...task.input.curves };
    for (const [contact, scale] of Object.entries(task.curves)) {
      curves[contact] = curves[contact]!.map(([speed, force]) => [speed, force * scale[p]!] as const);
    }
    const at = Object.entries(task.varied).map(([name, column]) => [name, column.slice(p, p + 1)] as const);
    const changed = at.map(([name, column]) => [name, column[0]!] as const);
    const drive = { ...task.input.drive, ...Object.fromEntries(changed.filter(([name]) => name in task.input.drive)) };
    const one = core.batch({ ...task.input, drive, curves }, Object.fromEntries(at), 1, task.band);
    numbers.set(one.numbers, p * width);
  }
  return numbers;
}
