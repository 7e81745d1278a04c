// The page with the device on it, at the scale of the page: a clamped pin stays on the print.
import type { Felt } from "./felt";
import { drawOutcomes } from "./outcomes";
import type { Paper } from "./paper";
import { disc, magnetRing, offsetOf, type Pen, type Picture, pullOf, ring } from "./picture";
import type { Line } from "./scan";

const PIN = 0.46e-3; // m, radius of a pin
const ROOM = 1.6e-3; // m of the housing around the spots

/** The page in the colour of its paper, until either is another. */
class Tinted {
  private readonly canvas = new OffscreenCanvas(1, 1);
  private of: unknown[] = [];

  at(paper: Paper, color: string): OffscreenCanvas {
    const of = [paper.raster, paper.changes, color];
    if (of.every((one, i) => one === this.of[i])) return this.canvas;
    this.of = of;
    const { width, height } = paper.canvas;
    [this.canvas.width, this.canvas.height] = [width, height];
    const pen = this.canvas.getContext("2d")!;
    pen.drawImage(paper.canvas, 0, 0);
    pen.globalCompositeOperation = "multiply";
    pen.fillStyle = color;
    pen.fillRect(0, 0, width, height);
    return this.canvas;
  }
}
const tinted = new Tinted();

/** The page with the device and the marks of lines. */
export function drawPage(
  pen: CanvasRenderingContext2D,
  width: number,
  paper: Paper,
  sheet: string,
  picture: Picture | null,
  lines: readonly Line[],
): void {
  const scale = width / (paper.width * 1e-3);
  const height = (width * paper.canvas.height) / paper.canvas.width;
  pen.drawImage(tinted.at(paper, sheet), 0, 0, width, height);
  drawOutcomes(pen, scale, lines);
  if (!picture) return;
  drawDevice(pen, scale, picture);
  if (picture.intended) drawRuler(pen, scale, height, picture.hand.x, picture.intended.x);
}

/** The mark of a ruler where the hand is meant to be, and how far the mouse is from it. */
function drawRuler(pen: Pen, scale: number, height: number, hand: number, intended: number): void {
  const [from, to, y] = [hand * scale, intended * scale, height - 9];
  [pen.strokeStyle, pen.fillStyle, pen.lineWidth, pen.lineCap] = ["#a0306a", "#a0306a", 2, "butt"];
  pen.beginPath();
  for (const [x0, y0, x1, y1] of [
    [to, 0, to, height],
    [from, y, to, y],
    [from, y - 4, from, y + 4],
  ] as const) {
    pen.moveTo(x0, y0);
    pen.lineTo(x1, y1);
  }
  pen.stroke();
  const apart = 1e3 * (intended - hand);
  if (Math.abs(apart) < 0.05) return;
  pen.textAlign = apart > 0 ? "right" : "left";
  pen.fillText(`${Math.abs(apart).toFixed(1)} mm`, to + (apart > 0 ? -5 : 5), y - 6);
}

function drawDevice(pen: Pen, scale: number, picture: Picture): void {
  const { hand, spots } = picture;
  const [xs, ys] = [spots.map(([x]) => x), spots.map(([, y]) => y)];
  const [left, top] = [Math.min(...xs) - ROOM, Math.min(...ys) - ROOM];
  const [wide, high] = [Math.max(...xs) + ROOM - left, Math.max(...ys) + ROOM - top];
  pen.beginPath();
  pen.roundRect((hand.x + left) * scale, (hand.y + top) * scale, wide * scale, high * scale, 1.3e-3 * scale);
  pen.fillStyle = "rgb(0 114 178 / 0.07)";
  pen.fill();
  [pen.strokeStyle, pen.lineWidth] = ["rgb(0 114 178 / 0.65)", 1.5];
  pen.stroke();
  spots.forEach(([dx, dy], pin) => {
    drawPin(pen, (hand.x + dx) * scale, (hand.y + dy) * scale, scale, picture, pin);
  });
}

function drawPin(pen: Pen, x: number, y: number, scale: number, picture: Picture, pin: number): void {
  const [ox, oy] = offsetOf(picture, pin).map((part) => part * scale) as [number, number];
  const dragged = Math.hypot(ox, oy) > 1;
  for (const [color, wide] of [
    ["rgb(255 255 255 / 0.8)", 5],
    [dragged ? "#0072b2" : "rgb(90 97 106 / 0.7)", 3],
  ] as const) {
    [pen.strokeStyle, pen.lineWidth, pen.lineCap] = [color, wide, "round"];
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(x + ox, y + oy);
    pen.stroke();
  }
  disc(pen, x, y, Math.max(1.6, 1e-4 * scale), "#fff");
  ring(pen, x, y, Math.max(1.6, 1e-4 * scale), "#5a616a", 1);
  const radius = PIN * scale;
  const light = { ...picture, colors: { ...picture.colors, magnet: "#d55e00" } }; // on white paper
  magnetRing(pen, light, pin, x + ox, y + oy, radius + 3.5);
  disc(pen, x + ox, y + oy, radius, pullOf(picture, pin) > 0.5 ? "#ffd9bf" : "#fff");
  ring(pen, x + ox, y + oy, radius, "#2b3036", 1.5);
  if (pin === picture.chosen) disc(pen, x + ox, y + oy, 0.42 * radius, "#2b3036");
}

/** The tactile image in the place and at the scale of the page, with the print in outline. */
export function drawFelt(pen: Pen, width: number, paper: Paper, felt: Felt, picture: Picture | null): void {
  const height = (width * paper.canvas.height) / paper.canvas.width;
  pen.drawImage(felt.canvas, 0, 0, width, height);
  pen.drawImage(paper.outline, 0, 0, width, height);
  if (!picture) return;
  const x = (picture.hand.x / (paper.width * 1e-3)) * width;
  pen.setLineDash([4, 4]);
  [pen.strokeStyle, pen.lineWidth] = ["rgb(0 114 178 / 0.5)", 1];
  pen.beginPath();
  pen.moveTo(x, 0);
  pen.lineTo(x, height);
  pen.stroke();
  pen.setLineDash([]);
}
