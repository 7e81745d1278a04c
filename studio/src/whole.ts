// Contradictions of the whole device between values in range: magnet, control, array.
import { Refusal } from "./checks";
import type { Rows } from "./core";
import { type Found, frictionOf } from "./friction";
import { floatRepr, general } from "./python";
import { part, required, TABLES } from "./table";

const MAGNETIC = 1.25663706127e-6; // N/A²
const COPPER = 1 / 58e6; // ohm m

/** A check that throws what it refuses, and the keys that it is about; the first is named. */
export interface Fit {
  readonly check: () => void;
  readonly keys: readonly string[];
}

/** The checks of the whole device, in the order in which the command makes them. */
export function fits(values: Found, given: Readonly<Record<string, object>>): Fit[] {
  const magnet = Object.keys(given.magnet!);
  const places = values["array.places"] as Rows | null;
  const at = (key: string): number => values[key] as number;
  const found: Fit[] = [
    { check: () => checkHolds(values), keys: ["plate", "plate.curve", "plate.kinetic"] },
    {
      check: () => checkMagnet(values, magnet),
      keys: magnet.length ? magnet.map((name) => `magnet.${name}`) : ["magnet"],
    },
    {
      check: () => checkBand(at("control.threshold"), at("control.hysteresis")),
      keys: ["control.hysteresis", "control.threshold"],
    },
  ];
  if (places) {
    found.push({ check: () => checkNoGrid(given.array!), keys: ["array.places"] });
    found.push({ check: () => checkApart(places), keys: ["array.places"] });
  }
  const slot = values["array.slot_length"] as number | null;
  found.push({
    check: () => checkSlot(slot, at("array.pin_diameter")),
    keys: ["array.slot_length", "array.pin_diameter"],
  });
  const touch = values["scan.touch"] as number | Rows | null;
  if (touch !== null)
    found.push({ check: () => checkPresses(values, touch), keys: ["scan.touch", "finger"] });
  const counts = ["array.columns", "array.rows"];
  for (const key of counts) {
    found.push({ check: () => checkCount(key.split(".")[1]!, at(key)), keys: [key] });
  }
  found.push({ check: () => checkPins(at("array.columns"), at("array.rows")), keys: counts });
  return found;
}

function checkHolds(values: Found): void {
  if (frictionOf(values, "plate").kinetic !== 0) return;
  throw new Refusal("plate.kinetic", "greater than 0 N where a magnet holds by friction", "0.0 N");
}

function checkMagnet(values: Found, given: readonly string[]): void {
  const of = (name: string): number => values[`magnet.${name}`] as number;
  const made = TABLES.coil.filter((name) => given.includes(name));
  const direct = TABLES.magnet.filter((name) => given.includes(name));
  if (made.length) checkOneWay(made, direct);
  const voltage = values["magnet.voltage"] as Rows | null;
  if (!made.length && voltage) {
    throw new Refusal("voltage", "given with a coil, by turns, gap, wire_diameter and the like", "it alone");
  }
  const hold = made.length ? pullOf(of) : of("hold_force");
  const closing = ["lift", "closing_force"].filter((name) => of(name) != null);
  if (closing.length === 1) {
    const other = closing[0] === "lift" ? "closing_force" : "lift";
    throw new Refusal(closing[0]!, `given with ${other}`, "it alone");
  }
  if (made.length && voltage) checkVoltage(voltage, of("supply_voltage"));
  if (of("residual") >= hold) {
    throw new Refusal(
      "residual",
      `less than the hold force, ${floatRepr(hold)} N`,
      `${floatRepr(of("residual"))} N`,
    );
  }
  if (made.length) checkPoles(of("pole_area"), values["magnet.outer_diameter"] as number | null);
  const pulses = ["pwm_frequency", "pwm_duty"].filter((name) => of(name) != null);
  if (pulses.length === 1) {
    const other = pulses[0] === "pwm_duty" ? "pwm_frequency" : "pwm_duty";
    throw new Refusal(pulses[0]!, `given with ${other}`, "it alone");
  }
  if (voltage && pulses.length) {
    throw new Refusal("voltage", "left out where pwm_frequency gives pulses", "both");
  }
  if (closing.length) checkClosing(of, hold);
}

/** A gap that would never close, or never open. */
function checkClosing(of: (name: string) => number, hold: number): void {
  const [residual, force] = [of("residual"), of("closing_force")];
  const open = of("gap") / (of("gap") + of("lift"));
  const saturation = Math.min(1, of("saturation_field") / fieldOf(of));
  const most = residual + (hold - residual) * Math.min((open / saturation) ** 2, 1);
  const given = `${floatRepr(force)} N`;
  if (force <= residual) {
    throw new Refusal("closing_force", `more than the residual pull, ${floatRepr(residual)} N`, given);
  }
  const flux = saturation * Math.sqrt((force - residual) / (hold - residual));
  if (force < most && flux < open) return;
  const words = `less than the pull of full current with the open gap, ${floatRepr(most)} N`;
  throw new Refusal("closing_force", words, given);
}

