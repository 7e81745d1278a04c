// Device files: TOML with units, read into the values of a drive and its release, and written again.
// What is wrong is said in the lines that the command prints: file, key, value and bound.
import type { Core } from "./core";
import type { Value, Values } from "./friction";
import { isFunctionTable, readFunction } from "./functions";
import type { Rows } from "./input";
import { nearest, unknownInFile } from "./names";
import { quoted } from "./numbertext";
import { DRIVE, INPUTS, type Quantity, TABLES } from "./table";
import { isTable, parseToml, TomlError, type TomlTable, type TomlValue } from "./toml";
import { Refusal, readNumber, readRows, refusal } from "./values";

const MOUSE = "motion.mouse_velocity";

export interface Device {
  readonly name: string;
  readonly description: string;
  /** Given keys of DRIVE. */
  readonly values: Values;
  /** The tables about the drive, as the file has them. */
  readonly around: Readonly<Record<string, TomlTable>>;
}

/** A device file that cannot be used; `problems` holds one line each. */
export class DeviceError extends Error {
  constructor(readonly problems: readonly string[]) {
    super(problems.join("\n"));
  }
}

/** The text of a file, which begins with its own mark or not. Throws DeviceError. */
export function decodeText(bytes: Uint8Array, file: string): string {
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    if (bytes[0] === 0x89 && bytes[1] === 0x48 && bytes[2] === 0x44 && bytes[3] === 0x46) {
      throw new DeviceError([`${file}: is a NetCDF file; \`pindrive map\` draws one that a sweep wrote`]);
    }
    throw new DeviceError([`${file}: is not UTF-8 text, at byte ${firstBadByte(bytes)}`]);
  }
}

function firstBadByte(bytes: Uint8Array): number {
  // The longest part that decodes, by halving: its end is where a character is broken.
  let [good, bad] = [0, bytes.length];
  const decodes = (end: number): boolean => {
    try {
      new TextDecoder("utf-8", { fatal: true }).decode(bytes.subarray(0, end), { stream: true });
      return true;
    } catch {
      return false;
    }
  };
  while (bad - good > 1) {
    const middle = (good + bad) >> 1;
    if (decodes(middle)) good = middle;
    else bad = middle;
  }
  while (good > 0 && (bytes[good]! & 0xc0) === 0x80 && bytes[good - 1]! >= 0x80) --good;
  return good;
}

/** The device that a file describes. `rows`: what stands in CSV files that it names, SI, by key. */
export function readDevice(
  core: Core,
  text: string,
  file: string,
  rows: Readonly<Record<string, Rows>> = {},
): Device {
  return new Reader(core, readTables(text, file), file, rows).device();
}

function readTables(text: string, file: string): TomlTable {
  if (!text.trim()) {
    throw new DeviceError([`${file}: is empty; \`pindrive init FILE\` writes a device file`]);
  }
  try {
    return parseToml(text);
  } catch (error) {
    if (!(error instanceof TomlError)) throw error;
    const unquoted = error.message.includes("followed by an end-of-line");
    const hint = unquoted ? "; a value with a unit stands in quotes" : "";
    throw new DeviceError([`${file}: is not valid TOML: ${error.message}${hint}`]);
  }
}

class Reader {
  private readonly tables: Record<string, TomlTable> = {};
  private readonly problems: string[] = [];
  /** Given values, SI; null: malformed. */
  private readonly values: Record<string, Value | null> = {};

  constructor(
    private readonly core: Core,
    private readonly given: TomlTable,
    private readonly file: string,
    private readonly rows: Readonly<Record<string, Rows>>,
  ) {
    this.refuseStudy();
    const flat = TABLES.tables.filter((name) => name in given && !isTable(given[name]));
    if (flat.length) {
      throw new DeviceError(
        flat.map((name) => `${file}: ${name} must be a table, [${name}], got ${quoted(given[name])}`),
      );
    }
    for (const name of TABLES.tables) this.tables[name] = (given[name] ?? {}) as TomlTable;
  }

  private refuseStudy(): void {
    const found = TABLES.studyKeys.filter((key) => key in this.given);
    if (!found.length) return;
    const shown = found.slice(0, 2).map((key) => (isTable(this.given[key]) ? `[${key}]` : key));
    throw new DeviceError([
      `${this.file}: is a study file, as it has ${shown.join(" and ")}; \`pindrive sweep\`, ` +
        "`sensitivity` and `robustness` take it",
    ]);
  }

