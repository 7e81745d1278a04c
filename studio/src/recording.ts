// A recording of a release: a CSV whose header names columns with their units, in SI.
import { floatRepr, quoted } from "./numbertext";
import { SERIES, type Series, TABLES } from "./table";
import { expected, toSi, UnitError } from "./units";

export type Channel = "position" | "velocity" | "acceleration" | "force";
const TIME = SERIES.get("time")!;
/** A header. */
export const EXAMPLE = `${TIME.heading}, ${TABLES.channels[0]!.heading}`;
const FEWEST = 8;

export interface Recording {
  readonly name: string;
  readonly times: Float64Array;
  readonly channels: Partial<Record<Channel, Float64Array>>;
}

export class RecordingError extends Error {}

interface Column {
  readonly index: number;
  readonly unit: string | null;
}

/** The recording in a CSV; throws RecordingError in the words of `pindrive fit`. */
export function readRecording(text: string, file: string): Recording {
  const fail = (label: string, required: string, given: string): never => {
    throw new RecordingError(`${file}: ${label} must be ${required}, got ${given}`);
  };
  const lines = text.replace(/^\ufeff/, "").split(/\r\n|\r|\n/);
  const numbers: number[] = [];
  lines.forEach((line, i) => {
    if (line.trim() && !line.trimStart().startsWith("#")) numbers.push(i);
  });
  if (!numbers.length) {
    throw new RecordingError(`${file}: is empty; a recording begins with ${quoted(EXAMPLE)}`);
  }
  if (numbers.length - 1 > TABLES.inputRows) {
    fail("the rows", `at most ${TABLES.inputRows}`, String(numbers.length - 1));
  }
  const head = lines[numbers[0]!]!;
  const count = (mark: string): number => head.split(mark).length;
  const mark = [",", ";", "\t"].reduce((best, one) => (count(one) > count(best) ? one : best));
  const headings = head.split(mark).map((cell) => unquoted(cell.trim()).trim());
  const columns = new Map<string, Column[]>();
  headings.forEach((heading, index) => {
    const match = /^\s*([^[(]*?)\s*[[(]([^\])]*)[\])]\s*$/.exec(heading);
    const name = (match?.[1] ?? heading).trim().toLowerCase();
    columns.set(name, [...(columns.get(name) ?? []), { index, unit: match?.[2]?.trim() ?? null }]);
  });
  const names = TABLES.channels.map((channel) => channel.name);
  if (!columns.has("time") || !names.some((name) => columns.has(name))) {
    const like = `with time and at least one of ${names.join(", ")}, like ${quoted(EXAMPLE)}`;
    fail("the header", like, quoted(headings.join(", ")));
  }
  const rows = numbers.slice(1);
  if (rows.length < FEWEST) fail("a recording", `at least ${FEWEST} rows`, String(rows.length));

  const read = ({ name, unit = "1", heading }: Series): Float64Array => {
    const [column, twice] = columns.get(name)! as [Column, Column | undefined];
    if (twice) fail(`column ${name}`, "given once", "it twice");
    const [like, given] = [quoted(heading), quoted(headings[column.index]!)];
    const written = column.unit ?? fail(`column ${name}`, `given with its unit, like ${like}`, given);
    let scale = 1;
    try {
      scale = toSi(`1 ${written}`, unit, `1 ${unit}`);
    } catch (error) {
      if (!(error instanceof UnitError)) throw error;
      fail(`column ${name}`, `${expected(unit, written)}, like ${like}`, given);
    }
    const values = new Float64Array(rows.length);
    rows.forEach((line, i) => {
      const cell = cellOf(lines[line]!, mark, column.index);
      const value = cell === "" ? NaN : Number(cell);
      if (Number.isNaN(value) && !/^[+-]?nan$/i.test(cell)) {
        fail(`row ${line + 1}: ${name}`, "a number", quoted(cell));
      }
      if (!Number.isFinite(value)) fail(`row ${line + 1}: ${name}`, "finite", quoted(cell));
      values[i] = value * scale;
    });
    return values;
  };

  const times = read(TIME);
  for (let i = 1; i < times.length; ++i) {
    if (times[i]! > times[i - 1]!) continue;
    const required = `greater than the one before, ${short(times[i - 1]!)} s; sort the rows, or split it`;
    fail(`row ${rows[i]! + 1}: time`, required, `${short(times[i]!)} s`);
  }
  const channels: Partial<Record<Channel, Float64Array>> = {};
  for (const channel of TABLES.channels) {
    if (!columns.has(channel.name)) continue;
    const values = read(channel);
    if (values.every((value) => value === 0)) {
      const required = "other than zero somewhere; check the sensor and the heading";
      fail(channel.name, required, "0 throughout");
    }
    channels[channel.name as Channel] = values;
  }
  return { name: file, times, channels };
}

function short(value: number): string {
  return floatRepr(Number(value.toPrecision(6))).replace(/\.0$/, "");
}

function unquoted(cell: string): string {
  return cell.startsWith('"') && cell.endsWith('"') ? cell.slice(1, -1).replaceAll('""', '"') : cell;
}

/** Cell of a line; the rest of the line is not split. */
function cellOf(line: string, mark: string, index: number): string {
  if (line.includes('"')) return unquoted((line.split(mark)[index] ?? "").trim()).trim();
  let begin = 0;
  for (let i = 0; i < index; ++i) {
    begin = line.indexOf(mark, begin) + 1;
    if (begin === 0) return "";
  }
  const end = line.indexOf(mark, begin);
  return line.slice(begin, end < 0 ? undefined : end).trim();
}
