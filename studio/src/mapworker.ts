// A thread that computes maps: it is sent the core's program first, then tasks.
import { Core } from "./core";
import { computeMap, type MapTask } from "./mapgrid";

let core: Promise<Core> | undefined;

addEventListener("message", ({ data }: MessageEvent<{ wasm: ArrayBuffer } | { task: MapTask }>) => {
  if ("wasm" in data) {
    core = Core.load(data.wasm);
    return;
  }
  core
    ?.then((ready) => postMessage(computeMap(ready, data.task)))
    .catch((error: unknown) =>
      setTimeout(() => {
        throw error; // outside of the promise, where the page hears of it
      }),
    );
});
