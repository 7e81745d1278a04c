// A finished reading shown again: a slider of its time, Play and Pause, and speeds.
import { button, h, option } from "../dom";
import type { Slowness } from "./hand";

/** Times that a reading is shown slower than it was read. */
const SPEEDS = [
  ["0.5", "2×"],
  ["1", "as read"],
  ["4", "1/4"],
  ["16", "1/16"],
] as const;

export class Playback {
  readonly element: HTMLElement;
  private readonly slider = h("input", {
    type: "range",
    min: 0,
    max: 1000,
    step: "any",
    "aria-label": "time of the reading",
  });
  private readonly play = button("Play", "Show the reading again (space bar)", () => this.toggle());
  private readonly speed = h(
    "select",
    { "aria-label": "speed of the replay" },
    ...SPEEDS.map(([value, words]) => option(value, words, value === "4")),
  );
  private readonly clock = h("output");
  private end = 1;
  private time = 0;
  /** Time of the wall clock of the last step, ms; 0: paused. */
  private last = 0;

  /** `changed` is called when time is to be shown from then on. */
  constructor(private readonly changed: () => void) {
    this.slider.addEventListener("input", () => {
      this.pause();
      this.time = (Number(this.slider.value) / 1000) * this.end;
      this.show();
      changed();
    });
    this.element = h(
      "div",
      { class: "playback", hidden: true },
      this.play,
      this.speed,
      this.slider,
      this.clock,
    );
  }

  /** Time that is to be shown, s of the device. */
  get wanted(): number {
    return this.time;
  }
  get playing(): boolean {
    return this.last > 0;
  }

  /** Opens it for a reading that lasts so long, s, at a time. */
  open(end: number, time: number): void {
    this.element.hidden = false;
    this.end = end || 1;
    this.goTo(time);
  }
  close(): void {
    this.pause();
    this.element.hidden = true;
  }

  goTo(time: number): void {
    this.pause();
    this.time = Math.min(Math.max(time, 0), this.end);
    this.show();
    this.changed();
  }

  /** Moves time on to now, ms of the wall clock. */
  step(now: number, slowness: Slowness): void {
    if (!this.playing) return;
    this.time += ((now - this.last) * 1e-3) / (Number(this.speed.value) * slowness);
    this.last = now;
    if (this.time >= this.end) {
      this.time = this.end;
      this.pause();
    }
    this.show();
  }

  toggle(): void {
    if (this.playing) this.pause();
    else this.begin();
    this.changed();
  }

  private begin(): void {
    if (this.time >= 0.999 * this.end) this.time = 0;
    this.last = performance.now();
    this.play.textContent = "Pause";
  }
  private pause(): void {
    this.last = 0;
    this.play.textContent = "Play";
  }

  private show(): void {
    this.slider.value = String((1000 * this.time) / this.end);
    const words = `${this.time.toFixed(2)} of ${this.end.toFixed(2)} s`;
    this.clock.textContent = words;
    this.slider.setAttribute("aria-valuetext", words);
  }
}
