// Contradictions between values in range: rows, contacts, skin, drive.
import type { Rows } from "./core";
import {
  byCoefficient,
  CONTACTS,
  type Found,
  frictionKeys,
  frictionOf,
  givenFriction,
  type Value,
  type Values,
} from "./friction";
import { brief, floatRepr, general } from "./python";
import { DRIVE, part, type Quantity, required, TABLES } from "./table";

export const MOUSE = "motion.mouse_velocity";
/** Keys of end stops, each of which requires the keys before it. */
export const STOPS = ["travel", "stop_stiffness", "stop_damping"] as const;
/** Keys of a release beside its inputs over time. */
export const RELEASED = ["displacement", "velocity", "skin_stretch", "duration"] as const;

/** A value that is refused; its words have no place yet. */
export class Refusal extends Error {
  constructor(
    readonly label: string,
    requirement: string,
    given: string,
  ) {
    super(`${label} must be ${requirement}, got ${given}`);
  }
}

/** Refuses rows out of order, or so close that the slope between them is out of range. */
export function checkRows(rows: Rows, quantity: Quantity): void {
  const key = quantity.key;
  const ofSlope = TABLES.slopes[quantity.rowsOf!];
  const curve = ofSlope !== undefined;
  const name = `${curve ? "speed" : "time"}`;
  const unit = curve ? "m/s" : "s";
  const continuous = TABLES.continuous.includes(key);
  const steps = !curve && !continuous;
  const why = continuous ? " (a jump would take an infinite force)" : "";
  for (let i = 1; i < rows.length; ++i) {
    const [before, given] = [rows[i - 1]![0], rows[i]![0]];
    const [label, shown] = [`${key}[${i}] ${name}`, `${floatRepr(given)} ${unit}`];
    const one = `the one before, ${floatRepr(before)} ${unit}`;
    if (!steps && !(before < given)) throw new Refusal(label, `greater than ${one}${why}`, shown);
    if (steps && !(before <= given)) throw new Refusal(label, `at least ${one}`, shown);
    if (steps && i > 1 && rows[i - 2]![0] === given) {
      const third = ": two rows at one time are a step, a third is none";
      throw new Refusal(label, `greater than ${one}${third}`, shown);
    }
  }
  const slope = part(ofSlope ?? "profile.rate");
  const worst = steepest(rows);
  const limits = slope.bounds![1]!;
  if (Math.abs(worst) > limits.upper!) {
    throw new Refusal(`${key} slope`, limits.words!, `${general(worst)} ${slope.unit}`);
  }
}

/** The steepest slope between rows, steps left out. */
function steepest(rows: Rows): number {
  let worst = 0;
  for (let i = 1; i < rows.length; ++i) {
    const [dx, dy] = [rows[i]![0] - rows[i - 1]![0], rows[i]![1] - rows[i - 1]![1]];
    if (!(dx > 0)) continue;
    const slope = dx > Math.abs(dy) * 1e-300 ? dy / dx : Math.sign(dy) * Infinity;
    if (Math.abs(slope) > Math.abs(worst)) worst = slope;
  }
  return worst;
}

// ---- what does not fit together ----------------------------------------------------------------------

/** Refuses friction given both by forces and by coefficients; `given` are keys. */
export function checkOneKind(contact: string, given: readonly string[]): void {
  const [force, coefficient] = [false, true].map((kind) =>
    frictionKeys(contact, kind).find((key) => given.includes(key)),
  );
  if (!force || !coefficient) return;
  const words = `left out where ${force} gives the friction as a force`;
  throw new Refusal(coefficient, words, `both, ${coefficient} and ${force}`);
}

/** Rejects a finger coefficient without a touch force, and the reverse. */
export function checkTouch(coefficients: boolean, touch: Value | null | undefined): void {
  if (coefficients && touch == null) {
    throw new Refusal("touch_force", "given where a coefficient gives the finger's friction", "none");
  }
  if (!coefficients && touch != null) {
    const words = "left out where the finger's friction is given as a force";
    throw new Refusal("touch_force", words, `${floatRepr(touch as number)} N`);
  }
}

/** Kind of a friction key and its unit behind a number: force or coefficient. */
function kindOf(key: string): {
  readonly name: string;
  readonly what: string;
  readonly noun: string;
  readonly unit: string;
} {
  const name = key.split(".")[1]!;
  return name.includes("coefficient")
    ? { name, what: "coefficient", noun: "friction coefficient", unit: "" }
    : { name, what: "force", noun: "friction", unit: " N" };
}

export function checkCurve(rows: Rows, kinetic: number, key: string): void {
  const { name, what, noun, unit } = kindOf(key);
  const [speed, value] = rows[0]!;
  if (speed !== 0) throw new Refusal(`${name}[0] speed`, "0 m/s", `${floatRepr(speed)} m/s`);
  if (value !== kinetic) {
    const words = `the kinetic ${noun}, ${floatRepr(kinetic)}${unit}`;
    throw new Refusal(`${name}[0] ${what}`, words, `${floatRepr(value)}${unit}`);
  }
}

export function checkStatic(still: number, kinetic: number, key: string): void {
  if (still >= kinetic) return;
  const { name, noun, unit } = kindOf(key);
  const words = `at least the kinetic ${noun}, ${floatRepr(kinetic)}${unit}`;
  throw new Refusal(name, words, `${floatRepr(still)}${unit}`);
}

