// A design: the values that a device file gives, what follows from them, and what the core is given.
import type { Core } from "./core";
import { type Device, readDevice } from "./device";
import type { Given } from "./files";
import {
  byCoefficient,
  CONTACTS,
  frictionKeys,
  frictionOf,
  frictionParts,
  givenFriction,
  pressRate,
  type Value,
  type Values,
} from "./friction";
import type { Input, Rows, TimeFunction } from "./input";
import { integralUntil, valueAt } from "./pieces";
import { DRIVE, TABLES } from "./table";

export interface Design extends Device {
  /** True if its curves are drawn beside the curves of the current design. */
  readonly shown: boolean;
}

const MOUSE = "motion.mouse_velocity";
/** Keys of end stops, each of which requires the keys before it. */
const STOPS = ["travel", "stop_stiffness", "stop_damping"] as const;
/** Keys of a release beside its inputs over time. */
const RELEASED = ["displacement", "velocity", "skin_stretch", "duration", "support"] as const;

/** A device file as a design. Throws DeviceError. */
export function designOf(core: Core, { text, file, rows }: Given): Design {
  return { ...readDevice(core, text, file, rows), shown: true };
}

/** Damping over critical damping. */
export function dampingRatio(values: Values): number {
  const [mass, stiffness] = [values["drive.mass"] as number, values["drive.stiffness"] as number];
  return dampingOf(values) / (2 * Math.sqrt(mass * stiffness));
}

/** Damping, given or by its ratio, N*s/m. */
function dampingOf(values: Values): number {
  const damping = values["drive.damping"];
  if (typeof damping === "number") return damping;
  const [ratio, mass, stiffness] = ["drive.damping_ratio", "drive.mass", "drive.stiffness"].map(
    (key) => values[key] as number,
  ) as [number, number, number];
  return 2 * ratio * Math.sqrt(mass) * Math.sqrt(stiffness);
}

export function isRows(value: Value | null | undefined): value is Rows {
  return Array.isArray(value);
}

export function isFunction(value: Value | null | undefined): value is TimeFunction {
  return typeof value === "object" && value !== null && "parts" in value;
}

/** Value of a key: the given one, or the default of a missing key; null: none. */
export function valueFor(values: Values, key: string): Value | null {
  return values[key] ?? DRIVE.get(key)!.absent ?? null;
}

/** Optional values of a drive: the core's name and the key. */
const OPTIONAL: readonly (readonly [string, string])[] = [
  ["finger.stiffness", "finger.stiffness"],
  ["finger.damping", "finger.damping"],
  ["finger.load_exponent", "finger.load_exponent"],
  ...STOPS.map((name) => [name, `drive.${name}`] as const),
  ...CONTACTS.flatMap((contact) =>
    ["law", "stribeck_velocity", "exponent"].map(
      (name) => [`${contact}.${name}`, `${contact}.${name}`] as const,
    ),
  ),
];

/** As pindrive.h has it. */
export function coreInput(values: Values): Input {
  const curves: Record<string, Rows> = {};
  const drive: Record<string, number> = {
    mass: values["drive.mass"] as number,
    stiffness: values["drive.stiffness"] as number,
    damping: dampingOf(values),
  };
  for (const contact of CONTACTS) {
    const { kinetic, still, curve, rest, viscous } = frictionOf(values, contact);
    if (curve) curves[contact] = curve;
    if (rest !== null) drive[`${contact}.breakaway`] = rest;
    if (viscous !== null) drive[`${contact}.viscous`] = viscous;
    drive[`${contact}.kinetic`] = kinetic;
    drive[`${contact}.static`] = still;
  }
  for (const [name, key] of OPTIONAL) {
    const value = values[key];
    if (typeof value === "number" && value !== DRIVE.get(key)!.absent) drive[name] = value;
  }
  const release: Record<string, number> = {};
  for (const name of RELEASED) {
    const value = valueFor(values, `motion.${name}`);
    if (typeof value === "number") release[name] = value;
  }
  const profiles: Record<string, Rows> = {};
  const functions: Record<string, TimeFunction> = {};
  for (const name of TABLES.overTime) {
    const value = valueFor(values, `motion.${name}`)!;
    if (isFunction(value)) {
      functions[name] = value;
      continue;
    }
    // An input that never changes is a constant, as in Python.
    const changes = isRows(value) && value.some(([, y]) => y !== value[0]![1]);
    profiles[name] = changes ? value : [[0, isRows(value) ? value[0]![1] : value]];
  }
  return { drive, curves, release, profiles, functions };
}

