// A thread that simulates a device: it is sent the core's program first, then tasks, and answers each.
import { Core } from "../core";
import { Engine, type Task } from "./engine";

let engine: Promise<Engine> | undefined;

addEventListener(
  "message",
  ({ data }: MessageEvent<{ wasm: ArrayBuffer } | { task: Task; number: number }>) => {
    if ("wasm" in data) {
      engine = Core.load(data.wasm).then((core) => new Engine(core));
      return;
    }
    void engine?.then((ready) => {
      postMessage({ answer: ready.answer(data.task), number: data.number });
    });
  },
);
