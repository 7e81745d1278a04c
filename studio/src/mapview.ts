// The live map of a number over two parameters, with the current design as a dot to be dragged.
import { Canvas, tickText } from "./canvas";
import { h } from "./dom";
import type { Axes } from "./map";
import { type MapResult, SIZE } from "./mapgrid";
import { partOf, type Range, valueAt } from "./range";
import { DRIVE, digits, label, NUMBERS, text, unitOf } from "./table";
import { type Look, mapColor } from "./theme";

const [LEFT, RIGHT, TOP, BOTTOM] = [56, 74, 10, 40];

export interface MapShown {
  readonly x: string;
  readonly y: string;
  readonly axes: Axes;
  readonly at: readonly [number, number];
  readonly number: string;
  readonly limited: boolean;
}

export class MapView {
  readonly element = h("div", { class: "map-holder" });
  private readonly canvas: Canvas;
  private readonly image = document.createElement("canvas");
  private readonly words = h("p", { class: "note", id: "map-words" });
  /** Values at the point under the pointer. */
  private readonly pointed = h("output", { class: "note pointed" });
  private shown: MapShown | null = null;
  private result: MapResult | null = null;
  private range: readonly [number, number] = [NaN, NaN];
  private ends: readonly [string, string] = ["", ""];

  constructor(
    private look: Look,
    private readonly moved: (x: number, y: number) => void,
  ) {
    this.canvas = new Canvas("map", "Map", 0.78, () => this.draw());
    const { element } = this.canvas;
    // A group with a description: arrow keys move the dot, as dragging does.
    element.setAttribute("role", "application");
    element.setAttribute("aria-roledescription", "map");
    element.setAttribute("aria-describedby", "map-words");
    element.tabIndex = 0;
    this.element.append(element, this.pointed, this.words);
    this.image.width = this.image.height = SIZE;
    const drag = (event: PointerEvent): void => {
      if (event.type === "pointerdown") element.setPointerCapture(event.pointerId);
      if (event.type === "pointermove" && !element.hasPointerCapture(event.pointerId)) return;
      const box = element.getBoundingClientRect();
      this.moveTo(event.clientX - box.left, event.clientY - box.top);
    };
    element.addEventListener("pointerdown", drag);
    element.addEventListener("pointermove", drag);
    element.addEventListener("pointermove", (event) => this.point(event));
    element.addEventListener("pointerleave", () => {
      this.pointed.textContent = "";
    });
    element.addEventListener("keydown", (event) => this.key(event));
  }

  /** Tells the number at the point of the grid under the pointer. */
  private point(event: PointerEvent): void {
    const { shown, result } = this;
    if (!shown || !result) return;
    const { left, top } = this.canvas.element.getBoundingClientRect();
    const { width, height } = this.box;
    const column = Math.round(((event.clientX - left - LEFT) / width) * SIZE - 0.5);
    const row = Math.round((1 - (event.clientY - top - TOP) / height) * SIZE - 0.5);
    const inside = [column, row].every((place) => place >= 0 && place < SIZE);
    const at = (range: Range, place: number, key: string): string =>
      text(DRIVE.get(key)!, valueAt(range, (place + 0.5) / SIZE));
    const { x, y, axes, number } = shown;
    const quantity = NUMBERS.get(number)!;
    this.pointed.textContent = inside
      ? `${text(quantity, result.values[row * SIZE + column]!)} at ${at(axes.x, column, x)}, ${at(axes.y, row, y)}`
      : "";
  }

  setLook(look: Look): void {
    this.look = look;
    this.draw();
  }

  /** Next picture; the colours stay until a result arrives. */
  show(shown: MapShown): void {
    this.shown = shown;
    const [x, y] = [DRIVE.get(shown.x)!, DRIVE.get(shown.y)!];
    this.canvas.element.setAttribute(
      "aria-label",
      `${label(NUMBERS.get(shown.number)!)} over ${x.name} and ${y.name}`,
    );
    this.draw();
  }

  setResult(result: MapResult): void {
    this.result = result;
    const finite = result.values.filter(Number.isFinite).sort();
    const [least, most] = [finite[0] ?? NaN, finite[finite.length - 1] ?? NaN];
    // A few points far out would take all the colours: the scale ends before them.
    const [low, high] = [0.02, 0.98].map((part) => finite[Math.round(part * (finite.length - 1))] ?? NaN) as [
      number,
      number,
    ];
    const far = most - least > 2 * (high - low) && high > low;
    const [lower, upper] = far ? [low, high] : [least, most];
    this.range = [lower, upper];
    this.ends = [least < lower ? "≤ " : "", most > upper ? "≥ " : ""];
    const context = this.image.getContext("2d")!;
    const pixels = context.createImageData(SIZE, SIZE);
    const span = upper - lower || 1;
    for (let p = 0; p < SIZE * SIZE; ++p) {
      const value = result.values[p]!;
      const at = 4 * ((SIZE - 1 - Math.floor(p / SIZE)) * SIZE + (p % SIZE));
      const missing = Number.isNaN(value);
      const color = missing ? [128, 128, 128] : mapColor((value - lower) / span);
      // Regions outside of the specification are paler, in stripes of the grid.
      const striped = ((p % SIZE) + Math.floor(p / SIZE)) % 4 < 2;
      const outside = this.shown?.limited === true && !result.met[p];
      for (let c = 0; c < 3; ++c) pixels.data[at + c] = color[c]!;
      pixels.data[at + 3] = missing ? 60 : outside ? (striped ? 80 : 130) : 255;
    }
    context.putImageData(pixels, 0, 0);
    const number = this.shown ? NUMBERS.get(this.shown.number)! : null;
    const met = result.met.reduce((sum, one) => sum + one, 0);
    const extent =
      number && finite.length ? `from ${text(number, least)} to ${text(number, most)}` : "has no value here";
    const share = this.shown?.limited
      ? `; ${Math.round((100 * met) / result.met.length)} % of the points meet the specification`
      : "";
    this.words.textContent = number
      ? `${label(number)} ${extent}${share}. Drag the dot, or move it with the arrow keys.`
      : "";
    this.draw();
  }

