// Picture that all drawings show: the pins now, the hand, colours and marks.
import type { Row } from "../input";
import type { Look } from "../theme";
import type { Motion } from "./hand";
import type { Sample } from "./session";

/** Colours of what moves the pins: the magnet, the dragged skin, the way back past the rest. */
export interface Colors {
  readonly magnet: string;
  readonly dragged: string;
  readonly thrown: string;
  readonly ink: string;
  readonly skin: string;
  readonly skinEdge: string;
}

export function colorsOf(look: Look): Colors {
  return look.dark
    ? {
        magnet: "#f08a3c",
        dragged: "#5ab4ee",
        thrown: "#d592cf",
        ink: look.text,
        skin: "#4a3a32",
        skinEdge: "#a98468",
      }
    : {
        magnet: "#d55e00",
        dragged: "#0072b2",
        thrown: "#a0569a",
        ink: "#2b3036",
        skin: "#fbe9dd",
        skinEdge: "#c08a66",
      };
}

/** A picture of the device: places in m, colours, and the pin that is looked at. */
export interface Picture {
  readonly sample: Sample;
  readonly hand: Motion;
  /** Intended motion of a hand that gives way. */
  readonly intended: Motion | null;
  readonly spots: readonly Row[];
  /** Direction of the drive axis. */
  readonly axis: Row;
  /** Largest pull of a magnet, N. */
  readonly hold: number;
  /** Part of a full change of skin stretch that each pin makes now. */
  readonly felt: Float64Array;
  readonly chosen: number;
  readonly look: Look;
  readonly colors: Colors;
}

/** Part of the full pull of a magnet. */
export function pullOf(picture: Picture, pin: number): number {
  return Math.min(1, picture.sample.values.pull[pin]! / picture.hold);
}

/** Place of a pin on the page beside its spot, m: a dragged pin stays behind. */
export function offsetOf(picture: Picture, pin: number): Row {
  const x = -picture.sample.values.position[pin]!;
  return [x * picture.axis[0], x * picture.axis[1]];
}

export type Pen = CanvasRenderingContext2D;

export function disc(pen: Pen, x: number, y: number, radius: number, fill: string | null): void {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  if (fill) {
    pen.fillStyle = fill;
    pen.fill();
  }
}

export function ring(pen: Pen, x: number, y: number, radius: number, color: string, width: number): void {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  [pen.strokeStyle, pen.lineWidth] = [color, width];
  pen.stroke();
}

/** The magnet of a pin: full where it pulls, dashed where it is commanded only. */
export function magnetRing(pen: Pen, picture: Picture, pin: number, x: number, y: number, r: number): void {
  const pull = pullOf(picture, pin);
  const { magnet } = picture.colors;
  if (pull > 0.02) {
    pen.globalAlpha = pull;
    ring(pen, x, y, r, magnet, 3);
    pen.globalAlpha = 1;
  } else if (picture.sample.values.command[pin]) {
    pen.setLineDash([3, 3]);
    ring(pen, x, y, r, magnet, 1.5);
    pen.setLineDash([]);
  }
}
