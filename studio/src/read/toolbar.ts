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
  readonly gives: (on: boolean) => void;
  readonly slowness: (slowness: Slowness) => void;
  readonly feedback: Feedback;
}

export class Toolbar {
  readonly element: HTMLElement;
  private readonly text = textField({ maxlength: 12, "aria-label": "text on the page" });
  private readonly times: HTMLSelectElement;
  private readonly clear: HTMLButtonElement;
  private readonly gives: HTMLButtonElement;

  constructor(actions: ToolbarActions) {
    this.text.addEventListener("input", () => actions.text(this.text.value));
    this.times = h(
      "select",
      { "aria-label": "time runs" },
      ...SLOWNESS.map((times) => option(String(times), times === 1 ? "real time" : `${times}× slower`)),
    );
    this.times.addEventListener("change", () => actions.slowness(Number(this.times.value) as Slowness));
    this.clear = button("Clear", "A blank page", actions.clear);
    this.gives = toggle(
      "Hand gives way",
      "The ruler moves; an arm pulls the mouse along it, and the pins slow the mouse",
      actions.gives,
    );
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
      this.gives,
      this.times,
      sound,
      vibration,
    );
  }

  /** A hand gives way along the drive axis alone, which must be that of the ruler. */
  allowGives(on: boolean): void {
    this.gives.disabled = !on;
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
