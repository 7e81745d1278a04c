// Friction by forces or by coefficients: what presses on a contact, and the forces that follow.
import type { Rows } from "./core";
import { DRIVE, TABLES } from "./table";

export type Value = number | Rows;
/** The values of keys that are given, SI. */
export type Values = Readonly<Record<string, Value>>;
/** Keys with defaults of missing ones; null without a default. */
export type Found = Readonly<Record<string, Value | null | undefined>>;

/** The friction of a contact: forces (N), or coefficients of what presses on it. */
export interface Friction {
  readonly kinetic: number;
  readonly still: number;
  readonly curve: Rows | null;
}

export const CONTACTS = ["plate", "finger"] as const;
const KINDS = ["kinetic", "static", "curve"] as const;

/** The keys of the friction of a contact: kinetic, static, curve. */
export function frictionKeys(contact: string, coefficients: boolean): [string, string, string] {
  const keys = KINDS.map((kind) => `${contact}.${kind}`);
  return (coefficients ? keys.map((key) => TABLES.coefficients[key]!) : keys) as [string, string, string];
}

export function byCoefficient(values: Found, contact: string): boolean {
  return frictionKeys(contact, true).some((key) => values[key] != null);
}

/** Normal force on a contact while the magnet is off, N. */
export function normalForce(values: Found, contact: string): number {
  const parts = Object.entries(TABLES.pressedBy[contact]!);
  const sizes = parts.map(([key, factor]) => factor * ((values[key] ?? DRIVE.get(key)!.absent) as number));
  return sizes.slice(1).reduce((sum, size) => sum + size, sizes[0]!);
}

/** Notation of friction: by forces or by coefficients. */
export function givenFriction(values: Found, contact: string): Friction {
  const [ofKinetic, ofStatic, ofCurve] = frictionKeys(contact, byCoefficient(values, contact));
  const curve = (values[ofCurve] as Rows | null | undefined) ?? null;
  const kinetic = (values[ofKinetic] as number | null | undefined) ?? curve![0]![1];
  return { kinetic, still: (values[ofStatic] as number | null | undefined) ?? kinetic, curve };
}

/** The forces, N. */
export function frictionOf(values: Found, contact: string): Friction {
  const given = givenFriction(values, contact);
  return byCoefficient(values, contact) ? times(given, normalForce(values, contact)) : given;
}

function times({ kinetic, still, curve }: Friction, load: number): Friction {
  const rows = curve?.map(([speed, each]) => [speed, each * load] as const) ?? null;
  return { kinetic: kinetic * load, still: still * load, curve: rows };
}

/** The keys from which a friction force follows where a coefficient gives it; of others none. */
export function frictionParts(key: string): readonly string[] {
  const own = TABLES.coefficients[key];
  if (own === undefined) return [];
  return [own, ...(DRIVE.get(own)!.follows ?? []), ...Object.keys(TABLES.pressedBy[key.split(".")[0]!]!)];
}

/** Friction in the alternative notation, within rounding; a finger then has this touch force, N. */
export function withKind(values: Values, contact: string, coefficients: boolean): Values {
  if (byCoefficient(values, contact) === coefficients) return values;
  const touch = "finger.touch_force";
  const forces = frictionOf(values, contact);
  const before = frictionKeys(contact, !coefficients);
  const next = Object.fromEntries(Object.entries(values).filter(([key]) => !before.includes(key)));
  if (contact === "finger") {
    if (coefficients) next[touch] = DRIVE.get(touch)!.example!;
    else delete next[touch];
  }
  const found = coefficients ? times(forces, 1 / normalForce(next, contact)) : forces;
  const [ofKinetic, ofStatic, ofCurve] = frictionKeys(contact, coefficients);
  next[ofKinetic] = found.kinetic;
  if (values[before[1]] !== undefined) next[ofStatic] = found.still;
  if (found.curve) next[ofCurve] = found.curve.map(([u, y], i) => [u, i ? y : found.kinetic] as const);
  return next;
}
