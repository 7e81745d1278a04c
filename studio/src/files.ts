// Files that come in: chosen, dropped, or given with the page; device files and recordings.
import type { Rows } from "./core";
import { h } from "./dom";

export interface Given {
  readonly file: string;
  readonly text: string;
  /** Contents of the CSV files of a device file, SI, by key. */
  readonly rows: Readonly<Record<string, Rows>>;
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
