// Owner of the hand: a demonstration, until a pointer, a finger or the arrow keys take it; or a pen draws.
//
// A hand is taken on purpose: by a finger or a button that is pressed on the page, by an arrow key, and, as long as
// there is no reading that could be lost, by a pointer that moves over the page. A reading ends where the pointer
// leaves the page or the finger lifts.
import { TICK } from "./hand";
import { HEIGHT, type Spot } from "./paper";
import { Demonstration, Keys, limited, Pointer } from "./pointer";

const ARROWS = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"];

export interface Held {
  /** Width of the page, mm. */
  readonly width: () => number;
  /** Place of the hand, mm. */
  readonly place: () => Spot;
  /** True while a hand reads. */
  readonly reads: () => boolean;
  /** True if a pointer takes the hand by moving over the page. */
  readonly free: () => boolean;
  /** A hand is put down at a place, mm. */
  readonly taken: (at: Spot) => void;
  /** It has a new aim. */
  readonly moved: () => void;
  /** The hand is let go. */
  readonly ended: () => void;
  readonly drawn: (from: Spot, to: Spot) => void;
  /** The end of a stroke of the pen. */
  readonly printed: (stroke: readonly Spot[]) => void;
}

export class HandControl {
  demonstration: Demonstration | null = null;
  /** True while the pen draws in place of the hand. */
  pen = false;
  /** True along a ruler. */
  ruler = false;
  private readonly pointer = new Pointer(Demonstration.start);
  private readonly keys = new Keys();
  private stroke: Spot[] | null = null;
  /** True while a finger, or a button of a mouse, holds the hand beyond the edge of the page. */
  private pressed = false;

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
  /** True while a key moves the hand. */
  get driven(): boolean {
    return this.keys.held;
  }

  /** Aim of the hand at a time of the wall clock, ms; one call for each tick. */
  aim(wall: number, slowness: number): Spot {
    if (this.keys.held) return this.keys.next(TICK, slowness, this.held.width());
    return this.demonstration?.at(wall) ?? this.pointer.at(wall);
  }

  demonstrate(slowness: number): void {
    this.demonstration = new Demonstration(this.held.width(), performance.now(), slowness);
  }

  private listen(): void {
    const { element } = this;
    const on = <K extends keyof HTMLElementEventMap>(
      kind: K,
      act: (event: HTMLElementEventMap[K]) => void,
    ): void => element.addEventListener(kind, act);
    on("pointerdown", (event) => this.down(event));
    on("pointermove", (event) => {
      const events = event.getCoalescedEvents?.() ?? [];
      for (const each of events.length ? events : [event]) this.moved(each);
    });
    for (const kind of ["pointerup", "pointercancel"] as const) on(kind, (event) => this.up(event));
    on("pointerleave", () => {
      if (!this.pressed && !this.keys.held) this.end();
    });
    on("keydown", (event) => {
      if (event.key === "Escape") this.end();
      if (!ARROWS.includes(event.key)) return;
      event.preventDefault();
      if (event.repeat) return;
      if (!this.held.reads()) this.take(Demonstration.start, event.timeStamp);
      this.keys.press(event.key, this.held.place());
      this.held.moved();
    });
    on("keyup", (event) => {
      this.keys.release(event.key);
      if (!this.keys.held) this.pointer.add(this.held.place(), event.timeStamp);
    });
    on("blur", () => {
      for (const key of ARROWS) this.keys.release(key);
      this.end();
    });
  }

  private spot(event: PointerEvent): Spot {
    const { left, top, width, height } = this.element.getBoundingClientRect();
    return {
      x: ((event.clientX - left) / width) * this.held.width(),
      y: ((event.clientY - top) / height) * HEIGHT,
    };
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0) return;
    this.element.setPointerCapture(event.pointerId);
    const at = this.spot(event);
    if (this.pen) {
      this.stroke = [at];
      return;
    }
    this.pressed = true;
    // A mouse that reads already goes on; a finger begins where it touches.
    if (event.pointerType === "mouse" && this.held.reads()) return;
    this.take(limited(at, this.held.width()), event.timeStamp);
  }

  private up(event: PointerEvent): void {
    this.pressed = false;
    if (this.stroke) {
      const { stroke } = this;
      this.stroke = null;
      this.held.printed(stroke);
      return;
    }
    const { left, top, right, bottom } = this.element.getBoundingClientRect();
    const inside =
      event.clientX >= left && event.clientX < right && event.clientY >= top && event.clientY < bottom;
    if (event.pointerType !== "mouse" || !inside) this.end();
  }

  private moved(event: PointerEvent): void {
    const at = this.spot(event);
    if (this.pen) {
      if (!this.stroke) return;
      this.held.drawn(this.stroke[this.stroke.length - 1]!, at);
      this.stroke.push(at);
      return;
    }
    const within = limited(at, this.held.width());
    if (this.held.reads()) {
      if (event.pointerType === "touch" && !this.pressed) return;
      this.pointer.add(within, event.timeStamp);
      this.held.moved();
    } else if (event.pointerType !== "touch" && this.held.free()) this.take(within, event.timeStamp);
  }

  /** Puts the hand down at a place, mm. */
  private take(at: Spot, wall: number): void {
    this.demonstration = null;
    this.pointer.put(at, wall);
    this.held.taken(at);
  }

  private end(): void {
    if (this.held.reads()) this.held.ended();
  }
}
