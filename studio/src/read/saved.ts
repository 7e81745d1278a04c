// A reading that is kept: device, page and hand, as `load_reading` of Python reads them.
import { deflated, inflated } from "../links";
import type { HandRows } from "./hand";
import type { Raster } from "./scan";
import type { PackedRaster } from "./state";

export const FORMAT = "pindrive reading 1";

export interface SavedReading {
  /** Text of its device file. */
  readonly device: string;
  readonly page: PackedRaster;
  readonly hand: HandRows;
}

export async function packedRaster(
  { grey, rows, columns, pixel }: Raster,
  title: string,
): Promise<PackedRaster> {
  return { title, rows, columns, pixel, luminance: await deflated(grey) };
}

export async function rasterOf({ rows, columns, pixel, luminance }: PackedRaster): Promise<Raster> {
  const grey = await inflated(luminance);
  if (grey.length !== rows * columns) throw new Error("the page is not whole");
  return { grey, rows, columns, pixel };
}

/** The reading in an object of a file or a link. Throws an error in words. */
export async function readingOf(given: unknown): Promise<SavedReading> {
  const { format, device, page, hand } = (given ?? {}) as Record<string, unknown>;
  if (format !== FORMAT) throw new Error(`is no reading: its format must be "${FORMAT}"`);
  if (typeof device !== "string" || !isHand(hand)) throw new Error("is no whole reading");
  try {
    const { title, rows, columns, pixel, luminance } = page as PackedRaster;
    const raster = { title: String(title), rows, columns, pixel, luminance };
    if (!Number.isFinite(pixel)) throw new Error();
    await rasterOf(raster);
    return { device, page: raster, hand };
  } catch {
    throw new Error("is no whole reading");
  }
}

/** True for a begin, and rows of whole numbers with times that grow. */
export function isHand(given: unknown): given is HandRows {
  const { start, rows } = (given ?? {}) as Partial<HandRows>;
  if (!Array.isArray(start) || !Array.isArray(rows) || start.length !== 2) return false;
  const whole = rows.every((row) => Array.isArray(row) && row.length === 3);
  return (
    whole &&
    [...start, ...rows.flat()].every(Number.isFinite) &&
    rows.every(([time], i) => time > (i ? rows[i - 1]![0] : 0))
  );
}
