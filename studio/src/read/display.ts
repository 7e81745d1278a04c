// Everything of "Read" that shows the pins under the hand: drawings, tactile image, sentence, speed and counts.
import type { Core } from "../core";
import type { Design } from "../design";
import { h, option } from "../dom";
import type { Row } from "../input";
import { currentLook, onLook } from "../theme";
import { spotsOf, valuesOf } from "./device";
import type { Limit } from "./dial";
import { Drawings } from "./drawings";
import { Feedback } from "./feedback";
import { Felt } from "./felt";
import type { Hand } from "./hand";
import type { Paper } from "./paper";
import { colorsOf, type Picture } from "./picture";
import { Readouts } from "./readouts";
import type { DeviceInput, Line } from "./scan";
import { speedOf } from "./sentence";
import type { Sample, Session } from "./session";
import { Skin } from "./skin";

const CALM = 0.25; // part of a new speed in the speed that is shown
const FADES = 0.985; // part of the peak of the speed that the next picture keeps

/** State of a reading that is drawn with the pins. */
export interface Shown {
  /** Words over the page, and beside it while nothing happens. */
  readonly notice: string;
  readonly waiting: string;
  /** True if somebody, or a demonstration, moves the hand. */
  readonly moved: boolean;
  readonly lines: readonly Line[];
}

export class Display {
  readonly readouts = new Readouts();
  readonly feedback = new Feedback();
  readonly drawings: Drawings;
  readonly felt: Felt;
  /** The pin that is looked at, by its number. */
  readonly pins = h("select", { "aria-label": "pin from the side" });
  chosen = 0;
  limits: readonly Limit[] = [];
  picture: Picture | null = null;
  private readonly skin = new Skin(0);
  private look = currentLook();
  private speed = 0;
  private peak = 0;
  private input: DeviceInput | null = null;
  private places: readonly Row[] = [];
  private axis: Row = [1, 0];
  private hold: number | null = null;

  constructor(
    private readonly core: Core,
    readonly paper: Paper,
    private readonly session: () => Session,
    private readonly shown: () => Shown,
  ) {
    this.felt = new Felt(paper.width, []);
    this.felt.setDark(this.look.dark);
    this.drawings = new Drawings(
      paper,
      this.felt,
      () => this.draw(),
      (pin) => this.choose(pin),
    );
    this.pins.addEventListener("change", () => this.choose(Number(this.pins.value)));
    onLook(() => {
      this.look = currentLook();
      this.felt.setDark(this.look.dark);
      this.draw();
    });
  }

  setDevice(design: Design, input: DeviceInput): void {
    const { "array.spot_scale": _, ...values } = valuesOf(design);
    const axis = (values["array.axis"] as number | undefined) ?? 0;
    this.axis = [Math.cos(axis), Math.sin(axis)];
    this.hold = (values["magnet.hold_force"] as number | undefined) ?? null;
    this.places = spotsOf(this.core, values);
    this.felt.setSpots(input.spots);
    if (input.spots.length !== this.input?.spots.length) {
      this.chosen = middleOf(input.spots);
      const names = input.spots.map((_, pin) => option(String(pin), `pin ${pin + 1}`, pin === this.chosen));
      this.pins.replaceChildren(...names);
    }
    this.input = input;
    this.picture = null;
  }

  /** True if the drive axis is that of a ruler. */
  get level(): boolean {
    return Math.abs(this.axis[1]) < 1e-6;
  }

  /** The page has another print. */
  setPage(narrow: boolean): void {
    this.felt.setWidth(this.paper.width);
    this.drawings.reshape(narrow);
  }

  choose(pin: number): void {
    this.chosen = pin;
    this.pins.value = String(pin);
    this.draw();
  }

  /** A reading begins. */
  begin(): void {
    this.felt.clear();
    this.skin.begin(this.input?.spots.length ?? 0);
  }

  /** Shows samples of the pins, of which the last is now. */
  show(samples: readonly Sample[], hand: Hand): void {
    const sample = samples[samples.length - 1];
    const { input, look } = this;
    if (!sample || !input) return;
    for (const each of samples) {
      this.skin.follow(each);
      this.feedback.announce(this.skin.felt, input.spots);
    }
    this.felt.paint(samples, hand);
    const motion = hand.at(sample.time);
    const intended = this.session().intended?.at(sample.time) ?? null;
    this.picture = {
      sample,
      hand: motion,
      intended,
      spots: input.spots,
      axis: this.axis,
      hold: this.hold ?? Math.max(...sample.values.pull, 1e-9),
      felt: this.skin.felt,
      chosen: this.chosen,
      look,
      colors: colorsOf(look),
    };
    const speed = 1e3 * speedOf(motion);
    this.speed += CALM * (speed - this.speed);
    this.peak = Math.max(FADES * this.peak, speed);
    this.draw(true);
    this.tell();
    this.readouts.showSpeed(this.speed, hand.slowness, this.limits);
    this.readouts.showLag(this.picture);
  }

  /** Says what happens now. */
  tell(): void {
    const { waiting, moved } = this.shown();
    this.readouts.tell(this.picture, waiting, moved);
  }

  /** Draws everything, or with `moving` what is looked at while the pins move. */
  draw(moving = false): void {
    const { look, picture, places, speed, peak, limits, chosen } = this;
    if (!this.input) return;
    const scene = {
      look,
      picture: picture && { ...picture, look, colors: colorsOf(look), chosen },
      places,
      samples: this.session().samples,
      threshold: this.input.numbers["control.threshold"] ?? 0.5,
      speed,
      peak,
      limits,
      ...this.shown(),
    };
    this.drawings.draw(scene, moving);
  }
}

/** The pin that is looked at first: the nearest to the middle. */
function middleOf(spots: readonly Row[]): number {
  const apart = spots.map(([x, y]) => Math.hypot(x, y));
  return apart.indexOf(Math.min(...apart));
}
