// Rasters of luminance as text.
import { deflated, inflated } from "../links";
import type { Raster } from "./scan";

/** A raster of luminance, compressed, in base64. */
export interface PackedRaster {
  readonly title: string;
  readonly rows: number;
  readonly columns: number;
  /** Size of a pixel, m. */
  readonly pixel: number;
  readonly luminance: string;
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
