// The core and the readers of files in Node, for tests: one question a line, one answer a line.
import { readFileSync } from "node:fs";
import { createInterface } from "node:readline";
import { answerOf, bits } from "./answers";
import { Core } from "./core";
import { coreInput, direction, withValue } from "./design";
import { DeviceError, decodeText, readDevice } from "./device";
import { fit } from "./fit";
import type { Values } from "./friction";
import type { Input } from "./input";
import { axesOf, gridValues, mapTask } from "./map";
import { expanded, SIZE } from "./mapgrid";
import type { Arm } from "./read/arm";
import { deviceInput } from "./read/device";
import { type Answer, Engine, SAMPLED, type Samples, type Verdict } from "./read/engine";
import { Hand, type HandRows, type Place, type Slowness, TIMES } from "./read/hand";
import { RecordingError, readRecording } from "./recording";
import { type Curves, simulateAll } from "./sample";
import { toSi } from "./units";
import { deviceFile, eventsCsv, samplesCsv } from "./write";

/** A reading, with the times of its pictures, s: its last sample, and its lines. */
interface Read {
  readonly read: {
    readonly device: string;
    readonly page: { readonly grey: string; readonly rows: number; readonly columns: number };
    readonly pixel: number;
    readonly hand: HandRows;
    readonly pictures: readonly number[];
    /** Arm that leads the hand along its rows. */
    readonly arm?: Arm;
  };
}
/** A hand that follows aims, m, one each tick. */
interface Follow {
  readonly follow: {
    readonly slowness: Slowness;
    readonly straight: boolean;
    readonly aims: readonly Place[];
  };
}

type Question =
  | Read
  | Follow
  | { readonly simulate: Input; readonly duration: number | null }
  | Device
  | { readonly recording: string; readonly file: string; readonly fit?: Fitted }
  | { readonly si: string; readonly unit: string };

/** A device that is fitted to a recording, with the keys that are free. */
interface Fitted {
  readonly device: string;
  readonly keys: readonly string[];
  readonly freeOffset: boolean;
}

/** Device file, and the requested result. */
interface Device {
  readonly device: string;
  readonly file: string;
  /** A key set to a value. */
  readonly set?: readonly [string, number];
  /** The direction of a key. */
  readonly direction?: string;
  /** Its motion as the CSV files that the page writes. */
  readonly csv?: true;
  /** The core's numbers at the corners of a map over two keys. */
  readonly map?: readonly [string, string];
}

function ofDevice(core: Core, asked: Device): unknown {
  const text = decodeText(Uint8Array.from(Buffer.from(asked.device, "base64")), asked.file);
  const device = readDevice(core, text, asked.file);
  const values = asked.set ? withValue(device.values, ...asked.set) : device.values;
  if (asked.direction) return { core: direction(values, asked.direction, 1) };
  if (asked.csv) {
    const { curves } = simulateAll(core, [values], null, 50).found[0] as { curves: Curves };
    return { samples: samplesCsv(curves), events: eventsCsv(curves) };
  }
  if (asked.map) return { corners: corners(values, ...asked.map) };
  const written = deviceFile({ ...device, values, shown: true });
  return { name: device.name, values, written, core: coreInput(values) };
}

function corners(values: Values, x: string, y: string): unknown {
  const axes = axesOf(values, x, y);
  const { varied, curves } = mapTask(values, x, y, axes, "", []);
  const [columns, scales] = [expanded(varied), expanded(curves)];
  const [along, across] = [gridValues(axes.x), gridValues(axes.y)];
  return [0, SIZE - 1, SIZE * SIZE - 1].map((p) => ({
    x: along[p % SIZE],
    y: across[Math.floor(p / SIZE)],
    varied: Object.fromEntries(Object.entries(columns).map(([name, column]) => [name, column[p]])),
    scales: Object.fromEntries(Object.entries(scales).map(([name, column]) => [name, column[p]])),
  }));
}

function ofReading(core: Core, { device, page, pixel, hand: saved, pictures, arm }: Read["read"]): unknown {
  const design = readDevice(core, device, "the device");
  const input = deviceInput(core, design);
  const grey = Uint8Array.from(Buffer.from(page.grey, "base64"));
  const hand = Hand.of(saved, 10);
  const open = { device: input, page: { ...page, grey, pixel }, start: hand.start };
  const engine = new Engine(core);
  const problem = engine.answer({ open: { ...open, arm: arm ?? null } });
  if (problem) return problem;
  let known = 0;
  let last: Answer = null;
  const sampled: number[] = [];
  const own = new Hand(hand.start, 10);
  for (const until of pictures) {
    let count = known;
    while (count < hand.count && (count === 0 || saved.rows[count - 1]![0] / TIMES < until)) ++count;
    const rows = hand.rowsFrom(known).subarray(0, 3 * (count - known));
    last = engine.answer({ rows, until });
    known = count;
    // Time and positions of all pins at each sample.
    const { times, values, rows: led } = last as Samples;
    if ("failed" in (last as object)) return last;
    own.extend(led);
    const pins = input.spots.length;
    times.forEach((time, i) => {
      const from = i * SAMPLED.length * pins;
      sampled.push(time, ...values.subarray(from, from + pins));
    });
  }
  const { values, times } = last as Samples; // the last picture is at the end of the hand
  const end = values.subarray((times.length - 1) * SAMPLED.length * input.spots.length);
  const moved = arm ? own : hand;
  const verdict = engine.answer({ judge: { ...open, rows: moved.rowsFrom(0) } }) as Verdict;
  const { x, y } = moved.at(moved.end);
  return { end: bits(end), place: bits([x, y]), sampled: bits(sampled), led: own.saved, ...verdict };
}

function answer(core: Core, asked: Question): unknown {
  if ("read" in asked) return ofReading(core, asked.read);
  if ("follow" in asked) {
    const hand = new Hand(asked.follow.aims[0]!, asked.follow.slowness);
    for (const aim of asked.follow.aims) hand.follow(aim, asked.follow.straight);
    return hand.saved;
  }
  if ("simulate" in asked) return answerOf(core, asked.simulate, asked.duration);
  try {
    if ("device" in asked) return ofDevice(core, asked);
    if ("recording" in asked) {
      const recording = readRecording(asked.recording, asked.file);
      const { times, channels } = recording;
      if (asked.fit) {
        const { device, keys, freeOffset } = asked.fit;
        const { values } = readDevice(core, device, "the device");
        return fit(core, recording, values, keys, Math.max(0, times[0]!), freeOffset);
      }
      return {
        times: bits(times),
        channels: Object.fromEntries(Object.entries(channels).map(([k, v]) => [k, bits(v)])),
      };
    }
    return { value: bits([toSi(asked.si, asked.unit, "1 g")]) };
  } catch (error) {
    if (error instanceof DeviceError || error instanceof RecordingError || "si" in asked) {
      return { problem: (error as Error).message };
    }
    throw error;
  }
}

const core = await Core.load(await WebAssembly.compile(readFileSync(process.argv[2]!)));
for await (const line of createInterface({ input: process.stdin })) {
  const found = answer(core, JSON.parse(line) as Question);
  process.stdout.write(`${JSON.stringify(found)}\n`);
}
