// Examples of both views, each with a sentence of what it shows.
import type { Core } from "./core";
import { type Design, designOf } from "./design";
import type { Kept } from "./keep";
import { HEIGHT, RESOLUTION, rasterOfCanvas } from "./read/paper";
import { packedRaster } from "./read/raster";
import type { PrintedLine, ReadState, Stroke } from "./read/state";
import { readRecording } from "./recording";
import type { ReleaseState } from "./state";
import { TABLES } from "./table";

/** The states of an example; what it does not change is missing. */
export interface Example {
  readonly read?: ReadState;
  readonly release?: ReleaseState;
  readonly shows?: string;
}

type Made = (core: Core, kept: Kept, width: number) => Example | Promise<Example>;

// ---- Read ----------------------------------------------------------------------------------------

function printed(print: ReadState["print"]): Made {
  return (_, { read }) => ({ read: { ...read, print, task: 0, hand: null } });
}

function text(words: string): Made {
  return (core, kept, width) => printed({ kind: "text", text: words, width })(core, kept, width);
}

/** Lines of five pitches, each half as wide as its pitch, mm. */
const gratings: Made = (core, kept, width) => {
  const lines: PrintedLine[] = [];
  let x = 3;
  for (const pitch of [4, 3, 2, 1.5, 1]) {
    for (let i = 0; i < 3 && x + pitch < width - 2; ++i, x += pitch) lines.push([x, pitch / 2]);
    x += 1;
  }
  return printed({ kind: "lines", lines, width })(core, kept, width);
};

/** A wave over a ground line. */
const drawing: Made = (core, kept, width) => {
  const at = (from: number, to: number, y: (part: number) => number): Stroke =>
    Array.from({ length: 81 }, (_, i) => ({ x: from + ((to - from) * i) / 80, y: y(i / 80) }));
  const strokes = [
    at(5, width - 5, (part) => 5.5 - 3 * Math.sin(4 * Math.PI * part)),
    at(5, width - 5, () => 11),
  ];
  return printed({ kind: "drawing", strokes, width })(core, kept, width);
};

/** Rings in shades of grey. */
const picture: Made = async (core, kept, width) => {
  const canvas = new OffscreenCanvas(Math.round(width * RESOLUTION), Math.round(HEIGHT * RESOLUTION));
  const pen = canvas.getContext("2d", { willReadFrequently: true })!;
  pen.fillStyle = "#fff";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.scale(RESOLUTION, RESOLUTION);
  [4, 3, 2, 1].forEach((pitch, k) => {
    const x = width / 2 + (k - 1.5) * 9;
    const shade = pen.createRadialGradient(x, HEIGHT / 2, 0, x, HEIGHT / 2, 4.2);
    for (let r = 0; r < 4.2; r += 0.05) {
      const grey = Math.round(127 + 127 * Math.cos((2 * Math.PI * r) / pitch));
      shade.addColorStop(r / 4.2, `rgb(${grey} ${grey} ${grey})`);
    }
    pen.fillStyle = shade;
    pen.beginPath();
    pen.arc(x, HEIGHT / 2, 4.2, 0, 2 * Math.PI);
    pen.fill();
  });
  const raster = await packedRaster(rasterOfCanvas(pen), "rings in grey");
  return printed({ kind: "picture", raster })(core, kept, width);
};

function pins(columns: number, rows: number): Made {
  return (core, { read }) => {
    const design = designOf(core, { text: TABLES.reader, file: "the reader", rows: {} });
    const around = { ...design.around, array: { ...design.around.array, columns, rows } };
    return { read: { ...read, device: { ...design, around }, hand: null } };
  };
}

const READ: Readonly<Record<string, Made>> = {
  "The word Hello": text("Hello"),
  "A long word": text("friction"),
  "A drawing": drawing,
  "A picture in grey": picture,
  "Gratings of five pitches": gratings,
  "A device of one pin": pins(1, 1),
  "Of four pins": pins(2, 2),
  "Of sixteen pins": pins(4, 4),
};

// ---- One release ---------------------------------------------------------------------------------

function device(name: string, tables: string): string {
  return `[device]\nname = "${name}"\n${tables}`;
}

