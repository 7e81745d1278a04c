// The page under the hand: text, drawing, picture or lines, as a raster of luminance.

import { rasterOf } from "./raster";
import type { Raster } from "./scan";
import type { Print, PrintedLine, Stroke } from "./state";

/** Pixels to the millimetre. */
export const RESOLUTION = 22;
const [WIDE, NARROW] = [44, 36]; // mm of page on a screen, and on a telephone
const MARGIN = 5.5; // mm beside a text at least
const LETTERS = 13; // mm, largest size of the font
const PEN = 1.2; // mm
export const HEIGHT = 12.5; // mm

/** Place on the page, mm. */
export interface Spot {
  readonly x: number;
  readonly y: number;
}

export function isNarrow(): boolean {
  return innerWidth < 600;
}
/** Width of a page that is printed here, mm. */
export function usualWidth(): number {
  return typeof innerWidth === "number" && isNarrow() ? NARROW : WIDE;
}

const LARGEST = 4e7; // pixels of a picture, as of a page in Python

export class Paper {
  readonly canvas = new OffscreenCanvas(1, 1);
  /** The print in outline. */
  readonly outline = new OffscreenCanvas(1, 1);
  private readonly pen = this.canvas.getContext("2d", { willReadFrequently: true })!;
  raster: Raster = { grey: new Uint8Array([255]), rows: 1, columns: 1, pixel: 1e-3 / RESOLUTION };
  /** Description for reports and screen readers. */
  title = "blank paper";
  /** Width, mm. */
  width = 0;
  /** Number of changes of the canvas. */
  changes = 0;

  constructor() {
    this.clear(usualWidth());
  }

  /** Prints anew. Throws an error for a raster that is spoiled. */
  async print(print: Print): Promise<void> {
    if (print.kind === "picture") {
      this.show(await rasterOf(print.raster), print.raster.title);
      return;
    }
    this.clear(print.width);
    if (print.kind === "text") this.text(print.text || " ");
    else if (print.kind === "lines") this.lines(print.lines);
    else this.drawing(print.strokes);
    this.printed();
  }

  private text(words: string): void {
    const { pen } = this;
    this.title = `the text “${words}”`;
    pen.save();
    pen.scale(RESOLUTION, RESOLUTION);
    const room = this.width - 2 * MARGIN;
    const measure = (size: number): TextMetrics => {
      pen.font = `600 ${size}px "DejaVu Sans", "Helvetica Neue", Arial, sans-serif`;
      return pen.measureText(words);
    };
    let measured = measure(LETTERS);
    if (measured.width > room) measured = measure((LETTERS * room) / measured.width);
    const { width, actualBoundingBoxAscent: up, actualBoundingBoxDescent: down } = measured;
    pen.fillText(words, (this.width - width) / 2, HEIGHT / 2 + (up - down) / 2);
    pen.restore();
  }

  /** Vertical lines at places with widths, mm. */
  private lines(lines: readonly PrintedLine[]): void {
    this.title = lines.length === 1 ? "one line" : `${lines.length} lines`;
    for (const [x, width] of lines) {
      this.pen.fillRect(x * RESOLUTION, RESOLUTION, width * RESOLUTION, (HEIGHT - 2) * RESOLUTION);
    }
  }

  /** A drawing of strokes. */
  private drawing(strokes: readonly Stroke[]): void {
    this.title = "a drawing";
    for (const stroke of strokes) {
      stroke.forEach((to, i) => {
        this.draw(stroke[Math.max(0, i - 1)]!, to);
      });
    }
  }
  /** Draws from one spot to another, mm; the raster stays as it was. */
  draw(from: Spot, to: Spot): void {
    const { pen } = this;
    this.changes += 1;
    [pen.lineWidth, pen.lineCap] = [PEN * RESOLUTION, "round"];
    pen.beginPath();
    pen.moveTo(from.x * RESOLUTION, from.y * RESOLUTION);
    pen.lineTo(to.x * RESOLUTION, to.y * RESOLUTION);
    pen.stroke();
  }

