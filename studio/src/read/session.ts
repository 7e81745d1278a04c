// One reading: a hand over a page, advanced with the pictures, and repeated at any speed.

import type { Thread } from "../thread";
import type { Arm } from "./arm";
import { type Answer, type Load, SAMPLED, type Samples, type Verdict } from "./engine";
import { Hand, type HandRows, type Motion, type Slowness, TICK } from "./hand";
import type { Pins } from "./pins";
import type { DeviceInput, Line, Raster, Shown } from "./scan";

const MM = 1e-3;
const KEPT = 0.3; // s of the device for which samples are kept
const LONGEST = 30_000; // rows of a reading
const LATE = 25; // ms of the wall clock between two pictures beyond which time stands still
const JUDGED = 300; // ms between two evaluations of the lines at least
const GIVES = 0.5; // s of the device that a hand which gives way is followed behind a ruler at rest
const REST = 3; // times that the evaluation rests as long as it took, for the threads of the pins

/** Quantities of all pins at a time, s of the device. */
export interface Sample {
  readonly time: number;
  readonly values: Readonly<Record<Shown, Float64Array>>;
}

export interface Listener {
  /** Samples since the last picture, in order; the last one is shown now. */
  sampled(samples: readonly Sample[], hand: Hand): void;
  /** Lines of the hand so far, or of a whole reading that is repeated. */
  judged(lines: readonly Line[]): void;
  began(): void;
  failed(words: string): void;
}

export class Session {
  hand = new Hand({ x: 4 * MM, y: 6.25 * MM }, 10);
  /** Intended motion of a hand that gives way, along the ruler. */
  intended: Hand | null = null;
  private arm: Arm | null = null;
  samples: Sample[] = [];
  /** Times that the pictures took in the threads of the pins, ms, for tests. */
  readonly took: number[] = [];
  private replayed = false;
  private shown = 0;
  private sent = 0;
  private wall = 0;
  private epoch = 0;
  /** True while an answer of the pins is awaited, and before there are any. */
  private pending = true;
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
  /** The motion that follows the aim. */
  private get lead(): Hand {
    return this.intended ?? this.hand;
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

  /** Begins a reading at a place, m, with pins at rest; an arm leads a hand that gives way. */
  begin(x: number, y: number, slowness: Slowness, arm: Arm | null): void {
    this.hand = new Hand({ x, y }, slowness);
    this.intended = arm && new Hand({ x, y }, slowness);
    this.arm = arm;
    [this.replayed, this.judgedRows] = [false, 0];
    this.open();
  }

  /** Begins to repeat a reading. */
  repeat(saved: HandRows, slowness: Slowness): void {
    this.hand = Hand.of(saved, slowness);
    [this.intended, this.arm] = [null, null];
    [this.replayed, this.judgedRows] = [true, 0];
    this.open();
    this.evaluate(0);
  }
  get repeating(): boolean {
    return this.replayed;
  }

  /** Repeats from now on the reading that was just made, at whose end it stands. */
  keep(): void {
    this.replayed = true;
    [this.intended, this.arm] = [null, null];
    this.judgeFrom = 0;
    this.evaluate(0);
  }

  /** True for a reading with the largest number of rows. */
  get full(): boolean {
    return this.hand.count >= LONGEST;
  }
  /** True if an answer of the pins or of the evaluation is awaited. */
  get waits(): boolean {
    return this.pending || !this.judge.idle;
  }

  private open(): void {
    ++this.epoch;
    [this.shown, this.sent, this.wall, this.pending] = [0, 0, 0, false];
    this.samples = [];
    this.listener.began();
    void this.live.open({ ...this.opening, arm: this.arm }).then((answer) => this.checked(answer));
  }

  /** The hand follows an aim, m, until now (ms), and the pins follow the hand; false if the hand rests at its aim. */
  follow(now: number, aim: (wall: number) => { x: number; y: number }, straight: () => boolean): boolean {
    if (this.pending) return true; // time waits for a thread that is late
    if (!this.wall) this.wall = now - TICK;
    this.wall = Math.max(this.wall, now - LATE);
    let moves = false;
    const { lead, intended } = this;
    const level = straight() || intended !== null;
    while (this.wall < now) {
      const at = aim(this.wall);
      moves = !lead.rests(at, level, intended ? GIVES : undefined) && !this.full;
      if (moves) lead.follow(at, level);
      this.wall += TICK;
    }
    const ahead = moves && !intended ? ((this.wall - now) * 1e-3) / lead.slowness : 0;
    this.advance(Math.max(this.shown, lead.end - ahead));
    this.evaluate(now);
    return moves || this.shown < lead.end || this.hand.count !== this.judgedRows;
  }

  /** Shows another time of a reading that is repeated, s of the device. */
  seek(time: number): void {
    this.wanted = Math.min(time, this.hand.end);
    if (this.wanted < this.shown) this.open();
    this.advance(this.wanted);
  }

  private advance(until: number): void {
    if (this.pending || !(until > this.shown)) return;
    const { lead, epoch } = this;
    const rows = lead.rowsFrom(this.sent);
    [this.sent, this.pending] = [lead.count, true];
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

  private take({ until, times, values, rows, took }: Samples): void {
    const { pins } = this;
    this.hand.extend(rows);
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

  /** Evaluates the lines from time to time, in the other thread. */
  private evaluate(now: number): void {
    const { hand } = this;
    const began = performance.now();
    const waits = !this.replayed && (!this.judge.idle || now < this.judgeFrom);
    if (waits || hand.count === this.judgedRows || hand.count < 2) return;
    this.judgedRows = hand.count;
    const task = { judge: { ...this.opening, rows: hand.rowsFrom(0) } };
    void this.judge.ask("read", task).then((answer) => {
      const took = performance.now() - began;
      this.judgeFrom = began + took + Math.max(JUDGED, REST * took);
      if (hand !== this.hand || !answer || !("lines" in answer)) return;
      this.listener.judged((answer as Verdict).lines);
    });
  }

  /** Place and velocity of the hand now. */
  get motion(): Motion {
    return this.hand.at(this.shown);
  }
}
