// The hand's speed, and beneath it the pitches of lines that merge at each speed.
import type { Look } from "../theme";
import type { Colors, Pen } from "./picture";

export interface Limit {
  /** Distance of two lines, mm. */
  readonly pitch: number;
  /** Largest speed at which they are distinct, mm/s; NaN: none. */
  readonly speed: number;
}

export const DIAL_HEIGHT = 58;

/** The distance below which lines merge at a speed, mm; null: unknown, or beyond the last limit. */
export function mergingPitch(limits: readonly Limit[], speed: number): number | null {
  const known = limits.filter(({ speed }) => speed > 0);
  const next = known.findIndex((limit) => limit.speed >= speed);
  if (next < 0) return null;
  const to = known[next]!;
  const from = known[next - 1] ?? { pitch: 0, speed: 0 };
  return from.pitch + ((to.pitch - from.pitch) * (speed - from.speed)) / (to.speed - from.speed);
}

export function drawDial(
  pen: Pen,
  width: number,
  speed: number,
  peak: number,
  limits: readonly Limit[],
  look: Look,
  colors: Colors,
): void {
  const fastest = Math.max(...limits.map(({ speed }) => speed || 0), 0);
  const most = Math.max(100, Math.ceil((1.04 * fastest) / 100) * 100);
  const at = (value: number): number => 4 + Math.min(1, value / most) * (width - 8);
  const y = 17;
  const shade = pen.createLinearGradient(4, 0, width - 4, 0);
  const stops = look.dark ? ["#23445c", "#3c3c3a", "#5d3a22"] : ["#cfe3f1", "#e3e3e0", "#f6cfb6"];
  stops.forEach((color, i) => {
    shade.addColorStop([0, 0.35, 1][i]!, color);
  });
  pen.fillStyle = shade;
  pen.fillRect(4, y, width - 8, 16);
  const merging = mergingPitch(limits, speed);
  pen.fillStyle = merging !== null && merging < 2 ? colors.dragged : colors.magnet;
  pen.fillRect(4, y + 3, at(speed) - 4, 10);
  pen.fillStyle = look.text;
  pen.fillRect(at(peak) - 1, y - 2, 2, 20);
  pen.fillStyle = look.muted;
  const step = most / 100 > width / 45 ? (most > 1000 ? 500 : 200) : 100;
  for (let value = 0; value <= most; value += step) {
    pen.textAlign = value === 0 ? "left" : value === most ? "right" : "center";
    pen.fillText(String(value), at(value), 12);
  }
  pen.fillStyle = look.text;
  pen.textAlign = "center";
  limits.forEach(({ pitch, speed }, i) => {
    if (!(speed > 0)) return;
    pen.fillRect(at(speed) - 0.5, y + 16, 1, 5);
    pen.fillText(i ? String(pitch) : `${pitch} mm`, Math.min(at(speed), width - 8), y + 34);
  });
}
