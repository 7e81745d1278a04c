// The view "Read": a page, a hand that the person moves, and what the pins do under it.
import type { Core } from "../core";
import { type Design, dampingRatio } from "../design";
import { card, download, fileName, h, pause } from "../dom";
import type { Store } from "../store";
import { type Program, Thread } from "../thread";
import { deviceFile } from "../write";
import { ARM, type Arm } from "./arm";
import { Controls } from "./controls";
import { deviceInput } from "./device";
import { Display, type Shown } from "./display";
import type { Limits } from "./engine";
import type { Hand, HandRows } from "./hand";
import { HandControl } from "./handcontrol";
import { Outcomes } from "./outcomes";
import { isNarrow, Paper, type Spot, usualWidth } from "./paper";
import { Pins } from "./pins";
import { Playback } from "./playback";
import { Demonstration } from "./pointer";
import { pinDesign } from "./release";
import { FORMAT, packedPage } from "./saved";
import type { DeviceInput, Line } from "./scan";
import { type Sample, Session } from "./session";
import type { Drawn, Print, ReadState } from "./state";
import { TaskCard } from "./taskcard";
import { TASKS } from "./tasks";
import { Toolbar } from "./toolbar";

const PITCHES = [1, 2, 3, 4]; // mm, on the dial
const SETTLED = 200; // ms after which changed sliders have new limits
const SHORTEST = 5e-3; // m of way of a reading that is kept

/** Owner of the hand: nobody yet, a demonstration, a person; or nobody, after a reading, while the pins come to rest;
 * "kept" is a finished reading, which can be shown again. */
type Phase = "waiting" | "demonstration" | "reading" | "ending" | "kept";

export class ReadView {
  readonly element: HTMLElement;
  readonly session: Session;
  readonly paper = new Paper();
  phase: Phase = "waiting";
  private last: ReadState | null = null;
  /** The hand of the reading that is shown, if it is a finished one. */
  private kept: HandRows | null = null;
  readonly display: Display;
  private readonly judge: Thread;
  private readonly controls: Controls;
  private readonly tasks: TaskCard;
  private readonly outcomes: Outcomes;
  private readonly playback: Playback;
  private readonly toolbar: Toolbar;
  private readonly hand: HandControl;
  private input: DeviceInput;
  private lines: readonly Line[] = [];
  /** True of a hand that gives way, along a ruler. */
  private gives = false;
  private limitsAsked = 0;
  private limitsTimer = 0;
  private frame = 0;

  constructor(
    private readonly core: Core,
    program: Program,
    private readonly store: Store<ReadState>,
    private readonly say: (problem: string) => void,
    private readonly openRelease: (design: Design) => void,
  ) {
    this.input = deviceInput(core, store.now.device);
    this.display = new Display(
      core,
      this.paper,
      () => this.session,
      () => this.shown,
    );
    this.judge = new Thread(program);
    this.session = new Session(new Pins(program), this.judge, this.input, this.paper.raster, {
      sampled: (samples, hand) => this.sampled(samples, hand),
      judged: (lines) => this.judged(lines),
      began: () => this.began(),
      failed: (words) => this.say(words),
    });
    this.controls = new Controls((device, kind) => this.change({ device, hand: null }, kind));
    this.tasks = new TaskCard((task) => this.change({ task, print: this.printOf(task), hand: null }));
    this.outcomes = new Outcomes((line) => this.showLine(line));
    this.playback = new Playback(() => this.wake());
    this.hand = this.handControl();
    this.toolbar = new Toolbar({
      text: (text) =>
        this.change({ print: { kind: "text", text, width: usualWidth() }, task: 0, hand: null }, "text"),
      pen: (on) => this.setPen(on),
      clear: () => this.change({ print: blank(), hand: null }),
      ruler: (on) => {
        this.hand.ruler = on;
      },
      gives: (on) => {
        this.gives = on;
        if (this.phase === "waiting" || this.phase === "demonstration") this.restart();
      },
      slowness: (slowness) => this.change({ slowness, hand: null }),
      feedback: this.display.feedback,
    });
    this.element = h("div", { class: "read", hidden: true }, this.layout());
    store.listen(() => void this.update());
    addEventListener("resize", () => this.display.setPage(isNarrow()));
    this.display.setPage(isNarrow());
  }

