// Friction by forces or by coefficients: what presses on a contact, and the forces that follow.
import type { Rows, TimeFunction } from "./input";
import { DRIVE, TABLES } from "./table";

export type Value = number | Rows | TimeFunction;
/** The values of keys that are given, SI. */
export type Values = Readonly<Record<string, Value>>;
/** Keys with defaults of missing ones; null without a default. */
export type Found = Readonly<Record<string, Value | null | undefined>>;

/** The friction of a contact: forces (N), or coefficients of what presses on it. */
export interface Friction {
  readonly kinetic: number;
  readonly still: number;
  readonly curve: Rows | null;
  /** At rest, where friction falls by a law; null elsewhere. */
  readonly rest: number | null;
  readonly viscous: number | null;
}

export const CONTACTS = ["plate", "finger"] as const;
const KINDS = ["kinetic", "static", "curve", "breakaway", "viscous"] as const;
type Keys = [string, string, string, string, string];

/** The keys of the friction of a contact: kinetic, static, curve, at rest, viscous. */
export function frictionKeys(contact: string, coefficients: boolean): Keys {
  const keys = KINDS.map((kind) => `${contact}.${kind}`);
  return (coefficients ? keys.map((key) => TABLES.coefficients[key]!) : keys) as Keys;
}

const FALLING = ["stribeck", "hess-soom"];

/** Name of the friction law of a contact. */
export function lawOf(values: Found, contact: string): string {
  const curve = frictionKeys(contact, byCoefficient(values, contact))[2];
  const given = values[`${contact}.law`] as number | null | undefined;
  return given == null
    ? values[curve]
      ? "table"
      : "coulomb"
    : DRIVE.get(`${contact}.law`)!.choices![given]!;
}

/** True if friction falls by a law. */
export function falls(values: Found, contact: string): boolean {
  return FALLING.includes(lawOf(values, contact));
}

/** The values with another law of a contact, and what it needs; a law that falls makes a finger rigid. */
export function withLaw(values: Values, contact: string, law: string): Values {
  const coefficients = byCoefficient(values, contact);
  const [ofKinetic, ofStatic, ofCurve, ofRest] = frictionKeys(contact, coefficients);
  const { kinetic, still } = givenFriction(values, contact);
  const next: Record<string, Value> = { ...values, [ofKinetic]: kinetic };
  for (const key of [`${contact}.law`, ofRest, `${contact}.stribeck_velocity`, `${contact}.exponent`])
    delete next[key];
  delete next[ofCurve];
  if (law === "table")
    next[ofCurve] = DRIVE.get(ofCurve)!.rows!.map(
      ([u, y], _, rows) => [u, (y / rows[0]![1]) * kinetic] as const,
    );
  if (!FALLING.includes(law)) return next;
  next[`${contact}.law`] = DRIVE.get(`${contact}.law`)!.choices!.indexOf(law);
  next[ofRest] = still > kinetic ? still : 1.2 * kinetic;
  next[`${contact}.stribeck_velocity`] = DRIVE.get(`${contact}.stribeck_velocity`)!.example!;
  if (values[ofStatic] !== undefined) next[ofStatic] = next[ofRest];
  delete next[`${contact}.stiffness`];
  delete next[`${contact}.damping`];
  if (contact === "finger") delete next["motion.skin_stretch"];
  return next;
}

export function byCoefficient(values: Found, contact: string): boolean {
  return frictionKeys(contact, true).some((key) => values[key] != null);
}

/** What presses on a contact, by the keys of its normal force; the touch of a finger with a force is 0. */
function pressing(values: Found, contact: string): number[] {
  return TABLES.pressedBy[contact]!.map((key) => (values[key] ?? DRIVE.get(key)!.absent ?? 0) as number);
}

/** Normal force by which the coefficients of a contact are multiplied while the magnet is off, N. */
export function normalForce(values: Found, contact: string): number {
  const parts = pressing(values, contact);
  if (contact === "plate") {
    const [mass, preload, share, touch] = parts as [number, number, number, number];
    return TABLES.gravity * mass + preload + share * touch;
  }
  const [touch, exponent, reference] = parts as [number, number, number];
  return exponent === 1 || !reference ? touch : reference * (touch / reference) ** exponent;
}

