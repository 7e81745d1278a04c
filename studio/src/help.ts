// Help for each view: a dialog with a line for each thing that can be done.
import { button, h } from "./dom";
import type { ViewName } from "./keeper";
import { TABLES } from "./table";

type Line = readonly [string, string];

const HELP: Readonly<Record<ViewName, readonly Line[]>> = {
  release: [
    ["Slider, or field with its unit", "changes a parameter; the motion follows at once"],
    ["Drag the pin", "lets it go from another deflection"],
    ["Point at the curves", "moves the cursor; device, phase plane and numbers show that time"],
    ["Space", "plays the motion"],
    ["Ctrl+Z, Ctrl+Shift+Z", "undo and redo"],
    ["Keep ghost", "leaves the present curve in grey, to compare with"],
    ["Drag the dot of the map", "sets both of its parameters; stripes mark where limits are exceeded"],
    ["Drop a file", "opens a device file (TOML), or lays a recording (CSV) over the curves"],
  ],
  read: [
    [
      "Move over the page, or drag a finger",
      "moves the device; a reading ends where the pointer leaves the page or the finger lifts",
    ],
    [
      "Press on the page",
      "begins the next reading; with the button held down the hand follows beyond the edge",
    ],
    ["Arrow keys on the page", "move the hand at a set speed; Escape ends the reading"],
    ["Type, draw, drop a picture", "makes another page"],
    ["Click a pin", "shows it from the side; its motion opens in the other view"],
    ["10× slower", "time runs slower than your hand: a release lasts some milliseconds"],
    ["Number of pins, sliders", "change the device under the hand; the next reading is of the new one"],
    ["Play, Pause, the slider of time", "show the reading again, at any speed"],
    ["Missed, merged, false", "marks on the page and a list: choose one to see its moment"],
    ["Ctrl+Z, Ctrl+Shift+Z", "undo and redo"],
  ],
};

/** Shows the help of a view until it is closed. */
export function showHelp(view: ViewName): void {
  const close = button("Close", "Close the help", () => dialog.close());
  const rows = HELP[view].flatMap(([what, does]) => [h("dt", {}, what), h("dd", {}, does)]);
  const dialog = h(
    "dialog",
    { class: "help", "aria-labelledby": "help-title", onclose: () => dialog.remove() },
    h("h2", { id: "help-title" }, view === "read" ? "Read" : "One release"),
    h("dl", {}, ...rows),
    h("p", { class: "note" }, `pindrive ${TABLES.version}. Nothing leaves this page: it makes no request.`),
    close,
  );
  document.body.append(dialog);
  dialog.showModal();
}
