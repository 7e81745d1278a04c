// The device of a design as the core takes it: the values of its keys, and the spots of its pins.
import type { Core } from "../core";
import type { Design } from "../design";
import { settingsOf } from "../device";
import type { Value } from "../friction";
import type { Row, Rows } from "../input";
import type { DeviceInput } from "./scan";

const OF_THE_DEVICE = ["drive", "plate", "finger", "magnet", "control", "criteria"];
/** Keys that change neither motion nor commands. */
const OF_THE_SIZE = ["outer_diameter", "height", "spring_height", "pin_height", "temperature_rise"].map(
  (name) => `magnet.${name}`,
);

/** Values of all keys of a design, SI. */
export function valuesOf(design: Pick<Design, "values" | "around">): Readonly<Record<string, Value>> {
  return { ...design.values, ...settingsOf(design.around) };
}

/** Spots of the pins from the hand on the page, m, in the order of the array. */
export function spotsOf(core: Core, values: Readonly<Record<string, Value>>): Row[] {
  const number = (name: string, otherwise: number): number =>
    (values[`array.${name}`] as number | undefined) ?? otherwise;
  const scale = number("spot_scale", 1);
  const [ax, ay] = core.direction(number("axis", 0));
  const places = (values["array.places"] as Rows | undefined) ?? gridOf(number);
  return places.map(([x, y]) => {
    const [along, across] = [x * scale, y * scale];
    return [ax * along - ay * across, ay * along + ax * across];
  });
}

function gridOf(number: (name: string, otherwise: number) => number): Row[] {
  const [columns, rows, pitch] = [number("columns", 1), number("rows", 1), number("pitch", 0.005)];
  return Array.from({ length: columns * rows }, (_, i) => [
    ((i % columns) - 0.5 * (columns - 1)) * pitch,
    (Math.floor(i / columns) - 0.5 * (rows - 1)) * pitch,
  ]);
}

export function deviceInput(core: Core, design: Pick<Design, "values" | "around">): DeviceInput {
  const values = valuesOf(design);
  const numbers: Record<string, number> = {};
  const rows: Record<string, Rows> = {};
  for (const [key, value] of Object.entries(values)) {
    const known = OF_THE_DEVICE.includes(key.split(".")[0]!) || key === "array.axis";
    if (!known || OF_THE_SIZE.includes(key)) continue;
    if (typeof value === "number") numbers[key] = value;
    else rows[key] = value as Rows;
  }
  return { numbers, rows, spots: spotsOf(core, values) };
}
