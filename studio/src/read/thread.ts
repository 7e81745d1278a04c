// A thread that simulates, beside the page: one answer for each task, in order.
import type { Answer, Task } from "./engine";

declare const READ_WORKER: string; // the text of readworker.ts, which the build puts here

export class Thread {
  private readonly worker: Worker;
  private readonly waiting = new Map<number, (answer: Answer) => void>();
  private count = 0;

  constructor(wasm: ArrayBuffer) {
    this.worker = new Worker(URL.createObjectURL(new Blob([READ_WORKER], { type: "text/javascript" })));
    this.worker.addEventListener("message", ({ data }: MessageEvent<{ answer: Answer; number: number }>) => {
      this.waiting.get(data.number)?.(data.answer);
      this.waiting.delete(data.number);
    });
    this.worker.postMessage({ wasm });
  }

  /** True if no task is waiting for its answer. */
  get idle(): boolean {
    return this.waiting.size === 0;
  }

  ask(task: Task): Promise<Answer> {
    this.count += 1;
    const number = this.count;
    this.worker.postMessage({ task, number });
    return new Promise((resolve) => this.waiting.set(number, resolve));
  }
}
