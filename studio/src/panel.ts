// The parameters of the current design: a slider and a field each, with unit, bounds and meaning.
import { applies, isFunction, isRows, valueFor, withValue } from "./design";
import { h, option, show, symbol, textField } from "./dom";
import type { Value, Values } from "./friction";
import {
  byCoefficient,
  falls,
  frictionKeys,
  frictionOf,
  givenFriction,
  lawOf,
  withKind,
  withLaw,
} from "./friction";
import { partOf, type Range, rangeOf, valueAt } from "./range";
import { columnsOf, DRIVE, plausible, type Quantity, TABLES, text, unitOf } from "./table";
import { readNumber } from "./values";
import { fieldText, written } from "./write";

const GROUPS: readonly (readonly [string, string])[] = [
  ["drive", "Drive"],
  ["plate", "Plate"],
  ["finger", "Finger"],
  ["motion", "Release"],
];
const STEPS = 1000;

interface Control {
  readonly element: HTMLElement;
  readonly update: (values: Values) => void;
}

export class Panel {
  readonly element = h("div", { class: "parameters" });
  private readonly controls: Control[] = [];
  /** State before the first of the last changes, if all changes are of one key. */
  private base: { key: string; values: Values; now: string } | null = null;

  constructor(
    /** Error of values, in one line; empty without one. */
    private readonly problemOf: (values: Values) => string,
    private readonly now: () => Values,
    private readonly change: (values: Values, kind: string) => void,
  ) {
    for (const [table, title] of GROUPS) {
      const rows = [...DRIVE.values()]
        .filter(({ key }) => key.startsWith(`${table}.`))
        .map((quantity) =>
          quantity.choices
            ? quantity.key.endsWith(".law")
              ? this.law(quantity)
              : this.choice(quantity)
            : quantity.rows && !quantity.mayBeConstant
              ? this.rowsOnly(quantity)
              : this.number(quantity),
        );
      if (table in TABLES.pressedBy) rows.unshift(this.kind(table, title));
      this.controls.push(...rows);
      this.element.append(
        h("details", { open: true }, h("summary", {}, title), ...rows.map(({ element }) => element)),
      );
    }
  }

  update(values: Values): void {
    for (const control of this.controls) control.update(values);
  }

  /** Start of a change of a key: ratios survive a slider at 0. */
  private before(key: string): Values {
    const now = this.now();
    const same = this.base?.key === key && this.base.now === JSON.stringify(now);
    return same ? this.base!.values : now;
  }

  private set(key: string, value: Value | null, kind: string): void {
    const values = this.before(key);
    const next = withValue(values, key, value);
    this.base = { key, values, now: JSON.stringify(next) };
    this.change(next, kind);
  }

  /** True if friction is given by coefficients. */
  private kind(contact: string, title: string): Control {
    const select = h(
      "select",
      { id: `${contact}-kind`, "aria-label": `friction of the ${title.toLowerCase()} given as` },
      option("force", "forces"),
      option("coefficient", "coefficients"),
    );
    select.addEventListener("change", () =>
      this.change(withKind(this.now(), contact, select.value === "coefficient"), ""),
    );
    return {
      element: h("label", { class: "kind", for: select.id }, "friction as", select),
      update: (values) => (select.value = byCoefficient(values, contact) ? "coefficient" : "force"),
    };
  }

  /** Friction law of a contact. */
  private law({ key, choices, meaning }: Quantity): Control {
    const contact = key.split(".")[0]!;
    const id = key.replace(".", "-");
    const names = choices!.map((name) => option(name, name));
    const select = h("select", { id, "aria-label": `friction law of the ${contact}` }, ...names);
    select.addEventListener("change", () => this.change(withLaw(this.now(), contact, select.value), ""));
    return {
      element: h("label", { class: "kind", for: id, title: meaning }, "law", select),
      update: (values) => (select.value = lawOf(values, contact)),
    };
  }

