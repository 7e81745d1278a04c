// Readouts in words and numbers: the present event, the speed of the hand, and the lines so far.
import { card, h } from "../dom";
import { type Limit, mergingPitch } from "./dial";
import type { Slowness } from "./hand";
import { type Picture, pullOf } from "./picture";
import type { Line } from "./scan";
import { happening } from "./sentence";

const SPOKEN = 3000; // ms between two sentences for screen readers
const READ = 100; // ms between two speeds that are shown: nobody reads faster
const STANDS = 8; // mm/s below which a hand stands
const COUNTS = ["crossed", "felt", "merged", "missed", "false", "lag"] as const;
type Count = (typeof COUNTS)[number];

export class Readouts {
  readonly now = h("p", { class: "now" });
  readonly spoken = h("p", { class: "visually-hidden", role: "status" });
  private readonly speed = h("output", { class: "speed" }, "0");
  private readonly yours = h("span", { class: "note yours" });
  private readonly merging = h("p", { class: "note merging" });
  private readonly finest = h("p", { class: "note" });
  private readonly lag = h("p", { class: "note lag", hidden: true });
  private readonly counts: Readonly<Record<Count, HTMLElement>>;
  private spokenAt = 0;
  private readAt = 0;
  private lagAt = 0;

  constructor() {
    const cells = COUNTS.map((name) => [name, h("b", {}, "0")]);
    this.counts = Object.fromEntries(cells) as Record<Count, HTMLElement>;
  }

  /** The card of the hand's speed and the counts. */
  card(dial: HTMLElement): HTMLElement {
    const cells = COUNTS.map((name) =>
      h("div", {}, h("dt", {}, name === "lag" ? "lag, mm" : name), h("dd", {}, this.counts[name])),
    );
    const speed = h("p", {}, this.speed, " mm/s ", this.yours);
    return card(
      "speed-card",
      "Speed of the hand",
      h("div", { class: "speeds" }, speed, dial),
      this.lag,
      this.merging,
      this.finest,
      h("dl", { class: "counts" }, ...cells),
    );
  }

  /** Describes the present event; `waiting` stands in while there is none, and nobody has moved the hand. */
  tell(picture: Picture | null, waiting: string, moved: boolean): void {
    const words = happening(picture, waiting, moved);
    const plain = words.map((part) => (typeof part === "string" ? part : part[1])).join("");
    if (plain === this.now.textContent) return;
    this.now.replaceChildren(
      ...words.map((part) => (typeof part === "string" ? part : h("span", { class: part[0] }, part[1]))),
    );
    const time = performance.now();
    if (time - this.spokenAt > SPOKEN) [this.spokenAt, this.spoken.textContent] = [time, plain];
  }

  /** Speed of the hand, mm/s, and the pitch of lines that merge at it. */
  showSpeed(speed: number, slowness: Slowness, limits: readonly Limit[]): void {
    const time = performance.now();
    if (time - this.readAt < READ) return;
    this.readAt = time;
    this.speed.textContent = String(Math.round(speed));
    this.yours.textContent =
      slowness === 1 ? "in real time" : `your ${Math.round(speed / slowness)} mm/s × ${slowness}`;
    const pitch = mergingPitch(limits, speed);
    const widest = limits[limits.length - 1];
    const merged =
      pitch !== null
        ? `closer than ${pitch.toFixed(1)} mm`
        : widest && `closer than ${widest.pitch} mm, and some wider ones,`;
    this.merging.textContent = speed < STANDS || !merged ? "" : `now lines ${merged} become one`;
  }

  /** Says how far a hand that gives way is behind its ruler, and what its pins pull. */
  showLag(picture: Picture): void {
    const { intended, hand, sample } = picture;
    this.lag.hidden = !intended;
    const time = performance.now();
    if (!intended || time - this.lagAt < READ) return;
    this.lagAt = time;
    const lag = 1e3 * (intended.x - hand.x) * (intended.vx < 0 ? -1 : 1);
    const { force } = sample.values;
    const pull = Math.abs(force.reduce((sum, one) => sum + one, 0));
    const held = [...force].filter((_, pin) => pullOf(picture, pin) > 0.5).length;
    const where =
      lag < -0.05 ? `${(-lag).toFixed(1)} mm ahead of` : `${Math.max(0, lag).toFixed(1)} mm behind`;
    const pins = held === 1 ? "1 magnet holds" : `${held} magnets hold`;
    this.lag.textContent = `The mouse is ${where} the ruler. ${pins}, the pins pull with ${pull.toFixed(2)} N.`;
  }

  /** Speeds up to which the closest lines stay distinct, with this device and with the one before. */
  showLimits([closest]: readonly Limit[], [before]: readonly Limit[]): void {
    if (!closest) return;
    const fastest = ({ speed }: Limit): string =>
      speed > 0 ? `up to ${Math.round(speed)} mm/s` : "at no speed";
    const other = before ? `; with the device before, ${fastest(before)}` : "";
    this.finest.textContent = `Two lines ${closest.pitch} mm apart are felt as two ${fastest(closest)}${other}.`;
  }

  showLines(lines: readonly Line[]): void {
    const of = (outcome: string): number => lines.filter((line) => line.outcome === outcome).length;
    const lags = lines.map(({ lag }) => 1e3 * lag).filter((lag) => !Number.isNaN(lag));
    lags.sort((a, b) => a - b);
    const lag = lags.length ? lags[lags.length >> 1]!.toFixed(1) : "–";
    const crossed = lines.length - of("false");
    const numbers = [crossed, of("shown"), of("merged"), of("unseen") + of("faint"), of("false"), lag];
    COUNTS.forEach((name, i) => {
      const words = String(numbers[i]);
      if (this.counts[name].textContent !== words) this.counts[name].textContent = words;
    });
  }
}
