// Values as Python writes them in messages.

/** The repr of a float: the shortest digits that give it back. */
export function floatRepr(value: number): string {
  if (Number.isNaN(value)) return "nan";
  if (!Number.isFinite(value)) return value > 0 ? "inf" : "-inf";
  if (Object.is(value, -0)) return "-0.0";
  const [mantissa, power] = value.toExponential().split("e") as [string, string];
  const exponent = Number(power);
  if (exponent < -4 || exponent >= 16) {
    return `${mantissa}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
  }
  const plain = plainDigits(value);
  return plain.includes(".") ? plain : `${plain}.0`;
}

/** A number without an exponent. */
function plainDigits(value: number): string {
  const [mantissa, power] = value.toExponential().split("e") as [string, string];
  const sign = mantissa.startsWith("-") ? "-" : "";
  const figures = mantissa.replace("-", "").replace(".", "");
  const exponent = Number(power);
  if (exponent < 0) return `${sign}0.${"0".repeat(-exponent - 1)}${figures}`;
  const whole = figures.slice(0, exponent + 1).padEnd(exponent + 1, "0");
  const rest = figures.slice(exponent + 1);
  return `${sign}${whole}${rest ? `.${rest}` : ""}`;
}

/** Python's format "g": a number of significant digits, without trailing zeros. */
export function general(value: number, count = 6): string {
  if (!Number.isFinite(value)) return floatRepr(value);
  if (value === 0) return Object.is(value, -0) ? "-0" : "0";
  const [mantissa, power] = value.toExponential(count - 1).split("e") as [string, string];
  const exponent = Number(power);
  const short = mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa;
  if (exponent < -4 || exponent >= count) {
    return `${short}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
  }
  return plainDigits(Number(value.toExponential(count - 1)));
}

/** `value` to six digits, as short as they come: "1e-6". */
export function brief(value: number): string {
  return general(value).replace(/e([+-])0*/, (_, sign: string) => `e${sign === "-" ? "-" : ""}`);
}

/** The repr of what a TOML file may hold: a bigint is an integer, a number a float. */
export function repr(value: unknown): string {
  if (typeof value === "bigint") return String(value);
  if (typeof value === "number") return floatRepr(value);
  if (typeof value === "boolean") return value ? "True" : "False";
  if (typeof value === "string") return stringRepr(value);
  if (Array.isArray(value)) return `[${value.map(repr).join(", ")}]`;
  if (value instanceof Map || (value !== null && typeof value === "object")) {
    const entries = Object.entries(value as Record<string, unknown>);
    return `{${entries.map(([key, item]) => `${stringRepr(key)}: ${repr(item)}`).join(", ")}}`;
  }
  return String(value);
}

export function stringRepr(value: string): string {
  const quote = value.includes("'") && !value.includes('"') ? '"' : "'";
  const inside = [...value].map((c) => {
    if (c === "\\" || c === quote) return `\\${c}`;
    const escaped = { "\n": "\\n", "\t": "\\t", "\r": "\\r" }[c];
    if (escaped) return escaped;
    const code = c.codePointAt(0)!;
    return code < 0x20 || code === 0x7f ? `\\x${code.toString(16).padStart(2, "0")}` : c;
  });
  return `${quote}${inside.join("")}${quote}`;
}

/** A value as one short piece of a message: text in quotes, all on one line. */
export function quoted(value: unknown): string {
  const text = typeof value === "string" ? JSON.stringify(value) : repr(value);
  const points = [...text];
  return points.length <= 60 ? text : `${points.slice(0, 57).join("")}...`;
}

/** A count with its noun, thousands apart. */
export function counted(count: number, noun: string): string {
  const shown = String(count).replace(/\B(?=(\d{3})+$)/g, " ");
  return `${shown} ${noun}${count === 1 ? "" : "s"}`;
}
