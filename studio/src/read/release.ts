// One pin of a reading as a release: its inputs over time, from springs at rest.

import type { Design } from "../design";
import type { Values } from "../friction";
import type { Piece, Row, Rows } from "../input";
import type { Hand } from "./hand";

/** Returns the design of a release with the motion of a pin: its drive, and inputs from hand and magnet. */
export function pinDesign(
  design: Design,
  hand: Hand,
  axis: Row,
  load: readonly Piece[],
  pin: number,
): Design {
  const rows = hand.rowsFrom(0);
  const times = [0, ...Array.from({ length: hand.count }, (_, i) => rows[3 * i]!)];
  const along = (of: (vx: number, vy: number) => number): Rows =>
    times.map((time, i): Row => [time, i ? of(rows[3 * i - 2]!, rows[3 * i - 1]!) : 0]);
  const drive = Object.entries(design.values).filter(([key]) => !key.startsWith("motion."));
  const across = along((vx, vy) => vy * axis[0] - vx * axis[1]);
  const changes = load.length > 1 || load[0]!.terms.length > 0;
  const values: Values = {
    ...Object.fromEntries(drive),
    "motion.mouse_velocity": along((vx, vy) => vx * axis[0] + vy * axis[1]),
    "motion.plate_load": changes ? { parts: [{ pieces: load }] } : load[0]!.polynomial[0]!,
    "motion.displacement": 0,
    "motion.velocity": 0,
    "motion.duration": hand.end,
    ...(across.some(([, v]) => v !== 0) ? { "motion.across_velocity": across } : {}),
  };
  return { name: `pin ${pin + 1} of a reading`, description: "", values, around: {}, shown: true };
}
