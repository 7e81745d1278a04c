// What is wrong with values that are each in range: rows, contacts, the skin, the drive together.
import type { Rows } from "./core";
import { brief, counted, floatRepr, general } from "./python";
import { DRIVE, part, required, type Quantity } from "./table";

export type Value = number | Rows;
/** The values of keys that are given, SI. */
export type Values = Readonly<Record<string, Value>>;
/** The same with what holds where a key is left out; null where nothing does. */
export type Found = Readonly<Record<string, Value | null | undefined>>;

export const MOUSE = "motion.mouse_velocity";

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
  const curve = quantity.rowsOf === "curve";
  const name = `${curve ? "speed" : "time"}`;
  const unit = curve ? "m/s" : "s";
  const steps = !curve && key !== MOUSE;
  const why = key === MOUSE ? " (a jump would take an infinite force)" : "";
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
  const slope = part(curve ? "curve.slope" : "profile.rate");
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

export function checkCurve(rows: Rows, kinetic: number): void {
  const [speed, force] = rows[0]!;
  if (speed !== 0) throw new Refusal("curve[0] speed", "0 m/s", `${floatRepr(speed)} m/s`);
  if (force !== kinetic) {
    const words = `the kinetic friction, ${floatRepr(kinetic)} N`;
    throw new Refusal("curve[0] force", words, `${floatRepr(force)} N`);
  }
}

export function checkStatic(still: number, kinetic: number): void {
  if (still >= kinetic) return;
  const words = `at least the kinetic friction, ${floatRepr(kinetic)} N`;
  throw new Refusal("static", words, `${floatRepr(still)} N`);
}

export function checkSkin(values: Found): void {
  const [curve, stiffness] = [values["finger.curve"] as Rows | null, values["finger.stiffness"]];
  if (!curve || curve.length < 2 || stiffness == null) return;
  const words = "one row for a compliant finger, whose skin would lag behind it";
  throw new Refusal("finger.curve", words, counted(curve.length, "row"));
}

export function checkStretch(values: Found): void {
  const [stretch, stiffness] = [values["motion.skin_stretch"], values["finger.stiffness"]];
  if (typeof stretch !== "number") return;
  const given = `${floatRepr(stretch)} m`;
  if (typeof stiffness !== "number") {
    throw new Refusal("skin_stretch", "left out for a rigid finger", given);
  }
  const largest = staticOf(values, "finger") / stiffness;
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
    throw new Refusal(
      "damping", words, `${floatRepr(damping)} N*s/m, which makes it ${general(ratio)}`,
    );
  }
  for (const table of ["plate", "finger"]) {
    const worst = Math.abs(steepest((values[`${table}.curve`] as Rows | null) ?? []));
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

export function kineticOf(values: Found, contact: string): number {
  return (
    (values[`${contact}.kinetic`] as number | null | undefined) ??
    (values[`${contact}.curve`] as Rows)[0]![1]
  );
}

export function staticOf(values: Found, contact: string): number {
  return (values[`${contact}.static`] as number | null | undefined) ?? kineticOf(values, contact);
}

/** What is wrong with values that a person set, in one line; empty where nothing is. */
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
    for (const table of ["plate", "finger"]) {
      const curve = found[`${table}.curve`] as Rows | null;
      if (curve) checkCurve(curve, kineticOf(found, table));
      checkStatic(staticOf(found, table), kineticOf(found, table));
    }
    checkSkin(found);
    checkStretch(found);
    checkDrive(found);
    checkPhase(found);
  } catch (error) {
    if (error instanceof Refusal) return error.message;
    throw error;
  }
  return "";
}
