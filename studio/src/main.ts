// The beginning: the two views of the page, the states that they show, and what the person gives to them.
import { answerOf } from "./answers";
import { Core } from "./core";
import { type Design, designOf } from "./design";
import { DeviceError } from "./device";
import { h, pause } from "./dom";
import { EXAMPLES, exampleState } from "./examples";
import {
  acceptDrops,
  choose,
  FileError,
  type Given,
  givenDevice,
  named,
  OPENED,
  type Opened,
  openFile,
} from "./files";
import { Header } from "./header";
import type { Kept } from "./keep";
import { isOwn, Keeper, partsOf, type ViewName } from "./keeper";
import { rasterOfPicture, usualWidth } from "./read/paper";
import { packedRaster } from "./read/raster";
import { initialRead, type ReadState } from "./read/state";
import { ReadView } from "./read/view";
import { ReleaseView } from "./releaseview";
import { currentDesign, initialRelease, type ReleaseState } from "./state";
import { Store } from "./store";
import { type Program, serve } from "./thread";

class Studio {
  readonly states: { readonly read: Store<ReadState>; readonly release: Store<ReleaseState> };
  release: ReleaseView | null = null;
  read: ReadView | null = null;
  view: ViewName = "read";
  private readonly header: Header;
  private readonly keeper: Keeper;
  private readonly problem = h("pre", { id: "problem", role: "alert", hidden: true });
  private readonly said = h("p", { id: "said", role: "status", hidden: true });
  private readonly given = givenDevice();
  /** The device of "One release" that was last read with. */
  private opened: Design | null = null;

  constructor(
    readonly core: Core,
    private readonly program: Program,
    private readonly place: HTMLElement,
  ) {
    this.states = { read: new Store(initialRead(core)), release: new Store(initialRelease(core)) };
    const store = (): Store<unknown> => this.states[this.view] as Store<unknown>;
    this.header = new Header(
      {
        open: () => choose(OPENED, (file) => void this.take(file)),
        save: (kind) => void this.current.save(kind),
        share: () => void this.share(),
        undo: () => store().undo(),
        redo: () => store().redo(),
        reset: () => this.reset(),
        example: (name) => void this.example(name),
      },
      {
        read: {
          save: [
            ["file", "Reading (JSON)"],
            ["device", "Device file (TOML)"],
          ],
          examples: EXAMPLES.read,
        },
        release: {
          save: [
            ["toml", "Device file (TOML)"],
            ["csv", "Samples (CSV)"],
            ["events", "Events (CSV)"],
            ["svg", "Curves (SVG)"],
            ["png", "Curves (PNG)"],
          ],
          examples: EXAMPLES.release,
        },
      },
    );
    this.keeper = new Keeper(
      core,
      {
        kept: () => this.kept,
        view: () => this.view,
      },
      this.given?.text ?? "",
    );
    for (const one of Object.values(this.states)) {
      one.listen(() => {
        this.header.update(store().canUndo, store().canRedo);
        this.keeper.changed();
      });
    }
    place.append(this.header.element, h("div", { class: "messages" }, this.problem, this.said));
    acceptDrops((file) => void this.take(file));
    document.addEventListener("keydown", (event) => this.key(event));
    window.addEventListener("hashchange", () => void this.follow(location.hash));
  }

  private get kept(): Kept {
    return { read: this.states.read.now, release: this.states.release.now };
  }
  private get current(): ReadView | ReleaseView {
    return this.view === "read" ? this.read! : this.release!;
  }

  /** The states that were left behind, or those of the link or of the device that the page came with. */
  async begin(): Promise<void> {
    await pause();
    const found = await this.keeper.found(location.hash, this.kept);
    let view = found?.view ?? partsOf(location.hash).view ?? "read";
    if (found) this.restore(found.kept);
    else if (this.given) view = this.begun(this.given);
    await pause();
    this.show(view);
    if (found) this.tell(found.problems);
  }

  private restore({ read, release }: Kept): void {
    this.opened = currentDesign(release);
    this.states.read.replace(read);
    this.states.release.replace(release);
  }

  /** Begins with the device that the command put into the page; the view that shows it. */
  private begun(given: Given): ViewName {
    const device = this.designOf(given);
    if (!device) return "release";
    const { release } = this.states;
    release.replace({ ...release.now, designs: [device], current: 0 });
    return isWhole(device) ? "read" : "release";
  }

  private designOf(given: Given): Design | null {
    try {
      return named(designOf(this.core, given), given.file);
    } catch (error) {
      if (!(error instanceof DeviceError)) throw error;
      this.say(error.message);
      return null;
    }
  }

  /** Shows a view; a whole device of "One release" is read with. */
  show(view: ViewName, shows?: string): void {
    this.view = view;
    this.header.show(view);
    const { read, release } = this.states;
    if (view === "read") {
      const design = currentDesign(release.now);
      if (isWhole(design) && design !== this.opened) {
        this.opened = design;
        read.change({ ...read.now, device: design, hand: null });
      }
      this.release?.hide();
      this.read ??= this.mounted(
        new ReadView(
          this.core,
          this.program,
          read,
          (problem) => this.say(problem),
          (design) => this.openPin(design),
        ),
      );
      this.read.show();
    } else {
      this.release ??= this.mounted(
        new ReleaseView(
          this.core,
          this.program,
          release,
          (problem) => this.say(problem),
          () => choose(".csv,.txt", (file) => void this.take(file)),
        ),
      );
      this.read?.hide();
      this.release.show(shows);
    }
    this.header.update(this.states[view].canUndo, this.states[view].canRedo);
    this.keeper.changed();
  }

