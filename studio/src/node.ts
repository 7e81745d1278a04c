// The core and the readers of files in Node, for tests: one question a line, one answer a line.
import { readFileSync } from "node:fs";
import { createInterface } from "node:readline";
import { answerOf, bits } from "./answers";
import { Core, type Input } from "./core";
import { DeviceError, decodeText, readDevice } from "./device";
import { RecordingError, readRecording } from "./recording";
import { toSi } from "./units";
import { deviceFile } from "./write";

type Question =
  | { readonly simulate: Input; readonly duration: number | null }
  | { readonly device: string; readonly file: string }
  | { readonly recording: string; readonly file: string }
  | { readonly si: string; readonly unit: string };

function answer(core: Core, asked: Question): unknown {
  if ("simulate" in asked) return answerOf(core, asked.simulate, asked.duration);
  try {
    if ("device" in asked) {
      const text = decodeText(Uint8Array.from(Buffer.from(asked.device, "base64")), asked.file);
      const device = readDevice(text, asked.file);
      return { name: device.name, values: device.values, written: deviceFile({ ...device, shown: true }) };
    }
    if ("recording" in asked) {
      const { times, channels } = readRecording(asked.recording, asked.file);
      return { times: bits(times), channels: Object.fromEntries(Object.entries(channels).map(([k, v]) => [k, bits(v)])) };
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
