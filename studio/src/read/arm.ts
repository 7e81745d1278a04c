// A hand that gives way: an arm leads it along a ruler by a spring and a damper, and the pins slow it.
import { SPEEDS, TIMES } from "./hand";

/** Hand with its arm: kg, N/m, N s/m. */
export interface Arm {
  readonly mass: number;
  readonly stiffness: number;
  readonly damping: number;
}

/** A relaxed arm: van Beek et al. 2015, doi:10.1038/srep18004. */
export const ARM: Arm = { mass: 0.55, stiffness: 135, damping: 6.5 };

/** Longest stretch over which the force of the pins is taken as even, in units of time. */
const FINE = 2;

/** The hand beside its intended motion: M e″ + B e′ + K e = −H, with the force H of the pins against it. */
export class LedHand {
  private units = 0;
  private intended = 0; // m/s
  /** Way ahead of the intended place, m, and its rate. */
  private ahead = 0;
  private rate = 0;
  private force = 0;

  constructor(private readonly arm: Arm) {}

  /** Time of the last row, s. */
  get time(): number {
    return this.units / TIMES;
  }

  /** Follows the intended motion to a row, s and m/s, in stretches that `move` carries out. The force at the begin of
   * each, N, is continued to its middle. */
  follow(time: number, velocity: number, force: () => number, move: (time: number, v: number) => void): void {
    const { mass, stiffness, damping } = this.arm;
    const [begin, from, end] = [this.units, this.intended, Math.round(time * TIMES)];
    while (this.units < end) {
      const next = Math.min(this.units + FINE, end);
      const lasts = (next - this.units) / TIMES;
      const now = this.units ? force() : 0; // the pins begin at rest
      const middle = now + 0.5 * (now - this.force);
      const held = (0.5 * lasts * (damping + 0.5 * lasts * stiffness)) / mass;
      const free = (this.rate * (1 - held) - (lasts * (middle + stiffness * this.ahead)) / mass) / (1 + held);
      const intended = from + ((velocity - from) * (next - begin)) / (end - begin);
      const speed = Math.round((intended + free) * SPEEDS) / SPEEDS;
      this.ahead += 0.5 * lasts * (this.rate + speed - intended);
      [this.rate, this.force, this.intended, this.units] = [speed - intended, now, intended, next];
      move(next / TIMES, speed);
    }
  }
}