function checkOneWay(made: readonly string[], direct: readonly string[]): void {
  const label = `magnet.${(direct[0] ?? made[0])!}`;
  if (direct.length) {
    const words = `left out where ${made[0]} describes the coil`;
    throw new Refusal(label, words, `both, ${direct[0]} and ${made[0]}`);
  }
  const missing = Object.entries(TABLES.coilNeeds).filter(([name]) => !made.includes(name));
  if (!missing.length) return;
  const needed = missing.map(([name, meaning]) => `${name} (${meaning})`).join(", ");
  throw new Refusal(label, `given with ${needed}`, `${made.join(", ")} alone`);
}

/** The field of a coil at full current if its iron did not saturate, T. */
function fieldOf(of: (name: string) => number): number {
  const resistance = (COPPER * of("turns") * of("turn_length")) / ((Math.PI / 4) * of("wire_diameter") ** 2);
  const current = of("supply_voltage") / resistance;
  return (MAGNETIC * of("turns") * current) / (2 * of("gap"));
}

/** The pull of a coil at full current or saturation, N; refuses one whose quotients are out of range. */
function pullOf(of: (name: string) => number): number {
  const [turns, area, gap] = [of("turns"), of("pole_area"), of("gap")];
  const resistance = (COPPER * turns * of("turn_length")) / ((Math.PI / 4) * of("wire_diameter") ** 2);
  const current = of("supply_voltage") / resistance;
  const field = fieldOf(of);
  const parts = {
    resistance,
    inductance: (MAGNETIC * turns ** 2 * area) / (2 * gap),
    current,
    field,
    power: of("supply_voltage") * current,
  };
  for (const [name, value] of Object.entries(parts)) {
    const quantity = part(`coil.${name}`);
    const words = required(quantity, value);
    if (words) throw new Refusal(`coil.${name}`, words, `${floatRepr(value)} ${quantity.unit}`);
  }
  return (Math.min(field, of("saturation_field")) ** 2 * area) / MAGNETIC;
}

function checkVoltage(rows: Rows, supply: number): void {
  if (rows[0]![0] !== 0) {
    throw new Refusal("voltage[0] time", "0 s, when the coil is switched on", `${floatRepr(rows[0]![0])} s`);
  }
  rows.forEach(([time], i) => {
    const before = i ? rows[i - 1]![0] : -1;
    if (time > before) return;
    const words = `greater than the one before, ${floatRepr(before)} s`;
    throw new Refusal(`voltage[${i}] time`, words, `${floatRepr(time)} s`);
  });
  rows.forEach(([, volts], i) => {
    if (volts >= 0 && volts <= supply) return;
    const words = `from 0 V to the supply voltage, ${floatRepr(supply)} V`;
    throw new Refusal(`voltage[${i}]`, words, `${floatRepr(volts)} V`);
  });
}

function checkPoles(area: number, diameter: number | null): void {
  if (diameter === null) return;
  const face = (Math.PI / 4) * diameter ** 2;
  if (2 * area <= face) return;
  const words = `at most half of the magnet's face, ${general(0.5 * face, 4)} m^2, as it has two poles`;
  throw new Refusal("pole_area", words, `${floatRepr(area)} m^2`);
}

function checkBand(threshold: number, hysteresis: number): void {
  const widest = 2 * Math.min(threshold, 1 - threshold);
  if (hysteresis <= widest) return;
  const words = `at most ${general(widest)} about a threshold of ${general(threshold)}`;
  throw new Refusal("hysteresis", words, floatRepr(hysteresis));
}

function checkNoGrid(array: object): void {
  const name = ["columns", "rows", "pitch"].find((each) => each in array);
  if (!name) return;
  throw new Refusal("places", "left out where columns, rows or pitch are given", `it beside array.${name}`);
}

function checkApart(places: Rows): void {
  places.forEach(([x, y], i) => {
    const first = places.findIndex(([u, v]) => u === x && v === y);
    if (first === i) return;
    const given = `pins ${first} and ${i} both at (${floatRepr(x)} m, ${floatRepr(y)} m)`;
    throw new Refusal("places", "places of their own", given);
  });
}

function checkSlot(slot: number | null, pin: number): void {
  if (slot === null || slot >= pin) return;
  const words = `at least array.pin_diameter, ${floatRepr(pin)} m, which moves in it`;
  throw new Refusal("slot_length", words, `${floatRepr(slot)} m`);
}

/** A touch force over time where friction does not follow it. */
function checkPresses(values: Found, touch: number | Rows): void {
  const keys = ["finger.coefficient", "finger.coefficient_curve"];
  const byCoefficient = keys.some((key) => values[key] !== null);
  if (byCoefficient && values["finger.touch_force"]) return;
  const friction = byCoefficient ? "no force" : "given as a force";
  const words =
    `left out where the finger's friction is ${friction}; ` +
    "it needs finger.coefficient and a finger.touch_force greater than 0 N";
  const given = typeof touch === "number" ? `${floatRepr(touch)} N` : "one over time";
  throw new Refusal("touch", words, given);
}

function checkCount(name: string, value: number): void {
  if (!Number.isInteger(value)) throw new Refusal(name, "a whole number", floatRepr(value));
}

function checkPins(columns: number, rows: number): void {
  const [most, words] = TABLES.pins;
  if (columns * rows <= most) return;
  const count = columns * rows;
  const shown = count < 1e15 ? count.toFixed(0) : general(count, 3);
  const of = `${general(columns)} columns of ${general(rows)} rows`;
  throw new Refusal(words, `at most ${most}`, `${shown} (${of})`);
}
