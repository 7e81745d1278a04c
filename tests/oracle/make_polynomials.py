"""The coefficients in numbers/elementary.hpp: minimax polynomials by the Remez exchange.

Each polynomial approximates the remainder of a function after its leading terms, so that the
coefficients before it are exact. The weight makes the error one relative to the whole function.

    cd tests && ../.venv/bin/python -m oracle.make_polynomials

prints the coefficients as C++ reads them, lowest power first, and the largest weighted error.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mpmath import mp, mpf

Function = Callable[[Any], Any]

mp.dps = 60


def remez(f: Function, weight: Function, low: Any, high: Any, degree: int) -> tuple[list[Any], Any]:
    """The p of that degree with the smallest max |weight (p - f)| on [low, high]; that maximum."""
    count = degree + 2
    middle, half = (low + high) / 2, (high - low) / 2
    points = [middle - half * mp.cos(mp.pi * i / (count - 1)) for i in range(count)]
    coefficients: list[Any] = []
    level = mpf(0)

    def error(x: Any) -> Any:
        return weight(x) * (mp.polyval(coefficients[::-1], x) - f(x))

    for _ in range(30):
        rows = [
            [*(x**k for k in range(degree + 1)), (-1) ** i / weight(x)]
            for i, x in enumerate(points)
        ]
        solution = mp.lu_solve(mp.matrix(rows), mp.matrix([f(x) for x in points]))
        coefficients = [solution[k] for k in range(degree + 1)]
        level = abs(solution[degree + 1])
        grid = [middle - half * mp.cos(mp.pi * i / (40 * count)) for i in range(40 * count + 1)]
        values = [error(x) for x in grid]
        # One extremum of each sign in turn.
        found: list[tuple[Any, Any]] = []
        for x, value in zip(grid, values, strict=True):
            if found and (value > 0) == (found[-1][1] > 0):
                if abs(value) > abs(found[-1][1]):
                    found[-1] = (x, value)
            else:
                found.append((x, value))
        while len(found) > count:
            found.pop(0 if abs(found[0][1]) < abs(found[-1][1]) else -1)
        if len(found) < count:
            break
        points = [x for x, _ in found]
        if max(abs(value) for _, value in found) < level * mpf("1.001"):
            break
    return coefficients, level


def rounded_error(
    coefficients: list[Any], f: Function, weight: Function, low: Any, high: Any
) -> Any:
    """Return the largest error with the coefficients rounded to doubles."""
    doubles = [mpf(float(c)) for c in coefficients][::-1]
    grid = (low + (high - low) * i / 2000 for i in range(2001))
    return max(abs(weight(x) * (mp.polyval(doubles, x) - f(x))) for x in grid)


def series(first: Function, z: Any) -> Any:
    """The sum over k of first(k) z^k."""
    total, term, k = mpf(0), mpf(1), 0
    while abs(term) > mpf(10) ** -58 or k < 4:
        total += first(k) * term
        term *= z
        k += 1
        if z == 0:
            break
    return total


def main() -> None:
    quarter = (mp.pi / 4 * mpf("1.0001")) ** 2
    ln2 = mp.log(2) / 2 * mpf("1.0001")
    eighth = mp.tan(mp.pi / 8) ** 2 * mpf("1.0001")
    # (m - 1)/(m + 1) at m = sqrt 2, squared.
    root2 = ((mp.sqrt(2) - 1) / (mp.sqrt(2) + 1)) ** 2 * mpf("1.0001")
    # A remainder weighs nothing at 0; a floor there keeps the exchange regular.
    wanted: list[tuple[str, Function, Function, Any, Any, int]] = [
        ("sine: (sin r - r) / r^3 in r^2",
         lambda z: series(lambda k: (-1) ** (k + 1) / mp.factorial(2 * k + 3), z),
         lambda z: z + quarter / 50, mpf(0), quarter, 5),
        ("cosine: (cos r - 1 + r^2/2) / r^4 in r^2",
         lambda z: series(lambda k: (-1) ** k / mp.factorial(2 * k + 4), z),
         lambda z: z * z + quarter**2 / 50, mpf(0), quarter, 5),
        ("exponential: (e^r - 1 - r - r^2/2) / r^3 in r",
         lambda r: series(lambda k: 1 / mp.factorial(k + 3), r),
         lambda r: r * r + ln2**2 / 50, -ln2, ln2, 9),
        ("logarithm: (2 artanh s - 2 s) / s^3 in s^2",
         lambda z: series(lambda k: mpf(2) / (2 * k + 3), z),
         lambda z: z / 2 + root2 / 50, mpf(0), root2, 6),
        ("arctangent: (arctan t - t) / t^3 in t^2",
         lambda z: series(lambda k: (-1) ** (k + 1) / mpf(2 * k + 3), z),
         lambda z: z + eighth / 50, mpf(0), eighth, 10),
    ]  # fmt: skip
    for name, f, weight, low, high, degree in wanted:
        coefficients, _ = remez(f, weight, low, high, degree)
        worst = rounded_error(coefficients, f, weight, low, high)
        print(f"{name}, degree {degree}: largest relative error 2^{mp.nstr(mp.log(worst, 2), 4)}")
        print("  {" + ", ".join(float(c).hex() for c in coefficients) + "}")
    print("pi/2 in parts of 25 bits, and what is left:")
    print("  " + ", ".join(split(mp.pi / 2, 25, 5)))
    print("log 2 in two parts:")
    print("  " + ", ".join(split(mp.log(2), 40, 1)))
    print("pi/4 in two parts:")
    print("  " + ", ".join(split(mp.pi / 4, 50, 1)))


def split(value: Any, bits: int, count: int) -> list[str]:
    """Return parts of a number with equal bit counts, rounded down, and the rest as a double."""
    parts = []
    for _ in range(count):
        scale = mpf(2) ** (bits - 1 - mp.floor(mp.log(value, 2)))
        part = mp.floor(value * scale) / scale
        parts.append(float(part).hex())
        value -= part
    return [*parts, float(value).hex()]


if __name__ == "__main__":
    main()
