// The map kept up to date, by a thread of its own.

import { axesOf, mapTask } from "./map";
import type { MapResult, MapTask } from "./mapgrid";
import { MapView } from "./mapview";
import { currentDesign, type ReleaseState } from "./state";
import type { Look } from "./theme";
import { Newest, type Program, Thread } from "./thread";

export class MapRunner {
  /** The last map. */
  last: MapResult | null = null;
  /** The task of which the thread was asked last. */
  task: MapTask | null = null;
  private readonly view: MapView;
  readonly newest: Newest<"map">;
  private state: ReleaseState | null = null;

  constructor(program: Program, look: Look, choose: (point: Readonly<Record<string, number>>) => void) {
    this.view = new MapView(look, (x, y) => {
      const { map } = this.state!;
      choose({ [map.x]: x, [map.y]: y });
    });
    this.newest = new Newest(new Thread(program), "map");
  }

  get element(): HTMLElement {
    return this.view.element;
  }

  setLook(look: Look): void {
    this.view.setLook(look);
  }

  update(state: ReleaseState): void {
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
    this.view.element.dataset.stale = "";
    const task = (): MapTask => {
      this.task = mapTask(values, x, y, axes, state.number, limits);
      return this.task;
    };
    const failed = (error: Error): void => {
      this.view.element.dataset.failed = error.message;
    };
    setTimeout(() => this.newest.ask(task, (result) => this.answered(result), failed)); // after what is seen at once
  }

  private answered(result: MapResult): void {
    this.last = result;
    this.view.setResult(result);
    this.view.element.dataset.took = result.took.toFixed(3);
    if (!this.newest.waits) delete this.view.element.dataset.stale;
  }
}
