// Keys that a user types: which are near an unknown one, as src/pindrive/quantities/names.py has it.
import { quoted } from "./numbertext";
import { TABLES } from "./table";

const NEAR = 0.6;
const BESIDE = 0.03;
const MOST = 3;
const BY_PART = 0.9;

/** The keys most like an unknown one, the likeliest first; at the top of a file tables, too. */
export function nearest(given: string): string[] {
  return nearestOf(given, given.includes(".") ? TABLES.keys : [...TABLES.tables, ...TABLES.keys]);
}

function nearestOf(given: string, keys: readonly string[]): string[] {
  const plain = given.trim().replaceAll(".", "_");
  const usual = plain
    .split("_")
    .map((word) => TABLES.otherWords[word] ?? word)
    .join("_");
  const [table] = given.includes(".") ? given.split(".") : [""];
  const last = given.slice(given.lastIndexOf(".") + 1).trim();
  const meant = matches(last, keys);
  const likeness = keys.map((key) => {
    const pairs = spellings(key).flatMap((spelled) =>
      [plain, usual].map((one) => alike(one, spelled, table!)),
    );
    const byPart = meant.includes(key) || key.startsWith(`${given}.`) ? BY_PART : 0;
    return { key, like: Math.max(byPart, ...pairs) };
  });
  const best = Math.max(...likeness.map(({ like }) => like));
  return likeness
    .filter(({ like }) => like >= Math.max(NEAR, best - BESIDE))
    .sort((a, b) => b.like - a.like)
    .slice(0, MOST)
    .map(({ key }) => key);
}

/** Message for an unknown key of a device file. */
export function unknownInFile(key: string): string {
  if (key === "plate.stiffness") {
    return `${key} cannot be given, the plate is rigid; skin gives way by finger.stiffness`;
  }
  if (key === "plate.damping") {
    return `${key} cannot be given, the plate is rigid; skin is damped by finger.damping`;
  }
  const count = TABLES.keys.length + (key.includes(".") ? 0 : TABLES.tables.length);
  return said("key", key, nearest(key), `none is like it; docs/reference/device-file.md lists all ${count}`);
}

/** Message for an unknown name of a kind, where there are few names. */
export function unknown(kind: string, name: string, names: readonly string[]): string {
  return said(kind, name, nearestOf(name, names), `there are ${names.join(", ")}`);
}

function said(kind: string, name: string, near: string[], without: string): string {
  const shown = /^[\w.-]{1,60}$/.test(name) ? name : quoted(name);
  const last = near.pop();
  const meant = near.length ? `${near.join(", ")} or ${last}` : last;
  return `unknown ${kind} ${shown}; ${meant ? `did you mean ${meant}?` : without}`;
}

/** The keys that are written so, or else all that end so after the dot. */
function matches(plain: string, keys: readonly string[]): string[] {
  const spelled = keys.find((key) => written(key).includes(plain));
  return spelled ? [spelled] : keys.filter((key) => key.includes(".") && end(key) === plain);
}

function spellings(key: string): string[] {
  return key.includes(".") ? [...written(key), end(key)] : written(key);
}

function written(key: string): string[] {
  const plain = key.replaceAll(".", "_");
  return key in TABLES.variables ? [plain, TABLES.variables[key]!] : [plain];
}

function end(key: string): string {
  return key.slice(key.indexOf(".") + 1).replaceAll(".", "_");
}

/** From 0 to 1: how alike two names are, by letters or by a word that is not their table. */
function alike(given: string, spelled: string, table: string): number {
  const [one, other] = [given.toLowerCase(), spelled.toLowerCase()];
  const letters = similarity(one, other);
  const words = new Set(other.split("_"));
  const shares = one.split("_").some((word) => word.length > 2 && word !== table && words.has(word));
  return shares ? Math.max(letters, 0.5 + 0.5 * letters) : letters;
}

/**
 * Similarity: twice the characters in matching blocks over all characters (Ratcliff and Obershelp).
 */
function similarity(a: string, b: string): number {
  const total = a.length + b.length;
  return total ? (2 * matching(a, b)) / total : 1;
}

function matching(a: string, b: string): number {
  let [size, atA, atB] = [0, 0, 0];
  let lengths = new Map<number, number>();
  for (let i = 0; i < a.length; ++i) {
    const next = new Map<number, number>();
    for (let j = 0; j < b.length; ++j) {
      if (a[i] !== b[j]) continue;
      const length = (lengths.get(j - 1) ?? 0) + 1;
      next.set(j, length);
      if (length > size) [size, atA, atB] = [length, i - length + 1, j - length + 1];
    }
    lengths = next;
  }
  if (!size) return 0;
  return (
    size + matching(a.slice(0, atA), b.slice(0, atB)) + matching(a.slice(atA + size), b.slice(atB + size))
  );
}