/** Lists of keys; a key means nothing without the ones before. */
const CHAINS: readonly (readonly string[])[] = [
  STOPS.map((name) => `drive.${name}`),
  ["finger.stiffness", "finger.damping"],
];

/** The keys that mean nothing without that one. */
function needing(key: string): readonly string[] {
  return CHAINS.flatMap((chain) => (chain.includes(key) ? chain.slice(chain.indexOf(key) + 1) : []));
}

/** True if the keys that a key requires are given. */
export function applies(values: Values, key: string): boolean {
  return CHAINS.flat().every((needed) => !needing(needed).includes(key) || needed in values);
}

/** The values with one set or, for null, left out; what keeps a ratio to it follows. */
export function withValue(values: Values, key: string, value: Value | null): Values {
  const next: Record<string, Value> = { ...values };
  if (value === null) for (const gone of [key, ...needing(key)]) delete next[gone];
  else next[key] = value;
  if (key === "drive.damping" && value !== null) delete next["drive.damping_ratio"];
  if (key === "drive.damping_ratio" && value !== null) delete next["drive.damping"];
  // Several may follow one another: in the order of the table, as for --set.
  const moved = new Set([key]);
  for (const [other, quantity] of DRIVE) {
    const follows = quantity.follows ?? [];
    if (values[other] === undefined && frictionParts(other).some((name) => moved.has(name))) moved.add(other);
    if (moved.has(other) || !follows.some((name) => moved.has(name))) continue;
    moved.add(other);
    const given = values[other];
    const [before, after] = [quotient(values, follows), quotient(next, follows)];
    if (given === undefined || before === null || after === null) continue;
    if (before === 0) {
      // Without a ratio to keep, static friction follows kinetic friction up from 0.
      if (given === 0 && other.includes(".static")) next[other] = after;
      continue;
    }
    const scale = (y: number): number => (y / before) * after;
    if (isFunction(given)) continue;
    next[other] = isRows(given)
      ? given[0]![1] === 0
        ? given
        : given.map(([x, y]) => [x, (y / given[0]![1]) * after] as const)
      : scale(given);
  }
  return next;
}

/** The value of the first key, over that of the second if there is one; null without one. */
function quotient(values: Values, keys: readonly string[]): number | null {
  const numbers = keys.map((key) => numberOf(values, key));
  if (numbers[0] === null || numbers[0] === undefined) return null;
  if (numbers.length < 2) return numbers[0];
  return numbers[1] ? numbers[0] / numbers[1] : null;
}

function numberOf(values: Values, key: string): number | null {
  const [contact] = key.split(".") as [string];
  for (const coefficients of [false, true]) {
    const [kinetic, still] = frictionKeys(contact, coefficients);
    if (key !== kinetic && key !== still) continue;
    if (coefficients && !byCoefficient(values, contact)) return null;
    const friction = (coefficients ? givenFriction : frictionOf)(values, contact);
    return key === kinetic ? friction.kinetic : friction.still;
  }
  const value = valueFor(values, key);
  return typeof value === "number" ? value : null;
}

