// A reading that is kept: device, page and hand, as `load_reading` of Python reads them.
import type { HandRows } from "./hand";
import { Paper } from "./paper";
import { type PackedRaster, packedRaster, rasterOf } from "./raster";
import type { Print } from "./state";

export const FORMAT = "pindrive reading 1";

export interface SavedReading {
  /** Text of its device file. */
  readonly device: string;
  readonly page: PackedRaster;
  readonly hand: HandRows;
}

const packedPages = new WeakMap<Print, PackedRaster>();

/** The raster of a print, for Python and other browsers, whose fonts are others. */
export async function packedPage(print: Print): Promise<PackedRaster> {
  if (print.kind === "picture") return print.raster;
  const known = packedPages.get(print);
  if (known) return known;
  const paper = new Paper();
  await paper.print(print);
  const packed = await packedRaster(paper.raster, paper.title);
  packedPages.set(print, packed);
  return packed;
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
