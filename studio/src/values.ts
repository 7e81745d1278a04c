// Values of device files: text with units, rows of two columns, and what is refused.
import type { Row, Rows } from "./input";
import { floatRepr, general, quoted } from "./numbertext";
import { columnsOf, type Quantity, required, TABLES } from "./table";
import type { TomlValue } from "./toml";
import { toSi, UnitError } from "./units";

/** A value that is refused; its words have no place yet. */
export class Refusal extends Error {}

export function refusal(label: string, requirement: string, given: string): Refusal {
  return new Refusal(`${label} must be ${requirement}, got ${given}`);
}

/** A number from text with a unit, or a bare one where the quantity has no unit. Throws in words. */
export function readNumber(value: TomlValue, quantity: Quantity, example: string, label: string): number {
  if (quantity.choices) {
    const found = quantity.choices.indexOf(String(value));
    if (typeof value === "string" && found >= 0) return found;
    throw refusal(label, `one of ${quantity.choices.join(", ")}`, quoted(value));
  }
  const bare = typeof value === "bigint" ? String(value) : typeof value === "number" ? floatRepr(value) : "";
  let found: number;
  try {
    found = toSi(typeof value === "string" ? value : bare, quantity.unit || "1", example);
  } catch (error) {
    if (!(error instanceof UnitError)) throw error;
    throw refusal(label, error.message, quoted(value));
  }
  const words = required(quantity, found);
  if (words) throw refusal(label, words, quoted(value));
  return found;
}

/** A value as a design has it: "22 mN". */
export function usualOf(quantity: Quantity, value: number): string {
  return `${general(value * quantity.displayScale, 12)} ${quantity.displayUnit ?? ""}`.trimEnd();
}

export function readRows(value: TomlValue, quantity: Quantity): Rows {
  const key = quantity.key;
  const [across, along] = columnsOf(quantity);
  const [first, second] = TABLES.columns[quantity.rowsOf!]!.map((name) => name.split(".").pop()!) as [
    string,
    string,
  ];
  const last = quantity.rows![quantity.rows!.length - 1]!;
  const examples = [usualOf(across, last[0]), usualOf(quantity, last[1])] as const;
  if (!Array.isArray(value) || !value.length) {
    throw refusal(key, `rows, like ${quantity.usualRows}`, quoted(value));
  }
  return value.map((row, i): Row => {
    if (!Array.isArray(row) || row.length !== 2) {
      const like = examples.map((example) => quoted(example)).join(", ");
      throw refusal(`${key}[${i}]`, `a ${first} and a ${second}, like ${like}`, quoted(row));
    }
    return [
      readNumber(row[0]!, across, examples[0], `${key}[${i}] ${first}`),
      readNumber(row[1]!, along, examples[1], `${key}[${i}] ${second}`),
    ];
  });
}