/** Relative change of the normal force on a contact by the changes of its keys. */
export function pressRate(values: Found, contact: string, of: (key: string) => number): number {
  const parts = pressing(values, contact);
  const rates = TABLES.pressedBy[contact]!.map(of);
  const load = normalForce(values, contact);
  if (!load) return 0;
  if (contact === "plate") {
    const [mass, preload, share, touch] = parts as [number, number, number, number];
    const sizes = [TABLES.gravity * mass, preload, share * touch, share * touch];
    return sizes.reduce((sum, size, i) => sum + size * rates[i]!, 0) / load;
  }
  const [touch, exponent, reference] = parts as [number, number, number];
  const [byTouch, byExponent, byReference] = rates as [number, number, number];
  if (!reference) return byTouch;
  return exponent * (byTouch + Math.log(touch / reference) * byExponent) + (1 - exponent) * byReference;
}

/** Notation of friction: by forces or by coefficients. */
export function givenFriction(values: Found, contact: string): Friction {
  const [ofKinetic, ofStatic, ofCurve, ofRest, ofViscous] = frictionKeys(
    contact,
    byCoefficient(values, contact),
  );
  const number = (key: string): number | null => (values[key] as number | null | undefined) ?? null;
  const curve = (values[ofCurve] as Rows | null | undefined) ?? null;
  const kinetic = number(ofKinetic) ?? curve![0]![1];
  const rest = number(ofRest);
  return { kinetic, still: number(ofStatic) ?? rest ?? kinetic, curve, rest, viscous: number(ofViscous) };
}

/** The forces, N. */
export function frictionOf(values: Found, contact: string): Friction {
  const given = givenFriction(values, contact);
  return byCoefficient(values, contact) ? times(given, normalForce(values, contact)) : given;
}

function times({ kinetic, still, curve, rest, viscous }: Friction, load: number): Friction {
  const rows = curve?.map(([speed, each]) => [speed, each * load] as const) ?? null;
  const part = (each: number | null): number | null => (each === null ? null : each * load);
  return {
    kinetic: kinetic * load,
    still: still * load,
    curve: rows,
    rest: part(rest),
    viscous: part(viscous),
  };
}

/** The keys from which a friction force follows where a coefficient gives it; of others none. */
export function frictionParts(key: string): readonly string[] {
  const own = TABLES.coefficients[key];
  if (own === undefined) return [];
  return [own, ...(DRIVE.get(own)!.follows ?? []), ...TABLES.pressedBy[key.split(".")[0]!]!];
}

/** The values with other coefficients of the plate, by which its forces stay as they were. */
function withForcesKept(before: Values, after: Values): Values {
  if (!byCoefficient(after, "plate")) return after;
  const part = normalForce(before, "plate") / normalForce(after, "plate");
  const next: Record<string, Value> = { ...after };
  for (const key of frictionKeys("plate", true)) {
    const value = next[key];
    if (typeof value === "number") next[key] = value * part;
    else if (value !== undefined) next[key] = (value as Rows).map(([u, y]) => [u, y * part] as const);
  }
  return next;
}

/** Friction in the alternative notation, within rounding; a finger then has a usual touch force, N. */
export function withKind(values: Values, contact: string, coefficients: boolean): Values {
  if (byCoefficient(values, contact) === coefficients) return values;
  const touch = "finger.touch_force";
  const forces = frictionOf(values, contact);
  const before = frictionKeys(contact, !coefficients);
  const next = Object.fromEntries(Object.entries(values).filter(([key]) => !before.includes(key)));
  if (contact === "finger") {
    if (coefficients) next[touch] = DRIVE.get(touch)!.example!;
    else for (const key of [touch, "finger.load_exponent", "finger.reference_touch"]) delete next[key];
  }
  const found = coefficients ? times(forces, 1 / normalForce(next, contact)) : forces;
  const [ofKinetic, ofStatic, ofCurve, ofRest, ofViscous] = frictionKeys(contact, coefficients);
  if (found.rest !== null) next[ofRest] = found.rest;
  if (found.viscous !== null) next[ofViscous] = found.viscous;
  next[ofKinetic] = found.kinetic;
  if (values[before[1]] !== undefined) next[ofStatic] = found.still;
  if (found.curve) next[ofCurve] = found.curve.map(([u, y], i) => [u, i ? y : found.kinetic] as const);
  return contact === "finger" ? withForcesKept(values, next) : next;
}
