// The curves as a picture for a paper: SVG, and PNG made of it.

import { ticks, tickText } from "./canvas";
import type { QuantityName } from "./motion";
import { columnAt } from "./sample";
import { SERIES, TABLES, unitOf } from "./table";
import { currentCurves, curvesOf, eventPath, isOpen, type View } from "./view";

const [WIDTH, HEIGHT, LEFT, RIGHT, TOP, GAP, BOTTOM] = [640, 150, 64, 12, 30, 14, 40];
const NAMES: readonly (readonly [QuantityName, string])[] = [
  ["position", "x"],
  ["velocity", "x′"],
  ["acceleration", "x″"],
  ["plate_force", "plate friction"],
  ["finger_force", "finger friction"],
  ["stretch", "skin stretch"],
];

/** The curves of all designs that are shown, on white, as SVG with text as text. */
export function figureSvg(view: View, title: string): string {
  const names = NAMES.filter(([name]) => view.lines.some((line) => curvesOf(line)?.columns[name]));
  const height = TOP + names.length * (HEIGHT + GAP) + BOTTOM;
  const panels = names.map(([name, symbol], i) => panel(view, name, symbol, TOP + i * (HEIGHT + GAP)));
  const bottom = TOP + names.length * (HEIGHT + GAP) - GAP;
  const toX = across(view);
  const [from, to] = view.span;
  const labels = ticks(1e3 * from, 1e3 * to, 7).map((time) =>
    label(toX(time / 1e3), bottom + 15, tickText(time), "middle"),
  );
  return [
    `<svg xmlns="http://www.w3.org/2000/svg" width="${WIDTH}" height="${height}" viewBox="0 0 ${WIDTH} ${height}" font-family="sans-serif" font-size="11">`,
    `<title>${escaped(title)}</title>`,
    `<rect width="100%" height="100%" fill="white"/>`,
    label(LEFT, 18, title, "start"),
    ...panels,
    ...labels,
    label((LEFT + WIDTH - RIGHT) / 2, height - 8, "time t, ms", "middle"),
    "</svg>",
  ].join("\n");
}

function across({ span: [from, to] }: View): (time: number) => number {
  return (time) => LEFT + ((time - from) / (to - from)) * (WIDTH - LEFT - RIGHT);
}

function panel(view: View, name: QuantityName, symbol: string, top: number): string {
  const quantity = SERIES.get(name)!;
  const scale = quantity.displayScale;
  const toX = across(view);
  const [from, to] = view.span;
  const within = (time: number): boolean => time >= from && time <= to;
  const lines = view.lines.flatMap((line) => {
    const curves = curvesOf(line);
    const column = curves?.columns[name];
    if (!column) return [];
    return [
      { line, times: curves.times.filter(within), values: column.filter((_, i) => within(curves.times[i]!)) },
    ];
  });
  let [min, max] = [0, 0];
  for (const { values } of lines) {
    for (const value of values)
      if (!Number.isNaN(value)) [min, max] = [Math.min(min, value), Math.max(max, value)];
  }
  const margin = 0.08 * (max - min || 1);
  const toY = (value: number): number => top + ((max + margin - value) / (max - min + 2 * margin)) * HEIGHT;
  const current = currentCurves(view);
  const { palette } = TABLES;
  const parts = [`<g data-quantity="${name}">`];
  for (const { kind, begin, end } of current?.phases ?? []) {
    if (end < from || begin > to) continue;
    const x = toX(Math.max(begin, from));
    const width = Math.max(toX(Math.min(end, to)) - x, 0.5);
    parts.push(
      `<rect x="${fixed(x)}" y="${top}" width="${fixed(width)}" height="${HEIGHT}" fill="${palette[kind]}" opacity="0.25"/>`,
    );
  }
  for (const tick of ticks((min - margin) * scale, (max + margin) * scale, 5)) {
    const y = toY(tick / scale);
    parts.push(
      `<path d="M${LEFT} ${fixed(y)}H${WIDTH - RIGHT}" stroke="#ddd" stroke-width="0.6"/>`,
      label(LEFT - 5, y + 4, tickText(tick), "end"),
    );
  }
  parts.push(
    `<path d="M${LEFT} ${top}V${top + HEIGHT}H${WIDTH - RIGHT}" fill="none" stroke="#000" stroke-width="0.6"/>`,
  );
  parts.push(
    `<text transform="translate(14 ${top + HEIGHT / 2}) rotate(-90)" text-anchor="middle">${symbol}, ${unitOf(quantity)}</text>`,
  );
  for (const { line, times, values } of [...lines].reverse()) {
    const own = TABLES.curves[line.index % TABLES.curves.length]!;
    const [color, width] = line.kind === "ghost" ? ["#aaa", 2.4] : [own.color, 1.3];
    const dash = line.kind === "other" && own.dash.length ? ` stroke-dasharray="${own.dash.join(" ")}"` : "";
    let path = "";
    values.forEach((value, i) => {
      if (!Number.isNaN(value)) path += `${path ? "L" : "M"}${fixed(toX(times[i]!))} ${fixed(toY(value))}`;
    });
    parts.push(
      `<path d="${path}" fill="none" stroke="${color}" stroke-width="${width}"${dash} data-line="${escaped(line.name)}"/>`,
    );
  }
  for (const { kind, contact, time } of current?.events.filter(({ time }) => within(time)).slice(0, 200) ??
    []) {
    const points = eventPath(kind, toX(time), toY(columnAt(current!, name, time)), 3);
    const color = palette[kind]!;
    parts.push(
      `<polygon points="${points.map((point) => point.map(fixed).join(",")).join(" ")}" fill="${isOpen(contact) ? "white" : color}" stroke="${color}"/>`,
    );
  }
  return `${parts.join("\n")}\n</g>`;
}

function label(x: number, y: number, text: string, anchor: string): string {
  return `<text x="${fixed(x)}" y="${fixed(y)}" text-anchor="${anchor}">${escaped(text)}</text>`;
}

function fixed(value: number): string {
  return value.toFixed(2);
}

function escaped(text: string): string {
  return text.replace(
    /[&<>"]/g,
    (sign) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[sign]!,
  );
}

/** Picture of SVG text, magnified. */
export async function pngOf(svg: string, scale = 3): Promise<Blob> {
  const image = new Image();
  image.src = `data:image/svg+xml;base64,${btoa(unescape(encodeURIComponent(svg)))}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [scale * image.width, scale * image.height];
  canvas.getContext("2d")!.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve, reject) => {
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("no picture could be made"))));
  });
}
