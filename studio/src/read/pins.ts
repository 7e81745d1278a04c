// The pins of a device, simulated in several threads: each pin follows the hand by itself.

import { type Program, Thread } from "../thread";
import { type Answer, type Failure, type Moved, type Opened, SAMPLED, type Samples } from "./engine";

const MOST = 4; // threads

export class Pins {
  private readonly threads: readonly Thread[];
  private shares: readonly number[] = [];

  constructor(program: Program) {
    const threads = Math.min(navigator.hardwareConcurrency || 1, MOST);
    this.threads = Array.from({ length: threads }, () => new Thread(program));
  }

  /** Opens a device at rest; each thread has its share of the pins. */
  open({ device, ...opening }: Opened["open"]): Promise<Failure | null> {
    const { spots } = device;
    // Pins that slow their hand move it together.
    const used = opening.arm ? 1 : Math.min(this.threads.length, spots.length);
    const ends = Array.from({ length: used + 1 }, (_, i) => Math.round((i * spots.length) / used));
    this.shares = ends.slice(1).map((end, i) => end - ends[i]!);
    return this.all((i) => ({
      open: { ...opening, device: { ...device, spots: spots.slice(ends[i], ends[i + 1]) } },
    })).then((answers) => answers.find(failed) ?? null);
  }

  /** Moves the hand on, and samples all pins. */
  async advance(moved: Moved): Promise<Samples | Failure> {
    const { shares } = this;
    const answers = await this.all(() => moved);
    return answers.find(failed) ?? together(answers as Samples[], shares);
  }

  private all(task: (share: number) => Opened | Moved): Promise<Answer[]> {
    const { threads, shares } = this;
    return Promise.all(shares.map((_, i) => threads[i]!.ask("read", task(i))));
  }
}

function failed(answer: Answer): answer is Failure {
  return answer !== null && "failed" in answer;
}

/** Joins the samples of the shares; they took as long as the slowest share. */
function together(parts: readonly Samples[], shares: readonly number[]): Samples {
  const { until, times, rows } = parts[0]!;
  const pins = shares.reduce((sum, share) => sum + share, 0);
  const values = new Float64Array(times.length * SAMPLED.length * pins);
  let first = 0;
  parts.forEach((part, i) => {
    const share = shares[i]!;
    for (let row = 0; row < times.length * SAMPLED.length; ++row) {
      values.set(part.values.subarray(row * share, (row + 1) * share), row * pins + first);
    }
    first += share;
  });
  return { until, times, values, rows, took: Math.max(...parts.map(({ took }) => took)) };
}
