// Keeps the states: in the browser's storage at each change, in the address soon after, and in links.
import type { Core } from "./core";
import { type Found, jsonOfStates, type Kept, statesOfJson } from "./keep";
import { packedText, unpackedText } from "./links";
import { packedPage } from "./read/saved";

export type ViewName = "read" | "release";

const STORED = 150; // ms from a change to its storage
const ADDRESSED = 700; // ms from a change to the address
const LONGEST = 60_000; // characters of an address that is kept by itself

/** The state that this tab, or the last visit, left behind. */
interface Stored {
  readonly view: ViewName;
  /** The address that the state belonged to. */
  readonly hash: string;
  readonly states: unknown;
}

export interface Source {
  readonly kept: () => Kept;
  readonly view: () => ViewName;
}

export class Keeper {
  private storing = 0;
  private addressing = 0;
  private readonly key: string;

  /** `own` is the text of a device that came with the page: its copy of the page keeps a state of its own. */
  constructor(
    private readonly core: Core,
    private readonly source: Source,
    own: string,
  ) {
    this.key = `pindrive ${own ? location.pathname + own : ""}`;
    for (const kind of ["pagehide", "visibilitychange"]) {
      addEventListener(kind, () => this.store());
    }
  }

  /** The state has changed. */
  changed(): void {
    this.storing ||= window.setTimeout(() => this.store(), STORED);
    clearTimeout(this.addressing);
    this.addressing = window.setTimeout(() => void this.address(), ADDRESSED);
  }

  /** The states of a link, or of what was left behind; null: there are none. */
  async found(hash: string, otherwise: Kept): Promise<(Found & { readonly view: ViewName }) | null> {
    const { view, packed } = partsOf(hash);
    const own = this.read(sessionStorageOf());
    if (own && (!packed || (own.hash === hash && isAgain()))) {
      return { ...statesOfJson(this.core, own.states, otherwise), view: view ?? own.view };
    }
    if (packed) return { ...(await this.ofLink(packed, otherwise)), view: view ?? "release" };
    const last = this.read(localStorageOf());
    return last && { ...statesOfJson(this.core, last.states, otherwise), view: view ?? last.view };
  }

  /** The states of a link. What is wrong with it is named, and the states as they were are kept. */
  async ofLink(packed: string, otherwise: Kept): Promise<Found> {
    let given: unknown;
    try {
      given = JSON.parse(await unpackedText(packed));
    } catch {
      return { kept: otherwise, problems: ["it is cut off or spoiled"] };
    }
    return statesOfJson(this.core, given, otherwise);
  }

  /** A link to the states, with the page of the reading as Python needs it. */
  private async link(): Promise<string> {
    const { kept, view } = this.source;
    const { release, read } = kept();
    const page = read.hand && (await packedPage(read.print));
    const json = jsonOfStates({ release, read }, page);
    return `#${view()}=${await packedText(JSON.stringify(json))}`;
  }

  /** Writes the address, unless the state makes it too long and nobody shares it: it is in the storage. */
  async address(shared = false): Promise<string> {
    clearTimeout(this.addressing);
    const hash = await this.link();
    if (hash.length > LONGEST && !shared) return location.href;
    history.replaceState({ own: true }, "", hash);
    this.store();
    return location.href;
  }

  private store(): void {
    clearTimeout(this.storing);
    this.storing = 0;
    const { kept, view } = this.source;
    const stored: Stored = { view: view(), hash: location.hash, states: jsonOfStates(kept(), null) };
    const text = JSON.stringify(stored);
    for (const storage of [sessionStorageOf(), localStorageOf()]) {
      try {
        storage?.setItem(this.key, text);
      } catch {
        storage?.removeItem(this.key); // full: an old state would be worse than none
      }
    }
  }

  private read(storage: Storage | null): Stored | null {
    try {
      return JSON.parse(storage?.getItem(this.key) ?? "null") as Stored | null;
    } catch {
      return null;
    }
  }
}

/** True for an address that was written here: the person went back or forward. */
export function isOwn(): boolean {
  return (history.state as { readonly own?: boolean } | null)?.own === true;
}

/** True if the person did not follow a link, but loaded the page again, or went back to it. */
function isAgain(): boolean {
  const [entry] = performance.getEntriesByType("navigation") as PerformanceNavigationTiming[];
  return entry !== undefined && entry.type !== "navigate";
}

/** The view that a hash names, and the packed states in it. */
export function partsOf(hash: string): { readonly view: ViewName | null; readonly packed: string } {
  const [, view, packed] = /^#?(?:(read|release)(?:=|$))?(.*)$/s.exec(hash)!;
  return { view: (view as ViewName | undefined) ?? null, packed: packed! };
}

// A browser may forbid storage, and says so by an exception.
function sessionStorageOf(): Storage | null {
  try {
    return sessionStorage;
  } catch {
    return null;
  }
}
function localStorageOf(): Storage | null {
  try {
    return localStorage;
  } catch {
    return null;
  }
}
