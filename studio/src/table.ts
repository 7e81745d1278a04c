// The table of quantities, generated from the one of the Python package, and how values are written.
import generated from "../build/tables.json";
import type { Rows } from "./input";

export interface Bounds {
  readonly lower?: number;
  readonly upper?: number;
  readonly lowerClosed?: boolean;
  readonly upperClosed?: boolean;
  readonly infinite?: boolean;
  readonly zero?: boolean;
  readonly words?: string;
}

/** A row of the table; what is missing is empty. */
export interface Quantity {
  readonly key: string;
  readonly name: string;
  readonly symbol: string;
  readonly unit?: string;
  readonly displayUnit?: string;
  readonly displayScale: number;
  readonly meaning: string;
  readonly bounds?: readonly Bounds[];
  readonly seen?: readonly [number, number];
  readonly default?: number;
  readonly absent?: number;
  readonly example?: number;
  readonly remark?: string;
  readonly source?: string;
  readonly mandatory?: boolean;
  readonly alternative?: readonly string[];
  readonly follows?: readonly string[];
  readonly rowsOf?: "curve" | "coefficient_curve" | "profile" | "places";
  readonly rows?: Rows;
  readonly mayBeConstant?: boolean;
  /** Names of the values 0, 1, 2 … */
  readonly choices?: readonly string[];
  readonly usual?: string;
  readonly usualRows?: string;
  readonly line?: string;
}

/** Quantities over time: columns of files. */
export interface Series extends Quantity {
  /** Its heading in a CSV, SI: "position [m]". */
  readonly heading: string;
}

interface Tables {
  readonly version: string;
  readonly inputs: readonly Quantity[];
  readonly drive: readonly string[];
  readonly parts: Readonly<Record<string, Quantity>>;
  readonly columns: Readonly<Record<string, readonly [string, string]>>;
  readonly numbers: readonly Quantity[];
  readonly series: readonly Series[];
  /** Columns of a recording of a release. */
  readonly channels: readonly Series[];
  readonly keys: readonly string[];
  /** Python names of keys with a quantity. */
  readonly variables: Readonly<Record<string, string>>;
  /** Words that people write for the words of names. */
  readonly otherWords: Readonly<Record<string, string>>;
  readonly tables: readonly string[];
  readonly alone: readonly string[];
  readonly around: readonly string[];
  /** The coefficient by which a friction force may be given instead, by key. */
  readonly coefficients: Readonly<Record<string, string>>;
  /** Keys of the normal force on each contact. */
  readonly pressedBy: Readonly<Record<string, readonly string[]>>;
  /** Standard gravity, m/s². */
  readonly gravity: number;
  /** Parameters of functions of time, by the name of the function; one without a unit has that of its input. */
  readonly functions: Readonly<Record<string, readonly Quantity[]>>;
  /** Functions that each input may be. */
  readonly functionsOf: Readonly<Record<string, readonly string[]>>;
  /** Examples of the parameters that have the unit of their input. */
  readonly functionExamples: Readonly<Record<string, Readonly<Record<string, number>>>>;
  /** Inputs of a release over time, by name. */
  readonly overTime: readonly string[];
  readonly studyKeys: readonly string[];
  readonly inputRows: number;
  readonly units: {
    readonly atoms: Readonly<Record<string, readonly [string, Readonly<Record<string, number>>]>>;
    readonly prefixes: Readonly<Record<string, string>>;
  };
  readonly palette: Readonly<Record<string, string>>;
  readonly shapes: Readonly<Record<string, string>>;
  readonly curves: readonly { readonly color: string; readonly dash: readonly number[] }[];
  readonly events: Readonly<Record<string, Readonly<Record<string, string>>>>;
  readonly template: string;
  /** Device file with which a page is read first. */
  readonly reader: string;
  /** Recordings among the examples, by the names of their files. */
  readonly recordings: Readonly<Record<string, string>>;
}

export const TABLES = generated as unknown as Tables;

/** The keys of a device file that hold a quantity, in their order. */
export const INPUTS: ReadonlyMap<string, Quantity> = new Map(TABLES.inputs.map((q) => [q.key, q]));
/** Keys of the drive and its release. */
export const DRIVE: ReadonlyMap<string, Quantity> = new Map(
  TABLES.drive.map((key) => [key, INPUTS.get(key)!]),
);
/** Results of a motion, by name. */
export const NUMBERS: ReadonlyMap<string, Quantity> = new Map(TABLES.numbers.map((q) => [q.name, q]));
/** State of a motion at a time, by name. */
export const SERIES: ReadonlyMap<string, Series> = new Map(TABLES.series.map((q) => [q.name, q]));

export function part(name: string): Quantity {
  return TABLES.parts[name]!;
}

/** The two columns of rows, the second with the unit of the quantity itself. */
export function columnsOf(quantity: Quantity): readonly [Quantity, Quantity] {
  return [part(TABLES.columns[quantity.rowsOf!]![0]), quantity];
}

function within(value: number, of: Bounds): boolean {
  const lower = of.lower ?? -Infinity;
  const upper = of.upper ?? Infinity;
  const above = value > lower || (of.lowerClosed === true && value === lower);
  const below = value < upper || (of.upperClosed === true && value === upper);
  return (
    (above && below) || (of.infinite === true && value === Infinity) || (of.zero === true && value === 0)
  );
}

/** Requirement that a value (SI) violates: "finite and greater than 0 kg"; else empty. */
export function required(quantity: Quantity, value: number): string {
  return quantity.bounds?.find((of) => !within(value, of))?.words ?? "";
}

/** True if a value (SI) is plausible for a device. */
export function plausible(quantity: Quantity, value: number): boolean {
  if (!quantity.seen || !Number.isFinite(value)) return true;
  const size = Math.abs(value);
  return size >= quantity.seen[0] && size <= quantity.seen[1];
}

// ---- numbers as text -----------------------------------------------------------------------------

/** Four significant digits, plain where that stays short; "–" where there is no such number. */
export function digits(value: number, count = 4): string {
  if (Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const exponent = Math.floor(Math.log10(Math.abs(value)));
  const plain = exponent >= -4 && exponent < 7;
  const text = plain
    ? value.toFixed(Math.min(Math.max(0, count - 1 - exponent), 20))
    : value.toExponential(count - 1).replace("e+", "e");
  return text.replace("-", "−");
}

/** A value (SI) in the unit of its quantity: "1.500"; a count has no decimals. */
export function shownNumber(quantity: Quantity, value: number): string {
  const isCount = !quantity.unit && Number.isFinite(value);
  return isCount ? String(Math.round(value)) : digits(value * quantity.displayScale);
}

/** A value (SI) for a person to read: "1.500 mm". */
export function text(quantity: Quantity, value: number): string {
  if (quantity.choices) return quantity.choices[value]!;
  return `${shownNumber(quantity, value)} ${unitOf(quantity)}`.trim();
}

/** The unit in which a person reads it, with its signs. */
export function unitOf(quantity: Quantity): string {
  return (quantity.displayUnit ?? "").replace("*", "·").replace("^2", "²");
}

/** A label for an axis or a heading: "position x, mm". */
export function label(quantity: Quantity): string {
  const name = quantity.name.replace(/^(transient|ending|motion)\./, "").replaceAll("_", " ");
  return name.replace(".", " ");
}
