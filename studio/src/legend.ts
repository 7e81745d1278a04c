// Legends of the signs in the plots.
import { h } from "./dom";
import { TABLES } from "./table";

function entry(classes: string, words: string): HTMLElement {
  return h("span", {}, h("span", { class: classes, "aria-hidden": "true" }), words);
}

/** Signs of end stops. */
export function stopSigns(): HTMLElement {
  const of = (kind: string): HTMLElement => entry(`mark ${kind} stop`, TABLES.events[kind]!.stop!);
  return h("span", { class: "legend" }, of("stop"), of("leave"));
}

export function legend(more: HTMLElement): HTMLElement {
  return h(
    "p",
    { class: "legend note" },
    entry("swatch carried", "carried by the plate"),
    entry("swatch resting", "at rest"),
    entry("swatch gripping", "gripped by skin"),
    entry("swatch line", "friction of the plate"),
    entry("swatch line dashed", "of the finger"),
    entry("mark stick plate", "sticks"),
    entry("mark slip plate", "slips"),
    entry("mark reverse plate", "reverses"),
    h("span", {}, "filled at the plate, open at the finger"),
    more,
  );
}
