// Tasks for a first minute: the print of the page, and a verdict on the lines that were read.

import type { Limit } from "./dial";
import type { Hand } from "./hand";
import type { Line } from "./scan";

/** Reading so far: its lines, the hand, and the limits of the device. */
export interface Read {
  readonly lines: readonly Line[];
  readonly hand: Hand;
  readonly limits: readonly Limit[];
}

export interface Task {
  readonly name: string;
  readonly what: string;
  /** Print of a page of a width, mm: a text, or lines at places with widths, mm. */
  readonly page: (width: number) => string | readonly (readonly [number, number])[];
  /** Verdict on a reading, in words; null: none yet. */
  readonly verdict: (read: Read) => string | null;
}

const PITCH = 2; // mm, of the two lines
const ENOUGH = 24; // lines after which a word is judged
const STRAIGHT = 6; // degrees

/** Speed of the hand at a line, mm/s, and its angle to the drive, degrees. */
function handAt(hand: Hand, line: Line): { speed: number; angle: number } {
  const { vx, vy } = hand.at(line.time);
  return { speed: 1e3 * Math.hypot(vx, vy), angle: (Math.atan2(Math.abs(vy), Math.abs(vx)) * 180) / Math.PI };
}

function mean(values: readonly number[]): number {
  return values.reduce((sum, value) => sum + value, 0) / values.length;
}

function readTheWord({ lines }: Read): string | null {
  if (lines.length < ENOUGH) return null;
  const part = lines.filter(({ outcome }) => outcome === "shown").length / lines.length;
  return `${Math.round(100 * part)} % of the lines got through${part > 0.85 ? ": well read!" : ". Slower!"}`;
}

/** The last crossing of both lines: felt apart, or as one. */
function howFast({ lines, hand, limits }: Read): string | null {
  if (lines.length < 8) return null;
  const last = Math.max(...lines.map(({ time }) => time));
  const crossing = lines.filter(({ time }) => time > last - 0.6);
  const merged = crossing.filter(({ outcome }) => outcome !== "shown").length;
  const speed = Math.round(mean(crossing.map((line) => handAt(hand, line).speed)));
  if (merged < crossing.length / 4) return `Still two at ${speed} mm/s. Faster!`;
  const own = limits.find(({ pitch }) => pitch === PITCH)?.speed;
  const known = own ? ` The device's own limit: ${Math.round(own)} mm/s.` : "";
  return `At ${speed} mm/s they became one.${known}`;
}

function whyAskew({ lines, hand }: Read): string | null {
  const strokes = lines
    .filter(({ stroke }) => stroke > 0)
    .map((line) => ({ stroke: 1e3 * line.stroke, ...handAt(hand, line) }));
  const straight = strokes.filter(({ angle }) => angle < STRAIGHT);
  const askew = strokes.filter(({ angle }) => angle >= STRAIGHT);
  const told = (of: typeof strokes): string => `${mean(of.map(({ stroke }) => stroke)).toFixed(2)} mm`;
  const angle = (): string => `${Math.round(mean(askew.map(({ angle }) => angle)))}° askew ${told(askew)}`;
  if (straight.length && askew.length) return `Straight ${told(straight)}, ${angle()}.`;
  if (straight.length) return `Straight ${told(straight)}. Now slanting.`;
  return askew.length ? `${angle()}. Now straight.` : null;
}

export const TASKS: readonly Task[] = [
  {
    name: "Read the word",
    what: "Cross it in one slow stroke. Every letter should appear in blue.",
    page: () => "Hello",
    verdict: readTheWord,
  },
  {
    name: "How fast is too fast?",
    what: "Cross the two lines, each time faster, until the finger gets only one.",
    page: (width) => [
      [width / 2 - PITCH, PITCH / 2],
      [width / 2, PITCH / 2],
    ],
    verdict: howFast,
  },
  {
    name: "Why askew feels less",
    what: "Cross the line straight, then slanting. How far is a pin dragged?",
    page: (width) => [[width / 2 - 0.75, 1.5]],
    verdict: whyAskew,
  },
];
