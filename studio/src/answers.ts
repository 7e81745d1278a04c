// Answers of the core as text, for tests in Node and in a browser.
import type { Core } from "./core";
import type { Input } from "./input";

/** Doubles as hexadecimal digits: JSON has no NaN, and text could hide a rounding. */
export function bits(values: Iterable<number>): string {
  const bytes = new Uint8Array(Float64Array.from(values).buffer);
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
}

/** Motion to the bit: its numbers, its segments, and values at eleven times. */
export function answerOf(core: Core, input: Input, duration: number | null): Record<string, unknown> {
  const motion = core.simulate(input);
  const { outcome } = motion;
  const numbers = Object.values(motion.numbers(duration ?? NaN, 0.05));
  const segments = motion.segments().flatMap(({ begin, end }) => [begin, end]);
  const long = duration ?? motion.duration(0.05);
  const times = Float64Array.from({ length: 11 }, (_, i) => long * (i / 10));
  const names = ["position", "velocity", "acceleration", "plate_force", "stop_force"] as const;
  const values = names.flatMap((name) => [...motion.evaluate(name, times)]);
  motion.free();
  return {
    end: outcome.end,
    status: outcome.status,
    numbers: bits(numbers),
    segments: bits(segments),
    times: bits(times),
    values: bits(values),
  };
}
