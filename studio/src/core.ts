// The core as WebAssembly: the functions of capi/pindrive.h on JavaScript's arrays. SI units throughout.
import type { Input, Piece, Row, Rows, TimeFunction } from "./input";
import { CoreError, type Exports, Memory, PIECE_BYTES, TERM_BYTES, TERMS_AT } from "./memory";
import { Motion } from "./motion";
import { valueAt } from "./pieces";

const INTERFACE = 2; // PINDRIVE_INTERFACE that this file is written for
const TEXT_BYTES = 1 << 13;

export class Core extends Memory {
  private constructor(wasm: Exports) {
    super(wasm);
    wasm._initialize?.();
    const found = wasm.pindrive_interface!();
    if (found !== INTERFACE) throw new CoreError(`the core has interface ${found}, not ${INTERFACE}`);
  }

  static async load(compiled: WebAssembly.Module): Promise<Core> {
    const imports: Record<string, Record<string, () => number>> = {};
    for (const { module: from, name } of WebAssembly.Module.imports(compiled)) {
      imports[from] = { ...imports[from], [name]: () => 8 }; // EBADF: the core has no files
    }
    const instance = await WebAssembly.instantiate(compiled, imports);
    return new Core(instance.exports as unknown as Exports);
  }

  statusText(status: number): string {
    return this.text(this.wasm.pindrive_status_text!(status));
  }

  /**
   * Problems of values of a device file, SI, in a line each: the bounds of each value, and what they require of
   * each other; `whole`: of a device with magnet, control block and array. Null: given, but not known.
   */
  problems(values: Readonly<Record<string, number | Rows | TimeFunction | null>>, whole = false): string[] {
    // A function contradicts others by its first value.
    const given = Object.fromEntries(
      Object.entries(values).map(([key, value]) => [
        key,
        typeof value === "object" && value !== null && "parts" in value ? valueAt(value, 0) : value,
      ]),
    ) as Record<string, number | Rows | null>;
    const keys = Object.keys(given);
    const columns = keys.map((key) => {
      const value = given[key]!;
      return value === null ? [] : typeof value === "number" ? [value] : value.flat();
    });
    const numbers = columns.reduce((sum, { length }) => sum + length, 0);
    return this.borrowed(8 * numbers + 12 * keys.length + TEXT_BYTES, (at) =>
      this.named(keys, (addresses) => {
        const [table, text] = [at + 8 * numbers, at + 8 * numbers + 12 * keys.length];
        let next = at;
        columns.forEach((column, i) => {
          new Float64Array(this.buffer, next, column.length).set(column);
          const rows = typeof given[keys[i]!] === "number" ? 0 : column.length / 2;
          [addresses[i]!, column.length ? next : 0, rows].forEach((word, j) => {
            this.view().setUint32(table + 12 * i + 4 * j, word, true);
          });
          next += 8 * column.length;
        });
        this.wasm.pindrive_check_values!(table, keys.length, Number(whole), text, TEXT_BYTES);
        const said = this.text(text);
        return said ? said.split("\n") : [];
      }),
    );
  }

  /** Unit vector at an angle, rad, with the bits that Python has. */
  direction(angle: number): Row {
    return this.borrowed(16, (at) => {
      this.wasm.pindrive_direction!(angle, at, at + 8);
      const [x, y] = new Float64Array(this.buffer, at, 2);
      return [x!, y!];
    });
  }

  /** The pieces of a function of a few numbers, SI. Throws CoreError on numbers out of range. */
  functionPieces(kind: string, numbers: readonly number[]): Piece[] {
    const most = 3; // pieces, and terms
    const termsAt = most * PIECE_BYTES;
    const numbersAt = termsAt + most * TERM_BYTES;
    return this.borrowed(numbersAt + 8 * numbers.length + 4, (at) =>
      this.named([kind], ([address]) => {
        const count = at + numbersAt + 8 * numbers.length;
        new Float64Array(this.buffer, at + numbersAt, numbers.length).set(numbers);
        this.call("function", address!, at + numbersAt, numbers.length, at, at + termsAt, count);
        return this.piecesAt(at, this.view().getUint32(count, true));
      }),
    );
  }

  /** The motion of a release; to be freed. Throws CoreError on what the core cannot follow. */
  simulate(input: Input): Motion {
    return this.withInput(input, (drive, release) =>
      this.borrowed(4, (out) => {
        this.call("simulate", drive, release, 0, 0, out);
        return new Motion(this, this.view().getUint32(out, true));
      }),
    );
  }

