// A state with its history: who is told of a change, and what undoes it.

const LONGEST = 500; // states that can be undone
const MERGED = 1000; // ms within which changes of one kind are one step

export class Store<T> {
  private past: T[] = [];
  private future: T[] = [];
  private lastKind = "";
  private lastTime = -Infinity;
  private readonly listeners: (() => void)[] = [];

  constructor(private state: T) {}

  get now(): T {
    return this.state;
  }

  /** Changes the state by a step that can be undone; steps of one kind that follow one another soon are merged. */
  change(next: T, kind = ""): void {
    const time = performance.now();
    if (kind === "" || kind !== this.lastKind || time - this.lastTime > MERGED) {
      this.past.push(this.state);
      if (this.past.length > LONGEST) this.past.shift();
    }
    this.future = [];
    [this.state, this.lastKind, this.lastTime] = [next, kind, time];
    this.tell();
  }

  /** Changes what no step is, such as the cursor. */
  replace(next: T): void {
    if (next === this.state) return;
    this.state = next;
    this.tell();
  }

  /** Calls `listener` after each change. */
  listen(listener: () => void): void {
    this.listeners.push(listener);
  }

  get canUndo(): boolean {
    return this.past.length > 0;
  }
  get canRedo(): boolean {
    return this.future.length > 0;
  }
  undo(): void {
    this.move(this.past, this.future);
  }
  redo(): void {
    this.move(this.future, this.past);
  }

  private move(from: T[], to: T[]): void {
    const state = from.pop();
    if (state === undefined) return;
    to.push(this.state);
    [this.state, this.lastKind] = [state, ""];
    this.tell();
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}
