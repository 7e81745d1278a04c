// The map kept up to date: the newest task goes to a thread of its own as soon as that is idle.

import type { Core } from "./core";
import { axesOf, mapTask } from "./map";
import { computeMap, type MapResult, type MapTask } from "./mapgrid";
import { MapView } from "./mapview";
import { currentDesign, type State } from "./state";
import type { Look } from "./theme";

declare const MAP_WORKER: string; // the text of mapworker.ts, which the build puts here

export class MapRunner {
  /** The last map, and what was asked for it. */
  last: MapResult | null = null;
  task: MapTask | null = null;
  private readonly view: MapView;
  private worker: Worker | null = null;
  /** True while the thread has not responded. */
  busy = false;
  private next: (() => MapTask) | null = null;
  private state: State | null = null;

  constructor(
    private readonly core: Core,
    wasm: ArrayBuffer,
    look: Look,
    choose: (point: Readonly<Record<string, number>>) => void,
  ) {
    this.view = new MapView(look, (x, y) => {
      const { map } = this.state!;
      choose({ [map.x]: x, [map.y]: y });
    });
    try {
      this.worker = new Worker(URL.createObjectURL(new Blob([MAP_WORKER], { type: "text/javascript" })));
      this.worker.addEventListener("message", ({ data }: MessageEvent<MapResult>) => this.answered(data));
      this.worker.addEventListener("error", () => this.failed());
      this.worker.postMessage({ wasm });
    } catch {
      this.worker = null;
    }
  }

  get element(): HTMLElement {
    return this.view.element;
  }

  setLook(look: Look): void {
    this.view.setLook(look);
  }

  update(state: State): void {
    this.state = state;
    const { values } = currentDesign(state);
    const { x, y } = state.map;
    const axes = axesOf(values, x, y);
    const limits = Object.entries(state.specification).map(([name, { atMost, atLeast }]) => ({
      number: name,
      atMost: atMost ?? Infinity,
      atLeast: atLeast ?? -Infinity,
    }));
    this.view.show({
      x,
      y,
      axes,
      number: state.number,
      limited: limits.length > 0,
      at: [values[x] as number, values[y] as number],
    });
    this.next = () => mapTask(values, x, y, axes, state.number, limits);
    this.view.element.dataset.stale = "";
    setTimeout(() => this.send()); // after what is seen at once
  }

  private send(): void {
    if (this.busy || !this.next) return;
    const task = this.next();
    this.task = task;
    this.next = null;
    if (this.worker) {
      this.busy = true;
      this.worker.postMessage({ task });
    } else {
      this.answered(computeMap(this.core, task));
    }
  }

  /** Without its thread, the map is computed here. */
  private failed(): void {
    this.worker = null;
    const unanswered = this.busy ? this.task : null;
    this.busy = false;
    this.next ??= unanswered && (() => unanswered);
    this.send();
  }

  private answered(result: MapResult): void {
    this.busy = false;
    this.last = result;
    this.view.setResult(result);
    this.view.element.dataset.took = result.took.toFixed(3);
    if (!this.next) delete this.view.element.dataset.stale;
    this.send();
  }
}
