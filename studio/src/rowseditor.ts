// An editor of rows: lines of text, "0 mm/s, 22 mN".
import { isRows } from "./design";
import { h } from "./dom";
import type { Value } from "./friction";
import { nameOf } from "./parameters";
import { columnsOf, type Quantity, TABLES } from "./table";
import { readNumber } from "./values";
import { written } from "./write";

/** Rows as lines of text; empty: none. */
export function rowsEditor(
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
