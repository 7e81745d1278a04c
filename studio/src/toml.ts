// TOML 1.0 as device files are written; what is wrong is said, and placed, as Python says it.
import { repr, stringRepr } from "./python";

/** A bigint is an integer, a number a float; dates are their text. */
export type TomlValue = string | bigint | number | boolean | TomlValue[] | TomlTable | TomlDate;
export interface TomlTable {
  [key: string]: TomlValue;
}
export class TomlDate {
  constructor(readonly text: string) {}
  toString(): string {
    return this.text;
  }
}
export class TomlError extends Error {}

export function isTable(value: unknown): value is TomlTable {
  return typeof value === "object" && value !== null && !Array.isArray(value) && !(value instanceof TomlDate);
}

export function parseToml(text: string): TomlTable {
  return new Parser(text.replaceAll("\r\n", "\n")).document();
}

const BARE_KEY = /[A-Za-z0-9_-]/;
// biome-ignore lint/suspicious/noControlCharactersInRegex: TOML refuses them
const CONTROL = /[\u0000-\u0008\u000a-\u001f\u007f]/;
// biome-ignore lint/suspicious/noControlCharactersInRegex: TOML refuses them
const CONTROL_BUT_NEWLINE = /[\u0000-\u0008\u000b-\u001f\u007f]/;
const DATE =
  /(?:\d{4}-(?:0[1-9]|1[0-2])-(?:0[1-9]|[12]\d|3[01])(?:[Tt ]\d{2}:\d{2}:\d{2}(?:\.\d+)?(?:[Zz]|[+-]\d{2}:\d{2})?)?|\d{2}:\d{2}:\d{2}(?:\.\d+)?)/y;
const NUMBER =
  /(?:0(?:x[\da-fA-F](?:_?[\da-fA-F])*|b[01](?:_?[01])*|o[0-7](?:_?[0-7])*)|[+-]?(?:0|[1-9](?:_?\d)*)(?:\.\d(?:_?\d)*)?(?:[eE][+-]?\d(?:_?\d)*)?)/y;
const SPECIAL = /[+-]?(?:inf|nan)/y;
const ESCAPES: Readonly<Record<string, string>> = {
  b: "\b",
  t: "\t",
  n: "\n",
  f: "\f",
  r: "\r",
  '"': '"',
  "\\": "\\",
};

/** Tables that may no longer be changed, by their place. */
class Marks {
  readonly nested = new Map<string, Marks>();
  declared = false;
  frozen = false;

  at(key: readonly string[]): Marks {
    let here: Marks = this;
    for (const name of key) {
      let next = here.nested.get(name);
      if (!next) {
        next = new Marks();
        here.nested.set(name, next);
      }
      here = next;
    }
    return here;
  }

  isFrozen(key: readonly string[]): boolean {
    let here: Marks | undefined = this;
    for (const name of key) {
      here = here.nested.get(name);
      if (!here) return false;
      if (here.frozen) return true;
    }
    return false;
  }

  isDeclared(key: readonly string[]): boolean {
    let here: Marks | undefined = this;
    for (const name of key) here = here?.nested.get(name);
    return here?.declared ?? false;
  }

  forget(key: readonly string[]): void {
    this.at(key.slice(0, -1)).nested.delete(key[key.length - 1]!);
  }
}

class Parser {
  private at = 0;
  private readonly root: TomlTable = Object.create(null) as TomlTable;
  private readonly marks = new Marks();
  private header: string[] = [];
  private pending: string[][] = [];

  constructor(private readonly text: string) {}

  document(): TomlTable {
    while (true) {
      this.skipSpace();
      const char = this.text[this.at];
      if (char === undefined) return this.root;
      if (char === "\n") {
        ++this.at;
        continue;
      }
      if (BARE_KEY.test(char) || char === '"' || char === "'") this.statement();
      else if (char === "[") this.declaration();
      else if (char !== "#") throw this.error("Invalid statement");
      this.skipSpace();
      this.skipComment();
      if (this.at >= this.text.length) return this.root;
      if (this.text[this.at] !== "\n") {
        throw this.error("Expected newline or end of document after a statement");
      }
      ++this.at;
    }
  }

  private error(message: string, at = this.at): TomlError {
    if (at >= this.text.length) return new TomlError(`${message} (at end of document)`);
    const before = this.text.slice(0, at);
    const line = before.split("\n").length;
    const column = [...before.slice(before.lastIndexOf("\n") + 1)].length + 1;
    return new TomlError(`${message} (at line ${line}, column ${column})`);
  }

  private skipSpace(): void {
    while (this.text[this.at] === " " || this.text[this.at] === "\t") ++this.at;
  }

  private skipComment(): void {
    if (this.text[this.at] === "#") this.skipUntil("\n", CONTROL, false);
  }

