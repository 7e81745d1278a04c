// The device at the time of the cursor: mouse, plate, electromagnet with pin, spring and finger.
import { Canvas } from "./canvas";
import { plateDistance } from "./design";
import { line } from "./phaseplane";
import { columnAt } from "./sample";
import type { Look } from "./theme";
import { currentCurves, type View } from "./view";

const NAMED = 260; // px of width from which the parts are named

export class Animation {
  private readonly canvas: Canvas;
  private view: View | null = null;
  /** Pixels for a metre of the pin's deflection, and its rest, in the last drawing. */
  private drawn: { readonly scale: number; readonly middle: number } | null = null;
  /** Scale while the pin is dragged: it stays as it was when the pin was taken. */
  private held: { readonly scale: number; readonly middle: number } | null = null;

  /** `pull` is called with the deflection to which the pin is dragged, m. */
  constructor(
    private look: Look,
    private readonly pull: (position: number) => void,
  ) {
    const label = "The device at the time of the cursor; the pin can be dragged";
    this.canvas = new Canvas("animation", label, 0.5, () => this.draw());
    const { element } = this.canvas;
    element.addEventListener("pointerdown", (event) => {
      element.setPointerCapture(event.pointerId);
      this.held = this.drawn;
      this.drag(event);
    });
    element.addEventListener("pointermove", (event) => this.drag(event));
    for (const kind of ["pointerup", "pointercancel"] as const) {
      element.addEventListener(kind, () => {
        this.held = null;
      });
    }
  }

  private drag(event: PointerEvent): void {
    if (!this.held) return;
    const across = event.clientX - this.canvas.element.getBoundingClientRect().left;
    const position = (across - this.held.middle) / this.held.scale;
    this.pull(Number(position.toPrecision(3)));
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
    const curves = view && currentCurves(view);
    if (!view || !canvas.width) return;
    const context = canvas.begin(look.font);
    if (!curves) return;
    const [w, height] = [canvas.width, canvas.height];
    const time = view.state.cursor;
    const positions = curves.columns.position!;
    let reach = 1e-6;
    for (const x of positions) if (Math.abs(x) > reach) reach = Math.abs(x);
    const scale = (0.2 * w) / reach; // pixels for a metre of the pin's deflection
    const x = columnAt(curves, "position", time);
    const sliding = columnAt(curves, "velocity", time);
    const middle = 0.54 * w;
    this.drawn = { scale, middle };
    const pin = middle + scale * x;
    const plateTop = 0.84 * height;
    const [top, bottom] = [0.3 * height, 0.78 * height];
    const phase = curves.phases.find(({ begin, end }) => time >= begin && time < end);

    context.textBaseline = "middle";
    context.textAlign = "left";
    // The plate passes under the mouse: its marks move with it.
    context.fillStyle = look.grid;
    context.fillRect(0, plateTop, w, height - plateTop);
    context.strokeStyle = look.muted;
    context.lineWidth = 1;
    const shift = scale * plateDistance(view.lines[0]!.values, time);
    const pitch = w / 14;
    for (let mark = (((shift % pitch) + pitch) % pitch) - pitch; mark < w + pitch; mark += pitch) {
      line(context, [
        [mark, height],
        [mark + 0.6 * (height - plateTop), plateTop],
      ]);
    }
    line(context, [
      [0, plateTop],
      [w, plateTop],
    ]);
    // The housing of the mouse, open below, with a hole for the pin.
    const travel = view.lines[0]!.values["drive.travel"];
    const thick = 0.012 * w; // half of the pin
    const slot = typeof travel === "number" ? scale * travel + thick : Infinity;
    const hole = Math.min(slot, 0.24 * w); // stops farther away are not in the picture
    context.strokeStyle = look.text;
    context.lineWidth = 2.5;
    for (const side of slot === hole ? [-1, 1] : []) {
      line(context, [
        [middle + side * hole, top - 0.03 * height],
        [middle + side * hole, top + 0.06 * height],
      ]);
    }
    line(context, [
      [0.06 * w, bottom],
      [0.06 * w, top],
      [middle - hole, top],
    ]);
    line(context, [
      [middle + hole, top],
      [0.96 * w, top],
      [0.96 * w, bottom],
    ]);
    // Spring and damper from the housing to the electromagnet.
    const magnet = 0.085 * w;
    const springY = 0.56 * height;
    const [from, to, coils] = [0.06 * w, pin - magnet, 9];
    context.lineWidth = 1.5;
    context.strokeStyle = look.text;
    const points: [number, number][] = [
      [from, springY],
      [from + 0.03 * w, springY],
    ];
    const begin = from + 0.03 * w;
    const part = (to - 0.02 * w - begin) / (2 * coils);
    for (let i = 0; i < 2 * coils; ++i)
      points.push([begin + (i + 0.5) * part, springY + (i % 2 ? 1 : -1) * 0.05 * height]);
    points.push([to - 0.02 * w, springY], [to, springY]);
    line(context, points);
    const damperY = 0.71 * height;
    const cup = from + 0.45 * (0.54 * w - magnet - from);
    const [open, piston] = [
      cup + 0.12 * w,
      Math.min(Math.max(cup + 0.06 * w + 0.4 * (pin - middle), cup + 5), cup + 0.11 * w),
    ];
    line(context, [
      [from, damperY],
      [cup, damperY],
    ]);
    line(context, [
      [open, damperY - 0.04 * height],
      [cup, damperY - 0.04 * height],
      [cup, damperY + 0.04 * height],
      [open, damperY + 0.04 * height],
    ]);
    line(context, [
      [piston, damperY - 0.03 * height],
      [piston, damperY + 0.03 * height],
    ]);
    line(context, [
      [piston, damperY],
      [to, damperY],
    ]);
    // Electromagnet and pin, in the colour of what they do.
    const name = {
      carried: "carried by the plate",
      resting: "at rest",
      gripping: "gripped by the skin",
    };
    context.fillStyle = look.curves[view.lines[0]!.index % look.curves.length]!.color;
    context.fillRect(pin - magnet, 0.48 * height, 2 * magnet, plateTop - 0.48 * height - 1);
    context.fillRect(pin - thick, top - 0.05 * height, 2 * thick, 0.25 * height);
    if (phase) {
      context.fillStyle = look.phases[phase.kind]!;
      context.fillRect(pin - magnet - 5, 0.48 * height - 5, 2 * magnet + 10, plateTop - 0.48 * height + 5);
    }
    // The finger rests on the housing; compliant skin follows the pin by its stretch.
    const stretch = curves.compliant ? columnAt(curves, "stretch", time) : 0;
    context.beginPath();
    context.ellipse(middle + scale * stretch, top - 0.15 * height, 0.3 * w, 0.13 * height, 0, 0, 2 * Math.PI);
    context.fillStyle = look.phases.resting!;
    context.fill();
    context.strokeStyle = look.muted;
    context.stroke();
    // Friction forces on the pin, as arrows.
    const largest = Math.max(
      ...(["plate_force", "finger_force"] as const).map((of) =>
        curves.columns[of]!.reduce((most, force) => Math.max(most, Math.abs(force) || 0), 0),
      ),
      1e-12,
    );
    arrow(
      context,
      pin,
      plateTop - 4,
      (columnAt(curves, "plate_force", time) / largest) * 0.2 * w,
      look.events.stick!,
    );
    arrow(
      context,
      pin,
      top - 0.02 * height,
      (columnAt(curves, "finger_force", time) / largest) * 0.2 * w,
      look.events.slip!,
    );
    this.label(context, pin);
    context.textBaseline = "middle";
    context.textAlign = "left";
    context.fillStyle = look.text;
    context.fillText(`${(1e3 * time).toFixed(2)} ms`, 8, 0.06 * height + 4);
    context.textAlign = "right";
    context.fillText(
      phase ? name[phase.kind] : Math.abs(sliding) > 0 ? "sliding" : "at rest",
      w - 8,
      0.06 * height + 4,
    );
  }

