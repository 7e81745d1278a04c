// The core and the readers of files in Node, for tests: one question a line, one answer a line.
import { readFileSync } from "node:fs";
import { createInterface } from "node:readline";
import { answerOf, bits } from "./answers";
import { Core, type Input } from "./core";
import { coreInput, direction, withValue } from "./design";
import { DeviceError, decodeText, readDevice } from "./device";
import type { Values } from "./friction";
import { axesOf, gridValues, mapTask } from "./map";
import { expanded, SIZE } from "./mapgrid";
import { RecordingError, readRecording } from "./recording";
import { type Curves, simulateAll } from "./sample";
import { toSi } from "./units";
import { deviceFile, eventsCsv, samplesCsv } from "./write";

type Question =
  | { readonly simulate: Input; readonly duration: number | null }
  | Device
  | { readonly recording: string; readonly file: string }
  | { readonly si: string; readonly unit: string };

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
  const device = readDevice(text, asked.file);
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

function answer(core: Core, asked: Question): unknown {
  if ("simulate" in asked) return answerOf(core, asked.simulate, asked.duration);
  try {
    if ("device" in asked) return ofDevice(core, asked);
    if ("recording" in asked) {
      const { times, channels } = readRecording(asked.recording, asked.file);
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

const core = await Core.load(readFileSync(process.argv[2]!));
for await (const line of createInterface({ input: process.stdin })) {
  const found = answer(core, JSON.parse(line) as Question);
  process.stdout.write(`${JSON.stringify(found)}\n`);
}
