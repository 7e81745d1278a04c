// The parameters of the current design: a slider and a field each, with unit, bounds and meaning.
import { withValue } from "./design";
import { h, option, symbol } from "./dom";
import type { Value, Values } from "./friction";
import { byCoefficient, lawOf, withKind, withLaw } from "./friction";
import { type Control, numberControl, type Parameters } from "./numbercontrol";
import { meant, nameOf } from "./parameters";
import { rowsEditor } from "./rowseditor";
import { DRIVE, type Quantity, TABLES } from "./table";

const GROUPS: readonly (readonly [string, string])[] = [
  ["drive", "Drive"],
  ["plate", "Plate"],
  ["finger", "Finger"],
  ["motion", "Release"],
];

export class Panel {
  readonly element = h("div", { class: "parameters" });
  private readonly controls: Control[] = [];
  private readonly parameters: Parameters = {
    now: () => this.now(),
    before: (key) => this.before(key),
    set: (key, value, kind) => this.set(key, value, kind),
    problemOf: (values) => this.problemOf(values),
  };
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
              : numberControl(quantity, this.parameters),
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

  /** A choice among names; the first is the default. */
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