/** Refuses what describes end stops without what it needs. */
export function checkStops(values: Found): void {
  const [travel, stiffness, damping] = STOPS.map((name) => values[`drive.${name}`] ?? null);
  for (const [name, value, unit] of [
    ["stop_stiffness", stiffness, "N/m"],
    ["stop_damping", damping, "N*s/m"],
  ] as const) {
    if (typeof value !== "number" || travel !== null) continue;
    const words = "left out without travel, as there are no end stops";
    throw new Refusal(name, words, `${floatRepr(value)} ${unit}`);
  }
  if (typeof damping !== "number" || damping === 0 || stiffness !== null) return;
  const words = "left out for rigid end stops; give stop_stiffness too";
  throw new Refusal("stop_damping", words, `${floatRepr(damping)} N*s/m`);
}

/** Refuses a displacement beyond rigid end stops. */
export function checkWithinTravel(values: Found): void {
  const [travel, displacement] = [values["drive.travel"], values["motion.displacement"]];
  if (typeof travel !== "number" || values["drive.stop_stiffness"] != null) return;
  if (typeof displacement !== "number" || Math.abs(displacement) <= travel) return;
  const words = `at most travel, ${floatRepr(travel)} m, either way`;
  throw new Refusal("displacement", words, `${floatRepr(displacement)} m`);
}

/** Value of an input at t = 0. */
function initial(given: Value): number {
  if (typeof given === "number") return given;
  const after = given.findIndex(([time]) => time > 0);
  if (after <= 0) return given[after < 0 ? given.length - 1 : 0]![1];
  const [[t0, y0], [t1, y1]] = [given[after - 1]!, given[after]!];
  return y0 + ((y1 - y0) / (t1 - t0)) * (0 - t0);
}

export function checkStretch(values: Found): void {
  const [stretch, stiffness] = [values["motion.skin_stretch"], values["finger.stiffness"]];
  if (typeof stretch !== "number") return;
  const given = `${floatRepr(stretch)} m`;
  if (typeof stiffness !== "number") {
    throw new Refusal("skin_stretch", "left out for a rigid finger", given);
  }
  const largest =
    (frictionOf(values, "finger").still * initial(values["motion.finger_load"] ?? 1)) / stiffness;
  if (Math.abs(stretch) <= largest) return;
  const words = `at most static friction over stiffness, ${floatRepr(largest)} m, either way`;
  throw new Refusal("skin_stretch", words, given);
}

export function checkDrive(values: Found): void {
  const damping = dampingOf(values);
  const critical = criticalOf(values);
  const ratio = damping / critical;
  const limits = DRIVE.get("drive.damping_ratio")!.bounds![1]!;
  const rounded = Number(ratio.toPrecision(12));
  if (rounded !== 0 && !(rounded >= limits.lower! && rounded <= limits.upper!)) {
    const words = `such that the damping ratio is ${limits.words}`;
    throw new Refusal("damping", words, `${floatRepr(damping)} N*s/m, which makes it ${general(ratio)}`);
  }
  for (const table of CONTACTS) {
    const worst = Math.abs(steepest(frictionOf(values, table).curve ?? []));
    if (worst <= limits.upper! * critical) continue;
    const words = `at most ${brief(limits.upper!)} times critical damping`;
    throw new Refusal(`${table} curve slope`, words, `${general(worst)} N*s/m`);
  }
}

/** Refuses a duration in which the phase grows beyond what doubles tell apart. */
function checkPhase(values: Found): void {
  const duration = values["motion.duration"];
  const frequency = Math.sqrt(num(values, "drive.stiffness") / num(values, "drive.mass"));
  const phase = part("phase").bounds![1]!.upper!;
  if (typeof duration === "number" && duration * frequency > phase) {
    const words = `at most ${brief(phase / frequency)} s, ${brief(phase)} over the natural frequency`;
    throw new Refusal("duration", words, `${floatRepr(duration)} s`);
  }
}

function num(values: Found, key: string): number {
  return values[key] as number;
}

function criticalOf(values: Found): number {
  return 2 * Math.sqrt(num(values, "drive.mass")) * Math.sqrt(num(values, "drive.stiffness"));
}

export function dampingOf(values: Found): number {
  const damping = values["drive.damping"];
  if (typeof damping === "number") return damping;
  const [mass, stiffness] = [num(values, "drive.mass"), num(values, "drive.stiffness")];
  return 2 * num(values, "drive.damping_ratio") * Math.sqrt(mass) * Math.sqrt(stiffness);
}

/** Error of values from a person, in one line; empty without one. */
export function problemOf(values: Values): string {
  const found: Record<string, Value | null> = {};
  for (const [key, quantity] of DRIVE) found[key] = values[key] ?? quantity.absent ?? null;
  try {
    for (const [key, quantity] of DRIVE) {
      const value = found[key];
      if (typeof value === "number") {
        const words = required(quantity, value);
        if (words) throw new Refusal(key, words, `${floatRepr(value)} ${quantity.unit ?? ""}`.trim());
      }
    }
    for (const table of CONTACTS) {
      const coefficients = byCoefficient(found, table);
      checkOneKind(table, Object.keys(values));
      if (table === "finger") checkTouch(coefficients, found["finger.touch_force"]);
      const [, ofStatic, ofCurve] = frictionKeys(table, coefficients);
      const { kinetic, still, curve } = givenFriction(found, table);
      if (curve) checkCurve(curve, kinetic, ofCurve);
      checkStatic(still, kinetic, ofStatic);
    }
    checkStops(found);
    checkWithinTravel(found);
    checkStretch(found);
    checkDrive(found);
    checkPhase(found);
  } catch (error) {
    if (error instanceof Refusal) return error.message;
    throw error;
  }
  return "";
}
