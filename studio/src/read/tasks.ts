// Tasks for a first minute: the print of the page, and a verdict on the lines that were read.

import type { Limit } from "./dial";
import type { Hand } from "./hand";
import type { Line, Outcome } from "./scan";
import type { Sample } from "./session";
import type { Print } from "./state";

/** A printed line that a hand has crossed: its outcome, the speed of the hand, mm/s, and the angle, degrees. */
export interface Crossing {
  readonly outcome: Outcome;
  readonly time: number;
  readonly stroke: number;
  readonly speed: number;
  readonly angle: number;
}

/** Reading so far, what was read of the task before, and the limits of the device. */
export interface Read {
  readonly lines: readonly Crossing[];
  readonly before: readonly Crossing[];
  readonly limits: readonly Limit[];
  /** The last samples, and the pin that is looked at. */
  readonly samples: readonly Sample[];
  readonly chosen: number;
  /** Damping ratio of the pins. */
  readonly ratio: number;
}

export interface Task {
  readonly name: string;
  readonly what: string;
  /** Print of a page of a width, mm. */
  readonly page: (width: number) => Print;
  /** Verdict on a reading, in words; null: none yet. */
  readonly verdict: (read: Read) => string | null;
}

const PITCH = 2; // mm, of the two lines
const ENOUGH = 8; // lines after which a word is judged
const CROSSED = 0.6; // s of the device within which both lines are crossed
const STRAIGHT = 6; // degrees
const SWUNG = 0.03; // s after a release until its swing is told
const DRAGGED = 1e-4; // m that a pin is dragged at the least

/** The printed lines that a hand has crossed. */
export function crossings(lines: readonly Line[], hand: Hand): Crossing[] {
  return lines
    .filter(({ outcome }) => outcome !== "false")
    .map(({ outcome, time, stroke }) => {
      const { vx, vy } = hand.at(time);
      const angle = (Math.atan2(Math.abs(vy), Math.abs(vx)) * 180) / Math.PI;
      return { outcome, time, stroke: 1e3 * stroke, speed: 1e3 * Math.hypot(vx, vy), angle };
    });
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
function howFast({ lines, limits }: Read): string | null {
  const last = Math.max(...lines.map(({ time }) => time));
  const crossing = lines.filter(({ time }) => time > last - CROSSED);
  if (crossing.length < 2) return null;
  const merged = crossing.filter(({ outcome }) => outcome !== "shown").length;
  const speed = Math.round(mean(crossing.map((line) => line.speed)));
  if (merged < crossing.length / 4) return `Still two at ${speed} mm/s. Faster!`;
  const own = limits.find(({ pitch }) => pitch === PITCH)?.speed;
  const known = own ? ` The device's own limit: ${Math.round(own)} mm/s.` : "";
  return `At ${speed} mm/s they became one.${known}`;
}

function whyAskew({ lines, before }: Read): string | null {
  const strokes = [...before, ...lines].filter(({ stroke }) => stroke > 0);
  const straight = strokes.filter(({ angle }) => angle < STRAIGHT);
  const askew = strokes.filter(({ angle }) => angle >= STRAIGHT);
  const told = (of: typeof strokes): string => `${mean(of.map(({ stroke }) => stroke)).toFixed(2)} mm`;
  const angle = (): string => `${Math.round(mean(askew.map(({ angle }) => angle)))}° askew ${told(askew)}`;
  if (straight.length && askew.length) return `Straight ${told(straight)}, ${angle()}.`;
  if (straight.length) return `Straight ${told(straight)}. Now slanting.`;
  return askew.length ? `${angle()}. Now straight.` : null;
}

const swings = new Map<string, string>(); // swings in words, by damping ratio

/** The swing of the chosen pin past its rest after its last release, for each damping that was tried. */
function figure4({ samples, chosen, ratio }: Read): string | null {
  const at = (i: number): number => samples[i]!.values.position[chosen]!;
  const off = samples.findLastIndex(({ values }) => values.command[chosen]! > 0);
  if (off < 0 || off === samples.length - 1) return null;
  const after = samples.slice(off + 1);
  if (after[after.length - 1]!.time - samples[off]!.time < SWUNG) return null;
  const dragged = after.reduce((most, { values }) => {
    const x = values.position[chosen]!;
    return Math.abs(x) > Math.abs(most) ? x : most;
  }, at(off));
  const past = after.map(({ values }) => -Math.sign(dragged) * values.position[chosen]!);
  if (Math.abs(dragged) < DRAGGED) return null;
  const part = Math.max(0, ...past) / Math.abs(dragged);
  const key = ratio.toFixed(2);
  swings.set(key, `${Math.round(100 * part)} % past its rest at damping ratio ${key}`);
  return `Let go at ${(1e3 * Math.abs(dragged)).toFixed(2)} mm, the pin swings ${[...swings.values()].join(", ")}.`;
}

export const TASKS: readonly Task[] = [
  {
    name: "Read the word",
    what: "Cross it in one slow stroke. Every letter should appear in blue.",
    page: (width) => ({ kind: "text", text: "Hello", width }),
    verdict: readTheWord,
  },
  {
    name: "How fast is too fast?",
    what: "Cross the two lines, each time faster, until the finger gets only one.",
    page: (width) => ({
      kind: "lines",
      lines: [
        [width / 2 - PITCH, PITCH / 2],
        [width / 2, PITCH / 2],
      ],
      width,
    }),
    verdict: howFast,
  },
  {
    name: "Why askew feels less",
    what: "Cross the line straight, then slanting. How far is a pin dragged?",
    page: (width) => ({ kind: "lines", lines: [[width / 2 - 0.75, 1.5]], width }),
    verdict: whyAskew,
  },
  {
    name: "The paper's Figure 4",
    what: "Cross the line. Behind it the pin springs back, and swings: how far, at damping ratios 0.04, 0.16 and 0.32? The slider sets them; “Open its motion” shows the curve.",
    page: (width) => ({ kind: "lines", lines: [[width / 2 - 1, 2]], width }),
    verdict: figure4,
  },
];
