// The state of "Read": the device, the print of the page, and the reading that a hand made of it.
import type { Core } from "../core";
import { type Design, designOf } from "../design";
import { TABLES } from "../table";
import type { HandRows, Slowness } from "./hand";
import { type Spot, usualWidth } from "./paper";
import type { PackedRaster } from "./raster";

/** Begin and width of a printed line, mm. */
export type PrintedLine = readonly [number, number];
export type Stroke = readonly Spot[];

export interface Drawn {
  readonly kind: "drawing";
  readonly strokes: readonly Stroke[];
  readonly width: number;
}

/** The print of a page of a width, mm. */
export type Print =
  | { readonly kind: "text"; readonly text: string; readonly width: number }
  | { readonly kind: "lines"; readonly lines: readonly PrintedLine[]; readonly width: number }
  | Drawn
  | { readonly kind: "picture"; readonly raster: PackedRaster };

export interface ReadState {
  readonly device: Design;
  readonly print: Print;
  /** The hand of the reading that is finished; null: none. */
  readonly hand: HandRows | null;
  /** Number of the task; -1: none. */
  readonly task: number;
  /** Times by which the device runs slower than the clock. */
  readonly slowness: Slowness;
}

export function initialRead(core: Core): ReadState {
  const device = designOf(core, { text: TABLES.reader, file: "the reader", rows: {} });
  return {
    device,
    print: { kind: "text", text: "Hello", width: usualWidth() },
    hand: null,
    task: 0,
    slowness: 10,
  };
}
