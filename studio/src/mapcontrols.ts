// Controls of map and bars: number, parameters, and specification.
import { button, h, option, refill } from "./dom";
import { nameOf } from "./results";
import type { Limit, ReleaseState, Step } from "./state";
import { DRIVE, label, NUMBERS, type Quantity, text, unitOf } from "./table";
import { toSi } from "./units";
import { fieldText } from "./write";

/** The numbers that a map can show. */
export function mapNumbers(): Quantity[] {
  return [...NUMBERS.values()].filter(
    ({ name }) =>
      (name.startsWith("transient.") && name !== "transient.settled") || name.startsWith("ending."),
  );
}

/** Keys of a map: given single numbers, without the displayed ones. */
export function mapKeys(state: ReleaseState): string[] {
  const { values } = state.designs[state.current]!;
  return [...DRIVE.keys()].filter((key) => {
    const value = values[key];
    if (typeof value !== "number") return false;
    if (DRIVE.get(key)!.choices || key.endsWith("exponent")) return false;
    if (key === "plate.touch_share") return false; // with a touch neither a product nor a sum
    return key !== "motion.duration" && key !== "motion.settling_band";
  });
}

export class MapControls {
  readonly element = h("div", { class: "map-controls" });
  readonly specification = h("div", { class: "specification" });
  private shown = "";

  constructor(private readonly change: (step: Step) => void) {}

  update(state: ReleaseState): void {
    const structure = JSON.stringify([mapKeys(state), state.map, state.number, state.specification]);
    if (structure === this.shown) return;
    this.shown = structure;
    const choice = (
      id: string,
      words: string,
      options: [string, string][],
      value: string,
      set: (value: string) => void,
    ): HTMLElement => {
      const select = h("select", { id }, ...options.map(([key, name]) => option(key, name, key === value)));
      select.addEventListener("change", () => set(select.value));
      return h("label", { for: id }, words, select);
    };
    const keys = mapKeys(state).map((key): [string, string] => [key, nameOf(key)]);
    refill(this.element, [
      choice(
        "map-number",
        "number",
        mapNumbers().map((q) => [q.name, label(q)]),
        state.number,
        (number) => this.change((now) => ({ ...now, number })),
      ),
      choice("map-x", "across", keys, state.map.x, (x) =>
        this.change((now) => ({ ...now, map: { ...now.map, x } })),
      ),
      choice("map-y", "up", keys, state.map.y, (y) =>
        this.change((now) => ({ ...now, map: { ...now.map, y } })),
      ),
    ]);
    this.limits(state);
  }

  private limits(state: ReleaseState): void {
    const set = (name: string, limit: Limit | null): void =>
      this.change((now) => {
        const { [name]: _, ...rest } = now.specification;
        return { ...now, specification: limit ? { ...rest, [name]: limit } : rest };
      });
    const rows = Object.entries(state.specification).map(([name, limit]) => {
      const number = NUMBERS.get(name)!;
      const atMost = limit.atMost !== undefined;
      const value = limit.atMost ?? limit.atLeast ?? 0;
      const side = h(
        "select",
        { "aria-label": `${label(number)}: at most or at least` },
        option("most", "≤", atMost),
        option("least", "≥", !atMost),
      );
      const field = h("input", {
        type: "text",
        inputmode: "decimal",
        value: fieldText(number, value),
        "aria-label": `limit of ${label(number)} in ${number.displayUnit ?? ""}`,
      });
      const apply = (): void => {
        try {
          const given =
            number.displayUnit && /^[-+\d.eE\s]+$/.test(field.value)
              ? `${field.value} ${number.displayUnit}`
              : field.value;
          const si = toSi(given, number.unit || "1", text(number, value));
          set(name, side.value === "most" ? { atMost: si } : { atLeast: si });
        } catch (error) {
          field.setCustomValidity((error as Error).message);
          field.reportValidity();
        }
      };
      side.addEventListener("change", apply);
      field.addEventListener("change", apply);
      return h(
        "li",
        {},
        h("span", {}, label(number)),
        side,
        h("span", { class: "value" }, field, h("span", { class: "unit" }, unitOf(number))),
        button("×", `No limit on ${label(number)}`, () => set(name, null)),
      );
    });
    const number = NUMBERS.get(state.number)!;
    const limited = state.number in state.specification;
    const add = button(`Limit the ${label(number)}`, "Add this number to the specification", () =>
      set(state.number, { atMost: (0.1 / number.displayScale) * (number.unit === "s" ? 1000 : 1) }),
    );
    refill(this.specification, [
      h("h3", {}, "Specification"),
      rows.length ? h("ul", {}, ...rows) : h("p", { class: "note" }, "No limit: nothing is shaded."),
      ...(limited ? [] : [add]),
    ]);
  }
}
