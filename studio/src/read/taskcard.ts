// The tasks of a first minute: one is open, with its verdict.
import { card, h } from "../dom";
import type { Hand } from "./hand";
import type { Line } from "./scan";
import { type Crossing, crossings, type Read, TASKS } from "./tasks";

export class TaskCard {
  readonly element: HTMLElement;
  private readonly tabs: readonly HTMLButtonElement[];
  private readonly what = h("p", { class: "what" });
  private readonly verdict = h("p", { class: "verdict", role: "status" });
  private task = -1;
  /** Lines of the readings before this one that were read for the task. */
  private before: Crossing[] = [];
  private now: Crossing[] = [];

  constructor(choose: (task: number) => void) {
    this.tabs = TASKS.map(({ name }, i) =>
      h("button", { type: "button", title: name, onclick: () => choose(i) }, String(i + 1)),
    );
    this.element = card(
      "tasks-card",
      "Task",
      h("div", { class: "tabs" }, ...this.tabs),
      this.what,
      this.verdict,
    );
  }

  /** Opens a task; its verdict begins anew. */
  show(task: number): void {
    if (task === this.task) return;
    [this.task, this.before, this.now] = [task, [], []];
    this.tabs.forEach((tab, i) => {
      tab.setAttribute("aria-pressed", String(i === task));
    });
    const { name, what } = TASKS[task]!;
    this.what.replaceChildren(h("b", {}, name), ` ${what}`);
    this.verdict.textContent = "";
  }

  /** Another reading begins. */
  began(): void {
    this.before.push(...this.now);
    this.now = [];
  }

  judge(lines: readonly Line[], hand: Hand, read: Omit<Read, "lines" | "before">): void {
    this.now = crossings(lines, hand);
    const said = TASKS[this.task]!.verdict({ ...read, lines: this.now, before: this.before });
    if (said) this.verdict.textContent = said;
  }
}
