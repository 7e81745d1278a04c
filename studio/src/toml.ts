// TOML as device files are written, read by smol-toml.
import { parse, TomlDate, TomlError as TomlSyntaxError } from "smol-toml";

/** A bigint is an integer, a number a float. */
export type TomlValue = string | bigint | number | boolean | TomlValue[] | TomlTable | TomlDate;
export interface TomlTable {
  [key: string]: TomlValue;
}
/** An error of the syntax, in one line with its place. */
export class TomlError extends Error {}

export function isTable(value: unknown): value is TomlTable {
  return typeof value === "object" && value !== null && !Array.isArray(value) && !(value instanceof TomlDate);
}

export function parseToml(text: string): TomlTable {
  try {
    return parse(text, { integersAsBigInt: true }) as TomlTable;
  } catch (error) {
    if (!(error instanceof TomlSyntaxError)) throw error;
    const what = error.message.split("\n")[0]!.replace("Invalid TOML document: ", "");
    throw new TomlError(`${what} (at line ${error.line}, column ${error.column})`);
  }
}

export { TomlDate };
