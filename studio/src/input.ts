// Inputs of the core: numbers, rows and functions of time, SI.
export type Row = readonly [number, number];
export type Rows = readonly Row[];
/** Term (cosine, sine, decay, frequency) of a piece: (cosine cos Ωτ + sine sin Ωτ) e^(−δτ). */
export type Term = readonly [number, number, number, number];
/** Part of a function of time from its begin (s) on: a polynomial and terms. */
export interface Piece {
  readonly begin: number;
  readonly polynomial: readonly number[];
  readonly terms: readonly Term[];
}
/** Function of time: its pieces, and the parameters from which they were made, by name. */
export interface Part {
  readonly parameters?: Readonly<Record<string, number>>;
  readonly pieces: readonly Piece[];
}
/** Sum of functions of time. */
export interface TimeFunction {
  readonly parts: readonly Part[];
}
/** A drive and a release in the names of pindrive.h; a rate along which they change looks alike. */
export interface Input {
  readonly drive: Readonly<Record<string, number>>;
  readonly curves: Readonly<Record<string, Rows>>;
  readonly release: Readonly<Record<string, number>>;
  readonly profiles: Readonly<Record<string, Rows>>;
  readonly functions: Readonly<Record<string, TimeFunction>>;
}
