// Lines that were not felt as they are printed: a list, whose entries show their moment, and marks on the page.
import { button, h } from "../dom";
import { disc, type Pen } from "./picture";
import type { Line, Outcome } from "./scan";

const LISTED = 40;
export const MARKED = "#a4128a"; // on white paper, unlike black, orange and blue

/** Outcomes that are marked, with their signs and what they are in the list. */
const WORDS: Readonly<Partial<Record<Outcome, readonly [string, string]>>> = {
  unseen: ["×", "missed: the sensor did not see it"],
  faint: ["×", "missed: its pin moved the skin too little"],
  merged: ["∪", "merged with the line before"],
  false: ["◇", "false: no line is there"],
};

export class Outcomes {
  readonly element = h("details", { class: "outcomes", hidden: true });
  private readonly summary = h("summary");
  private readonly list = h("ul");
  private shown: readonly Line[] = [];

  /** `show` is called with a line that is chosen. */
  constructor(private readonly show: (line: Line) => void) {
    this.element.append(this.summary, this.list);
    this.element.addEventListener("toggle", () => this.fill());
  }

  update(lines: readonly Line[]): void {
    this.shown = marked(lines).sort((a, b) => a.time - b.time);
    const { length } = this.shown;
    this.element.hidden = length === 0;
    this.summary.textContent = `Which ${length === 1 ? "one was" : `${length} were`} not felt as printed: × missed, ∪ merged, ◇ false`;
    this.fill();
  }

  private fill(): void {
    if (!this.element.open) return;
    const items = this.shown.slice(0, LISTED).map((line) => {
      const { pin, x, y, outcome } = line;
      const [sign, words] = WORDS[outcome]!;
      const place = `${(1e3 * x).toFixed(1)}, ${(1e3 * y).toFixed(1)} mm`;
      const made = button(`${sign} pin ${pin + 1} at ${place} ${words}`, "Show this moment", () =>
        this.show(line),
      );
      made.className = "link";
      return h("li", {}, made);
    });
    const more = this.shown.length - LISTED;
    if (more > 0) items.push(h("li", {}, `and ${more} more`));
    this.list.replaceChildren(...items);
  }
}

function marked(lines: readonly Line[]): Line[] {
  return lines.filter(({ outcome }) => outcome in WORDS);
}

/** Marks the lines on the page, at a scale of pixels to the metre. */
export function drawOutcomes(pen: Pen, scale: number, lines: readonly Line[]): void {
  pen.save();
  [pen.textAlign, pen.textBaseline] = ["center", "middle"];
  pen.font = `bold ${pen.font}`;
  for (const { x, y, outcome } of marked(lines)) {
    const [at, down] = [x * scale, y * scale];
    disc(pen, at, down, 7, "rgb(255 255 255 / 0.85)");
    pen.fillStyle = MARKED;
    pen.fillText(WORDS[outcome]![0], at, down + 0.5);
  }
  pen.restore();
}
