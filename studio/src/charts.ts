// Curves over time, one below the other, with a common time axis, cursor, phases and events.
import uPlot from "uplot";
import { h } from "./dom";
import type { QuantityName } from "./motion";
import type { Channel } from "./recording";
import { columnAt, type Span } from "./sample";
import { SERIES, unitOf } from "./table";
import type { Look } from "./theme";
import { currentCurves, curvesOf, eventPath, isOpen, type Line, type View } from "./view";

interface Panel {
  readonly title: string;
  readonly symbol: string;
  readonly names: readonly QuantityName[];
  readonly channel: Channel | null;
}

const PANELS: readonly Panel[] = [
  { title: "Position", symbol: "x", names: ["position"], channel: "position" },
  { title: "Velocity", symbol: "x′", names: ["velocity"], channel: "velocity" },
  { title: "Acceleration", symbol: "x″", names: ["acceleration"], channel: "acceleration" },
  {
    title: "Friction of plate (line) and finger (dashes)",
    symbol: "R",
    names: ["plate_force", "finger_force"],
    channel: "force",
  },
  { title: "Force on the housing", symbol: "H", names: ["housing_force"], channel: null },
  { title: "Skin stretch", symbol: "s", names: ["stretch"], channel: null },
];
const LEAST = 5; // px of a span that is dragged
const MARKS = 200; // signs of events in one plot
const POINTS = 4000; // samples of a recording in one plot

export interface ChartActions {
  readonly cursor: (time: number) => void;
  /** Shows a span of the time axis, s; null: the whole axis. */
  readonly zoom: (span: Span | null) => void;
}

/** The panels over time. Times are in ms and values in display units. */
export class Charts {
  readonly element = h("div", { class: "charts" });
  private plots: { plot: uPlot; panel: Panel }[] = [];
  private structure = "";
  private view: View | null = null;
  private placing = false;

  constructor(
    private look: Look,
    private readonly actions: ChartActions,
  ) {
    new ResizeObserver(() => this.resize()).observe(this.element);
  }

  setLook(look: Look): void {
    this.look = look;
    this.structure = "";
    if (this.view) this.update(this.view);
  }

  update(view: View): void {
    this.view = view;
    const compliant = view.lines.some((line) => curvesOf(line)?.compliant);
    const structure = JSON.stringify([compliant, view.lines.map(({ kind, index }) => [kind, index])]);
    if (structure !== this.structure) {
      this.structure = structure;
      this.build(compliant ? PANELS : PANELS.slice(0, -1));
    }
    const times = currentTimes(view);
    const milliseconds = scaledColumn(times, 1e3);
    const [from, to] = view.span;
    const first = times.findIndex((time) => time >= from);
    const last = times.findLastIndex((time) => time <= to);
    const shown = <T>(column: readonly T[]): readonly T[] => column.slice(first, last + 1);
    for (const { plot, panel } of this.plots) {
      const columns = inOrder(view).flatMap((line) =>
        namesFor(panel, line).map((name) => column(line, name, times.length)),
      );
      plot.batch(() => {
        plot.setData([milliseconds, ...columns] as unknown as uPlot.AlignedData, false);
        plot.setScale("x", { min: 1e3 * view.span[0], max: 1e3 * view.span[1] });
        plot.setScale("y", extent(columns.map(shown), overlayOf(view, panel)));
      });
    }
    this.setCursor(view.state.cursor);
  }

  /** Puts the cursor of every panel at a time, s. */
  setCursor(time: number): void {
    this.placing = true;
    for (const { plot, panel } of this.plots) {
      const left = plot.valToPos(1e3 * time, "x");
      const curves = this.view && currentCurves(this.view);
      const value = curves ? columnAt(curves, panel.names[0]!, time) * scaleOf(panel.names[0]!) : NaN;
      plot.setCursor({ left, top: Number.isNaN(value) ? -10 : plot.valToPos(value, "y") }, false);
    }
    this.placing = false;
  }

  private build(panels: readonly Panel[]): void {
    for (const { plot } of this.plots) plot.destroy();
    this.element.replaceChildren();
    this.plots = panels.map((panel, i) => {
      const holder = h("div", { class: "chart" });
      this.element.append(holder);
      const plot = new uPlot(this.options(panel, i === panels.length - 1), [[0, 1]], holder);
      plot.root.setAttribute("role", "img");
      plot.root.setAttribute("aria-label", `${panel.title} over time`);
      return { plot, panel };
    });
  }

