// Sensation of skin: the change of its stretch. A stretch that stays is no longer felt.
import type { Sample } from "./session";

const SETTLES = 0.03; // s in which skin forgets a stretch
const FULL_STRETCH = 0.1e-3; // m, change that is felt fully
const FULL_MOTION = 0.8e-3; // m, of a pin under a rigid finger

export class Skin {
  /** Part of a full change at each pin. */
  felt = new Float64Array(0);
  private bases = new Float64Array(0);
  private time = 0;

  constructor(pins: number) {
    this.begin(pins);
  }

  begin(pins: number): void {
    [this.felt, this.bases, this.time] = [new Float64Array(pins), new Float64Array(pins), 0];
  }

  follow({ time, values }: Sample): void {
    const rigid = Number.isNaN(values.stretch[0]);
    const moved = rigid ? values.position : values.stretch;
    const part = 1 - Math.exp(-Math.max(0, time - this.time) / SETTLES);
    this.time = time;
    moved.forEach((now, pin) => {
      this.bases[pin]! += (now - this.bases[pin]!) * part;
      const change = Math.abs(now - this.bases[pin]!);
      this.felt[pin] = Math.min(1, change / (rigid ? FULL_MOTION : FULL_STRETCH));
    });
  }
}