  /** Exact derivatives of the motion along a direction; missing rows are 0. */
  differentiate(input: Input, direction: Input): Motion {
    const { wasm } = this;
    return this.withInput(input, (drive, release) => {
      const driveRate = wasm.pindrive_drive_rate_new!(drive);
      const releaseRate = wasm.pindrive_release_rate_new!(release);
      try {
        this.fill(driveRate, releaseRate, direction);
        return this.borrowed(4, (out) => {
          this.call("differentiate", drive, release, driveRate, releaseRate, 0, 0, out);
          return new Motion(this, this.view().getUint32(out, true));
        });
      } finally {
        wasm.pindrive_drive_free!(driveRate);
        wasm.pindrive_release_free!(releaseRate);
      }
    });
  }

  /** Numbers of many releases, a row of `outputs` for each point; NaN where a point cannot be. */
  batch(
    input: Input,
    varied: Readonly<Record<string, Float64Array>>,
    outputs: readonly string[],
    points: number,
    band: number,
  ): Float64Array {
    const names = Object.keys(varied);
    const width = outputs.length;
    const bytes = names.length * (8 + 8 * points) + 8 * points * width + 4 * width;
    return this.withInput(input, (drive, release) =>
      this.borrowed(bytes, (at) => {
        const numbersAt = at;
        let next = at + 8 * points * width;
        const columns = names.map((name) => {
          const column = next;
          new Float64Array(this.buffer, column, points).set(varied[name]!);
          next += 8 * points;
          return column;
        });
        const table = next;
        const asked = table + 8 * names.length;
        return this.named([...names, ...outputs], (addresses) => {
          const view = this.view();
          addresses.slice(0, names.length).forEach((address, i) => {
            view.setUint32(table + 8 * i, address, true);
            view.setUint32(table + 8 * i + 4, columns[i]!, true);
          });
          addresses.slice(names.length).forEach((address, i) => {
            view.setUint32(asked + 4 * i, address, true);
          });
          this.call(
            "batch",
            drive,
            release,
            table,
            names.length,
            points,
            band,
            asked,
            width,
            0,
            0,
            numbersAt,
            0,
            0,
            0,
            0,
          );
          return new Float64Array(this.buffer, numbersAt, points * width).slice();
        });
      }),
    );
  }

  private withInput<T>(input: Input, use: (drive: number, release: number) => T): T {
    const drive = this.wasm.pindrive_drive_new!();
    const release = this.wasm.pindrive_release_new!();
    try {
      this.fill(drive, release, input);
      return use(drive, release);
    } finally {
      this.wasm.pindrive_drive_free!(drive);
      this.wasm.pindrive_release_free!(release);
    }
  }

  private fill(drive: number, release: number, input: Input): void {
    for (const [contact, rows] of Object.entries(input.curves)) {
      this.setRows("drive_set_curve", drive, contact, rows);
    }
    // Kinetic friction sets the static one too, so it comes first.
    const last = (name: string): number => (name.endsWith(".static") ? 1 : 0);
    const drives = Object.entries(input.drive).sort(([a], [b]) => last(a) - last(b));
    for (const [name, value] of drives) this.setNumber("drive_set", drive, name, value);
    for (const [name, value] of Object.entries(input.release)) {
      this.setNumber("release_set", release, name, value);
    }
    for (const [name, rows] of Object.entries(input.profiles)) {
      this.setRows("release_set_profile", release, name, rows);
    }
    for (const [name, { parts }] of Object.entries(input.functions)) {
      parts.forEach(({ pieces }, i) => {
        this.setPieces(i ? "release_add_function" : "release_set_function", release, name, pieces);
      });
    }
  }

  private setPieces(setter: string, release: number, name: string, pieces: readonly Piece[]): void {
    const terms = pieces.reduce((sum, piece) => sum + piece.terms.length, 0);
    this.borrowed(PIECE_BYTES * pieces.length + TERM_BYTES * terms, (at) =>
      this.named([name], ([address]) => {
        const view = this.view();
        const numbers = (from: number, values: readonly number[]): void =>
          values.forEach((value, i) => {
            view.setFloat64(from + 8 * i, value, true);
          });
        let next = at + PIECE_BYTES * pieces.length;
        pieces.forEach((piece, i) => {
          const from = at + PIECE_BYTES * i;
          numbers(from, [piece.begin, ...Array.from({ length: 6 }, (_, n) => piece.polynomial[n] ?? 0)]);
          view.setUint32(from + TERMS_AT, next, true);
          view.setUint32(from + TERMS_AT + 4, piece.terms.length, true);
          for (const term of piece.terms) {
            numbers(next, term);
            next += TERM_BYTES;
          }
        });
        this.call(setter, release, address!, at, pieces.length);
      }),
    );
  }
}
