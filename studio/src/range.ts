// Range of the slider of a quantity, and the values of its positions.
import type { Quantity } from "./table";

export interface Range {
  readonly lower: number;
  readonly upper: number;
  /** True if equal steps multiply. */
  readonly logarithmic: boolean;
  /** True if the first place stands for 0, which has no logarithm. */
  readonly zero: boolean;
}

const SPREAD = 10; // from a tenth of the usual value to ten times it

/** About the usual value, wide enough for the one that is given. */
export function rangeOf(quantity: Quantity, value: number): Range {
  const [bounds, limits] = quantity.bounds!;
  const usual =
    Math.abs(quantity.default ?? quantity.example ?? quantity.absent ?? 0) ||
    Math.abs(quantity.rows?.[0]?.[1] ?? 0) ||
    1 / quantity.displayScale;
  if (bounds!.lower === undefined) {
    let reach = 5 * usual;
    while (reach < Math.abs(value)) reach *= 10;
    return { lower: -reach, upper: reach, logarithmic: false, zero: false };
  }
  let [lower, upper] = [usual / SPREAD, usual * SPREAD];
  const size = Math.abs(value);
  while (size > 0 && size < lower) lower /= 10;
  while (size > upper) upper *= 10;
  const highest = Math.min(bounds!.upper ?? Infinity, limits!.upper ?? Infinity);
  const zero = bounds!.lowerClosed === true && bounds!.lower === 0;
  return { lower, upper: Math.min(upper, highest), logarithmic: true, zero };
}

/** The value at a part, from 0 to 1, of the range. */
export function valueAt(range: Range, part: number): number {
  if (!range.logarithmic) {
    // In thousandths of the reach: a slider stops at plain numbers, 0 among them.
    const step = Math.max(-range.lower, range.upper) / 1000;
    const count = Math.round((range.lower + part * (range.upper - range.lower)) / step);
    return Number((count * step).toPrecision(6)) + 0; // no negative zero
  }
  if (part <= 0 && range.zero) return 0;
  return Number((range.lower * (range.upper / range.lower) ** part).toPrecision(4));
}

/** The part of the range at which a value stands. */
export function partOf(range: Range, value: number): number {
  if (!range.logarithmic) return (value - range.lower) / (range.upper - range.lower);
  if (value <= 0) return 0;
  return Math.log(value / range.lower) / Math.log(range.upper / range.lower);
}
