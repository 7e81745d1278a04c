// Releases to begin with, each with a sentence of what it shows.
import type { Given } from "./files";
import { TABLES } from "./table";

export interface Preset {
  readonly name: string;
  readonly shows: string;
  readonly text: string;
}

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

export const PRESETS: readonly Preset[] = [
  {
    name: "Carried and released",
    shows:
      "The magnet has carried the pin 1.5 mm against its spring and lets go. The pin swings back, rubbing on " +
      "plate and finger, until friction holds it.",
    text: TABLES.template,
  },
  {
    name: "The paper's Figure 4",
    shows:
      "With a damping ratio of 0.04 the pin swings many times before it settles: the next line comes too soon.",
    text: device("the paper's Figure 4", `${MOUSE}damping_ratio = 0.04\n${CONTACTS}${RELEASED}`),
  },
  {
    name: "At an angle",
    shows:
      "The hand moves at 45 degrees to the drive. Friction opposes the whole sliding velocity, so that the pin creeps " +
      "and never sticks to the plate.",
    text: device(
      "at an angle",
      `${MOUSE}damping_ratio = 0.16\n${CONTACTS}${RELEASED}across_velocity = "60 mm/s"\n`,
    ),
  },
  {
    name: "Skin that stretches",
    shows: "Under a compliant finger the skin stretches before it slips, and holds the pin off its rest.",
    text: device(
      "skin that stretches",
      `${MOUSE}damping_ratio = 0.16\n${CONTACTS}stiffness = "300 N/m"\n${RELEASED}`,
    ),
  },
  {
    name: "Stick-slip on a belt",
    shows:
      "A mass of 1 kg on a belt sticks until the spring wins, slips back, and sticks again: for ever, with a period of " +
      "0.67 s.",
    text: device(
      "stick-slip on a belt",
      `
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
`,
    ),
  },
];

export function givenOf({ name, text }: Preset): Given {
  return { file: name, text, rows: {} };
}
