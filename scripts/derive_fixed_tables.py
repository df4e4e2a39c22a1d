#!/usr/bin/env python3
"""Derives fixed/include/samestep/fixed_tables.h: polynomials and tables of the Q32.32 functions.

Needs mpmath. Prints the header; run clang-format over it. The proof tests check every table entry, and the
functions as a whole, against MPFR.
"""
from mpmath import atan, chebyfit, cos, floor, log, mp, mpf, nint, pi, sin, sqrt

mp.prec = 400


def fixed(value, bits):
    return int(nint(value * mpf(2) ** bits))


def fit(function, high, terms):
    """Coefficients of a near-minimax polynomial on [0, high], lowest power first, and its error."""
    coefficients, error = chebyfit(function, [0, high], terms, error=True)
    return coefficients[::-1], error


def emit(comment, name, values, kind="std::uint64_t"):
    print(f"/// {comment}")
    body = ", ".join(f"{v:#x}" for v in values)
    print(f"inline constexpr std::array<{kind}, {len(values)}> {name} = {{{body}}};\n")


def scalar(comment, name, value):
    print(f"/// {comment}")
    print(f"inline constexpr std::uint64_t {name} = {value:#x};\n")


def word(value, bits):
    """High and low word of value in units of 2^-(bits + 64)."""
    whole = int(floor(value * mpf(2) ** (bits + 64) + mpf(1) / 2))
    return (whole >> 64) & (2**64 - 1), whole & (2**64 - 1)


print("#pragma once\n\n#include <array>\n#include <cstdint>\n")
print("// Printed by scripts/derive_fixed_tables.py.\n")
print("namespace samestep::raw {\n")

high, low = word(1 / (2 * pi), 32)
scalar("2^96 / (2 pi), upper part: turns per raw unit of an angle.", "kTurnsHigh", high)
scalar("Its lower part.", "kTurnsLow", low)

# Powers of z = u^2, u in [0, 1] in units of pi / 4; signs alternate. Highest powers first, at the widths
# of the evaluation.
tiny = mpf(10) ** -40
sine, sineError = fit(lambda z: sin(pi / 4 * sqrt(z + tiny)) / sqrt(z + tiny), 1, 6)
cosine, cosineError = fit(lambda z: cos(pi / 4 * sqrt(z + tiny)), 1, 6)
for name, coefficients, error in (("Sine", sine, sineError), ("Cosine", cosine, cosineError)):
    signed = [(-1) ** i * c for i, c in enumerate(coefficients)]
    assert all(c > 0 for c in signed)
    emit(f"{name} on [0, pi / 4], error {float(error):.1e}: powers 0 to 2 of z with 63, 64, 65 fraction bits, "
         "without their signs + - +.", f"k{name}Terms", [fixed(c, w) for c, w in zip(signed, [63, 64, 65])])
    emit("Powers 3 to 5, Q42.", f"k{name}HighTerms", [fixed(c, 42) for c in coefficients[3:]], "std::int64_t")

# atan(t) / t = 1 - z B(z), z = t^2 at most 0.0567.
limit = mpf("0.0567")
def rest(z):
    z = z + tiny
    t = sqrt(z)
    return (1 - atan(t) / t) / z
arc, arcError = fit(rest, limit, 5)
emit(f"(1 - atan(t) / t) / z; powers 0 to 4 of z, Q32; error {float(arcError):.1e}.", "kArcTerms",
     [fixed(c, 32) for c in arc], "std::int64_t")
base = [mpf(0), atan(mpf(1) / 2), pi / 4]
emit("atan(0), atan(1/2), atan(1), Q62; the same from pi / 2 back, from pi back, and from pi / 2 on.", "kArcBase",
     [fixed(v, 62) for v in base + [pi / 2 - b for b in base] + [pi - b for b in base] + [pi / 2 + b for b in base]])

# 2^d - 1 = d P(d), d in [0, 2^-6).
power, powerError = fit(lambda d: (mpf(2) ** (d + tiny) - 1) / (d + tiny), mpf(2) ** -6, 6)
emit(f"(2^d - 1) / d for d below 1/64; powers 0 to 5 with 64, 64, 64, 64, 41, 41 fraction bits; error "
     f"{float(powerError):.1e}.", "kPowerTerms",
     [fixed(c, w) for c, w in zip(power, [64, 64, 64, 64, 41, 41])])
emit("2^(i / 64) in units of 2^-63.", "kPowerHigh", [word(mpf(2) ** (mpf(i) / 64), 63)[0] for i in range(64)])
emit("Its next 64 bits.", "kPowerLow", [word(mpf(2) ** (mpf(i) / 64), 63)[1] for i in range(64)])

high, low = word(1 / log(2), 63)
scalar("log2(e) in units of 2^-63.", "kLog2eHigh", high)
scalar("Its next 64 bits.", "kLog2eLow", low)

# log2 of m in [1, 2): m times a short inverse of the middle of its interval is near 1.
inverses = []
for i in range(64):
    if i == 0:
        inverse = 512
    elif i == 63:
        inverse = 256
    else:
        inverse = int(nint(512 / (1 + (mpf(i) + mpf(1) / 2) / 64)))
    inverses.append(inverse)
worst = max(max(abs(mpf(inverses[i]) / 512 * (1 + mpf(j) / 64) - 1) for j in (i, i + 1)) for i in range(64))
assert worst <= mpf(1) / 64, float(worst)
emit("About 512 / m in each 64th of [1, 2); exact at both ends.", "kInverse", inverses)
logs = [word(-log(mpf(v) / 512, 2), 56) for v in inverses]
emit("-log2(kInverse[i] / 512) in units of 2^-56.", "kInverseLogHigh", [v[0] for v in logs])
emit("Its next 64 bits.", "kInverseLogLow", [v[1] for v in logs])

# log2(1 + u) = u (1/ln 2 - u Q(u)), |u| <= 1/64. Q for u >= 0 and for u < 0 as one series in u.
count = 11
emit("1 / ((k + 2) ln 2), k = 0 to 10, in units of 2^-64: log2(1 + u) = u / ln 2 - u^2 (q0 - u (q1 - ...)).",
     "kLogTerms", [fixed(1 / ((k + 2) * log(2)), 64) for k in range(count)])
short, shortError = chebyfit(lambda u: (1 / log(2) - log(1 + u + tiny, 2) / (u + tiny)) / (u + tiny),
                             [-mpf(1) / 64, mpf(1) / 64], 5, error=True)
short = short[::-1]
signed = [(-1) ** i * c for i, c in enumerate(short)]
assert all(c > 0 for c in signed)
emit(f"The same series cut to 5 terms, for log2 alone, in units of 2^-32; error {float(shortError):.1e}.",
     "kShortLogTerms", [fixed(c, 32) for c in signed])
print("}  // namespace samestep::raw")
