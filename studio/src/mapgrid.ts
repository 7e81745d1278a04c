// A map computed: the numbers of each point, and whether they keep the limits.
import type { Core } from "./core";
import type { Input, Rows } from "./input";

export const SIZE = 64;

/** A number over the grid: x[i] times y[j], or their sum; x fastest, rows from the smallest y. */
export interface Product {
  readonly x: Float64Array;
  readonly y: Float64Array;
  readonly sum?: boolean;
}

export interface MapTask {
  readonly input: Input;
  readonly varied: Readonly<Record<string, Product>>;
  /** Factors of the forces of friction curves that grow with an axis. */
  readonly curves: Readonly<Record<string, Product>>;
  readonly band: number;
  /** The number, and the limits on others. */
  readonly number: string;
  readonly limits: readonly { readonly number: string; readonly atMost: number; readonly atLeast: number }[];
}

export interface MapResult {
  readonly values: Float64Array;
  /** 1 where every limit is kept. */
  readonly met: Uint8Array;
  /** Computing time, ms. */
  readonly took: number;
}

/** Computes a map. */
export function computeMap(core: Core, task: MapTask): MapResult {
  const begin = performance.now();
  const points = SIZE * SIZE;
  const outputs = [...new Set([task.number, ...task.limits.map(({ number }) => number)])];
  const width = outputs.length;
  const numbers = Object.keys(task.curves).length
    ? pointByPoint(core, task, outputs, points)
    : core.batch(task.input, expanded(task.varied), outputs, points, task.band);
  const values = new Float64Array(points);
  const met = new Uint8Array(points);
  for (let p = 0; p < points; ++p) {
    values[p] = numbers[p * width]!;
    const kept = task.limits.every(({ number, atMost, atLeast }) => {
      const value = numbers[p * width + outputs.indexOf(number)]!;
      return value <= atMost && value >= atLeast;
    });
    met[p] = kept ? 1 : 0;
  }
  return { values, met, took: performance.now() - begin };
}

export function expanded(products: Readonly<Record<string, Product>>): Record<string, Float64Array> {
  const grid = ({ x, y, sum }: Product): Float64Array =>
    Float64Array.from({ length: SIZE * SIZE }, (_, p) => {
      const [u, v] = [x[p % SIZE]!, y[Math.floor(p / SIZE)]!];
      return sum ? u + v : u * v;
    });
  return Object.fromEntries(Object.entries(products).map(([name, product]) => [name, grid(product)]));
}

/** A batch varies no curves: there each point is a batch of its own. */
function pointByPoint(core: Core, task: MapTask, outputs: readonly string[], points: number): Float64Array {
  const width = outputs.length;
  const numbers = new Float64Array(points * width);
  const [scales, varied] = [expanded(task.curves), expanded(task.varied)];
  for (let p = 0; p < points; ++p) {
    const curves: Record<string, Rows> = { ...task.input.curves };
    for (const [contact, scale] of Object.entries(scales)) {
      curves[contact] = curves[contact]!.map(([speed, force]) => [speed, force * scale[p]!] as const);
    }
    const at = Object.entries(varied).map(([name, column]) => [name, column.slice(p, p + 1)] as const);
    const changed = at.map(([name, column]) => [name, column[0]!] as const);
    const drive = {
      ...task.input.drive,
      ...Object.fromEntries(changed.filter(([name]) => name in task.input.drive)),
    };
    const one = core.batch({ ...task.input, drive, curves }, Object.fromEntries(at), outputs, 1, task.band);
    numbers.set(one, p * width);
  }
  return numbers;
}