  private mounted<T extends { readonly element: HTMLElement }>(view: T): T {
    this.place.append(view.element);
    return view;
  }

  /** Another hash: that of a view, or a link that was put into the address. */
  private async follow(hash: string): Promise<void> {
    const { view, packed } = partsOf(hash);
    if (!packed || isOwn()) {
      this.say("");
      this.show(view ?? "read");
      return;
    }
    const { kept, problems } = await this.keeper.ofLink(packed, this.kept);
    const { read, release } = this.states;
    this.opened = currentDesign(kept.release);
    this.show(view ?? this.view);
    if (kept.read !== read.now) read.change(kept.read);
    if (kept.release !== release.now) release.change(kept.release);
    this.tell(problems);
  }

  private tell(problems: readonly string[]): void {
    if (!problems.length) return;
    this.say(`Of the link not everything could be read: ${problems.join("; ")}. The rest is shown.`);
  }

  // ---- what the person gives -----------------------------------------------------------------------

  /** Opens a file, in the view that shows what is in it. */
  async take(file: File): Promise<void> {
    this.say("");
    try {
      await this.opens(await openFile(this.core, file));
    } catch (error) {
      if (!(error instanceof FileError)) throw error;
      this.say(error.message);
    }
  }

  private async opens(opened: Opened): Promise<void> {
    const { read, release } = this.states;
    if ("recording" in opened) {
      const { recording } = opened;
      const offset = Math.max(0, recording.times[0]!);
      const overlay = { recording, offset, keys: [], freeOffset: false, report: null };
      release.change({ ...release.now, overlay });
      this.show("release");
    } else if ("picture" in opened) {
      const { picture } = opened;
      try {
        const raster = await rasterOfPicture(picture);
        const print = { kind: "picture", raster: await packedRaster(raster, picture.name) } as const;
        read.change({ ...read.now, print, task: 0, hand: null });
      } catch (error) {
        throw new FileError(`${picture.name}: ${(error as Error).message}`);
      }
      this.show("read");
    } else if ("reading" in opened) {
      const { reading, file } = opened;
      const device = this.designOf({ text: reading.device, file, rows: {} });
      if (!device) return;
      read.change({
        ...read.now,
        device,
        print: { kind: "picture", raster: reading.page },
        hand: reading.hand,
      });
      this.show("read");
    } else if (this.view === "read" && isWhole(opened.device)) {
      read.change({ ...read.now, device: opened.device, hand: null });
    } else this.addDesigns([opened.device], false);
  }

  /** Adds designs to "One release", and shows the last. */
  private addDesigns(designs: readonly Design[], alone: boolean, shows?: string): void {
    const { release } = this.states;
    const others = alone ? [] : release.now.designs;
    const next = [...others, ...designs];
    release.change({ ...release.now, designs: next, current: next.length - 1 });
    this.show("release", shows);
  }

  /** Shows the motion of a pin alone: other designs are kept, and not drawn beside it. */
  private openPin(design: Design): void {
    const { release } = this.states;
    const others = release.now.designs.map((other) => ({ ...other, shown: false }));
    const designs = [...others, design];
    release.change({ ...release.now, designs, current: designs.length - 1, ghost: null, overlay: null });
    this.show(
      "release",
      "The motion of one pin over the whole reading, as its hand and its magnet moved it.",
    );
  }

  private async example(name: string): Promise<void> {
    this.say("");
    const { read, release } = this.states;
    const found = await exampleState(this.core, name, this.kept, usualWidth());
    if (found.read) read.change(found.read);
    if (found.release) release.change(found.release);
    this.show(this.view, found.shows);
  }

  private reset(): void {
    const { read, release } = this.states;
    this.say("");
    if (this.view === "read") read.change(initialRead(this.core));
    else release.change(initialRelease(this.core));
  }

  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    const typing = target.matches("input[type=text], textarea, select");
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && !typing) {
      event.preventDefault();
      const store = this.states[this.view];
      if (event.shiftKey) store.redo();
      else store.undo();
    } else if (event.key === " " && !typing && !target.closest("button, input, summary, select, textarea")) {
      event.preventDefault();
      this.current.togglePlayer();
    }
  }

  private async share(): Promise<void> {
    const link = await this.keeper.address(true);
    const copied = await navigator.clipboard?.writeText(link).then(
      () => true,
      () => false,
    );
    this.inform(
      copied ? "The link is in the clipboard, and in the address." : "The link is in the address bar.",
    );
  }

  /** Shows what is wrong. */
  say(problem: string): void {
    this.problem.textContent = problem;
    this.problem.hidden = problem === "";
    this.inform("");
  }
  private inform(words: string): void {
    this.said.textContent = words;
    this.said.hidden = words === "";
  }

  /** The link to what is shown, for tests. */
  link(): Promise<string> {
    return this.keeper.address(true);
  }
}

/** True for a device with magnet, control block or pins, beside its drive. */
function isWhole({ around }: Design): boolean {
  return Object.keys(around).length > 0;
}

/** Shows the page. */
async function begin(program: Program): Promise<void> {
  const core = await Core.load(program.wasm);
  await pause();
  const studio = new Studio(core, program, document.getElementById("page")!);
  await studio.begin();
  // For scripts in the console, and tests: the core, and the page with its states.
  const tested = {
    core,
    answerOf,
    studio,
    get release() {
      return studio.release;
    },
    get read() {
      return studio.read;
    },
  };
  Object.assign(globalThis, { pindrive: tested });
  await studio.release?.settled();
  document.documentElement.dataset.ready = "";
}

export type Begin = typeof begin;

if (typeof document === "undefined")
  serve(); // in a thread of the page
else Object.assign(globalThis, { begin });
