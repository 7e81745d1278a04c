// The state of both views as text: in the address, in the browser's storage, and in files of readings. A part
// that is spoiled is left out and named, and the rest is kept.
import type { Core } from "./core";
import { type Design, designOf } from "./design";
import { DeviceError } from "./device";
import { base64, bytesOf } from "./links";
import type { HandRows, Slowness } from "./read/hand";
import { SLOWNESS } from "./read/hand";
import type { PackedRaster } from "./read/raster";
import { FORMAT, isHand } from "./read/saved";
import type { Print, ReadState } from "./read/state";
import type { Channel, Recording } from "./recording";
import { initialRelease, type Limit, type Overlay, type ReleaseState } from "./state";
import { DRIVE, NUMBERS, TABLES } from "./table";
import { deviceFile } from "./write";

export interface Kept {
  readonly release: ReleaseState;
  readonly read: ReadState;
}
/** The states in a text, and the parts that could not be read, in words. */
export interface Found {
  readonly kept: Kept;
  readonly problems: readonly string[];
}

type Json = Readonly<Record<string, unknown>>;

/** Both states as an object for JSON; with the page of a reading it is what `load_reading` of Python reads. */
export function jsonOfStates({ release, read }: Kept, page: PackedRaster | null): Json {
  return {
    format: FORMAT,
    device: deviceFile(read.device, false),
    ...(page ? { page } : { print: read.print }),
    hand: read.hand,
    task: read.task,
    slowness: read.slowness,
    release: {
      designs: release.designs.map((design) => ({ device: deviceFile(design, false), shown: design.shown })),
      current: release.current,
      ghost: release.ghost && deviceFile(designWith(release.ghost), false),
      map: release.map,
      number: release.number,
      specification: release.specification,
      overlay: release.overlay && jsonOfOverlay(release.overlay),
      cursor: release.cursor,
    },
  };
}

function designWith(values: Design["values"]): Design {
  return { name: "", description: "", values, around: {}, shown: true };
}

function jsonOfOverlay({ recording, ...rest }: Overlay): Json {
  const packed = (column: Float64Array): string =>
    base64(new Uint8Array(column.buffer, column.byteOffset, column.byteLength));
  const channels = Object.entries(recording.channels).map(([name, column]) => [name, packed(column)]);
  return {
    ...rest,
    name: recording.name,
    times: packed(recording.times),
    channels: Object.fromEntries(channels),
  };
}

/** The states in an object; `otherwise` stands in for what it lacks. */
export function statesOfJson(core: Core, given: unknown, otherwise: Kept): Found {
  const problems: string[] = [];
  /** A part of the object; what is wrong with it is named, and the part of another state taken. */
  const part = <T>(name: string, value: unknown, read: (value: never) => T, other: T): T => {
    if (value === undefined || value === null) return other;
    try {
      return read(value as never);
    } catch (error) {
      problems.push(error instanceof DeviceError ? error.message : `${name} cannot be read`);
      return other;
    }
  };
  const from = (given ?? {}) as Json;
  const design = (text: string, name: string): Design => designOf(core, { text, file: name, rows: {} });
  const device = part(
    "the device",
    from.device,
    (text: string) => design(text, "the device"),
    otherwise.read.device,
  );
  const print = part("the page", from.page ?? from.print, printOf, otherwise.read.print);
  const hand = part("the hand", from.hand, handOf, null);
  const read: ReadState = {
    device,
    print,
    hand: problems.length ? null : hand,
    task: part("the task", from.task, whole, 0),
    slowness: part("the time", from.slowness, slownessOf, otherwise.read.slowness),
  };
  const of = (from.release ?? {}) as Json;
  if (!from.release) return { kept: { release: otherwise.release, read }, problems };
  const usual = initialRelease(core);
  const listed = Array.isArray(of.designs) ? of.designs : [];
  const designs = listed.flatMap((one: { device: string; shown: boolean }, i) => {
    const name = `design ${i + 1}`;
    const found = part(name, one?.device ?? "", (text: string) => design(text, name), null);
    return found ? [{ ...found, shown: one.shown !== false }] : [];
  });
  if (!designs.length) problems.push("the designs are missing");
  const release: ReleaseState = {
    designs: designs.length ? designs : usual.designs,
    current: part(
      "the current design",
      of.current,
      (i: number) => Math.max(0, Math.min(whole(i), designs.length - 1)),
      0,
    ),
    ghost: part("the ghost", of.ghost, (text: string) => design(text, "the ghost").values, null),
    map: part("the map", of.map, mapOf, usual.map),
    number: part("the number", of.number, numberOf, usual.number),
    specification: part("the specification", of.specification, specificationOf, usual.specification),
    overlay: part("the recording", of.overlay, overlayOf, null),
    cursor: part("the cursor", of.cursor, finite, 0),
  };
  return { kept: { release, read }, problems };
}

