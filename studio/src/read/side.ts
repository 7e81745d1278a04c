// One pin from the side: mouse, spring, magnet, plate with its print, and skin; below, its last moments.
import type { Paper } from "./paper";
import { RESOLUTION } from "./paper";
import { offsetOf, type Pen, type Picture, pullOf } from "./picture";
import type { Sample } from "./session";

const SHOWN = 9.5; // mm from left to right
const LAST = 0.15; // s of the trace
const STRETCHED = 4; // times that the stretch of skin is drawn larger

export function drawSide(
  pen: Pen,
  width: number,
  height: number,
  paper: Paper,
  picture: Picture,
  samples: readonly Sample[],
  dark: (sample: Sample) => boolean,
): void {
  const chart = 84;
  drawScene(pen, width, height - chart, paper, picture);
  drawTrace(pen, width, height - chart, chart, picture, samples, dark);
}

function drawScene(pen: Pen, width: number, height: number, paper: Paper, picture: Picture): void {
  const { colors, look, hand, chosen } = picture;
  const scale = width / SHOWN; // pixels to the mm
  const rest = 0.56 * width;
  const [ox, oy] = offsetOf(picture, chosen);
  const x = rest + Math.sign(ox * picture.axis[0] + oy * picture.axis[1]) * Math.hypot(ox, oy) * 1e3 * scale;
  const pull = pullOf(picture, chosen);
  const plate = height - 34;
  const top = plate - 2.05 * scale;
  const [sx, sy] = [(hand.x + picture.spots[chosen]![0]) * 1e3, (hand.y + picture.spots[chosen]![1]) * 1e3];
  const box = (left: number, up: number, wide: number, high: number, fill: string, stroke: string): void => {
    pen.beginPath();
    pen.rect(left, up, wide, high);
    [pen.fillStyle, pen.strokeStyle, pen.lineWidth] = [fill, stroke, 1.4];
    pen.fill();
    pen.stroke();
  };
  // the plate, and the print as it goes by
  pen.fillStyle = look.dark ? "#4a515b" : "#c9ced5";
  pen.fillRect(0, plate, width, 15);
  [pen.strokeStyle, pen.lineWidth] = [look.dark ? "#6a727d" : "#aab1ba", 1];
  for (let k = -2; k < 2 * SHOWN + 4; ++k) {
    const at = (0.5 * k - (((sx % 0.5) + 0.5) % 0.5)) * scale;
    pen.beginPath();
    pen.moveTo(at, plate + 15);
    pen.lineTo(at + 9, plate);
    pen.stroke();
  }
  const row = Math.round(sy * RESOLUTION);
  if (row >= 0 && row < paper.canvas.height) {
    const left = (sx - rest / scale) * RESOLUTION;
    pen.drawImage(paper.canvas, left, row, SHOWN * RESOLUTION, 1, 0, plate - 1, width, 6);
  }
  // the housing with its slot
  const slot = 1.6 * scale;
  const [shell, edge] = look.dark ? ["#2b3037", "#7c8591"] : ["#eef0f3", "#8b929c"];
  box(8, top, rest - slot - 8, 12, shell, edge);
  box(rest + slot, top, width - 8 - rest - slot, 12, shell, edge);
  box(8, top, 12, plate - top - 8, shell, edge);
  box(width - 20, top, 12, plate - top - 8, shell, edge);
  // spring, magnet and pin
  const half = 0.85 * scale;
  const up = plate - 1.25 * scale;
  const middle = up + 0.45 * scale;
  const [from, to] = [20, x - half];
  [pen.strokeStyle, pen.lineWidth] = [look.muted, 2];
  pen.beginPath();
  pen.moveTo(from, middle);
  for (let k = 0; k <= 12; ++k) {
    const swing = k > 0 && k < 12 ? (k % 2 ? -8 : 8) : 0;
    pen.lineTo(from + 8 + ((to - from - 16) * k) / 12, middle + swing);
  }
  pen.lineTo(to, middle);
  pen.stroke();
  if (pull > 0.02) {
    pen.globalAlpha = 0.3 * pull;
    pen.fillStyle = colors.magnet;
    pen.beginPath();
    pen.ellipse(x, plate, 1.35 * half, 13, 0, 0, 2 * Math.PI);
    pen.fill();
    pen.globalAlpha = 1;
  }
  const commanded = picture.sample.values.command[chosen] === 1;
  box(
    x - half,
    up,
    2 * half,
    plate - up - 1,
    look.dark ? "#3a4048" : "#c8cdd4",
    commanded ? colors.magnet : look.muted,
  );
  pen.globalAlpha = pull;
  pen.fillStyle = colors.magnet;
  pen.fillRect(x - half, up, 2 * half, plate - up - 1);
  pen.globalAlpha = 1;
  const skin = top - 2;
  pen.beginPath();
  pen.roundRect(x - 0.3 * scale, skin - 0.12 * scale, 0.6 * scale, up - skin + 0.12 * scale, [
    0.25 * scale,
    0.25 * scale,
    0,
    0,
  ]);
  [pen.fillStyle, pen.strokeStyle, pen.lineWidth] = [look.surface, colors.ink, 1.4];
  pen.fill();
  pen.stroke();
  pen.setLineDash([3, 3]);
  [pen.strokeStyle, pen.lineWidth] = [look.muted, 1];
  pen.beginPath();
  pen.moveTo(rest, skin - 8);
  pen.lineTo(rest, plate);
  pen.stroke();
  pen.setLineDash([]);
  drawFinger(pen, rest, x, skin - 0.1 * scale, scale, picture);
  const words = (
    text: string,
    at: number,
    down: number,
    align: CanvasTextAlign,
    color = look.muted,
  ): void => {
    [pen.fillStyle, pen.textAlign] = [color, align];
    pen.fillText(text, at, down);
  };
  words(pull > 0.05 ? "clamped" : "magnet", x, up + 0.72 * scale, "center", pull > 0.4 ? "#fff" : look.text);
  words("spring", 26, middle - 13, "left");
  words("mouse", width - 26, top + 28, "right");
  words("steel plate with the page", 6, plate + 29, "left");
  pen.fillStyle = look.text;
  pen.beginPath();
  pen.moveTo(rest, plate + 6);
  pen.lineTo(rest - 6, plate + 16);
  pen.lineTo(rest + 6, plate + 16);
  pen.fill();
  words("sensor", rest + 10, plate + 29, "left", look.text);
  if (Math.hypot(hand.vx, hand.vy) > 1e-3)
    drawArrow(pen, width - 48, top + 44, Math.sign(hand.vx) || 1, look.muted);
}

