// The beginning: the two views of the page, and what they are given.
import { answerOf } from "./answers";
import { Core } from "./core";
import { type Design, designOf } from "./design";
import { acceptDrops, givenDevice } from "./files";
import { Page } from "./page";
import { ReadView } from "./read/view";
import { currentDesign, fromHash, initialState } from "./state";
import { TABLES } from "./table";
import { type Program, serve } from "./thread";

const READ = "#read";

/** The views, each made when it is first shown. */
class Studio {
  page: Page | null = null;
  read: ReadView | null = null;
  /** The design of "One release" that was last read with. */
  private opened: Design | null = null;
  private readonly places: Record<"page" | "read", HTMLElement>;

  constructor(
    readonly core: Core,
    private readonly program: Program,
  ) {
    const place = document.getElementById("page")!;
    const read = document.createElement("div");
    place.after(read);
    this.places = { page: place, read };
    acceptDrops((file) => this.takeFile(file));
  }

  async show(hash: string): Promise<void> {
    if (hash.startsWith(READ)) await this.showRead(hash.slice(READ.length + 1));
    else await this.showRelease(hash);
  }

  private async showRelease(hash: string): Promise<void> {
    const given = givenDevice();
    const state = await fromHash(this.core, hash);
    this.choose("page");
    if (this.page) {
      if (state) this.page.change(state, "");
      return;
    }
    this.page = new Page(this.core, this.program, state ?? initialState(this.core));
    this.page.mount(this.places.page);
    if (given && !state) this.page.load(given, true);
  }

  private async showRead(saved: string): Promise<void> {
    this.choose("read");
    const current = this.page && currentDesign(this.page.state);
    const whole = current && Object.keys(current.around).length ? current : this.givenWhole();
    if (!this.read) {
      const design = whole ?? designOf(this.core, { text: TABLES.reader, file: "the reader", rows: {} });
      this.read = new ReadView(this.core, this.program, design, (release) => this.showDesign(release));
      this.places.read.append(this.read.element);
    } else if (whole && whole !== this.opened) this.read.open(whole);
    this.opened = whole;
    this.read.start();
    if (!saved) return;
    await this.read.takeLink(saved);
  }

  /** Adds a design to "One release" and shows that view. */
  private showDesign(design: Design): void {
    history.pushState(null, "", "#");
    void this.showRelease("").then(() => this.page!.add(design));
  }

  /** The whole device that the command put into this copy of the page. */
  private givenWhole(): Design | null {
    const given = givenDevice();
    if (!given) return null;
    const design = designOf(this.core, given);
    return Object.keys(design.around).length ? design : null;
  }

  private choose(view: "page" | "read"): void {
    for (const [name, place] of Object.entries(this.places)) place.hidden = name !== view;
    if (view === "page") this.read?.stop();
    document.title = view === "read" ? "Read – pindrive studio" : "pindrive studio";
  }

  private takeFile(file: File): void {
    void (this.places.read.hidden ? this.page : this.read)?.takeFile(file);
  }
}

/** Shows the page. */
async function begin(program: Program): Promise<void> {
  const core = await Core.load(program.wasm);
  const studio = new Studio(core, program);
  await studio.show(location.hash);
  window.addEventListener("hashchange", () => void studio.show(location.hash));
  // For scripts in the console, and tests: the core, and the page with its state.
  const tested = {
    core,
    answerOf,
    get page() {
      return studio.page;
    },
    get read() {
      return studio.read;
    },
  };
  Object.assign(globalThis, { pindrive: tested });
  await studio.page?.settled();
  document.documentElement.dataset.ready = "";
}

export type Begin = typeof begin;

if (typeof document === "undefined")
  serve(); // in a thread of the page
else Object.assign(globalThis, { begin });
