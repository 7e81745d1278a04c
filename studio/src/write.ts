// Files that the page writes: device files (TOML), samples and events (CSV).

import { type Design, isFunction, isRows } from "./design";
import { functionText } from "./functions";
import type { QuantityName } from "./motion";
import { floatRepr, general } from "./numbertext";
import type { Curves } from "./sample";
import { columnsOf, DRIVE, type Quantity, SERIES, TABLES } from "./table";
import { TomlDate, type TomlTable, type TomlValue } from "./toml";
import { toSi } from "./units";

/** A value (SI) as a device file has it, with the fewest digits that give it back to the bit. */
export function written(quantity: Quantity, value: number): string {
  if (quantity.choices) return quantity.choices[value]!;
  const unit = quantity.unit || "1";
  if (unit === "1") return floatRepr(value);
  for (let digits = 6; digits <= 17; ++digits) {
    const text = `${general(value * quantity.displayScale, digits)} ${quantity.displayUnit}`;
    if (toSi(text, unit, "") === value) return text;
  }
  return `${floatRepr(value)} ${unit}`;
}

/** A number as it stands in a field, in the unit beside it. */
export function fieldText(quantity: Quantity, value: number): string {
  return general(value * quantity.displayScale, 6);
}

/** Device file of a design: its keys, each with its meaning if they are explained. */
export function deviceFile(design: Design, explained = true): string {
  const lines = ["[device]", `name = ${JSON.stringify(design.name)}`];
  if (design.description) lines.push(`description = ${JSON.stringify(design.description)}`);
  let table = "device";
  for (const [key, quantity] of DRIVE) {
    const value = design.values[key];
    if (value === undefined) continue;
    const [own, name] = key.split(".") as [string, string];
    if (own !== table) lines.push("", `[${own}]`);
    table = own;
    if (explained) lines.push(`# ${quantity.symbol}: ${quantity.meaning}`);
    const shown = isFunction(value)
      ? functionText(quantity, value)
      : isRows(value)
        ? rowsText(quantity, value)
        : valueText(quantity, value);
    lines.push(`${name} = ${shown}`);
  }
  for (const [name, rest] of Object.entries(design.around)) {
    lines.push("", `[${name}]`, ...Object.entries(rest).map(([key, value]) => `${key} = ${toml(value)}`));
  }
  return `${lines.join("\n")}\n`;
}

/** A value as it stands in a device file, in quotes or bare. */
export function valueText(quantity: Quantity, value: number): string {
  const text = written(quantity, value);
  return (quantity.unit || "1") === "1" && !quantity.choices ? text : JSON.stringify(text);
}

function rowsText(quantity: Quantity, rows: readonly (readonly [number, number])[]): string {
  const [across] = columnsOf(quantity);
  return `[${rows.map(([x, y]) => `[${valueText(across, x)}, ${valueText(quantity, y)}]`).join(", ")}]`;
}

function toml(value: TomlValue): string {
  if (typeof value === "string") return JSON.stringify(value);
  if (typeof value === "number") return floatRepr(value);
  if (Array.isArray(value)) return `[${value.map(toml).join(", ")}]`;
  if (typeof value === "object" && !(value instanceof TomlDate)) {
    const entries = Object.entries(value as TomlTable);
    return `{${entries.map(([key, item]) => `${JSON.stringify(key)} = ${toml(item)}`).join(", ")}}`;
  }
  if (value instanceof TomlDate) return value.toISOString();
  return String(value);
}

function headings(names: readonly string[]): string {
  return names.map((name) => SERIES.get(name)!.heading).join(",");
}

/** Samples of a motion, SI, of two at one time the right-hand limit; `readRecording` reads them again. */
export function samplesCsv({ times, columns }: Curves): string {
  const names = [...SERIES.keys()].filter((name) => name === "time" || columns[name as QuantityName]);
  const values = names.map((name) => (name === "time" ? times : columns[name as QuantityName]!));
  const kept = [...times.keys()].filter((i) => times[i] !== times[i + 1]);
  const rows = kept.map((i) => values.map((column) => floatRepr(column[i]!)).join(","));
  return `${[headings(names), ...rows].join("\r\n")}\r\n`;
}

/** The events of a motion, SI. */
export function eventsCsv(curves: Curves): string {
  const rows = curves.events.map((event) =>
    [event.time, event.contact, event.kind, event.position, event.velocity]
      .map((cell) => (typeof cell === "number" ? floatRepr(cell) : cell))
      .join(","),
  );
  return `${[`${headings(["time"])},contact,kind,${headings(["position", "velocity"])}`, ...rows].join("\r\n")}\r\n`;
}

export const TEMPLATE = TABLES.template;