function check(true_: unknown): asserts true_ {
  if (!true_) throw new Error();
}
function finite(value: number): number {
  check(Number.isFinite(value));
  return value;
}
function whole(value: number): number {
  check(Number.isInteger(value) && value >= 0);
  return value;
}

function slownessOf(value: number): Slowness {
  check((SLOWNESS as readonly number[]).includes(value));
  return value as Slowness;
}

function handOf(given: unknown): HandRows {
  check(isHand(given));
  return given;
}

function printOf(given: Print | PackedRaster): Print {
  if (!("kind" in given)) return printOf({ kind: "picture", raster: given });
  const width = "width" in given ? finite(given.width) : 0;
  check(given.kind === "picture" || (width > 0 && width <= 1000));
  switch (given.kind) {
    case "text":
      return { kind: "text", text: String(given.text), width };
    case "lines":
      check(given.lines.every((line) => line.length === 2 && line.every(Number.isFinite)));
      return { kind: "lines", lines: given.lines, width };
    case "drawing":
      check(
        given.strokes.every((stroke) => stroke.every(({ x, y }) => Number.isFinite(x) && Number.isFinite(y))),
      );
      return { kind: "drawing", strokes: given.strokes, width };
    case "picture": {
      const { title, rows, columns, pixel, luminance } = given.raster;
      check([rows, columns, pixel].every((size) => Number.isFinite(size) && size > 0));
      check(typeof luminance === "string" && bytesOf(luminance));
      return { kind: "picture", raster: { title: String(title), rows, columns, pixel, luminance } };
    }
  }
}

function mapOf({ x, y }: ReleaseState["map"]): ReleaseState["map"] {
  check(DRIVE.has(x) && DRIVE.has(y));
  return { x, y };
}
function numberOf(name: string): string {
  check(NUMBERS.has(name));
  return name;
}
function specificationOf(given: ReleaseState["specification"]): ReleaseState["specification"] {
  const limits = Object.entries(given).map(([name, { atMost, atLeast }]): [string, Limit] => [
    numberOf(name),
    {
      ...(atMost === undefined ? {} : { atMost: finite(atMost) }),
      ...(atLeast === undefined ? {} : { atLeast: finite(atLeast) }),
    },
  ]);
  return Object.fromEntries(limits);
}

function overlayOf(
  given: Overlay & { name: string; times: string; channels: Record<string, string> },
): Overlay {
  const column = (packed: string): Float64Array => new Float64Array(bytesOf(packed).buffer as ArrayBuffer);
  const times = column(given.times);
  const known = TABLES.channels.map(({ name }) => name);
  const channels = Object.entries(given.channels).map(([name, packed]): [Channel, Float64Array] => {
    const values = column(packed);
    check(known.includes(name) && values.length === times.length && values.every(Number.isFinite));
    return [name as Channel, values];
  });
  check(channels.length && times.every((time, i) => i === 0 || time > times[i - 1]!));
  const recording: Recording = { name: String(given.name), times, channels: Object.fromEntries(channels) };
  return {
    recording,
    offset: finite(given.offset),
    keys: given.keys.filter((key) => DRIVE.has(key)),
    freeOffset: given.freeOffset === true,
    report: given.report ?? null,
  };
}
