// Colours of the page: those of the figures (Okabe and Ito), in steps that read on light and on dark.
import { TABLES } from "./table";

export type Scheme = "auto" | "light" | "dark";

export interface Look {
  readonly dark: boolean;
  /** Size of text in plots: a little smaller than on the page. */
  readonly font: string;
  readonly text: string;
  readonly muted: string;
  readonly grid: string;
  readonly surface: string;
  readonly accent: string;
  /** Colour of a printed page. */
  readonly paper: string;
  readonly curves: readonly { readonly color: string; readonly dash: readonly number[] }[];
  readonly ghost: string;
  readonly recording: string;
  readonly phases: Readonly<Record<string, string>>;
  readonly events: Readonly<Record<string, string>>;
}

/** Hue for dark backgrounds: lighter. */
function lightened(color: string, part: number): string {
  const channels = [1, 3, 5].map((i) => parseInt(color.slice(i, i + 2), 16));
  return `rgb(${channels.map((c) => Math.round(c + (255 - c) * part)).join(" ")})`;
}

function faded(color: string, opacity: number): string {
  const channels = [1, 3, 5].map((i) => parseInt(color.slice(i, i + 2), 16));
  return `rgb(${channels.join(" ")} / ${opacity})`;
}

const listeners: (() => void)[] = [];
const dark = (): MediaQueryList => matchMedia("(prefers-color-scheme: dark)");

/** The scheme that was chosen; the system's unless there is one. */
export function currentScheme(): Scheme {
  return (document.documentElement.dataset.scheme ?? "auto") as Scheme;
}

export function setScheme(scheme: Scheme): void {
  document.documentElement.dataset.scheme = scheme;
  for (const listener of listeners) listener();
}

/** Calls `listener` when the colours of the page have changed. */
export function onLook(listener: () => void): void {
  listeners.push(listener);
  dark().addEventListener("change", listener);
}

export function currentLook(): Look {
  const chosen = currentScheme();
  const isDark = chosen === "dark" || (chosen === "auto" && dark().matches);
  const style = getComputedStyle(document.documentElement);
  const own = (name: string): string => style.getPropertyValue(`--${name}`).trim();
  const { palette, curves } = TABLES;
  const shade = (color: string): string =>
    isDark ? lightened(color, color === "#000000" ? 0.85 : 0.35) : color;
  return {
    dark: isDark,
    font: `${Math.round(0.86 * parseFloat(style.fontSize))}px system-ui, sans-serif`,
    text: own("text"),
    muted: own("muted"),
    grid: own("grid"),
    surface: own("surface"),
    accent: own("accent"),
    paper: own("paper"),
    curves: curves.map(({ color, dash }) => ({ color: shade(color), dash })),
    ghost: own("ghost"),
    recording: shade(palette.gripping!),
    phases: {
      carried: faded(palette.carried!, isDark ? 0.3 : 0.28),
      resting: faded(palette.resting!, isDark ? 0.24 : 0.22),
      gripping: faded(palette.gripping!, isDark ? 0.3 : 0.26),
    },
    events: Object.fromEntries(Object.keys(TABLES.events).map((kind) => [kind, shade(palette[kind]!)])),
  };
}

/** Viridis by its stops: lightness grows evenly, for every kind of colour vision. */
const VIRIDIS = [
  [68, 1, 84],
  [71, 44, 122],
  [59, 81, 139],
  [44, 113, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
] as const;

export function mapColor(part: number): readonly [number, number, number] {
  const at = Math.min(Math.max(part, 0), 1) * (VIRIDIS.length - 1);
  const low = Math.min(Math.floor(at), VIRIDIS.length - 2);
  const mix = at - low;
  const [a, b] = [VIRIDIS[low]!, VIRIDIS[low + 1]!];
  return [0, 1, 2].map((i) => Math.round(a[i]! + (b[i]! - a[i]!) * mix)) as [number, number, number];
}
