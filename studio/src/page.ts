// The page: the state, what is computed of it at each change, and the parts that show it.
import { Animation } from "./animation";
import { Charts } from "./charts";
import type { Core } from "./core";
import { type Design, withValue } from "./design";
import { Designs } from "./designs";
import { DeviceError, decodeText, readDevice } from "./device";
import { button, card, download, fileName, h, menu, option } from "./dom";
import { figureSvg, pngOf } from "./figure";
import { choose, type Given } from "./files";
import { FitPanel } from "./fitpanel";
import type { Values } from "./friction";
import { help } from "./help";
import { MapControls, mapKeys } from "./mapcontrols";
import { MapRunner } from "./maprunner";
import { navigation } from "./navigation";
import { Panel } from "./panel";
import { PhasePlane } from "./phaseplane";
import { Player } from "./player";
import { givenOf, PRESETS } from "./presets";
import { RecordingError, readRecording } from "./recording";
import { Bars, EventsTable, NumbersTable, sentence } from "./results";
import { Sketch } from "./sketch";
import { currentDesign, History, type State, toHash, withDesign } from "./state";
import { NUMBERS, TABLES } from "./table";
import { currentLook, type Scheme, setScheme } from "./theme";
import { Newest, type Program, Stopped, Thread } from "./thread";
import { currentCurves, type Line, type Overlay, type View } from "./view";
import type { Answer, MotionsFound, Task } from "./work";
import { deviceFile, eventsCsv, samplesCsv } from "./write";
import { Zoom } from "./zoom";

const LONG = 300; // ms after which a simulation is said to take long
const STOPPED = "Stopped. A change of a value simulates again.";

export class Page {
  readonly history: History;
  view: View;
  private overlay: Overlay | null = null;
  private look = currentLook();
  private asked = false;
  private linkTimer = 0;
  private readonly charts: Charts;
  private readonly phase: PhasePlane;
  private readonly zoom = new Zoom(() => this.ask());
  private readonly animation: Animation;
  private readonly sketch: Sketch;
  private readonly player: Player;
  private readonly panel: Panel = new Panel(
    (values) => this.core.problems(values)[0] ?? "",
    () => this.values,
    (values, kind) => this.setValues(values, kind),
  );
  private readonly designs = new Designs((step) => this.change(step(this.state), ""));
  private readonly controls = new MapControls((step) => this.change(step(this.state), ""));
  private readonly numbers = new NumbersTable((number) => this.change({ ...this.state, number }, ""));
  private readonly events = new EventsTable((time) => this.setCursor(time));
  private readonly bars = new Bars();
  private readonly map: MapRunner;
  private readonly thread: Thread;
  private readonly motions: Newest<"motions">;
  private busyTimer = 0;
  /** Shown while a simulation takes long. */
  private readonly busy = h(
    "p",
    { id: "busy", role: "status", hidden: true },
    "Simulating a long motion … ",
    button("Stop", "Stop the simulation", () => this.thread.stop()),
  );
  private readonly fitting: FitPanel;
  private readonly words = h("p", { id: "summary", role: "status" });
  private readonly signs = stopSigns();
  private readonly problem = h("pre", { id: "problem", role: "alert", hidden: true });
  private readonly undo = button("Undo", "Undo (Ctrl+Z)", () => this.step("undo"));
  private readonly redo = button("Redo", "Redo (Ctrl+Shift+Z)", () => this.step("redo"));