  /** One of some names, of which the first is the default. */
  private choice(quantity: Quantity): Control {
    const { key, choices, meaning } = quantity;
    const id = key.replace(".", "-");
    const names = choices!.map((name) => option(name, name));
    const select = h("select", { id, "aria-label": meaning }, ...names);
    select.addEventListener("change", () => this.set(key, choices!.indexOf(select.value) || null, ""));
    return {
      element: h("label", { class: "kind", for: id, title: meaning }, nameOf(quantity), select),
      update: (values) => (select.value = choices![(values[key] as number | undefined) ?? 0]!),
    };
  }

  /** Number field; optional unless mandatory, with rows if the key may have rows. */
  private number(quantity: Quantity): Control {
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
    const rows = quantity.rows ? rowsEditor(quantity, (value) => this.set(key, value, "")) : null;
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
        const problem = this.problemOf(withValue(this.before(key), key, value));
        note.textContent = problem;
        if (!problem) this.set(key, value, "");
      } catch (error) {
        note.textContent = (error as Error).message;
      }
      field.setAttribute("aria-invalid", String(note.textContent !== ""));
    };
    field.addEventListener("change", () => type(field.value));
    slider.addEventListener("input", () => {
      const value = valueAt(range, Number(slider.value) / STEPS);
      const problem = this.problemOf(withValue(this.before(key), key, value));
      note.textContent = problem;
      if (!problem) this.set(key, value, `slider ${key}`);
    });
    given?.addEventListener("change", () => {
      this.set(key, given.checked ? this.usual(quantity) : null, "");
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

  /** Usual value, or present value. */
  private usual(quantity: Quantity): number {
    const values = this.now();
    const [contact, name] = quantity.key.split(".") as [string, string];
    if (name.startsWith("static")) {
      const { kinetic, rest } = givenFriction(values, contact);
      return (rest ?? kinetic) * 1.2;
    }
    if (name === "skin_stretch") {
      const limit = frictionOf(values, "finger").still;
      return limit / 2 / ((values["finger.stiffness"] as number | undefined) ?? Infinity);
    }
    if (name === "travel") return Math.max(quantity.example!, Math.abs(startOf(values)));
    return quantity.default ?? quantity.example ?? quantity.absent ?? 0;
  }

  private rowsOnly(quantity: Quantity): Control {
    const { key } = quantity;
    const editor = rowsEditor(quantity, (value) => this.set(key, value, ""));
    const element = h(
      "div",
      { class: "parameter", title: `${quantity.meaning}. ${quantity.remark ?? ""}` },
      h("span", { class: "name" }, h("span", {}, nameOf(quantity)), symbol(quantity.symbol)),
      editor.element,
    );
    const update = (values: Values): void => {
      element.hidden = !meant(key, values);
      editor.update((values[key] as Value | undefined) ?? null, null);
    };
    return { element, update };
  }
}

/** Displacement at the release, m. */
function startOf(values: Values): number {
  return (valueFor(values, "motion.displacement") as number | null) ?? 0;
}

/** Mandatory keys of a contact with coefficients. */
const PRESSED: readonly string[] = ["plate.coefficient", "finger.coefficient", "finger.touch_force"];

/** Parts of the keys of friction that falls. */
const FALLING: readonly string[] = ["breakaway", "stribeck_velocity"];

/** True if a key has a meaning with the notation of its contact and with these end stops. */
function meant(key: string, values: Values): boolean {
  const contact = key.split(".")[0]!;
  if (!(contact in TABLES.pressedBy)) return key in values || applies(values, key);
  const coefficients = byCoefficient(values, contact);
  const falling = falls(values, contact);
  if (FALLING.some((name) => key.includes(name)) && !falling) return false;
  if (key.endsWith(".exponent")) return lawOf(values, contact) === "stribeck";
  if (key === "finger.stiffness") return !falling;
  const curve = DRIVE.get(key)!.rowsOf?.endsWith("curve") === true;
  if (curve && lawOf(values, contact) !== "table") return false;
  if (key in TABLES.pressedBy[contact]!) return coefficients || values[key] !== undefined;
  return !frictionKeys(contact, !coefficients).includes(key);
}

function nameOf(quantity: Quantity): string {
  return quantity.name.replace(/^(plate|finger)\./, "").replaceAll("_", " ");
}

/** Alternative notation: damping or damping ratio. */
function partner(key: string): string | null {
  return { "drive.damping": "drive.damping_ratio", "drive.damping_ratio": "drive.damping" }[key] ?? null;
}

/** Default of a missing key. */
function absentWords(key: string, values: Values): string {
  const name = key.split(".")[1]!;
  const words: Record<string, string> = {
    static: "as kinetic",
    static_coefficient: "as coefficient",
    exponent: "1",
    viscous: "none",
    viscous_coefficient: "none",
    stiffness: "rigid",
    velocity: "plate's",
    skin_stretch: "none",
    travel: "none",
    stop_stiffness: "rigid",
    stop_damping: "none",
    duration: "ending",
    kinetic: "of curve",
    coefficient: "of curve",
  };
  const absent = DRIVE.get(key)!.absent;
  return (
    words[name] ?? (absent === undefined ? "" : text(DRIVE.get(key)!, absent)) ?? String(values[key] ?? "")
  );
}

/** Rows as lines of text: "0 mm/s, 22 mN". Empty: none. */
function rowsEditor(
  quantity: Quantity,
  set: (value: Value | null) => void,
): { element: HTMLElement; update: (value: Value | null, constant: number | null) => void } {
  const [across] = columnsOf(quantity);
  const heads = TABLES.columns[quantity.rowsOf!]!.map((name) => name.split(".").pop()!);
  const id = `${quantity.key.replace(".", "-")}-rows`;
  const area = h("textarea", {
    id,
    rows: 3,
    spellcheck: "false",
    "aria-label": `${nameOf(quantity)}: rows of ${heads[0]} and ${quantity.name.split(".").pop()}, one in a line`,
  });
  const note = h("p", { class: "problem", role: "status" });
  const apply = h("button", { type: "button" }, "Apply");
  const clear = h("button", { type: "button" }, "No rows");
  const details = h(
    "details",
    { class: "rows" },
    h("summary", {}, "rows"),
    area,
    h("span", { class: "buttons" }, apply, clear),
    note,
  );
  const example = quantity.rows!.map(([x, y]) => `${written(across, x)}, ${written(quantity, y)}`).join("\n");
  area.placeholder = example;
  let constant: number | null = null;
  apply.addEventListener("click", () => {
    try {
      const lines = (area.value.trim() || example).split("\n").filter((row) => row.trim());
      const rows = lines.map((row, i) => {
        const cells = row.split(",");
        if (cells.length !== 2)
          throw new Error(`row ${i} must be two values with a comma between, got ${JSON.stringify(row)}`);
        return [
          readNumber(cells[0]!.trim(), across, across.usual!, `row ${i} ${heads[0]}`),
          readNumber(
            asUnitless(cells[1]!.trim(), quantity),
            quantity,
            quantity.usual!,
            `row ${i} ${heads[1]}`,
          ),
        ] as const;
      });
      note.textContent = "";
      set(rows);
    } catch (error) {
      note.textContent = (error as Error).message;
    }
  });
  clear.addEventListener("click", () => {
    note.textContent = "";
    set(quantity.mandatory ? (constant ?? quantity.default ?? 0) : null);
  });
  return {
    element: details,
    update: (value, now) => {
      constant = now;
      const shown = isRows(value)
        ? value.map(([x, y]) => `${written(across, x)}, ${written(quantity, y)}`).join("\n")
        : "";
      if (document.activeElement !== area) area.value = shown;
      clear.disabled = !isRows(value);
    },
  };
}

function asUnitless(cell: string, quantity: Quantity): string {
  return quantity.unit === "1" ? String(Number(cell)) : cell;
}
