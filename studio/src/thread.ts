// A thread beside the page, which runs the page's own program and answers tasks in their order.
import { Core } from "./core";
import { type Answer, answersOf, type Kind, type Task } from "./work";

/** The page's own program, and the core, whose code all threads share. */
export interface Program {
  readonly url: string;
  readonly wasm: WebAssembly.Module;
}

interface Question {
  readonly number: number;
  readonly kind: Kind;
  readonly task: unknown;
}
interface Reply {
  readonly number: number;
  readonly answer?: unknown;
  readonly failed?: string;
}
type Waiting = { readonly resolve: (answer: unknown) => void; readonly reject: (error: Error) => void };

/** The error of tasks whose thread was stopped. */
export class Stopped extends Error {}

export class Thread {
  private worker: Worker;
  private readonly waiting = new Map<number, Waiting>();
  private count = 0;

  constructor(private readonly program: Program) {
    this.worker = this.started();
  }

  /** True if no task is waiting for its answer. */
  get idle(): boolean {
    return this.waiting.size === 0;
  }

  /** The answer to a task. Rejects with what went wrong, or with Stopped. */
  ask<K extends Kind>(kind: K, task: Task<K>): Promise<Answer<K>> {
    this.count += 1;
    const question: Question = { number: this.count, kind, task };
    this.worker.postMessage({ question });
    return new Promise((resolve, reject) => {
      this.waiting.set(question.number, { resolve: resolve as Waiting["resolve"], reject });
    });
  }

  /** Ends what it computes; later tasks are answered by a new thread. */
  stop(): void {
    this.worker.terminate();
    this.worker = this.started();
    this.fail(new Stopped("stopped"));
  }

  private fail(error: Error): void {
    const left = [...this.waiting.values()];
    this.waiting.clear();
    for (const { reject } of left) reject(error);
  }

  private started(): Worker {
    const worker = new Worker(this.program.url);
    worker.addEventListener("error", () => this.fail(new Error("the thread of the page has failed")));
    worker.addEventListener("message", ({ data }: MessageEvent<Reply>) => {
      const waiting = this.waiting.get(data.number);
      this.waiting.delete(data.number);
      if (data.failed === undefined) waiting?.resolve(data.answer);
      else waiting?.reject(new Error(data.failed));
    });
    worker.postMessage({ wasm: this.program.wasm });
    return worker;
  }
}

/** Answers the tasks of a page, within its thread. */
export function serve(): void {
  let answers: Promise<ReturnType<typeof answersOf>> | undefined;
  addEventListener(
    "message",
    ({ data }: MessageEvent<{ wasm: WebAssembly.Module } | { question: Question }>) => {
      if ("wasm" in data) {
        answers = Core.load(data.wasm).then(answersOf);
        return;
      }
      const { number, kind, task } = data.question;
      void answers?.then((of) => {
        const answer = of[kind] as (task: unknown) => unknown;
        try {
          postMessage({ number, answer: answer(task) });
        } catch (error) {
          postMessage({ number, failed: error instanceof Error ? error.message : String(error) });
        }
      });
    },
  );
}

interface Request<K extends Kind> {
  readonly task: () => Task<K>;
  readonly take: (answer: Answer<K>) => void;
  readonly failed: (error: Error) => void;
}

/** The newest of tasks that are asked for again and again: those that have not begun are left out. */
export class Newest<K extends Kind> {
  private next: Request<K> | null = null;
  /** The task in the thread; null: none. */
  task: Task<K> | null = null;

  constructor(
    private readonly thread: Thread,
    private readonly kind: K,
  ) {}

  /** True while an answer is awaited. */
  get busy(): boolean {
    return this.task !== null || this.next !== null;
  }
  /** True if a newer task than the present one waits. */
  get waits(): boolean {
    return this.next !== null;
  }

  ask(task: () => Task<K>, take: (answer: Answer<K>) => void, failed: (error: Error) => void): void {
    this.next = { task, take, failed };
    if (!this.task) void this.run();
  }

  private async run(): Promise<void> {
    while (this.next) {
      const { task, take, failed } = this.next;
      this.next = null;
      this.task = task();
      try {
        take(await this.thread.ask(this.kind, this.task));
      } catch (error) {
        failed(error as Error);
      }
    }
    this.task = null;
  }
}