  private options(panel: Panel, last: boolean): uPlot.Options {
    const { look } = this;
    const { font } = look;
    const axis = { stroke: look.muted, font, grid: { stroke: look.grid, width: 1 }, ticks: { show: false } };
    const lines = inOrder(this.view!).flatMap((line) =>
      namesFor(panel, line).map((name, i) => series(line, name, i, look)),
    );
    return {
      width: Math.max(this.element.clientWidth, 200),
      height: this.heightOf(last),
      padding: [8, 12, 0, 0],
      legend: { show: false },
      scales: { x: { time: false, auto: false }, y: { auto: false } },
      cursor: {
        y: false,
        drag: { x: true, y: false, setScale: false },
        bind: {
          dblclick: () => () => {
            this.actions.zoom(null);
            return null;
          },
        },
        points: {
          size: 7,
          fill: (plot: uPlot, i: number) =>
            String((plot.series[i]!.stroke as (u: uPlot, i: number) => string)(plot, i)),
        },
      },
      axes: [
        {
          ...axis,
          size: last ? 20 : 8,
          values: last ? plainValues : () => [],
          label: last ? "time t, ms" : undefined,
          labelSize: 18,
          labelFont: font,
          gap: 2,
        },
        {
          ...axis,
          size: 52,
          values: plainValues,
          label: `${panel.symbol}, ${unitOf(SERIES.get(panel.names[0]!)!)}`,
          labelSize: 18,
          labelFont: font,
          gap: 3,
          space: 28,
        },
      ],
      series: [{}, ...lines],
      hooks: {
        drawAxes: [(plot) => this.drawPhases(plot), (plot) => this.drawRecording(plot, panel)],
        draw: [(plot) => this.drawMarks(plot, panel)],
        setSelect: [
          (plot) => {
            const { left, width } = plot.select;
            if (!(width > LEAST)) return;
            plot.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
            this.actions.zoom([plot.posToVal(left, "x") / 1e3, plot.posToVal(left + width, "x") / 1e3]);
          },
        ],
        setCursor: [
          (plot) => {
            const { left } = plot.cursor;
            if (this.placing || left === undefined || left === null || left < 0) return;
            this.actions.cursor(Math.max(0, plot.posToVal(left, "x") / 1e3));
          },
        ],
      },
    } as uPlot.Options;
  }

  private heightOf(last: boolean): number {
    const tall = Math.min(Math.max(window.innerHeight * 0.18, 120), 330);
    return Math.round(tall + (last ? 28 : 0));
  }

  private resize(): void {
    const width = this.element.clientWidth;
    if (width < 50) return;
    this.plots.forEach(({ plot }, i) => {
      const height = this.heightOf(i === this.plots.length - 1);
      if (plot.width !== width || plot.height !== height) plot.setSize({ width, height });
    });
    if (this.view) this.setCursor(this.view.state.cursor);
  }

  private drawPhases(plot: uPlot): void {
    const curves = this.view && currentCurves(this.view);
    if (!curves) return;
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    for (const { kind, begin, end } of curves.phases) {
      ctx.fillStyle = this.look.phases[kind]!;
      const [from, to] = [begin, end].map((time) => plot.valToPos(1e3 * time, "x", true)) as [number, number];
      ctx.fillRect(from, bbox.top, Math.max(to - from, 1), bbox.height);
    }
    ctx.restore();
  }

  /** Under the curves. */
  private drawRecording(plot: uPlot, panel: Panel): void {
    const overlay = this.view && overlayOf(this.view, panel);
    if (!overlay) return;
    const { ctx, bbox } = plot;
    const ratio = devicePixelRatio;
    ctx.fillStyle = this.look.recording;
    for (let i = 0; i < overlay.times.length; ++i) {
      const x = plot.valToPos(overlay.times[i]!, "x", true);
      if (x < bbox.left || x > bbox.left + bbox.width) continue;
      const y = plot.valToPos(overlay.values[i]!, "y", true);
      ctx.fillRect(x - ratio, y - ratio, 2 * ratio, 2 * ratio);
    }
  }

