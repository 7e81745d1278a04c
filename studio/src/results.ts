// The numbers of the motion beside those it is compared with, its events, and bars of derivatives.

import { h, refill } from "./dom";
import type { Effect } from "./effects";
import { DRIVE, digits, label, NUMBERS, type Quantity, shownNumber, TABLES, text, unitOf } from "./table";
import { currentCurves, curvesOf, type View } from "./view";

const ENDINGS: Readonly<Record<string, string>> = {
  moving: "still moving at the end of the duration",
  resting: "rests",
  decaying: "decays freely",
  free: "oscillates freely",
  grazing: "oscillates, touching the plate's velocity once a period",
  stick_slip: "stick-slip, a cycle of carried and sliding phases",
  limit_cycle: "a limit cycle sustained by falling friction",
  driven: "the periodic response to its inputs",
  irregular: "irregular, never repeats",
  drifting: "follows a ramp of its inputs",
  growing: "grows from period to period",
  approaching: "approaches a limit slowly",
};

/** Description of the motion in one sentence. */
export function sentence(view: View, statusText: (status: number) => string): string {
  const curves = currentCurves(view);
  if (!curves) {
    const result = view.lines[0]?.result;
    return result && "problem" in result ? result.problem : "";
  }
  const of = (name: string): string => text(NUMBERS.get(name)!, curves.numbers[name]!);
  const parts = [`Ending: ${ENDINGS[curves.end]}`];
  if (curves.end === "resting") parts[0] += ` at ${of("ending.position")}`;
  if (Number.isFinite(curves.numbers["ending.period"]!)) parts.push(`period ${of("ending.period")}`);
  if (Number.isFinite(curves.numbers["ending.steady_since"]!))
    parts.push(`steady from ${of("ending.steady_since")} on`);
  else if (Number.isFinite(curves.numbers["transient.settling_time"]!))
    parts.push(`settled after ${of("transient.settling_time")}`);
  const count = curves.events.length;
  parts.push(`${count} event${count === 1 ? "" : "s"}`);
  if (curves.status) parts.push(statusText(curves.status));
  return `${parts.join("; ")}.`;
}

export class NumbersTable {
  readonly element = h("div", {
    class: "scroll",
    tabindex: 0,
    role: "group",
    "aria-label": "table of numbers",
  });

  constructor(private readonly choose: (name: string) => void) {}

  update(view: View): void {
    const lines = view.lines.filter((line) => curvesOf(line));
    const head = h(
      "tr",
      {},
      h("th", { scope: "col" }, "number"),
      h("th", { scope: "col" }, "unit"),
      ...lines.map((line) => h("th", { scope: "col", class: "figure" }, line.name)),
    );
    const rows: Node[] = [];
    let group = "";
    for (const quantity of NUMBERS.values()) {
      const [kind] = quantity.name.split(".") as [string];
      const values = lines.map((line) => valueIn(curvesOf(line)!, quantity));
      if (values.every((value) => value === undefined || Number.isNaN(value))) continue;
      if (kind !== group) {
        group = kind;
        rows.push(
          h("tr", { class: "group" }, h("th", { colspan: 2 + lines.length, scope: "colgroup" }, kind)),
        );
      }
      const chosen = quantity.name === view.state.number;
      const chooses = kind === "transient" || kind === "ending";
      const name = chooses
        ? h(
            "button",
            {
              type: "button",
              class: "link",
              "aria-pressed": chosen,
              onclick: () => this.choose(quantity.name),
            },
            label(quantity),
          )
        : label(quantity).replace(/^(energy|certificate) /, "");
      rows.push(
        h(
          "tr",
          { title: quantity.meaning, class: chosen ? "chosen" : undefined },
          h("th", { scope: "row" }, name),
          h("td", { class: "unit" }, unitOf(quantity)),
          ...values.map((value) =>
            h("td", { class: "figure" }, value === undefined ? "" : shownNumber(quantity, value)),
          ),
        ),
      );
    }
    refill(this.element, [h("table", {}, h("thead", {}, head), h("tbody", {}, ...rows))]);
  }
}

function valueIn(curves: NonNullable<ReturnType<typeof curvesOf>>, quantity: Quantity): number | undefined {
  const [kind, name] = quantity.name.split(/\.(.*)/) as [string, string];
  if (kind === "energy") return curves.energy[name];
  if (kind === "certificate") return curves.certificate[name];
  if (quantity.name === "transient.settled") return undefined;
  return curves.numbers[quantity.name];
}

