// A canvas as wide as its place and sharp on every screen.
import { h } from "./dom";

export class Canvas {
  readonly element: HTMLCanvasElement;
  width = 0;
  height = 0;

  /** `ratio`: height over width; `high`: or the height itself; `redraw` is called when the size has changed. */
  constructor(
    className: string,
    label: string,
    private ratio: number,
    private readonly redraw: () => void,
    private readonly high: number | null = null,
  ) {
    this.element = h("canvas", { class: className, role: "img", "aria-label": label });
    new ResizeObserver(() => this.resize()).observe(this.element);
  }

  /** Clears it; drawing is then in CSS pixels. */
  begin(font: string): CanvasRenderingContext2D {
    const context = this.element.getContext("2d")!;
    const scale = this.element.width / Math.max(this.width, 1);
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, this.width, this.height);
    context.font = font;
    return context;
  }

  setRatio(ratio: number): void {
    if (ratio === this.ratio) return;
    this.ratio = ratio;
    this.resize();
  }

  private resize(): void {
    const width = this.element.clientWidth;
    const height = this.high ?? Math.round(width * this.ratio);
    if (!width || (width === this.width && height === this.height)) return;
    [this.width, this.height] = [width, height];
    this.element.style.height = `${height}px`;
    const scale = Math.min(devicePixelRatio || 1, 3);
    this.element.width = Math.round(width * scale);
    this.element.height = Math.round(height * scale);
    this.redraw();
  }
}

/** Plain steps (1, 2, 5 times a power of ten) that cut an interval into about `count` parts. */
export function ticks(lower: number, upper: number, count: number): number[] {
  const rough = (upper - lower) / count;
  if (!(rough > 0) || !Number.isFinite(rough)) return [lower];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough)!;
  const found: number[] = [];
  for (let i = Math.ceil(lower / step); i * step <= upper * (1 + 1e-12); ++i) found.push(i * step);
  return found;
}

export function tickText(value: number): string {
  return String(Number(value.toPrecision(4))).replace("-", "−");
}
