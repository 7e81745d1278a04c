// The cursor over time: a slider, slow motion, and sound.
import { button, h, option } from "./dom";
import type { Curves } from "./sample";
import { Sound } from "./sound";
import type { View } from "./view";

export class Player {
  readonly element: HTMLElement;
  private readonly slider = h("input", {
    type: "range",
    id: "cursor",
    min: 0,
    max: 1000,
    step: "any",
    "aria-label": "time of the cursor",
  });
  private readonly play = button("Play", "Slow motion (space bar)", () => this.toggle());
  private readonly listen = button(
    "Listen",
    "Hear the motion: pitch is position, loudness is speed, a click is an event",
    () => this.hear(),
  );
  private readonly speed = h(
    "select",
    { "aria-label": "speed" },
    option("5", "1/5"),
    option("20", "1/20", true),
    option("100", "1/100"),
  );
  private readonly clock = h("output", { for: "cursor" });
  private readonly sound = new Sound();
  private running = 0;
  private end = 1;
  private time = 0;

  constructor(
    private readonly go: (time: number) => void,
    private readonly motion: () => { readonly curves: Curves | null; readonly end: number },
  ) {
    this.slider.addEventListener("input", () => go((Number(this.slider.value) / 1000) * this.end));
    this.element = h("div", { class: "player" }, this.play, this.speed, this.slider, this.clock, this.listen);
  }

  update(view: View): void {
    this.end = view.end;
    this.time = view.state.cursor;
    if (document.activeElement !== this.slider || this.running)
      this.slider.value = String((1000 * this.time) / this.end);
    const words = `${(1e3 * this.time).toFixed(2)} ms`;
    this.clock.textContent = words;
    this.slider.setAttribute("aria-valuetext", words);
  }

  toggle(): void {
    if (this.running) {
      cancelAnimationFrame(this.running);
      this.running = 0;
      this.play.textContent = "Play";
      return;
    }
    if (this.time >= this.end * 0.999) this.go(0);
    let before = performance.now();
    const frame = (now: number): void => {
      const time = this.time + (now - before) / 1e3 / Number(this.speed.value);
      before = now;
      this.go(time);
      if (time >= this.end) this.toggle();
      else this.running = requestAnimationFrame(frame);
    };
    this.running = requestAnimationFrame(frame);
    this.play.textContent = "Pause";
  }

  private hear(): void {
    const { curves, end } = this.motion();
    if (!curves) return;
    const playing = this.sound.toggle(curves, end, () => (this.listen.textContent = "Listen"));
    this.listen.textContent = playing ? "Stop" : "Listen";
  }
}
