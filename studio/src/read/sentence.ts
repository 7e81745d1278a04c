// The present event, in a sentence.
import type { Motion } from "./hand";
import { type Picture, pullOf } from "./picture";

const SLOW = 2e-3; // m/s
const AWAY = 1.5e-4; // m, a pin that is not back at its rest

/** Parts of a sentence: plain words, or words with a class of their colour. */
export type Words = readonly (string | readonly ["magnet" | "dragged" | "thrown", string])[];

function pins(count: number): string {
  return count === 1 ? "the pin" : `${count} pins`;
}

/** The event in a picture; `waiting` stands in while a hand that nobody moves is at rest. */
export function happening(picture: Picture | null, waiting: string, moved: boolean): Words {
  if (!picture) return ["The device is being prepared."];
  if (!moved && speedOf(picture.hand) < SLOW) return [waiting];
  const { sample, hand } = picture;
  const every = Array.from(sample.values.position, (_, pin) => pin);
  const held = every.filter((pin) => pullOf(picture, pin) > 0.3);
  const out = every.filter((pin) => !held.includes(pin) && Math.abs(sample.values.position[pin]!) > AWAY);
  const still = speedOf(hand) < SLOW;
  if (held.length && still) {
    const who = held.length === 1 ? "a magnet holds its pin" : `${held.length} magnets hold their pins`;
    return ["Over black ", ["magnet", who], "; nothing moves until the hand does."];
  }
  if (held.length) {
    return [
      `Black under ${held.length} of ${every.length} sensors: `,
      ["magnet", held.length === 1 ? "its magnet clamps" : "their magnets clamp"],
      ", and the hand moves on: ",
      [
        "dragged",
        held.length === 1
          ? "its pin stays behind and drags the skin"
          : "their pins stay behind and drag the skin",
      ],
      ".",
    ];
  }
  if (out.length) {
    return [
      "The line has ended: the magnets let go, and ",
      ["thrown", `the springs throw ${pins(out.length)} back`],
      ".",
    ];
  }
  if (still) return [waiting];
  return ["White paper: all pins rest on their springs, and the finger feels nothing."];
}

export function speedOf({ vx, vy }: Pick<Motion, "vx" | "vy">): number {
  return Math.hypot(vx, vy);
}
