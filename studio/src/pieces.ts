// Functions of time in pieces: their values and integrals.
import type { Piece, Pieces, Term } from "./core";

/** The piece at a time, s; before the first, the first at its begin. */
function pieceAt(pieces: readonly Piece[], t: number): [Piece, number] {
  const after = pieces.findIndex(({ begin }) => begin > t);
  const piece = pieces[(after < 0 ? pieces.length : Math.max(after, 1)) - 1]!;
  return [piece, Math.max(t - piece.begin, 0)];
}

export function valueAt({ pieces }: Pieces, t: number): number {
  const [piece, tau] = pieceAt(pieces, t);
  const terms = piece.terms.map(([cosine, sine, decay, frequency]) => {
    const phase = frequency * tau;
    return (cosine * Math.cos(phase) + sine * Math.sin(phase)) * Math.exp(-decay * tau);
  });
  return [...piece.polynomial.map((p, n) => p * tau ** n), ...terms].reduce((sum, part) => sum + part, 0);
}

/** Integral from 0 to a time, s. */
export function integralUntil(function_: Pieces, t: number): number {
  const { pieces } = function_;
  const edges = [0, ...pieces.map(({ begin }) => begin).filter((begin) => begin > 0 && begin < t), t];
  let sum = 0;
  for (let i = 1; i < edges.length; ++i) {
    const [from, to] = [edges[i - 1]!, edges[i]!];
    const [piece, tau] = pieceAt(pieces, from);
    if (piece.begin > from) sum += valueAt(function_, from) * (to - from);
    else sum += integral(piece, tau, tau + to - from);
  }
  return sum;
}

function integral({ polynomial, terms }: Piece, from: number, to: number): number {
  const powers = polynomial.map((p, n) => (p * (to ** (n + 1) - from ** (n + 1))) / (n + 1));
  const parts = terms.map((term) => antiderivative(term, to) - antiderivative(term, from));
  return [...powers, ...parts].reduce((sum, part) => sum + part, 0);
}

function antiderivative([cosine, sine, decay, frequency]: Term, tau: number): number {
  const size = decay ** 2 + frequency ** 2;
  if (size === 0) return cosine * tau;
  const [c, s] = [Math.cos(frequency * tau), Math.sin(frequency * tau)];
  const part = cosine * (frequency * s - decay * c) - sine * (frequency * c + decay * s);
  return (part * Math.exp(-decay * tau)) / size;
}
