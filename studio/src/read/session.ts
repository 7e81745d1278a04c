// One reading: a hand over a page, advanced with the pictures, and repeated at any speed.

import type { Thread } from "../thread";
import { type Answer, type Load, SAMPLED, type Samples, type Verdict } from "./engine";
import { Hand, type HandRows, type Motion, TICK } from "./hand";
import type { Pins } from "./pins";
import type { DeviceInput, Line, Raster, Shown } from "./scan";

const MM = 1e-3;
const KEPT = 0.3; // s of the device for which samples are kept
const LONGEST = 30_000; // rows of a reading, after which another begins
const LATE = 25; // ms of the wall clock between two pictures beyond which time stands still
const JUDGED = 300; // ms between two evaluations of the lines at least
const REST = 3; // times that the evaluation rests as long as it took, for the threads of the pins

/** Quantities of all pins at a time, s of the device. */
export interface Sample {
  readonly time: number;
  readonly values: Readonly<Record<Shown, Float64Array>>;
}

export interface Listener {
  /** Samples since the last picture, in order; the last one is shown now. */
  sampled(samples: readonly Sample[], hand: Hand): void;
  judged(lines: readonly Line[], falseLines: number): void;
  began(): void;
  failed(words: string): void;
}

export class Session {
  hand = new Hand({ x: 4 * MM, y: 6.25 * MM });
  samples: Sample[] = [];
  /** Times that the pictures took in the threads of the pins, ms, for tests. */
  readonly took: number[] = [];
  private replay: HandRows | null = null;
  private shown = 0;
  private sent = 0;
  private wall = 0;
  private epoch = 0;
  private pending = false;
  /** Time that a repeated reading is to show. */
  private wanted = 0;
  private judgedRows = 0;
  /** Time from which the lines may be evaluated again, ms. */
  private judgeFrom = 0;

  constructor(
    private readonly live: Pins,
    private readonly judge: Thread,
    private device: DeviceInput,
    private page: Raster,
    private readonly listener: Listener,
  ) {}

  /** Time that is shown, s of the device. */
  get time(): number {
    return this.shown;
  }
  get pins(): number {
    return this.device.spots.length;
  }
  /** Device, page and hand so far, for the thread. */
  private get opening(): { device: DeviceInput; page: Raster; start: { x: number; y: number } } {
    return { device: this.device, page: this.page, start: this.hand.start };
  }

  setDevice(device: DeviceInput): void {
    this.device = device;
  }
  setPage(page: Raster): void {
    this.page = page;
  }

  /** Begins a reading at a place, m, with pins at rest. */
  begin(x: number, y: number): void {
    const { slowness } = this.hand;
    this.hand = new Hand({ x, y });
    this.hand.slowness = slowness;
    this.replay = null;
    this.open();
  }

  /** Begins to repeat a reading. */
  repeat(saved: HandRows): void {
    const { slowness } = this.hand;
    this.hand = Hand.of(saved);
    this.hand.slowness = slowness;
    this.replay = saved;
    this.open();
  }
  get repeating(): boolean {
    return this.replay !== null;
  }

  private open(): void {
    ++this.epoch;
    [this.shown, this.sent, this.wall, this.pending] = [0, 0, 0, false];
    [this.samples, this.judgedRows] = [[], 0];
    this.listener.began();
    void this.live.open(this.opening).then((answer) => this.checked(answer));
  }

  /** The hand follows an aim, m, until now (ms), and the pins follow the hand. */
  follow(now: number, aim: (wall: number) => { x: number; y: number }, straight: () => boolean): void {
    if (this.pending) return; // time waits for a thread that is late
    if (!this.wall) this.wall = now - TICK;
    this.wall = Math.max(this.wall, now - LATE);
    while (this.wall < now) {
      const at = aim(this.wall);
      if (!this.hand.rests(at, straight())) this.hand.follow(at, straight());
      this.wall += TICK;
    }
    const ahead = ((this.wall - now) * 1e-3) / this.hand.slowness;
    this.advance(Math.max(this.shown, this.hand.end - ahead));
    if (this.hand.count > LONGEST) this.begin(this.hand.last.x, this.hand.last.y);
    this.evaluate(now);
  }

  /** Shows another time of a reading that is repeated, s of the device. */
  seek(time: number): void {
    this.wanted = Math.min(time, this.hand.end);
    if (this.wanted < this.shown) this.open();
    this.advance(this.wanted);
  }

  private advance(until: number): void {
    if (this.pending || !(until > this.shown)) return;
    const { hand, epoch } = this;
    const rows = hand.rowsFrom(this.sent);
    [this.sent, this.pending] = [hand.count, true];
    void this.live.advance({ rows, until }).then((answer) => {
      if (epoch !== this.epoch) return;
      this.pending = false;
      if (!this.checked(answer)) return;
      this.take(answer as Samples);
      if (this.repeating) this.advance(this.wanted);
    });
  }

  private checked(answer: Answer): boolean {
    if (!answer || !("failed" in answer)) return true;
    this.listener.failed(answer.failed);
    return false;
  }

  private take({ until, times, values, took }: Samples): void {
    const { pins } = this;
    const found = Array.from(times, (time, i): Sample => {
      const of = (q: number): Float64Array => {
        const from = (i * SAMPLED.length + q) * pins;
        return values.subarray(from, from + pins);
      };
      return {
        time,
        values: Object.fromEntries(SAMPLED.map((name, q) => [name, of(q)])) as Sample["values"],
      };
    });
    this.shown = until;
    this.samples = [...this.samples, ...found].filter(({ time }) => time > until - KEPT);
    this.took.push(took);
    this.listener.sampled(found, this.hand);
  }

  /** Rows of the factor of the plate friction of a pin under the hand so far; null if there are none. */
  async load(pin: number): Promise<Load["load"] | null> {
    const task = { load: { ...this.opening, rows: this.hand.rowsFrom(0), pin } };
    const answer = this.hand.count < 2 ? null : await this.judge.ask("read", task);
    return answer && "load" in answer ? answer.load : null;
  }

  /** Has the lines evaluated now and then, in the other thread. */
  private evaluate(now: number): void {
    const { hand, epoch } = this;
    if (!this.judge.idle || now < this.judgeFrom || hand.count === this.judgedRows) return;
    if (hand.count < 2) return;
    this.judgedRows = hand.count;
    const task = { judge: { ...this.opening, rows: hand.rowsFrom(0) } };
    void this.judge.ask("read", task).then((answer) => {
      const took = performance.now() - now;
      this.judgeFrom = now + took + Math.max(JUDGED, REST * took);
      if (epoch !== this.epoch || !answer || !("lines" in answer)) return;
      const { lines, falseLines } = answer as Verdict;
      this.listener.judged(lines, falseLines);
    });
  }

  /** Place and velocity of the hand now. */
  get motion(): Motion {
    return this.hand.at(this.shown);
  }
}
