// The deflection over time in little, for a place beside the sliders of a narrow screen.
import { Canvas } from "./canvas";
import type { Look } from "./theme";
import { curvesOf, type View } from "./view";

const HEIGHT = 72; // px
const EDGE = 4;

export class Sketch {
  private readonly canvas: Canvas;
  private view: View | null = null;

  constructor(private look: Look) {
    this.canvas = new Canvas("sketch", "Deflection over time", 0, () => this.draw(), HEIGHT);
  }

  get element(): HTMLElement {
    return this.canvas.element;
  }

  setLook(look: Look): void {
    this.look = look;
    this.draw();
  }

  update(view: View): void {
    this.view = view;
    this.draw();
  }

  private draw(): void {
    const { canvas, view, look } = this;
    if (!view || !canvas.width) return;
    const context = canvas.begin(look.font);
    const lines = view.lines.flatMap((line) => {
      const curves = curvesOf(line);
      return curves ? [{ line, curves, x: curves.columns.position! }] : [];
    });
    let [least, most] = [0, 0];
    for (const { x } of lines) for (const y of x) [least, most] = [Math.min(least, y), Math.max(most, y)];
    const toX = (time: number): number => (time / view.end) * canvas.width;
    const toY = (y: number): number => EDGE + ((most - y) / (most - least || 1)) * (canvas.height - 2 * EDGE);
    context.lineWidth = 1;
    context.strokeStyle = look.grid;
    stroke(context, [0, canvas.width], () => toY(0));
    for (const { line, curves, x } of [...lines].reverse()) {
      const color = look.curves[Math.max(line.index, 0) % look.curves.length]!.color;
      context.strokeStyle = line.kind === "ghost" ? look.ghost : color;
      context.lineWidth = line.kind === "current" ? 2 : 1;
      stroke(context, Array.from(curves.times, toX), (i) => toY(x[i]!));
    }
    context.strokeStyle = look.muted;
    context.lineWidth = 1;
    const cursor = toX(view.state.cursor);
    stroke(context, [cursor, cursor], (i) => i * canvas.height);
    context.fillStyle = look.muted;
    context.textBaseline = "top";
    context.textAlign = "right";
    context.fillText(`x, ${(1e3 * view.end).toPrecision(3)} ms`, canvas.width - 2, 2);
  }
}

function stroke(
  context: CanvasRenderingContext2D,
  across: readonly number[],
  y: (i: number) => number,
): void {
  context.beginPath();
  across.forEach((x, i) => {
    context.lineTo(x, y(i));
  });
  context.stroke();
}
