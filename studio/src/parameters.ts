// Parameters of a design: which of them have a meaning, their names, and what stands in for a missing one.
import { applies, valueFor } from "./design";
import {
  byCoefficient,
  falls,
  frictionKeys,
  frictionOf,
  givenFriction,
  lawOf,
  type Values,
} from "./friction";
import { DRIVE, type Quantity, TABLES, text } from "./table";

/** Mandatory keys of a contact with coefficients. */
export const PRESSED: readonly string[] = ["plate.coefficient", "finger.coefficient", "finger.touch_force"];

/** Parts of the keys of friction that falls. */
export const FALLING: readonly string[] = ["breakaway", "stribeck_velocity"];

/** True if a key has a meaning with the notation of its contact and with these end stops. */
export function meant(key: string, values: Values): boolean {
  const contact = key.split(".")[0]!;
  if (!(contact in TABLES.pressedBy)) return key in values || applies(values, key);
  const coefficients = byCoefficient(values, contact);
  const falling = falls(values, contact);
  if (FALLING.some((name) => key.includes(name)) && !falling) return false;
  if (key.endsWith(".exponent")) return lawOf(values, contact) === "stribeck";
  if (key === "finger.stiffness") return !falling;
  if (key === "finger.damping") return !falling && applies(values, key);
  const curve = DRIVE.get(key)!.rowsOf?.endsWith("curve") === true;
  if (curve && lawOf(values, contact) !== "table") return false;
  if (TABLES.pressedBy[contact]!.includes(key)) return coefficients || values[key] !== undefined;
  return !frictionKeys(contact, !coefficients).includes(key);
}

export function nameOf(quantity: Quantity): string {
  return quantity.name.replace(/^(plate|finger)\./, "").replaceAll("_", " ");
}

/** Alternative notation: damping or damping ratio. */
export function partner(key: string): string | null {
  return { "drive.damping": "drive.damping_ratio", "drive.damping_ratio": "drive.damping" }[key] ?? null;
}

/** Default of a missing key. */
export function absentWords(key: string, values: Values): string {
  const name = key.split(".")[1]!;
  const words: Record<string, string> = {
    static: "as kinetic",
    static_coefficient: "as coefficient",
    exponent: "1",
    viscous: "none",
    viscous_coefficient: "none",
    stiffness: "rigid",
    velocity: "plate's",
    skin_stretch: "none",
    travel: "none",
    stop_stiffness: "rigid",
    stop_damping: "none",
    duration: "ending",
    kinetic: "of curve",
    coefficient: "of curve",
  };
  const absent = DRIVE.get(key)!.absent;
  return (
    words[name] ?? (absent === undefined ? "" : text(DRIVE.get(key)!, absent)) ?? String(values[key] ?? "")
  );
}

/** A value with which a key that was not given begins. */
export function usualValue(quantity: Quantity, values: Values): number {
  const [contact, name] = quantity.key.split(".") as [string, string];
  if (name.startsWith("static")) {
    const { kinetic, rest } = givenFriction(values, contact);
    return (rest ?? kinetic) * 1.2;
  }
  if (name === "skin_stretch") {
    const limit = frictionOf(values, "finger").still;
    return limit / 2 / ((values["finger.stiffness"] as number | undefined) ?? Infinity);
  }
  if (name === "travel") return Math.max(quantity.example!, Math.abs(startOf(values)));
  return quantity.default ?? quantity.example ?? quantity.absent ?? 0;
}

/** Displacement at the release, m. */
function startOf(values: Values): number {
  return (valueFor(values, "motion.displacement") as number | null) ?? 0;
}
