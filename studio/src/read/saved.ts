// A reading that is kept: device, page and hand, as a file or in a link. `load_reading` of Python reads both.
import { piped } from "../state";
import type { HandRows } from "./hand";
import type { Raster } from "./scan";

const FORMAT = "pindrive reading 1";

export interface SavedReading {
  /** Text of its device file. */
  readonly device: string;
  readonly page: Raster;
  readonly title: string;
  readonly hand: HandRows;
}

export async function readingText({ device, page, title, hand }: SavedReading): Promise<string> {
  const { grey, rows, columns, pixel } = page;
  const luminance = base64(await piped(grey, new CompressionStream("deflate-raw")));
  return JSON.stringify({
    format: FORMAT,
    device,
    page: { title, rows, columns, pixel, luminance },
    hand,
  });
}

/** The reading in the text of a file. Throws an error in words. */
export async function readingOf(text: string): Promise<SavedReading> {
  let given: ReturnType<typeof JSON.parse>;
  try {
    given = JSON.parse(text);
  } catch {
    throw new Error("is no reading, which is JSON");
  }
  if (given?.format !== FORMAT) throw new Error(`is no reading: its format must be "${FORMAT}"`);
  try {
    const { title, rows, columns, pixel, luminance } = given.page;
    const grey = await piped(bytesOf(luminance), new DecompressionStream("deflate-raw"));
    if (grey.length !== rows * columns) throw new Error();
    const { start, rows: moves } = given.hand;
    const numbers = [pixel, ...start, ...moves.flat()];
    const whole = moves.every(({ length }: number[]) => length === 3) && numbers.every(Number.isFinite);
    if (!whole || typeof given.device !== "string") throw new Error();
    return {
      device: given.device,
      page: { grey, rows, columns, pixel },
      title: String(title),
      hand: given.hand,
    };
  } catch {
    throw new Error("is no whole reading");
  }
}

/** The reading as the part of a link after "#read=". */
export async function readingHash(reading: SavedReading): Promise<string> {
  const bytes = new TextEncoder().encode(await readingText(reading));
  const packed = base64(await piped(bytes, new CompressionStream("deflate-raw")));
  return packed.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

export async function readingOfHash(hash: string): Promise<SavedReading> {
  const bytes = bytesOf(hash.replaceAll("-", "+").replaceAll("_", "/"));
  return readingOf(new TextDecoder().decode(await piped(bytes, new DecompressionStream("deflate-raw"))));
}

function base64(bytes: Uint8Array): string {
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
}
function bytesOf(text: string): Uint8Array {
  return Uint8Array.from(atob(text), (char) => char.charCodeAt(0));
}
