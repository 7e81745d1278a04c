// Owner of the hand: a demonstration, until a pointer, a finger or the arrow keys take it; or a pen draws.
import { TICK } from "./hand";
import { HEIGHT, type Spot } from "./paper";
import { Demonstration, Keys, limited, Pointer } from "./pointer";

const ARROWS = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"];

export interface Held {
  /** Width of the page, mm, and on the screen. */
  readonly width: number;
  readonly shown: () => number;
  /** Place of the hand, mm. */
  readonly place: () => Spot;
  /** True if a reading is repeated, in which nobody holds the hand. */
  readonly repeating: () => boolean;
  /** A hand is put down at a place, mm. */
  readonly taken: (at: Spot) => void;
  readonly drawn: (from: Spot, to: Spot) => void;
  /** The end of a stroke of the pen. */
  readonly printed: () => void;
}

export class HandControl {
  demonstration: Demonstration | null = null;
  /** True while the pen draws in place of the hand. */
  pen = false;
  /** True along a ruler. */
  ruler = false;
  private readonly pointer = new Pointer(Demonstration.start);
  private readonly keys = new Keys();
  private away = true;
  private stroke: Spot | null = null;
  private grip: { readonly at: Spot; readonly x: number; readonly y: number } | null = null;

  constructor(
    private readonly element: HTMLElement,
    private readonly held: Held,
  ) {
    this.listen();
  }

  /** True if the hand keeps its height. */
  get straight(): boolean {
    return this.ruler || (this.keys.held && this.keys.straight);
  }

  /** Aim of the hand at a time of the wall clock, ms; one call for each tick. */
  aim(wall: number, slowness: number): Spot {
    if (this.keys.held) return this.keys.next(TICK, slowness, this.held.width);
    return this.demonstration?.at(wall) ?? this.pointer.at(wall);
  }

  demonstrate(slowness: number): void {
    this.demonstration = new Demonstration(this.held.width, performance.now(), slowness);
  }

  private listen(): void {
    const { element } = this;
    element.addEventListener("pointerdown", (event) => this.down(event));
    element.addEventListener("pointermove", (event) => {
      const events = event.getCoalescedEvents?.() ?? [];
      for (const each of events.length ? events : [event]) this.moved(each);
    });
    for (const kind of ["pointerup", "pointercancel"] as const) {
      element.addEventListener(kind, () => this.up());
    }
    element.addEventListener("pointerleave", () => {
      this.away = true;
    });
    element.addEventListener("keydown", (event) => {
      if (!ARROWS.includes(event.key)) return;
      event.preventDefault();
      if (event.repeat) return;
      if (this.unheld) this.take(Demonstration.start, event.timeStamp);
      this.keys.press(event.key, this.held.place());
    });
    element.addEventListener("keyup", (event) => {
      this.keys.release(event.key);
      if (!this.keys.held) this.pointer.add(this.held.place(), event.timeStamp);
    });
    element.addEventListener("blur", () => {
      for (const key of ARROWS) this.keys.release(key);
    });
  }

  private get unheld(): boolean {
    return this.demonstration !== null || this.held.repeating();
  }

  private spot(event: PointerEvent): Spot {
    const { left, top, width, height } = this.element.getBoundingClientRect();
    return {
      x: ((event.clientX - left) / width) * this.held.width,
      y: ((event.clientY - top) / height) * HEIGHT,
    };
  }

  private down(event: PointerEvent): void {
    if (this.pen || event.pointerType !== "mouse") this.element.setPointerCapture(event.pointerId);
    if (this.pen) this.stroke = this.spot(event);
    else if (event.pointerType === "touch") {
      // A finger moves the hand as a mouse would: by as much as the finger moves.
      const at = this.unheld ? Demonstration.start : this.held.place();
      this.take(at, event.timeStamp);
      this.grip = { at, x: event.clientX, y: event.clientY };
    }
  }

  private up(): void {
    this.grip = null;
    if (!this.stroke) return;
    this.stroke = null;
    this.held.printed();
  }

  private moved(event: PointerEvent): void {
    const at = this.spot(event);
    if (this.pen) {
      if (!this.stroke) return;
      this.held.drawn(this.stroke, at);
      this.stroke = at;
    } else if (event.pointerType === "touch") {
      if (!this.grip) return;
      const scale = this.held.width / this.held.shown();
      const { at: from, x, y } = this.grip;
      const aim = { x: from.x + (event.clientX - x) * scale, y: from.y + (event.clientY - y) * scale };
      this.pointer.add(limited(aim, this.held.width), event.timeStamp);
    } else {
      const within = limited(at, this.held.width);
      if (this.away || this.unheld) this.take(within, event.timeStamp);
      else this.pointer.add(within, event.timeStamp);
    }
  }

  /** Puts the hand down at a place, mm. */
  private take(at: Spot, wall: number): void {
    this.away = false;
    this.demonstration = null;
    this.pointer.put(at, wall);
    this.held.taken(at);
  }
}
