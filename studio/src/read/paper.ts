// The page under the hand: text, drawing, picture or lines, as a raster of luminance.
import type { Raster } from "./scan";

/** Pixels to the millimetre. */
export const RESOLUTION = 22;
const MARGIN = 5.5; // mm beside a text at least
const LETTERS = 13; // mm, largest size of the font
const PEN = 1.2; // mm
export const HEIGHT = 12.5; // mm

/** Place on the page, mm. */
export interface Spot {
  readonly x: number;
  readonly y: number;
}

const LARGEST = 4e7; // pixels of a picture, as of a page in Python

export class Paper {
  readonly canvas: OffscreenCanvas;
  /** The print in outline. */
  readonly outline: OffscreenCanvas;
  private readonly pen: OffscreenCanvasRenderingContext2D;
  raster: Raster;
  /** Description for reports and screen readers. */
  title = "blank paper";

  constructor(readonly width: number) {
    const [columns, rows] = [Math.round(width * RESOLUTION), Math.round(HEIGHT * RESOLUTION)];
    this.canvas = new OffscreenCanvas(columns, rows);
    this.outline = new OffscreenCanvas(columns, rows);
    this.pen = this.canvas.getContext("2d", { willReadFrequently: true })!;
    this.clear();
    this.raster = this.read();
  }

  text(words: string): void {
    const { pen } = this;
    this.clear();
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
    this.printed();
  }

  /** Vertical lines at places with widths, mm. */
  lines(lines: readonly (readonly [number, number])[]): void {
    this.clear();
    this.title = lines.length === 1 ? "one line" : `${lines.length} lines`;
    for (const [x, width] of lines) {
      this.pen.fillRect(x * RESOLUTION, RESOLUTION, width * RESOLUTION, (HEIGHT - 2) * RESOLUTION);
    }
    this.printed();
  }

  /** A picture in shades of grey, as large as the page allows. */
  async picture(file: Blob, name: string): Promise<void> {
    const picture = await createImageBitmap(file).catch(() => {
      throw new Error("is no picture that this browser shows");
    });
    if (picture.width * picture.height > LARGEST) {
      throw new Error(
        `must have at most ${LARGEST / 1e6} megapixels, got ${picture.width} × ${picture.height}`,
      );
    }
    const { width, height } = this.canvas;
    const scale = Math.min(width / picture.width, height / picture.height);
    const [w, h] = [picture.width * scale, picture.height * scale];
    this.clear();
    this.title = name;
    this.pen.filter = "grayscale(1)";
    this.pen.drawImage(picture, (width - w) / 2, (height - h) / 2, w, h);
    this.pen.filter = "none";
    this.printed();
  }

  /** Blank paper to draw on. */
  blank(): void {
    this.clear();
    this.title = "a drawing";
    this.printed();
  }
  /** Draws from one spot to another; `printed` ends a stroke. */
  draw(from: Spot, to: Spot): void {
    const { pen } = this;
    [pen.lineWidth, pen.lineCap] = [PEN * RESOLUTION, "round"];
    pen.beginPath();
    pen.moveTo(from.x * RESOLUTION, from.y * RESOLUTION);
    pen.lineTo(to.x * RESOLUTION, to.y * RESOLUTION);
    pen.stroke();
  }

  /** A page that was saved. */
  show(raster: Raster, title: string): void {
    this.clear();
    this.title = title;
    const picture = this.pen.createImageData(raster.columns, raster.rows);
    raster.grey.forEach((grey, i) => {
      picture.data.set([grey, grey, grey, 255], 4 * i);
    });
    this.pen.putImageData(picture, 0, 0);
    this.printed();
  }

  /** Reads the raster, and draws the outline of the print. */
  printed(): void {
    this.raster = this.read();
    const { grey, rows, columns } = this.raster;
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

  private clear(): void {
    const { pen, canvas } = this;
    pen.fillStyle = "#fff";
    pen.fillRect(0, 0, canvas.width, canvas.height);
    [pen.fillStyle, pen.strokeStyle] = ["#000", "#000"];
  }

  private read(): Raster {
    const { width: columns, height: rows } = this.canvas;
    const { data } = this.pen.getImageData(0, 0, columns, rows);
    const grey = Uint8Array.from({ length: rows * columns }, (_, i) => data[4 * i]!);
    return { grey, rows, columns, pixel: 1e-3 / RESOLUTION };
  }
}