  device(): Device {
    const { file, tables, problems } = this;
    const whole = TABLES.around.some((name) => Object.keys(tables[name]!).length > 0);
    const unknown = this.unknownKeys();
    const meant = new Set(unknown.map((key) => nearest(key)[0]));
    for (const key of unknown) problems.push(`${file}: ${unknownInFile(key)}`);
    this.checkDamping(meant);
    this.checkTexts();
    const hand = whole && !("mouse_velocity" in tables.motion!);
    if (hand) meant.add("motion.mouse_velocity");
    this.readValues(whole ? TABLES.tables : TABLES.alone, meant);
    problems.push(...this.core.problems(this.values, whole).map((problem) => `${file}: ${problem}`));
    if (problems.length) throw new DeviceError(problems);
    if (hand) this.values[MOUSE] = this.values["scan.hand_speed"] ?? INPUTS.get("scan.hand_speed")!.absent!;
    const of = tables.device!;
    const given = [...DRIVE.keys()].filter((key) => key in this.values);
    return {
      name: String(of.name ?? ""),
      description: String(of.description ?? ""),
      values: Object.fromEntries(given.map((key) => [key, this.values[key]!])),
      around: Object.fromEntries(
        TABLES.around.filter((name) => name in this.given).map((name) => [name, tables[name]!]),
      ),
    };
  }

  private isGiven(key: string): boolean {
    const [table, name] = split(key);
    return name in this.tables[table]!;
  }

  private unknownKeys(): string[] {
    const unknown = Object.keys(this.given).filter((name) => !TABLES.tables.includes(name));
    const full = TABLES.tables.flatMap((table) =>
      Object.keys(this.tables[table]!).map((name) => `${table}.${name}`),
    );
    return [...unknown, ...full.filter((key) => !TABLES.keys.includes(key))];
  }

  private checkDamping(meant: ReadonlySet<string | undefined>): void {
    const keys = ["drive.damping", "drive.damping_ratio"];
    const given = keys.filter((key) => this.isGiven(key));
    if (given.length === 1 || (!given.length && keys.some((key) => meant.has(key)))) return;
    const found = given.length ? "both" : "neither";
    this.problems.push(`${this.file}: give exactly one of ${keys.join(" and ")}, got ${found}`);
  }

  private checkTexts(): void {
    for (const name of ["name", "description"]) {
      const value = this.tables.device![name] ?? "";
      if (typeof value === "string") continue;
      this.problems.push(`${this.file}: device.${name} must be text in quotes, got ${quoted(value)}`);
    }
  }

  private readValues(names: readonly string[], meant: ReadonlySet<string | undefined>): void {
    for (const [key, quantity] of INPUTS) {
      const [table] = split(key);
      if (!names.includes(table)) continue;
      const others = quantity.alternative ?? [];
      if (this.isGiven(key)) {
        this.values[key] = this.read(key, quantity);
      } else if (quantity.mandatory && !others.some((other) => this.isGiven(other))) {
        if (meant.has(key) || others.some((other) => meant.has(other))) continue;
        this.problems.push(`${this.file}: ${key} is missing; write ${quantity.line} in [${table}]`);
      }
    }
  }

  /** A value that the file gives; null with a problem. */
  private read(key: string, quantity: Quantity): Value | null {
    const [table, name] = split(key);
    try {
      const given = this.tables[table]![name]!;
      if (this.rows[key]) return this.rows[key];
      const isFunction = quantity.rowsOf === "profile" && isFunctionTable(given);
      return isFunction ? readFunction(this.core, given, quantity) : readValue(given, quantity);
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      this.problems.push(`${this.file}: ${error.message}`);
      return null;
    }
  }
}

function readValue(value: TomlValue, quantity: Quantity): Value {
  if (quantity.rowsOf === "profile" && typeof value === "string" && /\.csv\s*$/i.test(value)) {
    const words = "a value or rows in a page, which may open no files (`pindrive studio FILE` reads it)";
    throw refusal(quantity.key, words, quoted(value));
  }
  if (quantity.rows && (Array.isArray(value) || !quantity.mayBeConstant)) {
    return readRows(value, quantity);
  }
  return readNumber(value, quantity, quantity.usual ?? "", quantity.key);
}

/** The values in the tables about the drive, SI, of a device that was read. */
export function settingsOf(around: Device["around"]): Values {
  const found: Record<string, Value> = {};
  for (const [key, quantity] of INPUTS) {
    const [table, name] = split(key);
    const value = around[table]?.[name];
    if (value !== undefined) found[key] = readValue(value, quantity);
  }
  return found;
}

function split(key: string): [string, string] {
  const dot = key.indexOf(".");
  return dot < 0 ? [key, ""] : [key.slice(0, dot), key.slice(dot + 1)];
}