/** Derivative of the core's numbers by the relative change of one key: the rate of withValue. */
export function direction(values: Values, key: string, part: number): Input {
  const relative: Record<string, number> = { [key]: part };
  const of = (name: string): number => relative[name] ?? 0;
  const input = coreInput(values);
  // Forces follow from coefficients after the coefficients have followed one another.
  const follow = (pressed: boolean): void => {
    for (const [other, quantity] of DRIVE) {
      const [over, under] = quantity.follows ?? [];
      if (over === undefined || other === key) continue;
      if (pressed && frictionParts(other).length) continue;
      const rate = of(over) - (under === undefined ? 0 : of(under));
      if (rate) relative[other] = rate;
    }
  };
  follow(false);
  const byRatio = values["drive.damping"] === undefined;
  const drive: Record<string, number> = {
    mass: of("drive.mass") * input.drive.mass!,
    stiffness: of("drive.stiffness") * input.drive.stiffness!,
    damping:
      input.drive.damping! *
      (byRatio
        ? of("drive.damping_ratio") + (of("drive.mass") + of("drive.stiffness")) / 2
        : of("drive.damping")),
  };
  const scaled = (rows: Rows, rate: number): Rows => rows.map(([, y]) => [0, rate * y] as const);
  const curves: Record<string, Rows> = {};
  for (const contact of CONTACTS) {
    const curve = input.curves[contact];
    const coefficients = byCoefficient(values, contact);
    const [ofKinetic, ofStatic, ofCurve, ofRest, ofViscous] = frictionKeys(contact, coefficients);
    const pressed = coefficients ? pressRate(values, contact, of) : 0;
    // The first force of a curve is kinetic friction and, without static friction, also the static limit.
    const kinetic = of(curve ? ofCurve : ofKinetic) + pressed;
    const falling = values[ofRest] !== undefined;
    const rest = falling ? of(ofRest) + pressed : kinetic;
    const still = values[ofStatic] === undefined ? rest : of(ofStatic) + pressed;
    if (falling) drive[`${contact}.breakaway`] = rest * input.drive[`${contact}.breakaway`]!;
    if (values[ofViscous] !== undefined)
      drive[`${contact}.viscous`] = (of(ofViscous) + pressed) * input.drive[`${contact}.viscous`]!;
    if (curve) curves[contact] = scaled(curve, kinetic);
    drive[`${contact}.kinetic`] = kinetic * input.drive[`${contact}.kinetic`]!;
    drive[`${contact}.static`] = still * input.drive[`${contact}.static`]!;
    if (coefficients) relative[`${contact}.static`] = still;
  }
  follow(true);
  for (const [name, key] of OPTIONAL) if (of(key)) drive[name] = of(key) * (values[key] as number);
  const release: Record<string, number> = {};
  for (const name of RELEASED) {
    const rate = of(`motion.${name}`);
    if (rate) release[name] = rate * input.release[name]!;
  }
  const profiles: Record<string, Rows> = {};
  for (const name of TABLES.overTime) {
    const rows = input.profiles[name];
    if (rows) profiles[name] = scaled(rows, of(`motion.${name}`)); // no parameter of a function is varied
  }
  return { drive, curves, release, profiles, functions: {} };
}

/** The keys with a value of their own that is not 0, which derivatives and fits may change. */
export function variedKeys(values: Values): string[] {
  return [...DRIVE.keys()].filter((key) => {
    if (key === "motion.duration" || key === "motion.settling_band") return false;
    if (DRIVE.get(key)!.choices || key.endsWith(".exponent")) return false;
    const value = values[key];
    if (isFunction(value)) return false;
    return value !== undefined && (isRows(value) ? value.some(([, y]) => y !== 0) : value !== 0);
  });
}

export function settlingBand(values: Values): number {
  return valueFor(values, "motion.settling_band") as number;
}

/** The plate's velocity in the housing at a time, m/s. */
export function plateVelocity(values: Values, t: number): number {
  const given = values[MOUSE];
  if (isFunction(given)) return valueAt(given, t);
  if (!isRows(given)) return given ?? 0;
  const after = given.findIndex(([time]) => time > t);
  if (after === 0) return given[0]![1];
  if (after < 0) return given[given.length - 1]![1];
  const [[t0, y0], [t1, y1]] = [given[after - 1]!, given[after]!];
  return y0 + ((y1 - y0) * (t - t0)) / (t1 - t0);
}

/** Distance of the plate since the release, m. */
export function plateDistance(values: Values, t: number): number {
  const given = values[MOUSE];
  if (isFunction(given)) return integralUntil(given, t);
  if (!isRows(given)) return (given ?? 0) * t;
  const times = [0, ...given.map(([time]) => time).filter((time) => time > 0 && time < t), t];
  let sum = 0;
  for (let i = 1; i < times.length; ++i) {
    const [a, b] = [times[i - 1]!, times[i]!];
    sum += ((plateVelocity(values, a) + plateVelocity(values, b)) / 2) * (b - a);
  }
  return sum;
}
