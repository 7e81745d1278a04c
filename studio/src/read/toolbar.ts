// Controls of the page and of time: text, pen, ruler, slowness, sound and vibration.
import { button, h, option, show, textField } from "../dom";
import { type Feedback, VIBRATES } from "./feedback";
import { SLOWNESS, type Slowness } from "./hand";
import type { ReadState } from "./state";

export interface ToolbarActions {
  readonly text: (text: string) => void;
  readonly pen: (on: boolean) => void;
  readonly clear: () => void;
  readonly ruler: (on: boolean) => void;
  readonly slowness: (slowness: Slowness) => void;
  readonly feedback: Feedback;
}

export class Toolbar {
  readonly element: HTMLElement;
  private readonly text = textField({ maxlength: 12, "aria-label": "text on the page" });
  private readonly times: HTMLSelectElement;
  private readonly clear: HTMLButtonElement;

  constructor(actions: ToolbarActions) {
    this.text.addEventListener("input", () => actions.text(this.text.value));
    this.times = h(
      "select",
      { "aria-label": "time runs" },
      ...SLOWNESS.map((times) => option(String(times), times === 1 ? "real time" : `${times}× slower`)),
    );
    this.times.addEventListener("change", () => actions.slowness(Number(this.times.value) as Slowness));
    this.clear = button("Clear", "A blank page", actions.clear);
    const { feedback } = actions;
    const sound = toggle("Sound", "A short tone, on its side, for each pin that moves the skin", (on) => {
      feedback.sound = on;
    });
    const vibration = toggle("Vibration", "A short vibration of this device when skin is moved", (on) => {
      feedback.vibration = on;
    });
    vibration.hidden = !VIBRATES;
    this.element = h(
      "div",
      { class: "toolbar" },
      h("label", {}, "Text ", this.text),
      toggle("Draw", "Draw on the page", actions.pen),
      this.clear,
      toggle("Along a ruler", "The hand keeps its height", actions.ruler),
      this.times,
      sound,
      vibration,
    );
  }

  update({ print, slowness }: ReadState): void {
    show(this.text, print.kind === "text" ? print.text : "");
    this.times.value = String(slowness);
    this.clear.hidden = print.kind !== "drawing" || !print.strokes.length;
  }
}

function toggle(text: string, title: string, change: (on: boolean) => void): HTMLButtonElement {
  const made = button(text, title, () => {
    const on = made.getAttribute("aria-pressed") !== "true";
    made.setAttribute("aria-pressed", String(on));
    change(on);
  });
  made.setAttribute("aria-pressed", "false");
  return made;
}
