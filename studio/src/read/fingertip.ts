// The fingertip from above with the true pitch of its pins, each tinted by the change of its skin stretch.
import type { Row } from "../input";
import { disc, magnetRing, offsetOf, type Pen, type Picture, ring } from "./picture";

const PIN = 0.75e-3; // m
const SLOT = 2.1e-3; // m either way
const ROOM = 3.2e-3; // m around the pins

/** Places of the pins in the drawing, for clicks. */
export interface Drawn {
  readonly scale: number;
  readonly places: readonly Row[];
}

export function drawFingertip(
  pen: Pen,
  width: number,
  height: number,
  places: readonly Row[],
  picture: Picture,
): Drawn {
  const size = (values: number[]): number => Math.max(...values) - Math.min(...values);
  const wide = size(places.map(([x]) => x)) + 2 * ROOM;
  const high = size(places.map(([, y]) => y)) + 2 * ROOM;
  const scale = Math.min(width / wide, height / high);
  const [cx, cy] = [width / 2, height / 2];
  drawSkin(pen, cx, cy, 0.5 * wide * scale, 0.5 * high * scale, picture);
  const drawn = places.map(([x, y]): Row => [cx + x * scale, cy + y * scale]);
  const angle = Math.atan2(picture.axis[1], picture.axis[0]);
  drawn.forEach(([x, y], pin) => {
    pen.save();
    pen.translate(x, y);
    pen.rotate(angle);
    pen.beginPath();
    pen.roundRect(-SLOT * scale, -PIN * scale, 2 * SLOT * scale, 2 * PIN * scale, PIN * scale);
    pen.fillStyle = picture.look.dark ? "rgb(0 0 0 / 0.35)" : "rgb(255 255 255 / 0.75)";
    pen.fill();
    [pen.strokeStyle, pen.lineWidth] = ["rgb(120 100 90 / 0.5)", 1];
    pen.stroke();
    pen.restore();
    const [ox, oy] = offsetOf(picture, pin).map((part) => part * scale) as [number, number];
    magnetRing(pen, picture, pin, x + ox, y + oy, 2 * PIN * scale);
    disc(pen, x + ox, y + oy, PIN * scale, tint(picture, pin));
    ring(pen, x + ox, y + oy, PIN * scale, picture.colors.ink, 1.3);
    if (pin === picture.chosen) ring(pen, x + ox, y + oy, 1.4 * PIN * scale, picture.look.text, 2);
  });
  return { scale, places: drawn };
}

function drawSkin(pen: Pen, cx: number, cy: number, rx: number, ry: number, picture: Picture): void {
  pen.beginPath();
  pen.roundRect(cx - rx, cy - ry, 2 * rx, 2 * ry, 0.85 * Math.min(rx, ry));
  pen.fillStyle = picture.colors.skin;
  pen.fill();
  [pen.strokeStyle, pen.lineWidth] = ["rgb(190 140 110 / 0.35)", 1];
  for (let k = 1; k < 6; ++k) {
    pen.beginPath();
    pen.ellipse(cx, cy + 0.3 * ry, 0.18 * k * rx, 0.21 * k * ry, 0, Math.PI, 2 * Math.PI);
    pen.stroke();
  }
}

/** From white, or the surface, to blue with the change of the skin stretch. */
function tint({ felt, look }: Picture, pin: number): string {
  const part = felt[pin]!;
  const [from, to] = look.dark
    ? [
        [40, 44, 50],
        [90, 180, 238],
      ]
    : [
        [255, 255, 255],
        [0, 114, 178],
      ];
  return `rgb(${from!.map((c, i) => Math.round(c + (to![i]! - c) * part)).join(" ")})`;
}

/** The pin nearest to a place of the drawing; null: none is near. */
export function pinAt({ scale, places }: Drawn, x: number, y: number): number | null {
  const apart = places.map(([px, py]) => Math.hypot(px - x, py - y));
  const least = Math.min(...apart);
  return least < 2.5e-3 * scale + 12 ? apart.indexOf(least) : null;
}