const LISTED = 100; // events in the table

/** Sequence of the events; a click moves the cursor to the event. */
export class EventsTable {
  readonly element = h("div", {
    class: "scroll",
    tabindex: 0,
    role: "group",
    "aria-label": "list of events",
  });

  constructor(private readonly goTo: (time: number) => void) {}

  update(view: View): void {
    const curves = currentCurves(view);
    const all = curves?.events ?? [];
    const events = all.slice(0, LISTED);
    let before = 0;
    // A velocity that is 0 but for the rounding of the core's sums is shown as 0.
    const velocities = curves?.columns.velocity ?? new Float64Array();
    const fastest = velocities.reduce((most, v) => Math.max(most, Math.abs(v) || 0), 0);
    const rows = events.map(({ time, contact, kind, position, velocity }) => {
      const since = time - before;
      before = time;
      return h(
        "tr",
        {},
        h(
          "td",
          { class: "figure" },
          h(
            "button",
            { type: "button", class: "link", onclick: () => this.goTo(time) },
            digits(1e3 * time, 5),
          ),
        ),
        h("td", { class: "figure" }, digits(1e3 * since)),
        h(
          "td",
          { class: "event" },
          h("span", { class: `mark ${kind} ${contact}`, "aria-hidden": "true" }),
          TABLES.events[kind]![contact]!,
        ),
        h("td", { class: "figure" }, digits(1e3 * position)),
        h("td", { class: "figure" }, digits(Math.abs(velocity) < 1e-12 * fastest ? 0 : 1e3 * velocity)),
      );
    });
    const head = ["t, ms", "since, ms", "what happens", "x, mm", "x′, mm/s"];
    const count = all.length.toLocaleString("en").replaceAll(",", " ");
    const more = `The first ${LISTED} of ${count} events; "Save as" writes all of them.`;
    refill(this.element, [
      ...(all.length > LISTED ? [h("p", { class: "note" }, more)] : []),
      events.length
        ? h(
            "table",
            {},
            h("thead", {}, h("tr", {}, ...head.map((name) => h("th", { scope: "col" }, name)))),
            h("tbody", {}, ...rows),
          )
        : h("p", { class: "note" }, "No event: the contacts do not change."),
    ]);
  }
}

export class Bars {
  readonly element = h("div", { class: "bars" });

  update(found: readonly Effect[], number: Quantity, value: number): void {
    const largest = Math.max(...found.map(({ change }) => Math.abs(change) || 0), Number.MIN_VALUE);
    const defined = Number.isNaN(value) ? [] : [...found];
    const sorted = defined.sort((a, b) => (Math.abs(b.change) || 0) - (Math.abs(a.change) || 0));
    const rows = sorted.map(({ key, change }) => {
      const part = Math.abs(change) / largest || 0;
      const bar = h("span", { class: change < 0 ? "bar down" : "bar up" });
      bar.style.width = `${(50 * part).toFixed(2)}%`;
      const relative = value ? ` (${signed(100 * (change / value))} %)` : "";
      return h(
        "tr",
        { title: DRIVE.get(key)!.meaning },
        h("th", { scope: "row" }, nameOf(key)),
        h("td", { class: "track" }, h("span", { class: "axis", "aria-hidden": "true" }), bar),
        h("td", { class: "figure" }, `${signed(change * number.displayScale)} ${unitOf(number)}${relative}`),
      );
    });
    refill(this.element, [
      rows.length
        ? h(
            "table",
            {},
            h(
              "caption",
              { class: "note" },
              `What 1 % more of each parameter does to the ${label(number)}, to first order`,
            ),
            h("tbody", {}, ...rows),
          )
        : h(
            "p",
            { class: "note" },
            found.length ? `This motion has no ${label(number)}.` : "No parameter differs from 0.",
          ),
    ]);
  }
}

export function nameOf(key: string): string {
  return key
    .replace(/^(drive|motion)\./, "")
    .replaceAll("_", " ")
    .replace(".", " ");
}

function signed(value: number): string {
  if (Number.isNaN(value)) return "–";
  if (value === 0) return "0";
  return `${value > 0 ? "+" : ""}${digits(value, 3)}`;
}