  private drawMarks(plot: uPlot, panel: Panel): void {
    const view = this.view;
    if (!view) return;
    const { ctx, bbox } = plot;
    const ratio = devicePixelRatio;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left - 6, bbox.top - 6, bbox.width + 12, bbox.height + 12);
    ctx.clip();
    const curves = currentCurves(view);
    if (curves && panel.names[0] !== "plate_force") {
      const name = panel.names[0]!;
      const [from, to] = view.span;
      const shown = curves.events.filter(({ time }) => time >= from && time <= to).slice(0, MARKS);
      for (const { kind, contact, time } of shown) {
        const value = columnAt(curves, name, time) * scaleOf(name);
        const [x, y] = [plot.valToPos(1e3 * time, "x", true), plot.valToPos(value, "y", true)];
        const color = this.look.events[kind]!;
        ctx.beginPath();
        for (const [i, [px, py]] of eventPath(kind, x, y, 4 * ratio).entries()) {
          if (i) ctx.lineTo(px, py);
          else ctx.moveTo(px, py);
        }
        ctx.closePath();
        ctx.fillStyle = isOpen(contact) ? this.look.surface : color;
        ctx.strokeStyle = color;
        ctx.lineWidth = 1.5 * ratio;
        ctx.fill();
        ctx.stroke();
      }
    }
    ctx.restore();
  }
}

/** Order of drawing: the current design last, over all others. */
function inOrder(view: View): Line[] {
  return [...view.lines].reverse();
}

function currentTimes(view: View): Float64Array {
  const found = view.lines.map(curvesOf).find((curves) => curves !== null);
  return found?.times ?? Float64Array.of(0, view.end);
}

function scaleOf(name: QuantityName): number {
  return SERIES.get(name)!.displayScale;
}

function scaledColumn(values: Float64Array, scale: number): Float64Array {
  return values.map((value) => value * scale);
}

/** Forces of the current design and the ghost alone: of more they would hide each other. */
function namesFor(panel: Panel, line: Line): readonly QuantityName[] {
  return panel.names.length > 1 && line.kind === "other" ? panel.names.slice(0, 1) : panel.names;
}

function column(line: Line, name: QuantityName, count: number): (number | null)[] {
  const values = curvesOf(line)?.columns[name];
  const scale = scaleOf(name);
  const found: (number | null)[] = new Array<number | null>(count).fill(null);
  if (values) for (let i = 0; i < count; ++i) found[i] = Number.isNaN(values[i]!) ? null : values[i]! * scale;
  return found;
}

function extent(
  columns: readonly (readonly (number | null)[])[],
  overlay: { readonly values: Float64Array } | null,
): { min: number; max: number } {
  let [min, max] = [0, 0];
  for (const values of columns) {
    for (const value of values) {
      if (value === null) continue;
      if (value < min) min = value;
      else if (value > max) max = value;
    }
  }
  for (const value of overlay?.values ?? []) [min, max] = [Math.min(min, value), Math.max(max, value)];
  const margin = (max - min || 1) * 0.08;
  return { min: min - margin, max: max + margin };
}

function series(line: Line, name: QuantityName, place: number, look: Look): uPlot.Series {
  const own = look.curves[line.index % look.curves.length]!;
  const dash = place > 0 ? [6, 4] : line.kind === "current" || line.kind === "ghost" ? [] : [...own.dash];
  const ghost = line.kind === "ghost";
  return {
    label: name,
    stroke: ghost ? look.ghost : own.color,
    width: ghost ? 3 : line.kind === "current" ? 1.75 : 1.4,
    dash: ghost && place > 0 ? [6, 4] : dash,
    points: { show: false },
  };
}

/** The samples of the recording that a panel shows, in its units. */
function overlayOf(view: View, panel: Panel): { times: Float64Array; values: Float64Array } | null {
  const { overlay } = view.state;
  if (!overlay || !panel.channel) return null;
  const { recording, offset } = overlay;
  const values = recording.channels[panel.channel];
  if (!values) return null;
  const step = Math.max(1, Math.ceil(values.length / POINTS));
  const scale = scaleOf(panel.names[0]!);
  const chosen = (i: number): boolean => i % step === 0;
  return {
    times: recording.times.filter((_, i) => chosen(i)).map((time) => 1e3 * (time - offset)),
    values: values.filter((_, i) => chosen(i)).map((value) => value * scale),
  };
}

function plainValues(_: uPlot, splits: number[]): string[] {
  return splits.map((value) => String(Number(value.toPrecision(6))).replace("-", "−"));
}
