// Functions of time in device files: tables of parameters or of pieces, and their sums.
import type { Core } from "./core";
import type { Part, Piece, Term, TimeFunction } from "./input";
import { CoreError } from "./memory";
import { unknown } from "./names";
import { floatRepr, quoted } from "./numbertext";
import { type Quantity, TABLES } from "./table";
import { isTable, type TomlTable, type TomlValue } from "./toml";
import { toSi, UnitError } from "./units";
import { Refusal, readNumber, refusal, usualOf } from "./values";
import { valueText } from "./write";

/** True for the table of a function, or a list of such tables. */
export function isFunctionTable(value: TomlValue): value is TomlTable | TomlTable[] {
  return Array.isArray(value) ? value.length > 0 && value.every(isTable) : isTable(value);
}

/** The function of a table, or the sum of the functions of a list of tables. Throws in words. */
export function readFunction(core: Core, value: TomlTable | TomlTable[], owner: Quantity): TimeFunction {
  if (!Array.isArray(value)) return { parts: [readPart(core, value, owner, owner.key)] };
  return { parts: value.map((table, i) => readPart(core, table, owner, `${owner.key}[${i}]`)) };
}

/** A function as a device file has it. */
export function functionText(owner: Quantity, { parts }: TimeFunction): string {
  const texts = parts.map((part) => (part.parameters ? namedText(owner, part.parameters) : piecesText(part)));
  return texts.length > 1 ? `[${texts.join(", ")}]` : texts[0]!;
}

/** Parameters of the functions that an input may be, by the name of the function. */
function kindsOf(owner: Quantity): (readonly [string, readonly Quantity[]])[] {
  const name = owner.key.slice(owner.key.indexOf(".") + 1);
  return TABLES.functionsOf[name]!.map((kind) => [
    kind,
    TABLES.functions[kind]!.map((parameter) => parameterOf(owner, name, parameter)),
  ]);
}

/** A parameter of an input; one without a unit has that of the input. */
function parameterOf(owner: Quantity, input: string, parameter: Quantity): Quantity {
  const { unit, displayUnit, displayScale } = parameter.unit ? parameter : owner;
  const example = TABLES.functionExamples[input]![parameter.name] ?? parameter.example ?? 0;
  const after = !unit || unit === "1" ? "" : ` ${unit}`;
  const bounds = parameter.bounds?.map((of) => ({ ...of, words: of.words?.replaceAll(" {unit}", after) }));
  return { ...parameter, unit, displayUnit, displayScale, example, bounds } as Quantity;
}

function readPart(core: Core, table: TomlTable, owner: Quantity, label: string): Part {
  if ("pieces" in table) return { pieces: readPieces(table, label) };
  const kinds = kindsOf(owner);
  const known = [...new Set(kinds.flatMap(([, parameters]) => parameters.map(({ name }) => name)))];
  for (const name of Object.keys(table)) {
    if (!known.includes(name)) throw new Refusal(unknown(`parameter of ${owner.key}`, name, known));
  }
  const given = Object.keys(table);
  const fit = kinds.find(([, of]) => given.every((name) => of.some((parameter) => parameter.name === name)));
  if (!given.length || !fit) {
    const usual = kinds.map(([, parameters]) => `{ ${parameters.map(usualLine).join(", ")} }`);
    throw refusal(label, `a function, like ${usual.join(" or ")}`, quoted(table));
  }
  const [kind, parameters] = fit;
  const numbers = parameters.map((parameter): readonly [string, number] => {
    const value = table[parameter.name];
    const place = `${label}.${parameter.name}`;
    if (value !== undefined) return [parameter.name, readNumber(value, parameter, usual(parameter), place)];
    if (parameter.absent !== undefined) return [parameter.name, parameter.absent];
    throw new Refusal(`${place} is missing; write ${usualLine(parameter)}`);
  });
  try {
    const pieces = core.functionPieces(
      kind,
      numbers.map(([, number]) => number),
    );
    return { parameters: Object.fromEntries(numbers), pieces };
  } catch (error) {
    if (error instanceof CoreError) throw new Refusal(`${label}: ${error.message}`);
    throw error;
  }
}

function usual(parameter: Quantity): string {
  return usualOf(parameter, parameter.example!);
}

function usualLine(parameter: Quantity): string {
  const text = usual(parameter);
  return `${parameter.name} = ${parameter.unit === "1" ? text : quoted(text)}`;
}

/** Pieces in SI numbers. */
function readPieces(table: TomlTable, label: string): Piece[] {
  const example = '{ pieces = [{ begin = "0 s", polynomial = [0.06, 1.2], terms = [] }] }';
  const refuse = (): never => {
    throw refusal(label, `like ${example}`, quoted(table));
  };
  const list = (given: TomlValue | undefined, least: number, most: number): number[] => {
    const numbers = Array.isArray(given) ? given.map(Number) : refuse();
    if (numbers.length < least || numbers.length > most || !numbers.every(Number.isFinite)) refuse();
    return numbers;
  };
  if (!Array.isArray(table.pieces)) return refuse();
  if (!table.pieces.length) throw refusal(`${label}.pieces`, "at least one", "none");
  return table.pieces.map((given): Piece => {
    if (!isTable(given)) return refuse();
    const terms = Array.isArray(given.terms ?? []) ? ((given.terms ?? []) as TomlValue[]) : refuse();
    return {
      begin: begins(given.begin) ?? refuse(),
      polynomial: list(given.polynomial ?? [], 0, 6),
      terms: terms.map((term) => list(term, 4, 4) as unknown as Term),
    };
  });
}

/** Begin of a piece, s; null for no text with a unit of time. */
function begins(given: TomlValue | undefined): number | null {
  try {
    return typeof given === "string" ? toSi(given, "s", "0 s") : null;
  } catch (error) {
    if (error instanceof UnitError) return null;
    throw error;
  }
}

function namedText(owner: Quantity, given: Readonly<Record<string, number>>): string {
  const parameters = new Map(kindsOf(owner).flatMap(([, of]) => of.map((one) => [one.name, one])));
  const entries = Object.entries(given);
  return `{ ${entries.map(([name, value]) => `${name} = ${valueText(parameters.get(name)!, value)}`).join(", ")} }`;
}

function piecesText({ pieces }: Part): string {
  const list = (numbers: readonly number[]): string => `[${numbers.map(floatRepr).join(", ")}]`;
  const texts = pieces.map(
    ({ begin, polynomial, terms }) =>
      `{ begin = ${JSON.stringify(`${floatRepr(begin)} s`)}, polynomial = ${list(polynomial)}, ` +
      `terms = [${terms.map(list).join(", ")}] }`,
  );
  return `{ pieces = [${texts.join(", ")}] }`;
}
