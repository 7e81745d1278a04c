// The view "One release": its state is simulated at each change, and its parts show the motions.
import { Animation } from "./animation";
import { Charts } from "./charts";
import type { Core } from "./core";
import { type Design, withValue } from "./design";
import { Designs } from "./designs";
import { card, download, fileName, h } from "./dom";
import { figureSvg, pngOf } from "./figure";
import { FitPanel } from "./fitpanel";
import type { Values } from "./friction";
import { legend, stopSigns } from "./legend";
import { MapControls, mapKeys } from "./mapcontrols";
import { MapRunner } from "./maprunner";
import { Panel } from "./panel";
import { PhasePlane } from "./phaseplane";
import { Player } from "./player";
import { Bars, EventsTable, NumbersTable, sentence } from "./results";
import { Simulation } from "./simulation";
import { Sketch } from "./sketch";
import { currentDesign, type ReleaseState, withDesign } from "./state";
import type { Store } from "./store";
import { NUMBERS } from "./table";
import { currentLook, onLook } from "./theme";
import type { Program } from "./thread";
import { currentCurves, type Line, type View } from "./view";
import type { MotionsFound } from "./work";
import { deviceFile, eventsCsv, samplesCsv } from "./write";
import { Zoom } from "./zoom";

export class ReleaseView {
  readonly element: HTMLElement;
  view: View;
  private last: ReleaseState;
  private look = currentLook();
  private asked = false;
  private readonly simulation: Simulation;
  private readonly charts: Charts;
  private readonly phase: PhasePlane;
  private readonly zoom = new Zoom(() => this.ask());
  private readonly animation: Animation;
  private readonly sketch: Sketch;
  private readonly player: Player;
  private readonly panel: Panel;
  private readonly designs: Designs;
  private readonly controls: MapControls;
  private readonly numbers: NumbersTable;
  private readonly events = new EventsTable((time) => this.setCursor(time));
  private readonly bars = new Bars();
  private readonly map: MapRunner;
  private readonly fitting: FitPanel;
  private readonly words = h("p", { id: "summary", role: "status" });
  private readonly shows = h("p", { class: "note", role: "status" });
  private readonly signs = stopSigns();

