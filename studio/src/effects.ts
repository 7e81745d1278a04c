// Derivatives of a number of the motion by each given parameter.
import type { Core } from "./core";
import { coreInput, direction, settlingBand, variedKeys } from "./design";
import type { Values } from "./friction";
import { CoreError } from "./memory";

export interface Effect {
  readonly key: string;
  /** Change of the number by 1 % of the key, SI. */
  readonly change: number;
}

/** Exact derivatives of a number by each given parameter, times 1 % of the parameter. */
export function effects(core: Core, values: Values, name: string, duration: number): Effect[] {
  const input = coreInput(values);
  return variedKeys(values).flatMap((key): Effect[] => {
    try {
      const derivative = core.differentiate(input, direction(values, key, 0.01));
      try {
        return [{ key, change: derivative.numbers(duration, settlingBand(values))[name]! }];
      } finally {
        derivative.free();
      }
    } catch (error) {
      if (error instanceof CoreError) return [{ key, change: NaN }];
      throw error;
    }
  });
}