function drawArrow(pen: Pen, x: number, y: number, sign: number, color: string): void {
  [pen.strokeStyle, pen.fillStyle, pen.lineWidth] = [color, color, 2];
  pen.beginPath();
  pen.moveTo(x - 13 * sign, y);
  pen.lineTo(x + 13 * sign, y);
  pen.stroke();
  pen.beginPath();
  pen.moveTo(x + 21 * sign, y);
  pen.lineTo(x + 11 * sign, y - 5);
  pen.lineTo(x + 11 * sign, y + 5);
  pen.fill();
}

/** The fingertip: its skin goes with the pin as far as it stretches. */
function drawFinger(pen: Pen, rest: number, x: number, low: number, scale: number, picture: Picture): void {
  const { colors, look } = picture;
  const stretch = -picture.sample.values.stretch[picture.chosen]! * 1e3 * scale * STRETCHED || 0;
  const wide = 3.1 * scale;
  pen.beginPath();
  pen.moveTo(rest - wide, low - 1.3 * scale);
  pen.bezierCurveTo(rest - 0.8 * wide, low, rest - 0.5 * wide, low, rest - 0.3 * wide, low);
  pen.lineTo(rest + 0.3 * wide, low);
  pen.bezierCurveTo(rest + 0.5 * wide, low, rest + 0.8 * wide, low, rest + wide, low - 1.3 * scale);
  pen.lineTo(rest + wide, -5);
  pen.lineTo(rest - wide, -5);
  pen.closePath();
  [pen.fillStyle, pen.strokeStyle, pen.lineWidth] = [colors.skin, colors.skinEdge, 1.5];
  pen.fill();
  pen.stroke();
  pen.lineWidth = 1.6;
  for (let k = -4; k <= 4; ++k) {
    const at = x + 0.42 * k * scale;
    const share = Math.exp(-((k / 2.2) ** 2)) * stretch;
    pen.strokeStyle = Math.abs(share) > 2 ? colors.dragged : colors.skinEdge;
    pen.beginPath();
    pen.moveTo(at, low - 1);
    pen.quadraticCurveTo(at - 0.15 * share, low - 0.3 * scale, at - share, low - 0.62 * scale);
    pen.stroke();
  }
  [pen.fillStyle, pen.textAlign] = [look.dark ? "#e8d5c8" : "#7a4f33", "center"];
  pen.fillText("fingertip", rest, Math.max(13, low - 0.95 * scale));
}

function drawTrace(
  pen: Pen,
  width: number,
  top: number,
  height: number,
  picture: Picture,
  samples: readonly Sample[],
  dark: (sample: Sample) => boolean,
): void {
  const { colors, look, chosen } = picture;
  const now = picture.sample.time;
  const left = 58;
  const across = (time: number): number => width - ((now - time) / LAST) * (width - left);
  const y = top + 8;
  pen.textAlign = "left";
  for (const [text, down, color] of [
    ["black", 9, look.text],
    ["magnet", 23, colors.magnet],
    ["pin", 44, colors.dragged],
    ["last 0.15 s", 74, look.muted],
  ] as const) {
    pen.fillStyle = color;
    pen.fillText(text, 2, y + down);
  }
  pen.save();
  pen.beginPath();
  pen.rect(left, top, width - left, height);
  pen.clip();
  const bars = (down: number, color: string, on: (sample: Sample) => boolean): void => {
    pen.fillStyle = color;
    samples.forEach((sample, i) => {
      const before = samples[i - 1];
      if (before && on(sample)) {
        pen.fillRect(across(before.time), y + down, across(sample.time) - across(before.time) + 0.5, 9);
      }
    });
  };
  bars(0, look.text, dark);
  bars(14, colors.magnet, ({ values }) => values.pull[chosen]! > 0.02 * picture.hold);
  const zero = y + 46;
  [pen.strokeStyle, pen.lineWidth] = [look.grid, 1];
  pen.beginPath();
  pen.moveTo(left, zero);
  pen.lineTo(width, zero);
  pen.stroke();
  [pen.strokeStyle, pen.lineWidth] = [colors.dragged, 2];
  pen.beginPath();
  samples.forEach(({ time, values }, i) => {
    const height = values.position[chosen]! * 1e3 * 18;
    if (i) pen.lineTo(across(time), zero - height);
    else pen.moveTo(across(time), zero - height);
  });
  pen.stroke();
  pen.restore();
}
