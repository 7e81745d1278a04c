// A number over two parameters: the points of a grid, as the core takes them.

import { coreInput, settlingBand, withValue } from "./design";
import type { Values } from "./friction";
import { byCoefficient } from "./friction";
import type { Input } from "./input";
import { type MapTask, type Product, SIZE } from "./mapgrid";
import { type Range, rangeOf, valueAt } from "./range";
import { DRIVE, TABLES } from "./table";

export interface Axes {
  readonly x: Range;
  readonly y: Range;
}

/** Ranges of the axes; a quantity of both signs keeps the sign of its value. */
export function axesOf(values: Values, x: string, y: string): Axes {
  const of = (key: string): Range => {
    const value = values[key] as number;
    const range = { ...rangeOf(DRIVE.get(key)!, value), zero: false };
    if (range.logarithmic || value === 0) return range;
    return value > 0 ? { ...range, lower: 0 } : { ...range, upper: 0 };
  };
  return { x: of(x), y: of(y) };
}

export function gridValues(range: Range): Float64Array {
  return Float64Array.from({ length: SIZE }, (_, i) => {
    const value = valueAt(range, (i + 0.5) / SIZE);
    return Math.min(Math.max(value, range.lower), range.upper);
  });
}

type Flat = Readonly<Record<string, number>>;

/** The core's numbers that are one number each. */
function flat(input: Input): Flat {
  const profiles = Object.entries(input.profiles).filter(([, rows]) => rows.length === 1);
  return { ...input.drive, ...input.release, ...Object.fromEntries(profiles.map(([k, r]) => [k, r[0]![1]])) };
}

/**
 * The grid. What follows an axis is a product of powers of both, or a sum where both press on a contact: it
 * needs each axis alone.
 */
export function mapTask(
  values: Values,
  x: string,
  y: string,
  axes: Axes,
  number: string,
  limits: MapTask["limits"],
): MapTask {
  const own = (key: string): string => key.replace(/^(drive|motion)\./, "");
  const lines = (
    [
      [x, axes.x],
      [y, axes.y],
    ] as const
  ).map(([key, range]) => [...gridValues(range)].map((value) => coreInput(withValue(values, key, value))));
  const base = coreInput(values);
  const [along, across] = lines.map((line) => line.map(flat)) as [Flat[], Flat[]];
  const origin = flat(base);
  const ones = new Float64Array(SIZE).fill(1);
  const adds = (contact: string): boolean =>
    contact === "plate" &&
    byCoefficient(values, contact) &&
    [x, y].every((key) => TABLES.pressedBy[contact]!.includes(key));
  const varied: Record<string, Product> = {};
  for (const name of Object.keys(origin)) {
    const changes = (line: readonly Flat[]): boolean => line.some((at) => at[name] !== origin[name]);
    const byX = name === own(x) || (changes(along) && name !== own(y));
    const byY = name === own(y) || (changes(across) && name !== own(x));
    if (!byX && !byY) continue;
    const [u, v] = [along, across].map((line) => Float64Array.from(line, (at) => at[name]!)) as [
      Float64Array,
      Float64Array,
    ];
    if (byX && byY && adds(name.split(".")[0]!)) {
      varied[name] = { x: u, y: v.map((value) => value - origin[name]!), sum: true };
      continue;
    }
    const both = byX && byY && origin[name];
    varied[name] = { x: byX ? u : ones, y: both ? v.map((value) => value / origin[name]!) : byY ? v : ones };
  }
  const curves: Record<string, Product> = {};
  for (const [contact, rows] of Object.entries(base.curves)) {
    const scale = (input: Input): number => (rows[0]![1] ? input.curves[contact]![0]![1] / rows[0]![1] : 1);
    const [u, v] = lines.map((line) => Float64Array.from(line, scale)) as [Float64Array, Float64Array];
    if (![...u, ...v].some((one) => one !== 1)) continue;
    curves[contact] = adds(contact) ? { x: u, y: v.map((one) => one - 1), sum: true } : { x: u, y: v };
  }
  return { input: base, varied, curves, band: settlingBand(values), number, limits };
}
