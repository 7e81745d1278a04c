// The drawings of the view: page, tactile image, fingertip, the chosen pin, and the dial.
import { Canvas } from "../canvas";
import { card, h } from "../dom";
import type { Row } from "../input";
import type { Look } from "../theme";
import { DIAL_HEIGHT, drawDial, type Limit } from "./dial";
import type { Felt } from "./felt";
import { type Drawn, drawFingertip, pinAt } from "./fingertip";
import { drawFelt, drawPage } from "./pagedrawing";
import { HEIGHT, type Paper } from "./paper";
import type { Picture } from "./picture";
import type { Line } from "./scan";
import type { Sample } from "./session";
import { drawSide } from "./side";

/** Picture with its surroundings. */
export interface Scene {
  readonly look: Look;
  readonly picture: Picture | null;
  /** Places of the pins under the finger, m. */
  readonly places: readonly Row[];
  readonly samples: readonly Sample[];
  /** Luminance below which the control block sees a line. */
  readonly threshold: number;
  /** Words over the page; empty: none. */
  readonly notice: string;
  /** Lines of the reading until now. */
  readonly lines: readonly Line[];
  /** Speed of the hand and its peak, mm/s. */
  readonly speed: number;
  readonly peak: number;
  readonly limits: readonly Limit[];
}

export class Drawings {
  readonly sheet: Canvas;
  readonly image: Canvas;
  private readonly fingertip: Canvas;
  private readonly side: Canvas;
  readonly dial: Canvas;
  private tip: Drawn = { scale: 1, places: [] };
  private turn = 0;

  /** `redraw` is called when a size has changed, `choose` with the number of a pin. */
  constructor(
    private readonly paper: Paper,
    private readonly felt: Felt,
    redraw: () => void,
    choose: (pin: number) => void,
  ) {
    const ratio = HEIGHT / paper.width;
    const page = "The page. Move the pointer over it, drag a finger, or hold the arrow keys, to read.";
    this.sheet = new Canvas("sheet", page, ratio, redraw);
    this.sheet.element.setAttribute("role", "application");
    this.sheet.element.tabIndex = 0;
    const image = "tactile image: how far each pin was dragged, where its sensor was";
    this.image = new Canvas("felt", image, ratio, redraw);
    this.fingertip = new Canvas("fingertip", "the fingertip from above with its pins", 0.66, redraw);
    this.side = new Canvas("side", "the chosen pin from the side, and its last 0.15 s", 0.82, redraw);
    this.dial = new Canvas(
      "dial",
      "speed of the hand, and pitches of lines that merge",
      0,
      redraw,
      DIAL_HEIGHT,
    );
    this.fingertip.element.addEventListener("click", (event) => {
      const { left, top } = this.fingertip.element.getBoundingClientRect();
      const pin = pinAt(this.tip, event.clientX - left, event.clientY - top);
      if (pin !== null) choose(pin);
    });
  }

  /** The page, or the window, has another width. */
  reshape(narrow: boolean): void {
    for (const canvas of [this.sheet, this.image]) canvas.setRatio(HEIGHT / this.paper.width);
    this.fingertip.setRatio(narrow ? 1 : 0.66);
  }

  /** The cards of the fingertip and of the chosen pin; `pins` chooses one by its number. */
  cards(pins: HTMLElement): [HTMLElement, HTMLElement] {
    const words =
      "Orange: the magnet is on. Blue: the skin is being moved. Choose a pin to see it from the side.";
    const tip = this.fingertip.element;
    return [
      card("tip", "Your fingertip from above", tip, h("p", { class: "note" }, words)),
      card("side-card", "The ringed pin from the side", this.side.element, pins),
    ];
  }

  /** Draws everything; with `moving` the page and the fingertip, and in turns one of the rest. */
  draw(scene: Scene, moving = false): void {
    const { picture, look } = scene;
    const { sheet, image, fingertip, side, dial, paper } = this;
    this.turn = (this.turn + 1) % 2;
    const [first, second] = [!moving || this.turn === 0, !moving || this.turn === 1];
    const pen = sheet.begin(look.font);
    drawPage(pen, sheet.width, paper, look.paper, picture, scene.lines);
    if (scene.notice) this.drawNotice(pen, scene.notice, look);
    if (first) drawFelt(image.begin(look.font), image.width, paper, this.felt, picture);
    if (!picture) return;
    const { width, height } = fingertip;
    this.tip = drawFingertip(fingertip.begin(look.font), width, height, scene.places, picture);
    if (!second) return;
    const isDark = ({ values }: Sample): boolean => values.luminance[picture.chosen]! < scene.threshold;
    drawSide(side.begin(look.font), side.width, side.height, paper, picture, scene.samples, isDark);
    const { speed, peak, limits } = scene;
    drawDial(dial.begin(look.font), dial.width, speed, peak, limits, look, picture.colors);
  }

  private drawNotice(pen: CanvasRenderingContext2D, words: string, look: Look): void {
    const { width, height } = this.sheet;
    pen.font = `600 ${pen.font}`;
    const wide = pen.measureText(words).width;
    [pen.fillStyle, pen.globalAlpha] = [look.surface, 0.92];
    pen.fillRect(width / 2 - wide / 2 - 8, height - 27, wide + 16, 22);
    [pen.fillStyle, pen.globalAlpha, pen.textAlign] = [look.accent, 1, "center"];
    pen.fillText(words, width / 2, height - 11);
  }
}
