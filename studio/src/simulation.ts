// Computations of "One release" beside the page: motions at each change, and fits; a long one can be stopped.
import { button, h } from "./dom";
import { Newest, type Program, Stopped, Thread } from "./thread";
import type { Answer, Motions, MotionsFound, Task } from "./work";

const LONG = 300; // ms after which a computation is said to take long
const STOPPED = "Stopped. A change of a value simulates again.";

export class Simulation {
  /** Shown while a computation takes long. */
  readonly busy = h(
    "p",
    { id: "busy", role: "status", hidden: true },
    "This takes a while … ",
    button("Stop", "Stop the computation", () => this.thread.stop()),
  );
  private readonly thread: Thread;
  private readonly motions: Newest<"motions">;
  private timer = 0;

  constructor(
    program: Program,
    private readonly say: (problem: string) => void,
  ) {
    this.thread = new Thread(program);
    this.motions = new Newest(this.thread, "motions");
  }

  get idle(): boolean {
    return !this.motions.busy && this.thread.idle;
  }

  /** Simulates the newest designs; `take` gets their motions, or in their place what went wrong. */
  ask(task: () => Motions, take: (found: MotionsFound) => void): void {
    if (!this.motions.busy) this.showBusy();
    const taken = (found: MotionsFound): void => {
      if (!this.motions.waits) this.hideBusy();
      take(found);
    };
    this.motions.ask(task, taken, (error) => {
      const problem = error instanceof Stopped ? STOPPED : error.message;
      taken({ end: 1e-3, found: task().designs.map(() => ({ problem })), effects: [] });
    });
  }

  /** The answer to another task; null with a message if there is none. */
  async answer<K extends "fit" | "offset">(kind: K, task: Task<K>): Promise<Answer<K> | null> {
    this.showBusy();
    try {
      return await this.thread.ask(kind, task);
    } catch (error) {
      this.say(error instanceof Stopped ? "The fit was stopped." : (error as Error).message);
      return null;
    } finally {
      this.hideBusy();
    }
  }

  private showBusy(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => {
      this.busy.hidden = false;
    }, LONG);
  }

  private hideBusy(): void {
    clearTimeout(this.timer);
    this.busy.hidden = true;
  }
}