  /** Goes to the text `end`, and refuses what `illegal` finds before it. */
  private skipUntil(end: string, illegal: RegExp, needed = true): string {
    const begin = this.at;
    let stop = this.text.indexOf(end, begin);
    if (stop < 0) {
      stop = this.text.length;
      if (needed) throw this.error(`Expected ${stringRepr(end)}`, stop);
    }
    const bad = this.text.slice(begin, stop).search(illegal);
    if (bad >= 0) {
      throw this.error(`Found invalid character ${stringRepr(this.text[begin + bad]!)}`, begin + bad);
    }
    this.at = stop;
    return this.text.slice(begin, stop);
  }

  private declaration(): void {
    this.finishPending();
    const many = this.text.startsWith("[[", this.at);
    this.at += many ? 2 : 1;
    this.skipSpace();
    const key = this.key();
    if (many) {
      if (this.marks.isFrozen(key)) throw this.error(`Cannot mutate immutable namespace ${tuple(key)}`);
      this.marks.forget(key);
    } else if (this.marks.isDeclared(key) || this.marks.isFrozen(key)) {
      throw this.error(`Cannot declare ${tuple(key)} twice`);
    }
    this.marks.at(key).declared = true;
    const parent = this.nest(this.root, many ? key.slice(0, -1) : key);
    if (many) {
      const name = key[key.length - 1]!;
      parent[name] ??= [];
      const list = parent[name];
      if (!Array.isArray(list)) throw this.error("Cannot overwrite a value");
      list.push(Object.create(null) as TomlTable);
    }
    const end = many ? "]]" : "]";
    if (!this.text.startsWith(end, this.at)) {
      throw this.error(`Expected '${end}' at the end of ${many ? "an array" : "a table"} declaration`);
    }
    this.at += end.length;
    this.header = key;
  }

  private finishPending(): void {
    for (const key of this.pending) this.marks.at(key).declared = true;
    this.pending = [];
  }

  private statement(): void {
    const [key, value] = this.pair();
    for (let i = 1; i < key.length; ++i) {
      const part = [...this.header, ...key.slice(0, i)];
      if (this.marks.isDeclared(part)) throw this.error(`Cannot redefine namespace ${tuple(part)}`);
      this.pending.push(part);
    }
    const parent = [...this.header, ...key.slice(0, -1)];
    if (this.marks.isFrozen(parent)) {
      throw this.error(`Cannot mutate immutable namespace ${tuple(parent)}`);
    }
    const table = this.nest(this.root, parent);
    const name = key[key.length - 1]!;
    if (name in table) throw this.error("Cannot overwrite a value");
    if (Array.isArray(value) || isTable(value)) this.marks.at([...this.header, ...key]).frozen = true;
    table[name] = value;
  }

  private nest(from: TomlTable, key: readonly string[], throughLists = true): TomlTable {
    let here: TomlValue = from;
    for (const name of key) {
      const table: TomlTable = here as TomlTable;
      table[name] ??= Object.create(null) as TomlTable;
      let next: TomlValue | undefined = table[name];
      if (throughLists && Array.isArray(next)) next = next[next.length - 1];
      if (!isTable(next)) throw this.error("Cannot overwrite a value");
      here = next;
    }
    return here as TomlTable;
  }

  private pair(): [string[], TomlValue] {
    const key = this.key();
    if (this.text[this.at] !== "=") throw this.error("Expected '=' after a key in a key/value pair");
    ++this.at;
    this.skipSpace();
    return [key, this.value()];
  }

  private key(): string[] {
    const key = [this.keyPart()];
    this.skipSpace();
    while (this.text[this.at] === ".") {
      ++this.at;
      this.skipSpace();
      key.push(this.keyPart());
      this.skipSpace();
    }
    return key;
  }

  private keyPart(): string {
    const char = this.text[this.at] ?? "";
    if (char === "'") return this.literal();
    if (char === '"') return this.basic();
    if (!BARE_KEY.test(char)) throw this.error("Invalid initial character for a key part");
    const begin = this.at;
    while (BARE_KEY.test(this.text[this.at] ?? "")) ++this.at;
    return this.text.slice(begin, this.at);
  }

  private value(): TomlValue {
    const { text } = this;
    const char = text[this.at];
    if (char === '"') return text.startsWith('"""', this.at) ? this.multiline('"') : this.basic();
    if (char === "'") return text.startsWith("'''", this.at) ? this.multiline("'") : this.literal();
    for (const [word, value] of [
      ["true", true],
      ["false", false],
    ] as const) {
      if (text.startsWith(word, this.at)) {
        this.at += word.length;
        return value;
      }
    }
    if (char === "[") return this.array();
    if (char === "{") return this.inlineTable();
    const date = this.matched(DATE);
    if (date) return new TomlDate(date);
    const number = this.matched(NUMBER)?.replaceAll("_", "");
    if (number) {
      if (/^0[xbo]/.test(number) || /^[+-]?\d+$/.test(number)) {
        return number.startsWith("-") ? -BigInt(number.slice(1)) : BigInt(number.replace("+", ""));
      }
      return Number(number);
    }
    const special = this.matched(SPECIAL);
    if (!special) throw this.error("Invalid value");
    return special.endsWith("nan") ? NaN : special.startsWith("-") ? -Infinity : Infinity;
  }