  get state(): ReadState {
    return this.store.now;
  }
  private get hidden(): boolean {
    return this.element.hidden === true;
  }

  show(): void {
    this.element.hidden = false;
    document.title = "Read – pindrive studio";
    void this.update();
    this.wake();
  }

  hide(): void {
    this.element.hidden = true;
    if (this.phase === "reading") this.ended();
    if (this.phase === "demonstration") this.setPhase("waiting");
  }

  private change(change: Partial<ReadState>, kind = ""): void {
    this.store.change({ ...this.state, ...change }, kind);
  }

  // ---- the state is shown ------------------------------------------------------------------------

  /** Shows what is another in the state. */
  private async update(): Promise<void> {
    if (this.hidden) return;
    const [before, now] = [this.last, this.state];
    this.last = now;
    if (before === now) return;
    this.toolbar.update(now);
    this.tasks.show(now.task);
    this.controls.update(now.device);
    if (before?.print !== now.print) {
      if (!before) await pause();
      await this.setPrint(now.print);
      if (this.state !== now) return; // another call shows what has changed meanwhile
    }
    if (before?.device !== now.device) this.setDevice(now.device);
    const same =
      before && (["print", "device", "slowness"] as const).every((key) => before[key] === now[key]);
    if (now.hand && now.hand === this.kept && same) this.draw();
    else if (now.hand) this.keep(now.hand);
    else if (!same || before.hand) this.restart();
  }

  private async setPrint(print: Print): Promise<void> {
    const { paper } = this;
    try {
      await paper.print(print);
    } catch {
      this.say("The page of the reading is spoiled.");
    }
    this.display.setPage(isNarrow());
    this.session.setPage(paper.raster);
  }

  private setDevice(device: Design): void {
    this.input = deviceInput(this.core, device);
    this.session.setDevice(this.input);
    this.display.setDevice(device, this.input);
    this.toolbar.allowGives(this.display.level);
    this.askLimits();
  }

  private get arm(): Arm | null {
    return this.gives && this.display.level ? ARM : null;
  }

  /** Begins anew: with a demonstration, until there was a first reading, or with a hand that waits. */
  private restart(): void {
    this.playback.close();
    this.kept = null;
    const { x, y } = Demonstration.start;
    this.session.begin(1e-3 * x, 1e-3 * y, this.state.slowness, this.arm);
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const shows = !still && !this.store.canUndo && this.phase !== "reading";
    if (shows) this.hand.demonstrate(this.state.slowness);
    this.setPhase(shows ? "demonstration" : "waiting");
  }

  /** Shows a reading that was kept, at its end. */
  private keep(hand: HandRows): void {
    this.kept = hand;
    this.session.repeat(hand, this.state.slowness);
    this.setPhase("kept");
    this.playback.open(this.session.hand.end, this.session.hand.end);
  }

  private setPhase(phase: Phase): void {
    this.phase = phase;
    if (phase !== "demonstration") this.hand.demonstration = null;
    this.wake();
    this.draw();
    this.display.tell();
  }

  // ---- time --------------------------------------------------------------------------------------

  /** Lets time go on until nothing moves. */
  private wake(): void {
    if (this.frame || this.hidden) return;
    const step = (now: number): void => {
      this.frame = !this.hidden && this.step(now) ? requestAnimationFrame(step) : 0;
      if (!this.frame) this.draw();
    };
    this.frame = requestAnimationFrame(step);
  }

  /** Shows the time until now; false if nothing moves any more. */
  private step(now: number): boolean {
    const { session, hand, playback } = this;
    const { slowness } = this.state;
    if (this.phase === "kept") {
      playback.step(now, slowness);
      session.seek(playback.wanted);
      return playback.playing || session.time !== playback.wanted;
    }
    const aim = (wall: number): { x: number; y: number } => {
      const { x, y } = hand.aim(wall, slowness);
      return { x: 1e-3 * x, y: 1e-3 * y };
    };
    const moves = session.follow(now, aim, () => hand.straight);
    if (hand.demonstration?.ended(now)) this.setPhase("waiting");
    if (this.phase === "reading" && session.full) {
      this.ended();
      this.say("The reading is full, and was kept. Press on the page for the next one.");
    }
    if (this.phase === "ending" && !moves && !session.waits) this.finish();
    return moves || session.waits || hand.driven || this.phase === "demonstration";
  }

