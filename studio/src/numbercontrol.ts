// A number of the current design: a slider and a field, optional unless it is mandatory, with rows where it may have rows.
import { isFunction, isRows, valueFor, withValue } from "./design";
import { h, show, symbol, textField } from "./dom";
import type { Value, Values } from "./friction";
import { absentWords, FALLING, meant, nameOf, PRESSED, partner, usualValue } from "./parameters";
import { partOf, type Range, rangeOf, valueAt } from "./range";
import { rowsEditor } from "./rowseditor";
import { plausible, type Quantity, text, unitOf } from "./table";
import { readNumber } from "./values";
import { fieldText } from "./write";

const STEPS = 1000;

export interface Control {
  readonly element: HTMLElement;
  readonly update: (values: Values) => void;
}

/** Values that a control shows and changes. */
export interface Parameters {
  readonly now: () => Values;
  /** Values before the first of the last changes of a key: ratios survive a slider at 0. */
  readonly before: (key: string) => Values;
  readonly set: (key: string, value: Value | null, kind: string) => void;
  /** Error of values, in one line; empty without one. */
  readonly problemOf: (values: Values) => string;
}

/** The control of a number. */
export function numberControl(quantity: Quantity, parameters: Parameters): Control {
  const { now, before, set, problemOf } = parameters;
  const { key } = quantity;
  const id = key.replace(".", "-");
  const unit = unitOf(quantity);
  const slider = h("input", {
    type: "range",
    id: `${id}-slider`,
    min: 0,
    max: STEPS,
    step: 1,
    "aria-label": `${nameOf(quantity)}, ${quantity.meaning}`,
  });
  const field = textField({
    id,
    inputmode: "decimal",
    autocomplete: "off",
    spellcheck: "false",
    "aria-describedby": `${id}-note`,
  });
  const note = h("p", { class: "problem", id: `${id}-note`, role: "status" });
  const rows = quantity.rows ? rowsEditor(quantity, (value) => set(key, value, "")) : null;
  let range: Range = rangeOf(quantity, 0);
  const needed = PRESSED.includes(key) || FALLING.some((name) => key.includes(name));
  const optional = !quantity.mandatory && !partner(key) && !needed;
  const given = optional
    ? h("input", { type: "checkbox", id: `${id}-given`, "aria-label": `give ${nameOf(quantity)}` })
    : null;

  const type = (content: string): void => {
    try {
      const bare = /^[\s+\-−]?[\d.]+(e[+-]?\d+)?\s*$/i.test(content.trim());
      const value = readNumber(
        bare && unit ? `${content.trim()} ${quantity.displayUnit}` : content.trim(),
        quantity,
        quantity.usual!,
        key,
      );
      const problem = problemOf(withValue(before(key), key, value));
      note.textContent = problem;
      if (!problem) set(key, value, "");
    } catch (error) {
      note.textContent = (error as Error).message;
    }
    field.setAttribute("aria-invalid", String(note.textContent !== ""));
  };
  field.addEventListener("change", () => type(field.value));
  slider.addEventListener("input", () => {
    const value = valueAt(range, Number(slider.value) / STEPS);
    const problem = problemOf(withValue(before(key), key, value));
    note.textContent = problem;
    if (!problem) set(key, value, `slider ${key}`);
  });
  given?.addEventListener("change", () => {
    set(key, given.checked ? usualValue(quantity, now()) : null, "");
  });

  const words = `${quantity.meaning}. ${quantity.bounds![1]!.words ?? quantity.bounds![0]!.words ?? ""}${quantity.remark ? `; ${quantity.remark}` : ""}.`;
  const element = h(
    "div",
    { class: "parameter", title: words },
    h("label", { for: id, class: "name" }, given, h("span", {}, nameOf(quantity)), symbol(quantity.symbol)),
    h("span", { class: "value" }, field, h("span", { class: "unit" }, unit)),
    slider,
    rows?.element ?? null,
    note,
  );
  const update = (values: Values): void => {
    const own = values[key];
    const value = valueFor(values, key);
    const damping = partner(key);
    element.hidden = (damping !== null && own === undefined) || !meant(key, values);
    if (given) given.checked = own !== undefined;
    const constant = typeof value === "number";
    const enabled = own !== undefined || !optional;
    field.disabled = slider.disabled = !enabled || !constant;
    slider.hidden = !enabled || !constant;
    rows?.update(isRows(own) ? own : null, constant ? value : null);
    if (!constant || !enabled) {
      field.value = "";
      field.placeholder = isRows(value)
        ? "rows"
        : isFunction(value)
          ? "a function"
          : absentWords(key, values);
      note.textContent = "";
      return;
    }
    range = rangeOf(quantity, value);
    if (document.activeElement !== slider) slider.value = String(Math.round(STEPS * partOf(range, value)));
    slider.setAttribute("aria-valuetext", text(quantity, value));
    if (document.activeElement !== field || field.getAttribute("aria-invalid") !== "true")
      show(field, fieldText(quantity, value));
    if (!note.textContent || field.getAttribute("aria-invalid") !== "true") {
      note.textContent = plausible(quantity, value)
        ? ""
        : `no such device has ${text(quantity, value)}; any has ${quantity.seen!.map((end) => text(quantity, end)).join(" to ")}`;
    }
  };
  return { element, update };
}
