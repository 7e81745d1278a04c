// The view "Read": a page, a hand that the person moves, and what the pins do under it.
import type { Core, Row } from "../core";
import { type Design, dampingRatio, designOf } from "../design";
import { DeviceError } from "../device";
import { button, card, download, fileName, h, menu, option } from "../dom";
import { choose } from "../files";
import { help } from "../help";
import { navigation } from "../navigation";
import { TABLES } from "../table";
import { currentLook } from "../theme";
import { type Program, Thread } from "../thread";
import { deviceFile } from "../write";
import { Controls } from "./controls";
import { deviceInput, spotsOf, valuesOf } from "./device";
import type { Limit } from "./dial";
import { Drawings } from "./drawings";
import type { Limits } from "./engine";
import { Feedback, VIBRATES } from "./feedback";
import { Felt } from "./felt";
import { type Hand, SLOWNESS, type Slowness } from "./hand";
import { HandControl } from "./handcontrol";
import { Paper } from "./paper";
import { colorsOf, type Picture } from "./picture";
import { Pins } from "./pins";
import { Demonstration } from "./pointer";
import { Readouts } from "./readouts";
import { pinDesign } from "./release";
import { readingHash, readingOf, readingOfHash, readingText, type SavedReading } from "./saved";
import type { DeviceInput, Line } from "./scan";
import { speedOf } from "./sentence";
import { type Sample, Session } from "./session";
import { Skin } from "./skin";
import { TASKS } from "./tasks";

const [WIDE, NARROW] = [44, 36]; // mm of page on a screen, and on a telephone
const PITCHES = [1, 2, 3, 4]; // mm, on the dial
const REPEATED = 4; // times that a repeated reading is slower than the reading
const SETTLED = 200; // ms after which changed sliders have new limits

export class ReadView {
  readonly element: HTMLElement;
  readonly session: Session;
  limits: Limit[] = [];
  private readonly paper = new Paper(innerWidth < 600 ? NARROW : WIDE);
  private readonly felt: Felt;
  private readonly skin: Skin;
  private readonly judge: Thread;
  private readonly drawings: Drawings;
  private readonly readouts = new Readouts();
  private readonly feedback = new Feedback();
  private readonly controls: Controls;
  private readonly hand: HandControl;
  private input: DeviceInput;
  private lines: readonly Line[] = [];
  private picture: Picture | null = null;
  private look = currentLook();
  private chosen: number;
  private speed = 0;
  private peak = 0;
  private task = -1;
  private repeatFrom = 0;
  private limitsAsked = 0;
  private limitsTimer = 0;
  private frame = 0;
  private readonly text = h("input", {
    type: "text",
    value: "Hello",
    maxlength: 12,
    "aria-label": "text on the page",
  });
  private readonly again = button("Replay", "Repeat this reading, slower", () => this.repeat());
  private readonly scrub = h("input", {
    type: "range",
    min: 0,
    max: 1000,
    step: "any",
    "aria-label": "time of the reading",
    hidden: true,
  });
  private readonly pins = h("select", { "aria-label": "pin from the side" });
  private readonly tasks: HTMLElement[];

  constructor(
    private readonly core: Core,
    program: Program,
    private design: Design,
    private readonly showRelease: (design: Design) => void,
  ) {
    this.paper.text("Hello");
    this.input = deviceInput(this.core, design);
    this.chosen = middleOf(this.input.spots);
    this.felt = new Felt(this.paper.width, this.input.spots);
    this.skin = new Skin(this.input.spots.length);
    this.judge = new Thread(program);
    this.session = new Session(new Pins(program), this.judge, this.input, this.paper.raster, {
      sampled: (samples, hand) => this.sampled(samples, hand),
      judged: (lines, falseLines) => this.judged(lines, falseLines),
      began: () => this.began(),
      failed: (words) => this.readouts.say(words),
    });
    this.controls = new Controls(design, (changed) => this.setDesign(changed));
    this.drawings = new Drawings(
      this.paper,
      this.felt,
      () => this.draw(),
      (pin) => this.choosePin(pin),
    );
    this.hand = this.handControl();
    this.tasks = TASKS.map((task, i) =>
      h(
        "button",
        { type: "button", "aria-pressed": "false", onclick: () => this.setTask(i) },
        h("b", {}, `${i + 1} · ${task.name}`),
        h("span", {}, task.what),
        h("em", { role: "status" }),
      ),
    );
    this.fillPins();
    this.element = h("div", { class: "read" }, this.header(), this.layout());
    this.listen();
  }

  /** Begins: a demonstration runs until someone takes the hand. */
  start(): void {
    if (this.frame) return;
    const step = (now: number): void => {
      this.frame = requestAnimationFrame(step);
      this.step(now);
    };
    this.frame = requestAnimationFrame(step);
    if (!this.session.hand.count) this.demonstrate();
    this.askLimits();
  }