  private matched(pattern: RegExp): string | undefined {
    pattern.lastIndex = this.at;
    const found = pattern.exec(this.text)?.[0];
    this.at += found?.length ?? 0;
    return found;
  }

  private skipInArray(): void {
    let before: number;
    do {
      before = this.at;
      while (/[ \t\n]/.test(this.text[this.at] ?? "")) ++this.at;
      this.skipComment();
    } while (this.at !== before);
  }

  private array(): TomlValue[] {
    ++this.at;
    const found: TomlValue[] = [];
    this.skipInArray();
    while (this.text[this.at] !== "]") {
      found.push(this.value());
      this.skipInArray();
      if (this.text[this.at] === "]") break;
      if (this.text[this.at] !== ",") throw this.error("Unclosed array");
      ++this.at;
      this.skipInArray();
    }
    ++this.at;
    return found;
  }

  private inlineTable(): TomlTable {
    ++this.at;
    const found = Object.create(null) as TomlTable;
    const marks = new Marks();
    this.skipSpace();
    if (this.text[this.at] === "}") {
      ++this.at;
      return found;
    }
    while (true) {
      const [key, value] = this.pair();
      if (marks.isFrozen(key)) throw this.error(`Cannot mutate immutable namespace ${tuple(key)}`);
      const table = this.nest(found, key.slice(0, -1), false);
      const name = key[key.length - 1]!;
      if (name in table) throw this.error(`Duplicate inline table key ${stringRepr(name)}`);
      table[name] = value;
      this.skipSpace();
      if (this.text[this.at] === "}") break;
      if (this.text[this.at] !== ",") throw this.error("Unclosed inline table");
      if (Array.isArray(value) || isTable(value)) marks.at(key).frozen = true;
      ++this.at;
      this.skipSpace();
    }
    ++this.at;
    return found;
  }

  private literal(): string {
    ++this.at;
    const found = this.skipUntil("'", CONTROL);
    ++this.at;
    return found;
  }

  private basic(): string {
    ++this.at;
    return this.basicRest(false);
  }

  private multiline(quote: string): string {
    this.at += 3;
    if (this.text[this.at] === "\n") ++this.at;
    let found: string;
    if (quote === "'") {
      found = this.skipUntil("'''", CONTROL_BUT_NEWLINE);
      this.at += 3;
    } else {
      found = this.basicRest(true);
    }
    for (let i = 0; i < 2 && this.text[this.at] === quote; ++i) {
      found += quote;
      ++this.at;
    }
    return found;
  }

  private basicRest(multiline: boolean): string {
    const illegal = multiline ? CONTROL_BUT_NEWLINE : CONTROL;
    let found = "";
    while (true) {
      const char = this.text[this.at];
      if (char === undefined) throw this.error("Unterminated string");
      if (char === '"' && (!multiline || this.text.startsWith('"""', this.at))) {
        this.at += multiline ? 3 : 1;
        return found;
      }
      if (char === "\\") {
        found += this.escape(multiline);
        continue;
      }
      if (illegal.test(char)) throw this.error(`Illegal character ${stringRepr(char)}`);
      found += char;
      ++this.at;
    }
  }

  private escape(multiline: boolean): string {
    const kind = this.text[this.at + 1] ?? "";
    this.at += 2;
    if (multiline && (kind === " " || kind === "\t" || kind === "\n")) {
      if (kind !== "\n") {
        this.skipSpace();
        if (this.text[this.at] === undefined) return "";
        if (this.text[this.at] !== "\n") throw this.error("Unescaped '\\' in a string");
        ++this.at;
      }
      while (/[ \t\n]/.test(this.text[this.at] ?? "")) ++this.at;
      return "";
    }
    if (kind === "u" || kind === "U") {
      const size = kind === "u" ? 4 : 8;
      const hex = this.text.slice(this.at, this.at + size);
      if (hex.length !== size || /[^\da-fA-F]/.test(hex)) throw this.error("Invalid hex value");
      this.at += size;
      const code = parseInt(hex, 16);
      if (code > 0x10ffff || (code >= 0xd800 && code <= 0xdfff)) {
        throw this.error("Escaped character is not a Unicode scalar value");
      }
      return String.fromCodePoint(code);
    }
    const plain = Object.hasOwn(ESCAPES, kind) ? ESCAPES[kind] : undefined;
    if (plain === undefined) throw this.error("Unescaped '\\' in a string");
    return plain;
  }
}

/** A key as Python writes a tuple. */
function tuple(key: readonly string[]): string {
  return `(${key.map(repr).join(", ")}${key.length === 1 ? "," : ""})`;
}
