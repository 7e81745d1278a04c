// Help for each view: a dialog with a line for each thing that can be done.
import { button, h } from "./dom";
import { TABLES } from "./table";

type Line = readonly [string, string];

const HELP: Readonly<Record<"release" | "read", readonly Line[]>> = {
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
    ["Move over the page", "moves the device; on a touch screen a finger drags it like a mouse"],
    ["Arrow keys on the page", "move the hand at a set speed"],
    ["Type, draw, drop a picture", "makes another page"],
    ["Click a pin", "shows it from the side; its motion opens in the other view"],
    ["10× slower", "time runs slower than your hand: a release lasts some milliseconds"],
    ["Sliders", "change the device under the hand; the reading begins anew"],
    ["Replay", "repeats the reading four times slower; its slider moves through it"],
  ],
};

/** A button that opens the help of a view. */
export function help(view: keyof typeof HELP): HTMLElement {
  const close = button("Close", "Close the help", () => dialog.close());
  const rows = HELP[view].flatMap(([what, does]) => [h("dt", {}, what), h("dd", {}, does)]);
  const dialog = h(
    "dialog",
    { class: "help", "aria-labelledby": `help-${view}` },
    h("h2", { id: `help-${view}` }, view === "read" ? "Read" : "One release"),
    h("dl", {}, ...rows),
    h("p", { class: "note" }, `pindrive ${TABLES.version}. Nothing leaves this page: it makes no request.`),
    close,
  );
  const open = button("Help", "Explanations of this view", () => dialog.showModal());
  return h("span", {}, open, dialog);
}