  stop(): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
  }

  say(problem: string): void {
    this.readouts.say(problem);
  }

  private demonstrate(): void {
    const { x, y } = Demonstration.start;
    this.session.begin(1e-3 * x, 1e-3 * y);
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (!still) this.hand.demonstrate(this.session.hand.slowness);
  }

  // ---- time ----------------------------------------------------------------------------------------

  private step(now: number): void {
    const { session, hand } = this;
    if (session.repeating) {
      if (!this.repeatFrom) return;
      const time = ((now - this.repeatFrom) * 1e-3) / (REPEATED * session.hand.slowness);
      session.seek(time);
      this.scrub.value = String((1000 * time) / session.hand.end);
      if (time >= session.hand.end) this.repeatFrom = 0;
      return;
    }
    const aim = (wall: number): { x: number; y: number } => {
      const { x, y } = hand.aim(wall, session.hand.slowness);
      return { x: 1e-3 * x, y: 1e-3 * y };
    };
    session.follow(now, aim, () => hand.straight);
    if (hand.demonstration?.ended(now)) this.demonstrate();
  }

  // ---- what comes back -----------------------------------------------------------------------------

  private began(): void {
    this.felt.clear();
    this.skin.begin(this.input.spots.length);
    this.lines = [];
    this.readouts.showLines([], 0);
    this.readouts.say("");
  }

  private sampled(samples: readonly Sample[], hand: Hand): void {
    const last = samples[samples.length - 1];
    if (!last) return;
    for (const sample of samples) {
      this.skin.follow(sample);
      this.feedback.announce(this.skin.felt, this.input.spots);
    }
    this.felt.paint(samples, hand);
    const motion = hand.at(last.time);
    const values = valuesOf(this.design);
    const axis = (values["array.axis"] as number | undefined) ?? 0;
    this.picture = {
      sample: last,
      hand: motion,
      spots: this.input.spots,
      axis: [Math.cos(axis), Math.sin(axis)],
      hold: (values["magnet.hold_force"] as number | undefined) ?? Math.max(...last.values.pull, 1e-9),
      felt: this.skin.felt,
      chosen: this.chosen,
      look: this.look,
      colors: colorsOf(this.look),
    };
    const speed = 1e3 * speedOf(motion);
    this.speed += 0.25 * (speed - this.speed);
    this.peak = Math.max(0.985 * this.peak, speed);
    this.draw();
    this.readouts.tell(this.picture, this.waiting);
    this.readouts.showSpeed(this.speed, this.session.hand.slowness, this.limits);
  }

  private get waiting(): string {
    if (this.hand.demonstration) return "Watch one stroke, or take the hand: move the pointer over the page.";
    return innerWidth < 600
      ? "Drag a finger across here, from left to right: the hand moves as much as your finger, like a mouse."
      : "Move across the print, from left to right.";
  }

  private judged(lines: readonly Line[], falseLines: number): void {
    this.lines = lines;
    this.readouts.showLines(lines, falseLines);
    const { hand, samples } = this.session;
    const { chosen, limits } = this;
    const ratio = dampingRatio(this.design.values);
    const said = TASKS[this.task]?.verdict({ lines, hand, limits, samples, chosen, ratio });
    if (said) this.tasks[this.task]!.querySelector("em")!.textContent = said;
  }

  /** Lines of the reading so far, as they were evaluated last. */
  get evaluated(): readonly Line[] {
    return this.lines;
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
        const before = this.limits;
        this.limits = limits.map(({ to }, i) => ({ pitch: PITCHES[i]!, speed: 1e3 * to }));
        this.readouts.showLimits(this.limits, before);
        this.draw();
      });
    }, SETTLED);
  }

  private draw(): void {
    const { look, picture, speed, peak, limits } = this;
    const { "array.spot_scale": _, ...places } = valuesOf(this.design);
    this.drawings.draw({
      look,
      picture: picture && { ...picture, chosen: this.chosen },
      places: spotsOf(this.core, places),
      samples: this.session.samples,
      threshold: this.input.numbers["control.threshold"] ?? 0.5,
      demonstration: this.hand.demonstration !== null,
      speed,
      peak,
      limits,
    });
  }

  // ---- changes -------------------------------------------------------------------------------------

  /** Another device, or other values of this one: the reading begins anew where the hand is. */
  private setDesign(design: Design): void {
    const pins = this.input.spots.length;
    this.design = design;
    this.input = deviceInput(this.core, design);
    this.session.setDevice(this.input);
    this.felt.setSpots(this.input.spots);
    if (this.input.spots.length !== pins) {
      this.chosen = middleOf(this.input.spots);
      this.fillPins();
    }
    this.picture = null;
    this.restart();
    this.askLimits();
  }
  /** The device of another view, or of a file. */
  open(design: Design): void {
    this.controls.setDesign(design);
    this.setDesign(design);
  }

  private restart(): void {
    this.endReplay();
    if (this.hand.demonstration) {
      this.demonstrate();
      return;
    }
    const { x, y } = this.session.hand.at(this.session.time);
    this.session.begin(x, y);
  }

  private setPage(): void {
    this.session.setPage(this.paper.raster);
    this.restart();
  }

  private setTask(number: number): void {
    this.task = number;
    this.tasks.forEach((element, i) => {
      element.setAttribute("aria-pressed", String(i === number));
      element.querySelector("em")!.textContent = i === number ? "Move over the page." : "";
    });
    const page = TASKS[number]!.page(this.paper.width);
    if (typeof page === "string") {
      this.text.value = page;
      this.paper.text(page);
    } else this.paper.lines(page);
    this.setPage();
  }

  private setSlowness(slowness: Slowness): void {
    this.session.hand.slowness = slowness;
    this.restart();
  }

  private setPen(on: boolean): void {
    this.hand.pen = on;
    this.drawings.sheet.element.classList.toggle("pen", on);
    if (!on) return;
    this.hand.demonstration = null;
    this.paper.blank();
    this.setPage();
  }

  /** Opens "One release" with the motion of the chosen pin. */
  private async openPin(): Promise<void> {
    const { hand } = this.session;
    const load = await this.session.load(this.chosen);
    if (load && this.picture) {
      this.showRelease(pinDesign(this.design, hand, this.picture.axis, load, this.chosen));
    }
  }

  private choosePin(pin: number): void {
    this.chosen = pin;
    this.pins.value = String(pin);
    this.draw();
  }

  private fillPins(): void {
    const numbers = this.input.spots.map((_, pin) =>
      option(String(pin), `pin ${pin + 1}`, pin === this.chosen),
    );
    this.pins.replaceChildren(...numbers);
  }

  // ---- readings and files --------------------------------------------------------------------------

  get reading(): SavedReading {
    const { raster: page, title } = this.paper;
    return { device: deviceFile(this.design), page, title, hand: this.session.hand.saved };
  }

  /** Shows a reading that was saved, and repeats it. */
  private show(reading: SavedReading, file: string): void {
    const design = designOf(this.core, { text: reading.device, file, rows: {} });
    this.paper.show(reading.page, reading.title);
    this.session.setPage(this.paper.raster);
    this.open(design);
    this.replay(reading.hand);
  }

  private repeat(): void {
    const { saved } = this.session.hand;
    if (this.session.repeating) this.restart();
    else if (saved.rows.length > 1) this.replay(saved);
  }

  private replay(hand: SavedReading["hand"]): void {
    this.hand.demonstration = null;
    this.session.repeat(hand);
    this.scrub.hidden = false;
    this.again.textContent = "End replay";
    this.repeatFrom = performance.now();
  }
  private endReplay(): void {
    this.scrub.hidden = true;
    this.again.textContent = "Replay";
    this.repeatFrom = 0;
  }

  /** Opens a device file, a saved reading or a picture; what is wrong is said in words. */
  async takeFile(file: File): Promise<void> {
    const { name } = file;
    try {
      if (/\.json$/i.test(name)) this.show(await readingOf(await file.text()), name);
      else if (/\.toml$/i.test(name))
        this.open(designOf(this.core, { text: await file.text(), file: name, rows: {} }));
      else await this.takePicture(file);
    } catch (error) {
      this.say(error instanceof DeviceError ? error.message : `${name}: ${(error as Error).message}`);
    }
  }
  /** Opens the reading of a link. */
  async takeLink(packed: string): Promise<void> {
    try {
      this.show(await readingOfHash(packed), "the link");
    } catch (error) {
      this.say(error instanceof DeviceError ? error.message : "the link holds no reading, or is cut off");
    }
  }

  private async takePicture(file: File): Promise<void> {
    await this.paper.picture(file, file.name);
    this.setPage();
  }

  private async save(kind: string): Promise<void> {
    const { reading } = this;
    const name = fileName(this.paper.title);
    if (kind === "file") download(`${name}.json`, await readingText(reading), "application/json");
    if (kind === "device") download("device.toml", reading.device, "application/toml");
    if (kind === "link") {
      history.replaceState(null, "", `#read=${await readingHash(reading)}`);
      await navigator.clipboard?.writeText(location.href).catch(() => undefined);
      this.readouts.spoken.textContent = "The link is in the address bar.";
    }
  }

  // ---- the parts of the page -----------------------------------------------------------------------

  private listen(): void {
    this.scrub.addEventListener("input", () => {
      this.repeatFrom = 0;
      this.session.seek((Number(this.scrub.value) / 1000) * this.session.hand.end);
    });
    this.pins.addEventListener("change", () => this.choosePin(Number(this.pins.value)));
    this.text.addEventListener("input", () => {
      this.paper.text(this.text.value || " ");
      this.setPage();
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.look = currentLook();
    });
  }

  private handControl(): HandControl {
    return new HandControl(this.drawings.sheet.element, {
      width: this.paper.width,
      shown: () => this.drawings.sheet.width,
      place: () => {
        const { x, y } = this.session.hand.last;
        return { x: 1e3 * x, y: 1e3 * y };
      },
      repeating: () => this.session.repeating,
      taken: ({ x, y }) => {
        this.endReplay();
        this.session.begin(1e-3 * x, 1e-3 * y);
      },
      drawn: (from, to) => {
        this.paper.draw(from, to);
        this.draw();
      },
      printed: () => {
        this.paper.printed();
        this.setPage();
      },
    });
  }

  private header(): HTMLElement {
    const save = menu(
      "Save as",
      [
        ["file", "Reading (JSON)"],
        ["device", "Device file (TOML)"],
      ],
      (kind) => void this.save(kind),
    );
    const share = button("Share", "A link to this reading, in the clipboard", () => void this.save("link"));
    const open = button(
      "Open …",
      "A picture of a page, a saved reading (JSON), or a device file (TOML)",
      () => choose("image/*,.json,.toml", (file) => void this.takeFile(file)),
    );
    const buttons = h("div", { class: "buttons" }, open, save, share, help("read"));
    return h(
      "header",
      {},
      h("h1", { title: `pindrive ${TABLES.version}` }, "pindrive studio"),
      navigation("read"),
      buttons,
    );
  }

  private toolbar(): HTMLElement {
    const times = h("fieldset", { class: "group" }, h("legend", { class: "visually-hidden" }, "time runs"));
    for (const slowness of SLOWNESS) {
      const usual = slowness === this.session.hand.slowness;
      const radio = h("input", { type: "radio", name: "slowness", value: slowness, checked: usual });
      radio.addEventListener("change", () => this.setSlowness(slowness));
      times.append(h("label", {}, radio, slowness === 1 ? "real time" : `${slowness}× slower`));
    }
    const pen = toggle("Draw", "Draw on the page", (on) => this.setPen(on));
    const ruler = toggle("Along a ruler", "The hand keeps its height", (on) => {
      this.hand.ruler = on;
    });
    const sound = toggle("Sound", "A short tone, on its side, for each pin that moves the skin", (on) => {
      this.feedback.sound = on;
    });
    const vibration = toggle("Vibration", "A short vibration of this device when skin is moved", (on) => {
      this.feedback.vibration = on;
    });
    vibration.hidden = !VIBRATES;
    const text = h("label", {}, "Text ", this.text);
    return h("div", { class: "toolbar" }, text, pen, ruler, this.again, sound, vibration, times);
  }

  private layout(): HTMLElement {
    const { drawings, readouts } = this;
    const page = card(
      "read-page",
      "Read with your own hand",
      h(
        "p",
        { class: "what" },
        "Under your fingertip are pins. Where one crosses black, its ",
        h("span", { class: "magnet" }, "magnet"),
        " clamps it to the page, and the moving hand leaves it behind: ",
        h("span", { class: "dragged" }, "that is what you feel"),
        ".",
      ),
      readouts.problem,
      this.toolbar(),
      drawings.sheet.element,
      readouts.now,
      readouts.spoken,
      this.scrub,
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
    );
    const openPin = button(
      "Open its motion",
      "The whole motion of this pin, in One release",
      () => void this.openPin(),
    );
    const tasks = card("tasks-card", "Tasks", h("div", { class: "choices" }, ...this.tasks));
    return h(
      "main",
      { class: "reading" },
      h("div", { class: "column" }, page, tasks),
      h(
        "div",
        { class: "column" },
        ...drawings.cards(h("div", { class: "toolbar" }, this.pins, openPin)),
        readouts.card(drawings.dial.element),
        card("device-card", "Change the device under your hand", this.controls.element),
      ),
    );
  }
}

/** The pin that is looked at first: the nearest to the middle. */
function middleOf(spots: readonly Row[]): number {
  const apart = spots.map(([x, y]) => Math.hypot(x, y));
  return apart.indexOf(Math.min(...apart));
}

function toggle(text: string, title: string, change: (on: boolean) => void): HTMLButtonElement {
  const made = button(text, title, () => {
    const on = made.getAttribute("aria-pressed") !== "true";
    made.setAttribute("aria-pressed", String(on));
    change(on);
  });
  made.setAttribute("aria-pressed", "false");
  return made;
}
