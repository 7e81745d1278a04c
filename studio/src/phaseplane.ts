// Velocity over position, with the plate's velocity, events and the cursor.
import { Canvas, ticks, tickText } from "./canvas";
import { plateVelocity } from "./design";
import { columnAt } from "./sample";
import type { Look } from "./theme";
import { currentCurves, curvesOf, eventPath, isOpen, type View } from "./view";

const [LEFT, RIGHT, TOP, BOTTOM] = [56, 10, 10, 38];

export class PhasePlane {
  private readonly canvas: Canvas;
  private view: View | null = null;

  constructor(private look: Look) {
    this.canvas = new Canvas("phase-plane", "Phase plane: velocity over position", 0.72, () => this.draw());
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

  draw(): void {
    const { canvas, view, look } = this;
    if (!view || !canvas.width) return;
    const context = canvas.begin(look.font);
    const lines = view.lines.flatMap((line) => {
      const curves = curvesOf(line);
      return curves ? [{ line, curves, x: curves.columns.position!, y: curves.columns.velocity! }] : [];
    });
    if (!lines.length) return;
    const speed = plateVelocity(view.lines[0]!.values, view.state.cursor);
    const [xs, ys] = [
      bounds(
        lines.map(({ x }) => x),
        0,
        1e3,
      ),
      bounds(
        lines.map(({ y }) => y),
        speed,
        1e3,
      ),
    ];
    const toX = (x: number): number => LEFT + ((x - xs[0]) / (xs[1] - xs[0])) * (canvas.width - LEFT - RIGHT);
    const toY = (y: number): number => TOP + ((ys[1] - y) / (ys[1] - ys[0])) * (canvas.height - TOP - BOTTOM);
    context.lineWidth = 1;
    context.strokeStyle = look.grid;
    context.fillStyle = look.muted;
    context.textAlign = "center";
    context.textBaseline = "top";
    for (const tick of ticks(...xs, Math.max(3, canvas.width / 90))) {
      line(context, [
        [toX(tick), TOP],
        [toX(tick), canvas.height - BOTTOM],
      ]);
      context.fillText(tickText(tick), toX(tick), canvas.height - BOTTOM + 4);
    }
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const tick of ticks(...ys, Math.max(3, canvas.height / 50))) {
      line(context, [
        [LEFT, toY(tick)],
        [canvas.width - RIGHT, toY(tick)],
      ]);
      context.fillText(tickText(tick), LEFT - 5, toY(tick));
    }
    context.textAlign = "center";
    context.fillText("x, mm", (LEFT + canvas.width - RIGHT) / 2, canvas.height - 8);
    context.save();
    context.translate(9, (TOP + canvas.height - BOTTOM) / 2);
    context.rotate(-Math.PI / 2);
    context.fillText("x′, mm/s", 0, 0);
    context.restore();

    context.strokeStyle = look.muted;
    context.setLineDash([3, 3]);
    line(context, [
      [LEFT, toY(1e3 * speed)],
      [canvas.width - RIGHT, toY(1e3 * speed)],
    ]);
    context.fillStyle = look.muted;
    context.textAlign = "right";
    context.textBaseline = "bottom";
    context.fillText("plate", canvas.width - RIGHT - 2, toY(1e3 * speed) - 2);
    context.setLineDash([]);
    for (const { line: of, x, y } of [...lines].reverse()) {
      const own = look.curves[of.index % look.curves.length]!;
      context.strokeStyle = of.kind === "ghost" ? look.ghost : own.color;
      context.lineWidth = of.kind === "ghost" ? 3 : of.kind === "current" ? 1.75 : 1.3;
      context.setLineDash(of.kind === "other" ? [...own.dash] : []);
      context.beginPath();
      let begun = false;
      for (let i = 0; i < x.length; ++i) {
        if (Number.isNaN(x[i]!)) continue;
        const [px, py] = [toX(1e3 * x[i]!), toY(1e3 * y[i]!)];
        if (begun) context.lineTo(px, py);
        else context.moveTo(px, py);
        begun = true;
      }
      context.stroke();
    }
    context.setLineDash([]);
    const curves = currentCurves(view);
    if (!curves) return;
    for (const { kind, contact, position, velocity } of curves.events.slice(0, 200)) {
      const color = look.events[kind]!;
      path(context, eventPath(kind, toX(1e3 * position), toY(1e3 * velocity), 4));
      context.fillStyle = isOpen(contact) ? look.surface : color;
      context.strokeStyle = color;
      context.lineWidth = 1.5;
      context.fill();
      context.stroke();
    }
    const [x, v] = (["position", "velocity"] as const).map((name) =>
      columnAt(curves, name, view.state.cursor),
    ) as [number, number];
    context.beginPath();
    context.arc(toX(1e3 * x), toY(1e3 * v), 5, 0, 2 * Math.PI);
    context.fillStyle = look.curves[view.lines[0]!.index % look.curves.length]!.color;
    context.fill();
    context.strokeStyle = look.surface;
    context.lineWidth = 2;
    context.stroke();
  }
}

function bounds(columns: readonly Float64Array[], also: number, scale: number): [number, number] {
  let [lower, upper] = [also, also];
  for (const column of columns) {
    for (const value of column) {
      if (value < lower) lower = value;
      if (value > upper) upper = value;
    }
  }
  const margin = (upper - lower || 1e-3) * 0.08;
  return [(lower - margin) * scale, (upper + margin) * scale];
}

export function path(
  context: CanvasRenderingContext2D,
  points: readonly (readonly [number, number])[],
): void {
  context.beginPath();
  points.forEach(([x, y], i) => {
    if (i) context.lineTo(x, y);
    else context.moveTo(x, y);
  });
  context.closePath();
}

export function line(
  context: CanvasRenderingContext2D,
  points: readonly (readonly [number, number])[],
): void {
  context.beginPath();
  points.forEach(([x, y], i) => {
    if (i) context.lineTo(x, y);
    else context.moveTo(x, y);
  });
  context.stroke();
}