  // ---- a reading ---------------------------------------------------------------------------------

  private taken({ x, y }: Spot): void {
    if (this.phase === "ending") this.finish();
    this.playback.close();
    this.say("");
    this.kept = null;
    this.session.begin(1e-3 * x, 1e-3 * y, this.state.slowness, this.arm);
    this.tasks.began();
    this.setPhase("reading");
  }

  /** The hand is let go: the reading is finished when the pins are at rest. */
  private ended(): void {
    const { start, last } = this.session.hand;
    const went = Math.hypot(last.x - start.x, last.y - start.y) > SHORTEST || this.lines.length > 0;
    if (went) this.setPhase("ending");
    else if (this.state.hand) this.keep(this.state.hand);
    else this.setPhase("waiting");
  }

  /** Keeps the reading that was made. */
  private finish(): void {
    const { session } = this;
    session.keep();
    this.phase = "kept";
    this.kept = session.hand.saved;
    this.change({ hand: this.kept });
    this.playback.open(session.hand.end, session.time);
    this.draw();
  }

  private began(): void {
    this.display.begin();
    if (!this.session.repeating) this.lines = [];
    this.showLines();
  }

  private sampled(samples: readonly Sample[], hand: Hand): void {
    if (this.session.repeating) this.showLines();
    this.display.show(samples, hand);
  }

  private judged(lines: readonly Line[]): void {
    this.lines = lines;
    this.showLines();
    if (this.phase === "demonstration") return;
    const { hand, samples } = this.session;
    const { chosen, limits } = this.display;
    this.tasks.judge(lines, hand, { limits, samples, chosen, ratio: dampingRatio(this.state.device.values) });
    this.draw();
  }

  /** The lines until the time that is shown. */
  get evaluated(): readonly Line[] {
    const { session, lines } = this;
    return session.repeating ? lines.filter(({ time }) => time <= session.time) : lines;
  }

  private showLines(): void {
    this.display.readouts.showLines(this.evaluated);
    this.outcomes.update(this.phase === "kept" ? this.lines : this.evaluated);
  }

  /** Shows the moment of a line. */
  private showLine({ pin, time }: Line): void {
    if (this.phase === "reading" || this.phase === "ending") this.finish();
    this.display.choose(pin);
    this.playback.goTo(time);
  }

  /** The sentence while nothing happens. */
  private get waiting(): string {
    if (this.phase === "demonstration") return "Watch one stroke, or take the hand.";
    if (this.phase === "kept" || this.phase === "ending")
      return "The reading is finished: Play shows it again, Save and Share keep it.";
    return isNarrow()
      ? "Drag a finger across the print, from left to right."
      : "Move across the print, from left to right.";
  }

  /** Words over the page. */
  private get notice(): string {
    if (this.hand.pen) return this.paper.title === "a drawing" ? "" : "Draw here";
    const narrow = isNarrow();
    switch (this.phase) {
      case "demonstration":
        return `Demonstration: ${narrow ? "drag" : "move over the page"} to take the hand`;
      case "waiting":
        return narrow ? "Drag a finger across to read" : "Move across the page to read it";
      case "kept":
        if (this.playback.playing) return "";
        return narrow ? "Finished. Drag to read again" : "Finished. Press on the page to read again";
      default:
        return "";
    }
  }

  private askLimits(): void {
    clearTimeout(this.limitsTimer);
    this.limitsTimer = window.setTimeout(() => {
      this.limitsAsked += 1;
      const number = this.limitsAsked;
      const task = { limits: { device: this.input, pitches: PITCHES.map((pitch) => 1e-3 * pitch) } };
      void this.judge.ask("read", task).then((answer) => {
        if (number !== this.limitsAsked || !answer || !("limits" in answer)) return;
        const { limits } = answer as Limits;
        const { display } = this;
        const before = display.limits;
        display.limits = limits.map(({ to }, i) => ({ pitch: PITCHES[i]!, speed: 1e3 * to }));
        display.readouts.showLimits(display.limits, before);
        this.draw();
      });
    }, SETTLED);
  }

