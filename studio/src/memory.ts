// Memory of the core: what a call takes and gives lies there, and is given back after it.
import type { Piece, Rows, Term } from "./input";

/** Sizes of pindrive_piece and pindrive_term, and the place of the terms in a piece. */
export const PIECE_BYTES = 64;
export const TERM_BYTES = 32;
export const TERMS_AT = 56;

/** Error of the core, in its words. */
export class CoreError extends Error {}

export type Exports = { readonly memory: WebAssembly.Memory } & Readonly<
  Record<string, (...given: number[]) => number>
>;

const MORE = 1; // PINDRIVE_MORE: there was more than fitted

/** Kinds of numbers with names. */
export type Named = "number" | "energy" | "certificate";

export class Memory {
  private readonly found = new Map<Named, readonly string[]>();

  constructor(readonly wasm: Exports) {}

  /** The names of all numbers of a kind. */
  names(of: Named): readonly string[] {
    const known = this.found.get(of);
    if (known) return known;
    const count = this.wasm[`pindrive_${of}_count`]!();
    const names = Array.from({ length: count }, (_, i) => this.text(this.wasm[`pindrive_${of}_name`]!(i)));
    this.found.set(of, names);
    return names;
  }

  get buffer(): ArrayBuffer {
    return this.wasm.memory.buffer as ArrayBuffer;
  }

  view(): DataView {
    return new DataView(this.buffer);
  }

  /** Calls a function that may fail; whether there was more than fitted. */
  call(name: string, ...given: number[]): boolean {
    const error = this.wasm[`pindrive_${name}`]!(...given);
    if (error > MORE) throw new CoreError(this.text(this.wasm.pindrive_last_error!()));
    return error === MORE;
  }

  borrowed<T>(bytes: number, use: (address: number) => T): T {
    const address = this.wasm.malloc!(Math.max(bytes, 8));
    if (!address) throw new CoreError("out of memory");
    try {
      return use(address);
    } finally {
      this.wasm.free!(address);
    }
  }

  text(address: number): string {
    const bytes = new Uint8Array(this.buffer, address);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  named<T>(names: readonly string[], use: (addresses: number[]) => T): T {
    const texts = names.map((name) => new TextEncoder().encode(`${name}\0`));
    return this.borrowed(
      texts.reduce((sum, text) => sum + text.length, 0),
      (at) => {
        let next = at;
        const addresses = texts.map((text) => {
          new Uint8Array(this.buffer, next).set(text);
          next += text.length;
          return next - text.length;
        });
        return use(addresses);
      },
    );
  }

  setNumber(setter: string, target: number, name: string, value: number): void {
    this.named([name], ([address]) => this.call(setter, target, address!, value));
  }

  setRows(setter: string, target: number, name: string, rows: Rows): void {
    this.borrowed(16 * rows.length, (at) =>
      this.named([name], ([address]) => {
        const columns = new Float64Array(this.buffer, at, 2 * rows.length);
        rows.forEach(([first, second], i) => {
          columns[i] = first;
          columns[rows.length + i] = second;
        });
        this.call(setter, target, address!, at, at + 8 * rows.length, rows.length);
      }),
    );
  }

  /** The pieces that the core has written. */
  piecesAt(address: number, count: number): Piece[] {
    const view = this.view();
    const read = (from: number, length: number): number[] =>
      Array.from({ length }, (_, i) => view.getFloat64(from + 8 * i, true));
    return Array.from({ length: count }, (_, i): Piece => {
      const from = address + PIECE_BYTES * i;
      const [begin, ...polynomial] = read(from, 7) as [number, ...number[]];
      const terms = view.getUint32(from + TERMS_AT, true);
      const length = view.getUint32(from + TERMS_AT + 4, true);
      return {
        begin,
        polynomial: polynomial.slice(0, Math.max(polynomial.findLastIndex((p) => p !== 0) + 1, 1)),
        terms: Array.from({ length }, (_, j) => read(terms + TERM_BYTES * j, 4) as unknown as Term),
      };
    });
  }
}