  private get box(): { width: number; height: number } {
    return { width: this.canvas.width - LEFT - RIGHT, height: this.canvas.height - TOP - BOTTOM };
  }

  private moveTo(left: number, top: number): void {
    if (!this.shown) return;
    const { width, height } = this.box;
    const inside = (part: number): number => Math.min(Math.max(part, 0.001), 1);
    const { x, y } = this.shown.axes;
    this.moved(valueAt(x, inside((left - LEFT) / width)), valueAt(y, inside(1 - (top - TOP) / height)));
  }

  private key(event: KeyboardEvent): void {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] }[event.key];
    if (!step || !this.shown) return;
    event.preventDefault();
    const { at, axes } = this.shown;
    const size = event.shiftKey ? 0.1 : 0.01;
    const next = (range: Range, value: number, by: number): number => {
      const part = Math.min(Math.max(partOf(range, value) + by * size, 0.001), 1);
      return by ? valueAt(range, part) : value;
    };
    this.moved(next(axes.x, at[0], step[0]!), next(axes.y, at[1], step[1]!));
  }

  private draw(): void {
    const { canvas, shown, look } = this;
    if (!shown || !canvas.width) return;
    const context = canvas.begin(look.font);
    const { width, height } = this.box;
    context.imageSmoothingEnabled = false;
    context.drawImage(this.image, LEFT, TOP, width, height);
    context.fillStyle = look.muted;
    context.strokeStyle = look.grid;
    context.strokeRect(LEFT, TOP, width, height);
    this.axis(context, shown.x, shown.axes.x, (part) => [LEFT + part * width, TOP + height + 5], "center");
    this.axis(context, shown.y, shown.axes.y, (part) => [LEFT - 5, TOP + (1 - part) * height], "right");
    this.colourBar(context, LEFT + width + 12, height);
    const [px, py] = [
      LEFT + partOf(shown.axes.x, shown.at[0]) * width,
      TOP + (1 - partOf(shown.axes.y, shown.at[1])) * height,
    ];
    for (const [radius, color] of [
      [8, "#000000"],
      [6.5, "#ffffff"],
      [4, look.curves[1]!.color],
    ] as const) {
      context.beginPath();
      context.arc(px, py, radius, 0, 2 * Math.PI);
      context.fillStyle = color;
      context.fill();
    }
  }

  private axis(
    context: CanvasRenderingContext2D,
    key: string,
    range: Range,
    place: (part: number) => [number, number],
    align: CanvasTextAlign,
  ): void {
    const quantity = DRIVE.get(key)!;
    const across = align === "center";
    context.textAlign = align;
    context.textBaseline = across ? "top" : "middle";
    let end = -Infinity; // end of the last text along a narrow axis
    for (const value of axisTicks(range)) {
      const words = tickText(value * quantity.displayScale);
      const [x, y] = place(partOf(range, value));
      const half = context.measureText(words).width / 2;
      if (across && x - half < end) continue;
      end = x + half + 4;
      context.fillText(words, x, y);
    }
    const name = `${symbolOf(key)}${unitOf(quantity) ? `, ${unitOf(quantity)}` : ""}`;
    const [x, y] = place(0.5);
    context.save();
    context.textAlign = "center";
    context.translate(across ? x : 8, across ? y + 17 : y);
    if (!across) context.rotate(-Math.PI / 2);
    context.fillText(name, 0, 0);
    context.restore();
  }

  private colourBar(context: CanvasRenderingContext2D, left: number, height: number): void {
    const number = NUMBERS.get(this.shown!.number)!;
    for (let i = 0; i < 64; ++i) {
      context.fillStyle = `rgb(${mapColor(1 - i / 63).join(" ")})`;
      context.fillRect(left, TOP + (i * height) / 64, 10, height / 64 + 1);
    }
    context.fillStyle = this.look.muted;
    context.textAlign = "left";
    context.textBaseline = "middle";
    const [lower, upper] = this.range;
    if (Number.isNaN(lower)) return;
    const [below, above] = this.ends;
    for (const [part, value, sign] of [
      [0, upper, above],
      [0.5, (upper + lower) / 2, ""],
      [1, lower, below],
    ] as const) {
      context.fillText(
        `${sign}${digits(value * number.displayScale, 3)}`,
        left + 14,
        TOP + 6 + part * (height - 12),
      );
    }
    context.fillText(unitOf(number), left, TOP + height + 12);
  }
}

function symbolOf(key: string): string {
  const { symbol, name } = DRIVE.get(key)!;
  return `${name.replaceAll("_", " ").replace(".", " ")} ${symbol.replace("_", "")}`;
}

/** Plain values along an axis: of a logarithmic one the powers of ten and a few between. */
function axisTicks(range: Range): number[] {
  if (!range.logarithmic) {
    const reach = Math.max(-range.lower, range.upper);
    const ticks = [-0.8, -0.4, 0, 0.4, 0.8].map((part) => part * reach);
    return ticks.filter((value) => value >= range.lower && value <= range.upper);
  }
  const found: number[] = [];
  for (let power = Math.floor(Math.log10(range.lower)); 10 ** power <= range.upper; ++power) {
    for (const m of [1, 2, 5]) {
      const value = m * 10 ** power;
      if (value >= range.lower * 0.999 && value <= range.upper * 1.001) found.push(value);
    }
  }
  return found;
}
