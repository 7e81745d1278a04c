// The state of the page, its history, and the link that holds it whole.

import type { Core } from "./core";
import type { Design } from "./design";
import { readDevice } from "./device";
import type { Values } from "./friction";
import { TABLES } from "./table";

/** A limit that a number must keep, SI. */
export interface Limit {
  readonly atMost?: number;
  readonly atLeast?: number;
}

export interface State {
  readonly designs: readonly Design[];
  readonly current: number;
  /** Values of the curve in the background. */
  readonly ghost: Values | null;
  readonly map: { readonly x: string; readonly y: string };
  /** The number of which the map and the bars of derivatives are. */
  readonly number: string;
  readonly specification: Readonly<Record<string, Limit>>;
  readonly cursor: number;
}

/** A change, from the newest state: two may come before anything is drawn anew. */
export type Step = (now: State) => State;

export function initialState(core: Core): State {
  const device = readDevice(core, TABLES.template, "the template");
  return {
    designs: [{ ...device, shown: true }],
    current: 0,
    ghost: null,
    map: { x: "motion.mouse_velocity", y: "plate.kinetic" },
    number: "transient.settling_time",
    specification: { "transient.settling_time": { atMost: 0.1 } },
    cursor: 0,
  };
}

export function currentDesign(state: State): Design {
  return state.designs[state.current]!;
}

export function withDesign(state: State, change: Partial<Design>, index = state.current): State {
  const designs = state.designs.map((design, i) => (i === index ? { ...design, ...change } : design));
  return { ...state, designs };
}

/** Past, present and undone states; a moving slider is one step. */
export class History {
  private past: State[] = [];
  private future: State[] = [];
  private lastStep = "";
  private lastTime = -Infinity;

  constructor(public now: State) {}

  /** Step; steps of one kind within a second are merged. */
  change(next: State, kind: string, time: number): void {
    if (kind === "" || kind !== this.lastStep || time - this.lastTime > 1000) {
      this.past.push(this.now);
      if (this.past.length > 500) this.past.shift();
    }
    this.future = [];
    [this.now, this.lastStep, this.lastTime] = [next, kind, time];
  }

  /** A change that is no step, such as of the cursor. */
  replace(next: State): void {
    this.now = next;
  }

  get canUndo(): boolean {
    return this.past.length > 0;
  }
  get canRedo(): boolean {
    return this.future.length > 0;
  }
  undo(): void {
    this.move(this.past, this.future);
  }
  redo(): void {
    this.move(this.future, this.past);
  }

  private move(from: State[], to: State[]): void {
    const state = from.pop();
    if (!state) return;
    to.push(this.now);
    [this.now, this.lastStep] = [state, ""];
  }
}

const UNPACKED = 1 << 26; // bytes that a link or a file may grow to

// ---- links ---------------------------------------------------------------------------------------

/** The state as the part of a link after "#". */
export async function toHash(state: State): Promise<string> {
  const json = JSON.stringify(state, (_, value: unknown) =>
    typeof value === "bigint" ? { $integer: String(value) } : value,
  );
  const bytes = await piped(new TextEncoder().encode(json), new CompressionStream("deflate-raw"));
  const text = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  return text.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** The state in a link; null where it holds none that this page can read. */
export async function fromHash(core: Core, hash: string): Promise<State | null> {
  const text = hash.replace(/^#/, "").replaceAll("-", "+").replaceAll("_", "/");
  if (!text) return null;
  try {
    const bytes = Uint8Array.from(atob(text), (char) => char.charCodeAt(0));
    const json = await piped(bytes, new DecompressionStream("deflate-raw"));
    const state = JSON.parse(new TextDecoder().decode(json), (_, value: unknown) =>
      value !== null && typeof value === "object" && "$integer" in value
        ? BigInt(String(value.$integer))
        : value,
    ) as State;
    const whole = Array.isArray(state.designs) && state.designs[state.current] && state.map;
    return whole ? { ...initialState(core), ...state } : null;
  } catch {
    return null;
  }
}

export async function piped(
  bytes: Uint8Array,
  through: CompressionStream | DecompressionStream,
): Promise<Uint8Array> {
  const stream = new Blob([bytes as BlobPart]).stream().pipeThrough(through);
  const parts: Uint8Array[] = [];
  let size = 0;
  for (const reader = stream.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) return new Uint8Array(await new Blob(parts as BlobPart[]).arrayBuffer());
    parts.push(value);
    size += value.length;
    if (size > UNPACKED) throw new Error(`is larger than ${UNPACKED >> 20} MB`);
  }
}