  private get shown(): Shown {
    const demonstrates = this.phase === "demonstration";
    return {
      notice: this.notice,
      waiting: this.waiting,
      moved: this.phase === "reading" || demonstrates || this.playback.playing,
      lines: demonstrates ? [] : this.evaluated,
    };
  }

  private draw(): void {
    if (!this.hidden) this.display.draw();
  }

  // ---- what the person does ----------------------------------------------------------------------

  private handControl(): HandControl {
    return new HandControl(this.display.drawings.sheet.element, {
      width: () => this.paper.width,
      place: () => {
        const { x, y } = this.session.hand.last;
        return { x: 1e3 * x, y: 1e3 * y };
      },
      reads: () => this.phase === "reading",
      free: () => this.phase === "waiting" || this.phase === "demonstration",
      taken: (at) => this.taken(at),
      moved: () => this.wake(),
      ended: () => this.ended(),
      drawn: (from, to) => {
        this.paper.draw(from, to);
        this.draw();
      },
      printed: (stroke) => {
        const { print } = this.state;
        const before = print.kind === "drawing" ? print : blank();
        this.change({ print: { ...before, strokes: [...before.strokes, stroke] }, hand: null });
      },
    });
  }

  /** A pen draws on a blank page, or on the drawing that is there. */
  private setPen(on: boolean): void {
    this.hand.pen = on;
    this.display.drawings.sheet.element.classList.toggle("pen", on);
    if (on && this.state.print.kind !== "drawing") this.change({ print: blank(), task: 0, hand: null });
    else this.draw();
  }

  private printOf(task: number): Print {
    return TASKS[task]!.page(usualWidth());
  }

  /** Opens "One release" with the motion of the chosen pin. */
  private async openPin(): Promise<void> {
    const { hand } = this.session;
    const { chosen, picture } = this.display;
    const load = await this.session.load(chosen);
    if (load && picture) {
      this.openRelease(pinDesign(this.state.device, hand, picture.axis, load, chosen));
    }
  }

  togglePlayer(): void {
    if (this.phase === "kept") this.playback.toggle();
  }

  async save(kind: string): Promise<void> {
    const { paper, session, state } = this;
    const device = deviceFile(state.device);
    const name = fileName(paper.title);
    if (kind === "device") download("device.toml", device, "application/toml");
    if (kind === "file") {
      const page = await packedPage(state.print);
      const reading = { format: FORMAT, device, page, hand: session.hand.saved };
      download(`${name}.json`, JSON.stringify(reading), "application/json");
    }
  }

  // ---- the parts ---------------------------------------------------------------------------------

  private layout(): HTMLElement {
    const { drawings, readouts, pins } = this.display;
    const page = card(
      "read-page",
      "Read with your own hand",
      h(
        "p",
        { class: "what intro" },
        "Under your fingertip are pins. Where one crosses black, its ",
        h("span", { class: "magnet" }, "magnet"),
        " clamps it to the page, and the moving hand leaves it behind: ",
        h("span", { class: "dragged" }, "that is what you feel"),
        ".",
      ),
      this.toolbar.element,
      drawings.sheet.element,
      readouts.now,
      readouts.spoken,
      this.playback.element,
      drawings.image.element,
      h(
        "p",
        { class: "note" },
        "What the fingertip got: how far each pin was ",
        h("span", { class: "dragged" }, "dragged"),
        " or ",
        h("span", { class: "thrown" }, "thrown past its rest"),
        ", where its sensor was; the print in outline.",
      ),
      this.outcomes.element,
    );
    const openPin = h(
      "button",
      {
        type: "button",
        title: "The whole motion of this pin, in One release",
        onclick: () => void this.openPin(),
      },
      "Open its motion",
    );
    const [tip, side] = drawings.cards(h("div", { class: "toolbar" }, pins, openPin));
    const change = card("device-card", "Change the device under your hand", this.controls.element);
    return h(
      "main",
      { class: "reading" },
      h("div", { class: "column" }, page, h("div", { class: "lower" }, side, change)),
      h("div", { class: "column" }, this.tasks.element, tip, readouts.card(drawings.dial.element)),
    );
  }
}

function blank(): Drawn {
  return { kind: "drawing", strokes: [], width: usualWidth() };
}
