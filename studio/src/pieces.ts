// Functions of time in pieces: their values and integrals.
import type { Part, Piece, Term, TimeFunction } from "./input";

/** The piece at a time, s; before the first, the first at its begin. */
function pieceAt(pieces: readonly Piece[], t: number): [Piece, number] {
  const after = pieces.findIndex(({ begin }) => begin > t);
  const piece = pieces[(after < 0 ? pieces.length : Math.max(after, 1)) - 1]!;
  return [piece, Math.max(t - piece.begin, 0)];
}

export function valueAt({ parts }: TimeFunction, t: number): number {
  return parts.reduce((sum, part) => sum + partAt(part, t), 0);
}

function partAt({ pieces }: Part, t: number): number {
  const [piece, tau] = pieceAt(pieces, t);
  const terms = piece.terms.map(([cosine, sine, decay, frequency]) => {
    const phase = frequency * tau;
    return (cosine * Math.cos(phase) + sine * Math.sin(phase)) * Math.exp(-decay * tau);
  });
  return [...piece.polynomial.map((p, n) => p * tau ** n), ...terms].reduce((sum, part) => sum + part, 0);
}

/** Integral from 0 to a time, s. */
export function integralUntil({ parts }: TimeFunction, t: number): number {
  return parts.reduce((sum, part) => sum + integralOf(part, t), 0);
}

function integralOf(part: Part, t: number): number {
  const { pieces } = part;
  const edges = [0, ...pieces.map(({ begin }) => begin).filter((begin) => begin > 0 && begin < t), t];
  let sum = 0;
  for (let i = 1; i < edges.length; ++i) {
    const [from, to] = [edges[i - 1]!, edges[i]!];
    const [piece, tau] = pieceAt(pieces, from);
    if (piece.begin > from) sum += partAt(part, from) * (to - from);
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
