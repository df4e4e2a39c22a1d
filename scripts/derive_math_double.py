#!/usr/bin/env python3
"""Derives every constant of src/math/math_double_tables.h. Needs mpmath; run by hand, the output is committed."""

import mpmath as mp

mp.mp.prec = 1400


def literal(value):
    """Nearest double as an exact hex literal."""
    return float(value).hex()


def rounded(value, bits):
    """Value rounded to a multiple of 2^-bits."""
    return mp.nint(value * mp.mpf(2) ** bits) / mp.mpf(2) ** bits


def double(value):
    return mp.mpf(float(value))


def pair(value):
    high = double(value)
    return literal(high), literal(value - high)


def pair_line(kind, name, value):
    high, low = pair(value)
    return f"inline constexpr {kind} {name}{{{high}, {low}}};"


def array(kind, name, items, per_line):
    lines = [", ".join(items[i : i + per_line]) for i in range(0, len(items), per_line)]
    body = ",\n    ".join(lines)
    return f"inline constexpr {kind} {name}[{len(items)}] = {{\n    {body}}};"


def fit(name, function, interval, count):
    """Near-minimax polynomial, lowest degree first."""
    with mp.workprec(400):
        coefficients, error = mp.chebyfit(function, interval, count, error=True)
    text = array("double", name, [literal(c) for c in reversed(coefficients)], 4)
    return f"// Fit error {mp.nstr(error, 2)}.\n{text}"


def series(function):
    def evaluate(z):
        return mp.fsum(function(n) * mp.mpf(z) ** n for n in range(40))

    return evaluate


out = []
out.append("// SPDX-License-Identifier: MIT")
out.append("// Made by scripts/derive_math_double.py. Not edited by hand.")
out.append("#pragma once\n\n#include <cstdint>\n")
out.append("namespace samestep::detail {\n")
out.append("/// An unevaluated sum high + low with |low| <= ulp(high) / 2.")
out.append("struct Pair {\n  double high, low;\n};\n")

half_pi = mp.pi / 2
p1 = rounded(half_pi, 32)
p2 = rounded(half_pi - p1, 65)
p3 = half_pi - p1 - p2
out.append("// pi/2 in three parts; the first two times an integer below 2^20 are exact.")
for name, value in (("kHalfPi1", p1), ("kHalfPi2", p2), ("kHalfPi3", p3), ("kTwoOverPi", 2 / mp.pi)):
    out.append(f"inline constexpr double {name} = {literal(value)};")
out.append(pair_line("Pair", "kHalfPi", half_pi))
out.append(pair_line("Pair", "kPi", mp.pi))

words = 40
bits = int(mp.floor(2 / mp.pi * mp.mpf(2) ** (32 * words)))
items = [f"0x{(bits >> (32 * (words - 1 - i))) & 0xFFFFFFFF:08x}" for i in range(words)]
out.append("\n// 2/pi as a binary fraction, most significant word first.")
out.append(array("std::uint32_t", "kTwoOverPiWords", items, 8))

z_max = mp.mpf("0.6174")
out.append("\n// sin r = r + r^3 * poly(r^2) and cos r = 1 - r^2/2 + r^4 * poly(r^2) for |r| <= pi/4.")
out.append(fit("kSin", series(lambda n: (-1) ** (n + 1) / mp.factorial(2 * n + 3)), [0, z_max], 6))
out.append(fit("kCos", series(lambda n: (-1) ** n / mp.factorial(2 * n + 4)), [0, z_max], 6))

ln2 = mp.log(2)
step = ln2 / 64
e1 = rounded(step, 6 + 36)
out.append("\n// ln 2 / 64 in two parts; the first times an integer below 2^17 is exact.")
out.append(f"inline constexpr double kExpStep1 = {literal(e1)};")
out.append(f"inline constexpr double kExpStep2 = {literal(step - e1)};")
out.append(f"inline constexpr double kExpInverseStep = {literal(1 / step)};")
out.append(f"inline constexpr double kLn2 = {literal(ln2)};")
out.append("\n// 2^(j/64).")
entries = ["{%s, %s}" % pair(mp.mpf(2) ** (mp.mpf(j) / 64)) for j in range(64)]
out.append(array("Pair", "kExp2Table", entries, 2))

out.append("\n// For a mantissa m in [1, 2) of cell i = floor((m - 1) * 128): a short number c near 1/m, and")
out.append("// -log2(c), less 1 from cell kLog2Fold on; high is a multiple of 2^-42, so that an exponent adds exactly.")
fold = 53
cells = []
for i in range(128):
    c = rounded(1 / (1 + (mp.mpf(i) + mp.mpf(1) / 2) / 128), 9)
    if i == 0:
        c = mp.mpf(1)
    if i == 127:
        c = mp.mpf(1) / 2
    value = -mp.log(c, 2) - (1 if i >= fold else 0)
    high = rounded(value, 42)
    cells.append(f"{{{literal(c)}, {literal(high)}, {literal(value - high)}}}")
out.append(f"inline constexpr int kLog2Fold = {fold};")
out.append("struct Log2Cell {\n  double c, high, low;\n};")
out.append(array("Log2Cell", "kLog2Table", cells, 1))
out.append(pair_line("Pair", "kInverseLn2", 1 / ln2))
out.append(pair_line("Pair", "kThird", mp.mpf(1) / 3))
out.append("// log(1 + r) = r - r^2/2 + r^3/3 + r^4 * poly(r) for |r| < 1/127.")
out.append(fit("kLog1p", series(lambda n: mp.mpf((-1) ** (n + 1)) / (n + 4)), [-mp.mpf(1) / 127, mp.mpf(1) / 127], 7))

out.append("\n// atan(i/64).")
out.append(array("Pair", "kAtanTable", ["{%s, %s}" % pair(mp.atan(mp.mpf(i) / 64)) for i in range(65)], 2))
out.append("// atan u = u + u^3 * poly(u^2) for |u| <= 1/127.")
out.append(fit("kAtan", series(lambda n: mp.mpf((-1) ** (n + 1)) / (2 * n + 3)), [0, mp.mpf(1) / 127 ** 2], 4))
out.append("\n}  // namespace samestep::detail")
print("\n".join(out))