  constructor(
    private readonly core: Core,
    program: Program,
    private readonly store: Store<ReleaseState>,
    say: (problem: string) => void,
    open: () => void,
  ) {
    this.last = store.now;
    this.view = { state: store.now, lines: [], end: 1e-3, span: [0, 1e-3] };
    this.simulation = new Simulation(program, say);
    const step = (next: (now: ReleaseState) => ReleaseState): void => store.change(next(store.now));
    this.panel = new Panel(
      (values) => core.problems(values)[0] ?? "",
      () => this.values,
      (values, kind) => this.setValues(values, kind),
    );
    this.designs = new Designs(step);
    this.controls = new MapControls(step);
    this.numbers = new NumbersTable((number) => step((now) => ({ ...now, number })));
    this.charts = new Charts(this.look, {
      cursor: (time) => this.setCursor(time),
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
    this.fitting = new FitPanel(store, this.simulation, say, open);
    this.element = h("div", { class: "layout" }, this.aside(), this.main());
    store.listen(() => this.changed());
    onLook(() => this.setLook());
  }

  get state(): ReleaseState {
    return this.store.now;
  }

  private get values(): Values {
    return currentDesign(this.state).values;
  }

  private get hidden(): boolean {
    return this.element.hidden === true;
  }

  /** Shows the view, with a sentence of what it shows. */
  show(shows?: string): void {
    this.element.hidden = false;
    if (shows !== undefined) this.shows.textContent = shows;
    this.ask();
  }

  hide(): void {
    this.element.hidden = true;
  }

  // ---- the parts ---------------------------------------------------------------------------------

  private aside(): HTMLElement {
    return h(
      "aside",
      { "aria-label": "designs and parameters" },
      card("designs-card", "Designs", this.designs.element),
      card("parameters-card", "Parameters", this.panel.element),
    );
  }

  private main(): HTMLElement {
    const column = (...cards: HTMLElement[]): HTMLElement => h("div", { class: "column" }, ...cards);
    return h(
      "main",
      { id: "main" },
      card(
        "introduction",
        "One release",
        h(
          "p",
          {},
          "A pin on a spring is let go on a moving plate, under a fingertip, with dry friction at both. Its motion is computed ",
          "exactly at each change: move a slider, or drag the pin in the drawing of the device.",
        ),
        this.shows,
      ),
      column(
        card(
          "curves",
          "Motion",
          this.words,
          this.simulation.busy,
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
        column(
          card("device-view", "Device", this.animation.element, this.sketch.element),
          card("plane", "Phase plane", this.phase.element),
          card("fit-card", "Recording", this.fitting.element),
        ),
        column(
          card("map-card", "Map", this.controls.element, this.map.element, this.controls.specification),
          card("numbers", "Numbers", this.numbers.element),
        ),
      ),
    );
  }

  // ---- changes -----------------------------------------------------------------------------------

  private changed(): void {
    const [before, now] = [this.last, this.store.now];
    this.last = now;
    const names = Object.keys(now) as (keyof ReleaseState)[];
    const same = names.every((name) => name === "cursor" || now[name] === before[name]);
    if (!same) this.ask();
    else if (!this.hidden) this.showCursor();
  }

  private setValues(values: Values, kind: string): void {
    this.store.change(withDesign(this.state, { values }), kind);
  }

  setCursor(time: number): void {
    this.store.replace({ ...this.state, cursor: Math.min(Math.max(time, 0), this.view.end) });
  }

  togglePlayer(): void {
    this.player.toggle();
  }

  /** Resolves when what was changed is simulated and drawn. */
  async settled(): Promise<void> {
    while (this.asked || !this.simulation.idle) {
      await new Promise((drawn) => requestAnimationFrame(drawn));
    }
  }

  // ---- what is shown -----------------------------------------------------------------------------

  private ask(): void {
    if (this.asked || this.hidden) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      if (!this.hidden) this.render();
    });
  }

  /** Shows the state, and has the thread simulate it; what follows is drawn when it answers. */
  render(): void {
    this.store.replace(this.settledAxes(this.state));
    const { state } = this;
    const { values, name } = currentDesign(state);
    this.panel.update(values);
    this.signs.hidden = !("drive.travel" in values);
    this.designs.update(state, this.look);
    this.controls.update(state);
    this.fitting.update(state);
    this.map.update(state);
    const shown = shownLines(state);
    const designs = shown.map((line) => line.values);
    this.simulation.ask(
      () => ({ designs, number: state.number, span: this.zoom.span }),
      (found) => this.draw(shown, found),
    );
    document.title = `${name || "design"} – pindrive studio`;
  }

  /** Draws motions that were found. */
  private draw(shown: readonly Omit<Line, "result">[], { end, found, effects }: MotionsFound): void {
    const lines = shown.map((line, i) => ({ ...line, result: found[i]! }));
    const cursor = Math.min(this.state.cursor, end);
    this.view = { ...this.view, lines, end };
    if (cursor !== this.state.cursor) this.setCursor(cursor);
    const { state } = this;
    this.view = { state, lines, end, span: this.zoom.update(end, cursor) };
    for (const part of [this.charts, this.phase, this.animation, this.sketch, this.player])
      part.update(this.view);
    this.numbers.update(this.view);
    this.events.update(this.view);
    this.words.textContent = sentence(this.view, (status) => this.core.statusText(status));
    const { number } = state;
    this.bars.update(effects, NUMBERS.get(number)!, currentCurves(this.view)?.numbers[number] ?? NaN);
  }

  private showCursor(): void {
    const { state, view } = this;
    this.zoom.update(view.end, state.cursor);
    this.view = { ...view, state };
    this.charts.setCursor(state.cursor);
    for (const part of [this.phase, this.animation, this.sketch, this.player]) part.update(this.view);
  }

  /** The axes of the map must be numbers of the current design. */
  private settledAxes(state: ReleaseState): ReleaseState {
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

  async save(kind: string): Promise<void> {
    const design: Design = currentDesign(this.state);
    const name = fileName(design.name);
    const curves = currentCurves(this.view);
    if (kind === "toml") download(`${name}.toml`, deviceFile(design), "application/toml");
    if (kind === "csv" && curves) download(`${name}.csv`, samplesCsv(curves), "text/csv");
    if (kind === "events" && curves) download(`${name}-events.csv`, eventsCsv(curves), "text/csv");
    if (kind === "svg") download(`${name}.svg`, figureSvg(this.view, design.name), "image/svg+xml");
    if (kind === "png") download(`${name}.png`, await pngOf(figureSvg(this.view, design.name)), "image/png");
  }
}

/** Lines of the plots: the current design, the ghost, and all others with their box ticked. */
function shownLines(state: ReleaseState): Omit<Line, "result">[] {
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