  constructor(
    readonly core: Core,
    program: Program,
    state: State,
  ) {
    this.history = new History(state);
    this.view = { state, lines: [], end: 1e-3, span: [0, 1e-3], overlay: null };
    this.thread = new Thread(program);
    this.motions = new Newest(this.thread, "motions");
    this.charts = new Charts(this.look, {
      cursor: (time) => this.setCursor(time, true),
      zoom: (span) => this.zoom.show(span),
    });
    this.phase = new PhasePlane(this.look);
    this.sketch = new Sketch(this.look);
    this.animation = new Animation(this.look, (position) =>
      this.setValues(withValue(this.values, "motion.displacement", position), "pin"),
    );
    this.player = new Player(
      (time) => this.setCursor(time),
      () => ({ curves: currentCurves(this.view), end: this.view.end }),
    );
    this.map = new MapRunner(program, this.look, (point) =>
      this.setValues(
        Object.entries(point).reduce((values, [key, value]) => withValue(values, key, value), this.values),
        "map",
      ),
    );
    this.fitting = new FitPanel({
      open: () => choose(".csv,.txt", (file) => void this.takeFile(file)),
      remove: () => this.setOverlay(null),
      offset: (offset) => this.setOverlay({ ...this.overlay!, offset }),
      fitOffset: () => void this.fitOffset(),
      fit: (keys, freeOffset) => void this.fit(keys, freeOffset),
    });
    document.addEventListener("keydown", (event) => this.key(event));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.setLook());
  }

  get state(): State {
    return this.history.now;
  }

  private get values(): Values {
    return currentDesign(this.state).values;
  }

  mount(parent: HTMLElement): void {
    const main = h(
      "main",
      { id: "main" },
      this.problem,
      this.introduction(),
      h(
        "div",
        { class: "column" },
        card(
          "curves",
          "Motion",
          this.words,
          this.busy,
          this.player.element,
          this.zoom.element,
          this.charts.element,
          legend(this.signs),
        ),
        card("bars-card", "Derivatives", this.bars.element),
        card("events", "Events", this.events.element),
      ),
      h(
        "div",
        { class: "columns" },
        h(
          "div",
          { class: "column" },
          card("device-view", "Device", this.animation.element, this.sketch.element),
          card("plane", "Phase plane", this.phase.element),
          card("fit-card", "Recording", this.fitting.element),
        ),
        h(
          "div",
          { class: "column" },
          card("map-card", "Map", this.controls.element, this.map.element, this.controls.specification),
          card("numbers", "Numbers", this.numbers.element),
        ),
      ),
    );
    const aside = h(
      "aside",
      { "aria-label": "designs and parameters" },

      card("designs-card", "Designs", this.designs.element),
      card("parameters-card", "Parameters", this.panel.element),
    );
    parent.append(this.header(), h("div", { class: "layout" }, aside, main));
    this.render();
  }

  /** One sentence for the page, and one for each preset. */
  private introduction(): HTMLElement {
    const shows = h("p", { class: "note", role: "status" });
    const buttons = PRESETS.map((preset) =>
      button(preset.name, preset.shows, () => {
        if (this.load(givenOf(preset), true)) shows.textContent = preset.shows;
      }),
    );
    return card(
      "introduction",
      "One release",
      h(
        "p",
        {},
        "A pin on a spring is let go on a moving plate, under a fingertip, with dry friction at both. Its motion is computed ",
        "exactly at each change: move a slider, or drag the pin in the drawing of the device.",
      ),
      h("div", { class: "presets" }, ...buttons),
      shows,
    );
  }

  // ---- changes -----------------------------------------------------------------------------------

  change(next: State, kind: string): void {
    this.history.change(next, kind, performance.now());
    this.ask();
  }

  setValues(values: Values, kind: string): void {
    this.change(withDesign(this.state, { values }), kind);
  }

  setCursor(time: number, fromCharts = false): void {
    const cursor = Math.min(Math.max(time, 0), this.view.end);
    this.history.replace({ ...this.state, cursor });
    this.zoom.update(this.view.end, cursor);
    this.view = { ...this.view, state: this.state };
    if (!fromCharts) this.charts.setCursor(cursor);
    this.phase.update(this.view);
    this.animation.update(this.view);
    this.sketch.update(this.view);
    this.player.update(this.view);
  }

  setOverlay(overlay: Overlay | null): void {
    this.overlay = overlay;
    this.ask();
  }

  /** Adds a design, or puts it in place of all others, and shows it. */
  add(design: Design, replace = false): void {
    const next = replace ? [design] : [...this.state.designs, design];
    this.change({ ...this.state, designs: next, current: next.length - 1 }, "");
  }

  /** Loads the text of a device file as a new design; what is wrong is said at the top. */
  load(given: Given, replace: boolean): boolean {
    try {
      const device = readDevice(this.core, given.text, given.file, given.rows);
      this.add({ ...device, name: device.name || given.file.replace(/\.toml$/i, ""), shown: true }, replace);
      this.say("");
      return true;
    } catch (error) {
      if (!(error instanceof DeviceError)) throw error;
      this.say(error.message);
      return false;
    }
  }

  async takeFile(file: File): Promise<void> {
    const bytes = new Uint8Array(await file.arrayBuffer());
    try {
      const text = decodeText(bytes, file.name);
      if (/\.(csv|txt)$/i.test(file.name)) {
        const recording = readRecording(text, file.name);
        this.fitting.setResult(null);
        this.setOverlay({ recording, offset: Math.max(0, recording.times[0]!) });
        this.say("");
      } else {
        this.load({ file: file.name, text, rows: {} }, false);
      }
    } catch (error) {
      if (!(error instanceof RecordingError || error instanceof DeviceError)) throw error;
      this.say(error.message);
    }
  }

  private async fitOffset(): Promise<void> {
    const { recording } = this.overlay!;
    const offset = await this.waited("offset", { recording, values: this.values });
    if (offset !== null) this.setOverlay({ recording, offset });
  }

  private async fit(keys: readonly string[], freeOffset: boolean): Promise<void> {
    if (!this.overlay || (!keys.length && !freeOffset)) {
      this.say("choose at least one parameter, or the time of the release, to be fitted");
      return;
    }
    const found = await this.waited("fit", { ...this.overlay, values: this.values, keys, freeOffset });
    if (!found) return;
    this.overlay = { ...this.overlay, offset: found.offset };
    this.fitting.setResult(found);
    this.setValues(found.values, "");
    this.say("");
  }

  /** The answer of the thread to a task; null with a message if there is none. */
  private async waited<K extends "fit" | "offset">(kind: K, task: Task<K>): Promise<Answer<K> | null> {
    this.showBusy();
    try {
      return await this.thread.ask(kind, task);
    } catch (error) {
      this.say(error instanceof Stopped ? "the fit was stopped" : (error as Error).message);
      return null;
    } finally {
      this.hideBusy();
    }
  }

  /** Shows that a computation takes long, if it does, with a button that stops it. */
  private showBusy(): void {
    clearTimeout(this.busyTimer);
    this.busyTimer = window.setTimeout(() => {
      this.busy.hidden = false;
    }, LONG);
  }

  private hideBusy(): void {
    clearTimeout(this.busyTimer);
    this.busy.hidden = true;
  }

  /** Resolves when what was changed is simulated and drawn. */
  async settled(): Promise<void> {
    while (this.asked || this.motions.busy || !this.thread.idle) {
      await new Promise((drawn) => requestAnimationFrame(drawn));
    }
  }

  private step(which: "undo" | "redo"): void {
    this.history[which]();
    this.ask();
  }

  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    const typing = target.matches("input[type=text], textarea, select");
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && !typing) {
      event.preventDefault();
      this.step(event.shiftKey ? "redo" : "undo");
    } else if (event.key === " " && !typing && !target.closest("button, input, summary, select, textarea")) {
      event.preventDefault();
      this.player.toggle();
    }
  }

  private say(problem: string): void {
    this.problem.textContent = problem;
    this.problem.hidden = problem === "";
  }

  // ---- what is shown -----------------------------------------------------------------------------

  private ask(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.render();
    });
  }

  /** Shows the state, and has the thread simulate it; what follows is drawn when it answers. */
  render(): void {
    const state = this.settledAxes(this.state);
    this.history.replace(state);
    const { values } = currentDesign(state);
    this.panel.update(values);
    this.signs.hidden = !("drive.travel" in values);
    this.designs.update(state, this.look);
    this.controls.update(state);
    this.fitting.update(values, this.overlay);
    this.map.update(state);
    const shown = shownLines(state);
    const designs = shown.map((line) => line.values);
    if (!this.motions.busy) this.showBusy();
    this.motions.ask(
      () => ({ designs, number: state.number, span: this.zoom.span }),
      (found) => this.draw(shown, found),
      (error) => {
        const words = error instanceof Stopped ? STOPPED : error.message;
        this.draw(shown, { end: 1e-3, found: shown.map(() => ({ problem: words })), effects: [] });
      },
    );
    this.undo.disabled = !this.history.canUndo;
    this.redo.disabled = !this.history.canRedo;
    document.title = `${currentDesign(state).name || "design"} – pindrive studio`;
    clearTimeout(this.linkTimer);
    this.linkTimer = window.setTimeout(() => void this.link(), 700);
  }

  /** Draws motions that were found. */
  private draw(shown: readonly Omit<Line, "result">[], { end, found, effects }: MotionsFound): void {
    if (!this.motions.waits) this.hideBusy();
    const lines = shown.map((line, i) => ({ ...line, result: found[i]! }));
    this.history.replace({ ...this.state, cursor: Math.min(this.state.cursor, end) });
    const span = this.zoom.update(end, this.state.cursor);
    this.view = { state: this.state, lines, end, span, overlay: this.overlay };
    this.charts.update(this.view);
    this.phase.update(this.view);
    this.animation.update(this.view);
    this.sketch.update(this.view);
    this.player.update(this.view);
    this.numbers.update(this.view);
    this.events.update(this.view);
    this.words.textContent = sentence(this.view, (status) => this.core.statusText(status));
    const { number } = this.state;
    this.bars.update(effects, NUMBERS.get(number)!, currentCurves(this.view)?.numbers[number] ?? NaN);
  }

  /** The axes of the map must be numbers of the current design. */
  private settledAxes(state: State): State {
    const keys = mapKeys(state);
    const x = keys.includes(state.map.x) ? state.map.x : keys[0]!;
    const y = keys.includes(state.map.y) && state.map.y !== x ? state.map.y : keys.find((key) => key !== x)!;
    return x === state.map.x && y === state.map.y ? state : { ...state, map: { x, y } };
  }

  private setLook(): void {
    this.look = currentLook();
    for (const part of [this.charts, this.phase, this.animation, this.sketch, this.map])
      part.setLook(this.look);
    this.ask();
  }

  async link(): Promise<string> {
    if (document.getElementById("page")!.hidden) return location.href;
    const hash = await toHash(this.state);
    history.replaceState(null, "", `#${hash}`);
    return location.href;
  }

  // ---- the head of the page ------------------------------------------------------------------------

  private header(): HTMLElement {
    const scheme = h(
      "select",
      { id: "scheme", "aria-label": "colours" },
      option("auto", "auto"),
      option("light", "light"),
      option("dark", "dark"),
    );
    scheme.addEventListener("change", () => {
      setScheme(scheme.value as Scheme);
      this.setLook();
    });
    const save = menu(
      "Save as",
      [
        ["toml", "Device file (TOML)"],
        ["csv", "Samples (CSV)"],
        ["events", "Events (CSV)"],
        ["svg", "Curves (SVG)"],
        ["png", "Curves (PNG)"],
      ],
      (kind) => void this.save(kind),
    );
    return h(
      "header",
      {},
      h(
        "a",
        {
          class: "skip",
          href: "#main",
          onclick: (event: Event) => {
            event.preventDefault();
            document.getElementById("main")!.scrollIntoView();
          },
        },
        "To the curves",
      ),
      h("h1", { title: `pindrive ${TABLES.version}` }, "pindrive studio"),
      navigation("release"),
      h(
        "div",
        { class: "buttons" },
        button("Open …", "A device file (TOML) or a recording (CSV)", () =>
          choose(".toml,.csv,.txt", (file) => void this.takeFile(file)),
        ),
        save,
        button("Share", "A link to this state, in the clipboard", () => void this.save("link")),
        this.undo,
        this.redo,
        help("release"),
        scheme,
      ),
    );
  }

  async save(kind: string): Promise<void> {
    const design = currentDesign(this.state);
    const name = fileName(design.name);
    const curves = currentCurves(this.view);
    if (kind === "toml") download(`${name}.toml`, deviceFile(design), "application/toml");
    if (kind === "csv" && curves) download(`${name}.csv`, samplesCsv(curves), "text/csv");
    if (kind === "events" && curves) download(`${name}-events.csv`, eventsCsv(curves), "text/csv");
    if (kind === "svg") download(`${name}.svg`, figureSvg(this.view, design.name), "image/svg+xml");
    if (kind === "png") download(`${name}.png`, await pngOf(figureSvg(this.view, design.name)), "image/png");
    if (kind === "link") {
      const link = await this.link();
      try {
        await navigator.clipboard.writeText(link);
        this.say("");
        this.words.textContent = "The link is in the clipboard.";
      } catch {
        this.words.textContent = "The link is in the address bar.";
      }
    }
  }
}

