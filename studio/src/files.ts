// Files that come in: chosen, dropped, or given with the page. One reader knows each kind of them.
import type { Core } from "./core";
import { type Design, designOf } from "./design";
import { DeviceError, decodeText } from "./device";
import { h } from "./dom";
import type { Rows } from "./input";
import { readingOf, type SavedReading } from "./read/saved";
import { type Recording, RecordingError, readRecording } from "./recording";

export interface Given {
  readonly file: string;
  readonly text: string;
  /** Contents of the CSV files of a device file, SI, by key. */
  readonly rows: Readonly<Record<string, Rows>>;
}

/** Content of a file. */
export type Opened =
  | { readonly device: Design }
  | { readonly recording: Recording }
  | { readonly reading: SavedReading; readonly file: string }
  | { readonly picture: File };

/** A file that cannot be used, in words that name it. */
export class FileError extends Error {}

/** Kinds of files that the page opens. */
export const OPENED = ".toml,.csv,.txt,.json,image/*";

/** Reads a device file, a recording, a saved reading or a picture. Throws FileError. */
export async function openFile(core: Core, file: File): Promise<Opened> {
  const { name } = file;
  if (file.type.startsWith("image/")) return { picture: file };
  try {
    return await openText(core, decodeText(new Uint8Array(await file.arrayBuffer()), name), name);
  } catch (error) {
    if (error instanceof DeviceError || error instanceof RecordingError) throw new FileError(error.message);
    throw new FileError(`${name}: ${(error as Error).message}`);
  }
}

async function openText(core: Core, text: string, name: string): Promise<Opened> {
  if (/\.json$/i.test(name) || text.trimStart().startsWith("{")) {
    return { reading: await readingOf(jsonOf(text)), file: name };
  }
  if (/\.(csv|txt)$/i.test(name)) return { recording: readRecording(text, name) };
  return { device: named(designOf(core, { text, file: name, rows: {} }), name) };
}

function jsonOf(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    throw new Error("is no reading, which is JSON");
  }
}

/** A design that has a name, if only that of its file. */
export function named(design: Design, file: string): Design {
  return { ...design, name: design.name || file.replace(/\.toml$/i, "") };
}

/** The device file that the command put into this copy of the page; null without one. */
export function givenDevice(): Given | null {
  const element = document.getElementById("device");
  const text = element?.textContent?.trim();
  return text ? (JSON.parse(text) as Given) : null;
}

/** Asks for one file. */
export function choose(accept: string, take: (file: File) => void): void {
  const input = h("input", { type: "file", accept });
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    if (file) take(file);
  });
  input.click();
}

/** Takes files that are dropped anywhere on the page. */
export function acceptDrops(take: (file: File) => void): void {
  const over = (event: DragEvent, dragging: boolean): void => {
    event.preventDefault();
    document.body.classList.toggle("dragging", dragging);
  };
  document.addEventListener("dragover", (event) => over(event, true));
  document.addEventListener("dragleave", (event) => over(event, false));
  document.addEventListener("drop", (event) => {
    over(event, false);
    for (const file of event.dataTransfer?.files ?? []) take(file);
  });
}