  /** Names the parts, where there is room for words. */
  private label(context: CanvasRenderingContext2D, pin: number): void {
    const { width: w, height } = this.canvas;
    if (w < NAMED) return;
    context.textBaseline = "middle";
    const plate = "plate, moving";
    context.fillStyle = this.look.grid;
    context.fillRect(0.01 * w, 0.87 * height, context.measureText(plate).width + 0.02 * w, 0.12 * height);
    context.fillStyle = this.look.text;
    const names: readonly (readonly [string, number, number, CanvasTextAlign])[] = [
      ["finger", 0.54 * w, 0.13 * height, "center"],
      ["mouse", 0.08 * w, 0.36 * height, "left"],
      ["spring", 0.16 * w, 0.46 * height, "left"],
      ["damper", 0.08 * w, 0.65 * height, "left"],
      ["pin", pin + 0.025 * w, 0.38 * height, "left"],
      [plate, 0.02 * w, 0.93 * height, "left"],
    ];
    for (const [name, x, y, align] of names) {
      context.textAlign = align;
      context.fillText(name, x, y);
    }
    context.textAlign = "center";
    context.fillStyle = this.look.surface;
    context.fillText("magnet", pin, 0.62 * height);
  }
}

function arrow(context: CanvasRenderingContext2D, x: number, y: number, length: number, color: string): void {
  if (Math.abs(length) < 1 || Number.isNaN(length)) return;
  const head = Math.sign(length) * Math.min(7, Math.abs(length));
  context.strokeStyle = context.fillStyle = color;
  context.lineWidth = 3;
  line(context, [
    [x, y],
    [x + length - head, y],
  ]);
  context.beginPath();
  context.moveTo(x + length, y);
  context.lineTo(x + length - head, y - 5);
  context.lineTo(x + length - head, y + 5);
  context.fill();
}