/** What is drawn: the current design, the ghost, the other shown designs. */
function shownLines(state: State): Omit<Line, "result">[] {
  const { name, values } = currentDesign(state);
  return [
    { name: name || "current", kind: "current", values, index: state.current },
    ...(state.ghost ? [{ name: "ghost", kind: "ghost" as const, values: state.ghost, index: -1 }] : []),
    ...state.designs.flatMap((design, index) =>
      design.shown && index !== state.current
        ? [{ name: design.name, kind: "other" as const, values: design.values, index }]
        : [],
    ),
  ];
}

function entry(classes: string, words: string): HTMLElement {
  return h("span", {}, h("span", { class: classes, "aria-hidden": "true" }), words);
}

/** Legend of the signs of end stops. */
function stopSigns(): HTMLElement {
  const of = (kind: string): HTMLElement => entry(`mark ${kind} stop`, TABLES.events[kind]!.stop!);
  return h("span", { class: "legend" }, of("stop"), of("leave"));
}

/** Legend of the signs in the plots. */
function legend(more: HTMLElement): HTMLElement {
  return h(
    "p",
    { class: "legend note" },
    entry("swatch carried", "carried by the plate"),
    entry("swatch resting", "at rest"),
    entry("swatch gripping", "gripped by skin"),
    entry("swatch line", "friction of the plate"),
    entry("swatch line dashed", "of the finger"),
    entry("mark stick plate", "sticks"),
    entry("mark slip plate", "slips"),
    entry("mark reverse plate", "reverses"),
    h("span", {}, "filled at the plate, open at the finger"),
    more,
  );
}
