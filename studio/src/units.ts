// Text with a unit to an SI number, "12 g" to 0.012 kg, with the rounding of one decimal product.
import { quoted } from "./numbertext";
import { TABLES } from "./table";

/** Text that is not a number with a unit of the expected kind; says what is expected. */
export class UnitError extends Error {}

/** A rational number, exact. */
interface Fraction {
  readonly over: bigint;
  readonly under: bigint;
}
interface Unit {
  readonly factor: Fraction;
  readonly dimension: ReadonlyMap<string, number>;
}

const NUMBER_AND_UNIT = /^\s*([+-]?(?:nan|inf|(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?))(.*)$/is;
const DECIMAL_COMMA = /^\s*[+-]?\d*,\d+(?![\d,])/;
const ONE: Fraction = { over: 1n, under: 1n };
const PLAIN: Readonly<Record<string, string>> = { "·": "*", "⋅": "*", "×": "*", "−": "-", "²": "^2" };

/**
 * The number in `text`, a number and a unit, in the SI unit `unit`; "1" for none.
 * Throws UnitError, with `example` in its message.
 */
export function toSi(text: string, unit: string, example: string): number {
  const plain = text.replace(/[·⋅×−²]/g, (sign) => PLAIN[sign]!);
  if (DECIMAL_COMMA.test(plain)) {
    const point = text.trim().replace(",", ".");
    throw new UnitError(`a number whose decimal sign is a point, like ${quoted(point)}`);
  }
  const match = NUMBER_AND_UNIT.exec(plain);
  if (!match) {
    const kind = unit === "1" ? "a number" : "a number with its unit";
    throw new UnitError(`${kind}, like "${example}"`);
  }
  const [number, written] = [match[1]!, match[2]!.trim().replace("%", "percent")];
  if (!written && unit !== "1") {
    if (unit !== "K" && Number(number) === 0) return Number(number); // zero needs no unit
    throw new UnitError(`a number with its unit (give a unit, like "${example}")`);
  }
  const factor = conversion(written, unit);
  if (!factor) {
    throw new UnitError(`${expected(unit, written, " or a percentage")}, like "${example}"`);
  }
  if (/n/i.test(number)) return plainNumber(number);
  // Beyond any double before its unit: as the number alone.
  if (Math.abs(Number(number.split(/e/i)[1] ?? 0)) > 5000) return Number(number);
  return toNumber(times(decimal(number), factor));
}

/** Description of the required unit; it mentions if the unit `written` is unknown. */
export function expected(unit: string, written: string, otherwise = ""): string {
  const kind = unit === "1" ? `a plain number${otherwise}` : `in ${unit} or a unit alike`;
  return parseUnit(written) ? kind : `${kind} (${quoted(written)} is not a known unit)`;
}

function plainNumber(text: string): number {
  if (/nan/i.test(text)) return NaN;
  return text.startsWith("-") ? -Infinity : Infinity;
}

const conversions = new Map<string, Fraction | null>();

/** Number of units `unit` in one `written`; null for different dimensions. */
function conversion(written: string, unit: string): Fraction | null {
  const key = `${written}\n${unit}`;
  let found = conversions.get(key);
  if (found === undefined) {
    const from = parseUnit(written);
    const to = parseUnit(unit === "1" ? "" : unit)!;
    const alike = from && sameDimension(from.dimension, to.dimension);
    found = alike ? times(from.factor, inverse(to.factor)) : null;
    conversions.set(key, found);
  }
  return found;
}

function sameDimension(a: ReadonlyMap<string, number>, b: ReadonlyMap<string, number>): boolean {
  return a.size === b.size && [...a].every(([base, power]) => b.get(base) === power);
}

// ---- units ---------------------------------------------------------------------------------------

/** The unit that a product of names and powers is; null where a name is unknown. */
function parseUnit(text: string): Unit | null {
  const tokens = text.match(/\*\*|[*/^()]|[+-]?\d+(?:\.\d+)?|[^\s*/^()\d+-][^\s*/^()+-]*|\S/g) ?? [];
  let at = 0;
  const product = (): Unit | null => {
    let result: Unit | null = { factor: ONE, dimension: new Map() };
    let divide = false;
    let first = true;
    while (at < tokens.length && tokens[at] !== ")") {
      if (!first && (tokens[at] === "*" || tokens[at] === "/")) divide = tokens[at++] === "/";
      const one = factorOf();
      result = result && one && multiplied(result, divide ? raised(one, -1) : one);
      if (!result) return null;
      divide = first = false;
    }
    return result;
  };
  const factorOf = (): Unit | null => {
    const token = tokens[at++];
    if (token === undefined) return null;
    let unit: Unit | null;
    if (token === "(") {
      unit = product();
      if (tokens[at++] !== ")") return null;
    } else if (/^\d/.test(token)) {
      unit = { factor: decimal(token), dimension: new Map() };
    } else {
      unit = named(token);
    }
    if (unit && (tokens[at] === "^" || tokens[at] === "**")) {
      const power = Number(tokens[at + 1]);
      at += 2;
      return Number.isInteger(power) ? raised(unit, power) : null;
    }
    return unit;
  };
  const found = product();
  return at === tokens.length ? found : null;
}

function named(name: string): Unit | null {
  const { atoms, prefixes } = TABLES.units;
  const atom = (text: string): Unit | null => {
    const found = Object.hasOwn(atoms, text) ? atoms[text]! : null;
    return found && { factor: decimal(found[0]), dimension: new Map(Object.entries(found[1])) };
  };
  for (const text of name.endsWith("s") ? [name, name.slice(0, -1)] : [name]) {
    const whole = atom(text);
    if (whole) return whole;
    for (const [prefix, factor] of Object.entries(prefixes)) {
      const rest = text.startsWith(prefix) ? atom(text.slice(prefix.length)) : null;
      if (rest) return { ...rest, factor: times(rest.factor, decimal(factor)) };
    }
  }
  return null;
}

function multiplied(a: Unit, b: Unit): Unit {
  const dimension = new Map(a.dimension);
  for (const [base, power] of b.dimension) {
    const sum = (dimension.get(base) ?? 0) + power;
    if (sum) dimension.set(base, sum);
    else dimension.delete(base);
  }
  return { factor: times(a.factor, b.factor), dimension };
}

function raised(unit: Unit, power: number): Unit {
  let result: Unit = { factor: ONE, dimension: new Map() };
  const one = power < 0 ? { factor: inverse(unit.factor), dimension: negated(unit.dimension) } : unit;
  for (let i = 0; i < Math.min(Math.abs(power), 99); ++i) result = multiplied(result, one);
  return result;
}

function negated(dimension: ReadonlyMap<string, number>): ReadonlyMap<string, number> {
  return new Map([...dimension].map(([base, power]) => [base, -power]));
}

// ---- exact arithmetic ------------------------------------------------------------------------------

function decimal(text: string): Fraction {
  const [mantissa, power] = text.toLowerCase().split("e") as [string, string | undefined];
  const [whole, rest = ""] = mantissa.split(".") as [string, string | undefined];
  const exponent = Number(power ?? 0) - rest.length;
  const size = BigInt(`${whole.replace(/^[+-]/, "")}${rest}` || "0");
  const signed = whole.startsWith("-") ? -size : size;
  return exponent < 0
    ? { over: signed, under: 10n ** BigInt(-exponent) }
    : { over: signed * 10n ** BigInt(exponent), under: 1n };
}

function times(a: Fraction, b: Fraction): Fraction {
  return { over: a.over * b.over, under: a.under * b.under };
}

function inverse(a: Fraction): Fraction {
  return { over: a.under, under: a.over };
}

/** The nearest double, by way of fifty decimal digits. */
function toNumber({ over, under }: Fraction): number {
  if (over === 0n) return 0;
  const size = over < 0n ? -over : over;
  const shift = 50 - (String(size).length - String(under).length);
  const scaled = shift > 0 ? (size * 10n ** BigInt(shift)) / under : size / (under * 10n ** BigInt(-shift));
  return Number(`${over < 0n ? "-" : ""}${scaled}e${-shift}`);
}