  /** A raster that was saved, at its size. */
  private show(raster: Raster, title: string): void {
    this.clear(raster.columns * raster.pixel * 1e3);
    this.title = title;
    const { rows, columns, grey, pixel } = raster;
    const [own, pen] = canvasOf(columns, rows);
    const picture = pen.createImageData(columns, rows);
    const { data } = picture;
    for (let i = 0; i < grey.length; ++i) {
      data[4 * i] = data[4 * i + 1] = data[4 * i + 2] = grey[i]!;
      data[4 * i + 3] = 255;
    }
    pen.putImageData(picture, 0, 0);
    const scale = pixel * 1e3 * RESOLUTION;
    this.pen.drawImage(own, 0, 0, columns * scale, rows * scale);
    this.printed(raster);
  }

  /** Keeps a raster, which is that of the canvas unless it is given, and draws the outline of the print. */
  private printed(given?: Raster): void {
    const drawn = rasterOfCanvas(this.pen);
    this.raster = given ?? drawn;
    const { grey, rows, columns } = drawn;
    const pen = this.outline.getContext("2d")!;
    const picture = pen.createImageData(columns, rows);
    const dark = (i: number): boolean => grey[i]! < 128;
    for (let y = 1; y < rows - 1; ++y) {
      for (let x = 1; x < columns - 1; ++x) {
        const i = y * columns + x;
        const edge = dark(i) && !(dark(i - 1) && dark(i + 1) && dark(i - columns) && dark(i + columns));
        if (edge) picture.data.set([110, 116, 124, 220], 4 * i);
      }
    }
    pen.putImageData(picture, 0, 0);
  }

  /** Blank paper of a width, mm. */
  private clear(width: number): void {
    const { pen, canvas, outline } = this;
    this.changes += 1;
    this.width = width;
    const [columns, rows] = [Math.round(width * RESOLUTION), Math.round(HEIGHT * RESOLUTION)];
    for (const one of [canvas, outline]) [one.width, one.height] = [columns, rows];
    pen.fillStyle = "#fff";
    pen.fillRect(0, 0, columns, rows);
    [pen.fillStyle, pen.strokeStyle] = ["#000", "#000"];
  }
}

/** A picture in shades of grey, as large as a page allows. Throws an error in words. */
export async function rasterOfPicture(file: Blob): Promise<Raster> {
  const picture = await createImageBitmap(file).catch(() => {
    throw new Error("is no picture that this browser shows");
  });
  if (picture.width * picture.height > LARGEST) {
    throw new Error(
      `must have at most ${LARGEST / 1e6} megapixels, got ${picture.width} × ${picture.height}`,
    );
  }
  const [width, height] = [usualWidth(), HEIGHT].map((size) => Math.round(size * RESOLUTION)) as [
    number,
    number,
  ];
  const [, pen] = canvasOf(width, height);
  const scale = Math.min(width / picture.width, height / picture.height);
  const [w, h] = [picture.width * scale, picture.height * scale];
  pen.fillStyle = "#fff";
  pen.fillRect(0, 0, width, height);
  pen.filter = "grayscale(1)";
  pen.drawImage(picture, (width - w) / 2, (height - h) / 2, w, h);
  return rasterOfCanvas(pen);
}

function canvasOf(columns: number, rows: number): [OffscreenCanvas, OffscreenCanvasRenderingContext2D] {
  const canvas = new OffscreenCanvas(columns, rows);
  return [canvas, canvas.getContext("2d", { willReadFrequently: true })!];
}

/** Luminance of a canvas in shades of grey. */
export function rasterOfCanvas(pen: OffscreenCanvasRenderingContext2D): Raster {
  const { width: columns, height: rows } = pen.canvas;
  const { data } = pen.getImageData(0, 0, columns, rows);
  const grey = new Uint8Array(rows * columns);
  for (let i = 0; i < grey.length; ++i) grey[i] = data[4 * i]!;
  return { grey, rows, columns, pixel: 1e-3 / RESOLUTION };
}