const MOUSE = `
[drive]
mass = "10 g"
stiffness = "100 N/m"
`;
const CONTACTS = `
[plate]
kinetic = "22 mN"
static = "26.5 mN"

[finger]
kinetic = "5 mN"
static = "7.5 mN"
`;
const RELEASED = `
[motion]
mouse_velocity = "60 mm/s"
displacement = "1.5 mm"
`;
const BELT = `
[drive]
mass = "1 kg"
stiffness = "100 N/m"
damping = "0 N*s/m"

[plate]
kinetic = "1 N"
static = "2 N"

[finger]
kinetic = "0 N"

[motion]
mouse_velocity = "100 mm/s"
displacement = "0 mm"
`;

function damped(ratio: number): string {
  return device(`damping ratio ${ratio}`, `${MOUSE}damping_ratio = ${ratio}\n${CONTACTS}${RELEASED}`);
}

/** The motions of some device files, side by side; the first is the current one. */
function released(shows: string, ...texts: readonly string[]): Made {
  return (core, { release }) => {
    const designs = texts.map((text): Design => designOf(core, { text, file: "the example", rows: {} }));
    return { shows, release: { ...release, designs, current: 0, ghost: null, overlay: null, cursor: 0 } };
  };
}

/** A recording over the motion of the template, with the parameters that it determines free. */
function recorded(shows: string, name: string, keys: readonly string[]): Made {
  return (core, kept) => {
    const { release } = released("", TABLES.template)(core, kept, 0) as Required<Example>;
    const recording = readRecording(TABLES.recordings[name]!, name);
    return {
      shows,
      release: { ...release, overlay: { recording, offset: 0, keys, freeOffset: true, report: null } },
    };
  };
}
const FITTED = [
  ...["drive.stiffness", "drive.damping_ratio", "plate.kinetic", "finger.kinetic"],
  "motion.displacement",
];

const RELEASE: Readonly<Record<string, Made>> = {
  "Carried and released": released(
    "The magnet has carried the pin 1.5 mm against its spring and lets go. The pin swings back, rubbing on " +
      "plate and finger, until friction holds it.",
    TABLES.template,
  ),
  "The paper's Figure 4": released(
    "Three damping ratios: at 0.04 the pin swings many times before it settles, and the next line comes too soon; " +
      "at 0.16 and 0.32 it settles sooner.",
    damped(0.04),
    damped(0.16),
    damped(0.32),
  ),
  "At an angle": released(
    "The hand moves at 45 degrees to the drive. Friction opposes the whole sliding velocity, so that the pin creeps " +
      "and never sticks to the plate.",
    device(
      "at an angle",
      `${MOUSE}damping_ratio = 0.16\n${CONTACTS}${RELEASED}across_velocity = "60 mm/s"\n`,
    ),
  ),
  "Skin that stretches": released(
    "Under a compliant finger the skin stretches before it slips, and holds the pin off its rest.",
    device(
      "skin that stretches",
      `${MOUSE}damping_ratio = 0.16\n${CONTACTS}stiffness = "300 N/m"\n${RELEASED}`,
    ),
  ),
  "Stick-slip on a belt": released(
    "A mass of 1 kg on a belt sticks until the spring wins, slips back, and sticks again: for ever, with a period of " +
      "0.67 s.",
    device("stick-slip on a belt", BELT),
  ),
  "A recording to be fitted": recorded(
    "A recording of a release with noise (made, not measured), over the motion of other parameters. Press Fit in the " +
      "card Recording: five parameters and the time of the release are found, and the noise is left.",
    "release-recording.csv",
    FITTED,
  ),
  "A recording that needs skin": recorded(
    "A release under an elastic finger (made, not measured). Press Fit: without skin several times the noise is left. " +
      "Then give the finger a stiffness, tick it too, and fit again.",
    "skin-recording.csv",
    FITTED,
  ),
};

export const EXAMPLES = {
  read: Object.keys(READ).map((name) => [name, name] as const),
  release: Object.keys(RELEASE).map((name) => [name, name] as const),
};

/** The states of an example, for a page of a width, mm. */
export async function exampleState(core: Core, name: string, kept: Kept, width: number): Promise<Example> {
  return (READ[name] ?? RELEASE[name])!(core, kept, width);
}
