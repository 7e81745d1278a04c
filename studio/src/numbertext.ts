// Values as messages and device files have them.

/** The shortest digits that give a float back: "0.1", "1.0", "1e-05". */
export function floatRepr(value: number): string {
  if (Number.isNaN(value)) return "nan";
  if (!Number.isFinite(value)) return value > 0 ? "inf" : "-inf";
  if (Object.is(value, -0)) return "-0.0";
  const [mantissa, power] = value.toExponential().split("e") as [string, string];
  const exponent = Number(power);
  if (exponent < -4 || exponent >= 16) {
    return `${mantissa}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
  }
  const plain = String(value); // without an exponent from 1e-6 up to 1e21
  return plain.includes(".") ? plain : `${plain}.0`;
}

/** A number of significant digits, without trailing zeros. */
export function general(value: number, count = 6): string {
  if (!Number.isFinite(value)) return floatRepr(value);
  if (value === 0) return Object.is(value, -0) ? "-0" : "0";
  const [mantissa, power] = value.toExponential(count - 1).split("e") as [string, string];
  const exponent = Number(power);
  const short = mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa;
  if (exponent < -4 || exponent >= count) {
    return `${short}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
  }
  return String(Number(value.toExponential(count - 1)));
}

/** Text of a TOML value: a bigint is an integer, a number a float. */
function written(value: unknown): string {
  if (typeof value === "number") return floatRepr(value);
  if (typeof value === "string") return JSON.stringify(value);
  if (Array.isArray(value)) return `[${value.map(written).join(", ")}]`;
  if (value === null || typeof value !== "object" || value instanceof Date) return String(value);
  const entries = Object.entries(value).map(([key, item]) => `${JSON.stringify(key)}: ${written(item)}`);
  return `{${entries.join(", ")}}`;
}

/** A value as one short piece of a message, all on one line. */
export function quoted(value: unknown): string {
  const points = [...written(value)];
  return points.length <= 60 ? points.join("") : `${points.slice(0, 57).join("")}...`;
}
