// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <vector>

#include <samestep/scalar.h>
#include <samestep/vector.h>

#include "solver/kernels/contact_block.h"

namespace samestep {

/// The radius, in powers of two metres, of what may be of any size since it does not move.
inline constexpr int kAnyRadiusBits = 24;

/// Bound of separations, as a power of two in metres: what is farther apart, or overlaps more, counts as that
/// far.
inline constexpr int kMostNearBits = 11;

/// Input of the soft step for a body that touches something.
template <Scalar S>
struct SoftStart {
  S velocity[3]{};  ///< x, y, angular: m/s, rad/s.
  S push[3]{};      ///< Velocity that a substep adds.
  S kept = S(1);    ///< Fraction of it that damping leaves in one substep.
  /// Inverse moment times mass, 1/m^2; and the mass, kg, 0 of what contacts leave as it is.
  S momentPerMass{};
  S mass{};
  /// Nothing of the body is farther from its centre of mass than two to the power of it, m.
  int radiusBits = 0;
};

/// Frame of a body from which its pairs are prepared: all of it in one cache line.
template <Scalar S>
struct alignas(64) SoftFrame {
  /// The centre of mass in the world and in the body's coordinates, m.
  Vector<S> center{}, centerOfMass{};
  Vector<S> rotation{S(1), S(0)};
  /// kg; 0 of what contacts leave as it is.
  S mass{};
  /// Number of its own start.
  std::uint32_t start = 0;
  std::int32_t radiusBits = 0;

  bool isFixed() const { return mass == S(0); }
  /// Lever arm from the centre of mass, in the body's coordinates.
  Vector<S> arm(const Vector<S>& anchor) const { return anchor - centerOfMass; }
};

/// Mass ratios: how two bodies share an impulse u.
template <class C>
struct Shares {
  /// The part that changes the speed of A; what a speed of the lighter body is as u, in [1, 2].
  C a, perSpeed;
};

/// Result of the soft step for a body.
template <Scalar S>
struct SoftMotion {
  S velocity[3]{};
  S moved[3]{};
  /// Velocities that were clamped: bits of Body::Held.
  std::uint8_t held = 0;
};

/// Settings for a whole step.
template <Scalar S>
struct SoftSettings {
  /// Between bodies that move, and against one that does not.
  Softness<S> softness[2]{};
  /// Seconds, and its inverse.
  S substep{}, perSubstep{};
  /// The greatest speed of pushing apart, m/s.
  S pushSpeed{};
  int substeps = 1;
};

namespace units {

/// x / 2^bits to nearest, ties away from zero; x * 2^-bits for negative bits, saturated at 2^62.
[[gnu::always_inline]] inline std::int64_t shifted(std::int64_t x, int bits) {
  if (bits > 0) [[likely]] {
    return bits > 62 ? 0 : (x + (std::int64_t{1} << (bits - 1)) - (x < 0)) >> bits;
  }
  const std::int64_t limit = std::int64_t{1} << (62 + bits);
  return clamp(x, -limit, limit) << -bits;
}

/// Rounds by a number of bits that is known and not less than 1.
template <int kBits>
[[gnu::always_inline]] inline std::int64_t rounded(std::int64_t x) {
  return (x + (std::int64_t{1} << (kBits - 1)) - (x < 0)) >> kBits;
}

/// factor * x / 2^bits, the product whole, to nearest, ties away from zero; bits up to 32. A result that does
/// not fit is what the sanitizer build finds.
template <int kBits>
[[gnu::always_inline]] inline std::int64_t scaled(std::int32_t factor, std::int64_t x) {
  const std::int64_t high = (x + (std::int64_t{1} << 31)) >> 32;
  const std::int64_t low = static_cast<std::int32_t>(x);
  return factor * high * (std::int64_t{1} << (32 - kBits)) + rounded<kBits>(factor * low);
}

/// Fraction bits of Shares::perSpeed.
inline constexpr int kPerSpeedBits = 29;

/// Shares in units of 2^-30 and 2^-29, from masses, of which 0 is one that nothing changes.
inline Shares<std::int32_t> shares(std::uint64_t massA, std::uint64_t massB) {
  constexpr std::int32_t kOne = 1 << 30;
  if (massB == 0) return {kOne, kOne / 2};
  if (massA == 0) return {0, kOne / 2};
  if (massA == massB) return {kOne / 2, kOne};
  const int coarser = max(static_cast<int>(std::bit_width(massA + massB)) - 33, 0);
  const std::uint64_t sum = (massA + massB) >> coarser;
  const std::uint64_t heavier = max(massA, massB) >> coarser;
  return {static_cast<std::int32_t>((((massB >> coarser) << 30) + sum / 2) / sum),
          static_cast<std::int32_t>(((sum << kPerSpeedBits) + heavier / 2) / heavier)};
}

/// Bits of the whole part of a Q32.32, less than 0 for small ones.
inline int wholeBits(std::uint64_t raw) { return static_cast<int>(std::bit_width(raw)) - 32; }

}  // namespace units

/// Conversion of the numbers of a scalar into the records of a kernel, and back. Where a number does not fit,
/// `misfit` is no longer 0.
template <Scalar S, class N>
class SoftUnits;

/// Conversion to numbers as they are.
template <Scalar S, bool kSpins>
class SoftUnits<S, PlainNumbers<S, kSpins>> {
 public:
  bool choose(const SoftSettings<S>&, const std::vector<SoftStart<S>>&, S) { return true; }
  SoftConstants<PlainNumbers<S, kSpins>> constants(const SoftSettings<S>& of, S mostSum) const {
    constexpr S kMost = S(1 << kMostNearBits);
    return {{of.softness[0], of.softness[1]}, of.perSubstep, of.pushSpeed, mostSum, kMost, kMost, of.substep,
            of.substep * ratio<S>(1, 2)};
  }

  static Shares<S> shares(S massA, S massB) {
    if constexpr (FixedNumber<S>) {
      const Shares<std::int32_t> of = units::shares(raw::magnitude(massA.raw()), raw::magnitude(massB.raw()));
      return {S::fromRaw(std::int64_t{of.a} << 2), S::fromRaw(std::int64_t{of.perSpeed} << 3)};
    } else {
      if (massB == S(0)) return {S(1), S(1)};
      if (massA == S(0)) return {S(0), S(1)};
      if (massA == massB) return {S(1) / S(2), S(2)};
      const S sum = massA + massB;
      return {massB / sum, sum / max(massA, massB)};
    }
  }
  static S perUnit(S kept, S perSpeed) { return kept * perSpeed; }
  static S larger(S share) { return max(share, S(1) - share); }
  static S perMass(S share, S sum) { return sum * share; }
  static S unit(S x) { return x; }
  static S factor(S x) { return x; }
  static S mostSpeed(S x, int) { return x; }
  static std::uint8_t bendBits(int) { return 0; }
  static S speed(S x, std::int64_t&) { return x; }
  static S turn(S x, int, std::int64_t&) { return x; }
  static S way(S x) { return x; }
  static S sum(S x, std::int64_t&) { return x; }

  static S fromUnit(S x) { return x; }
  static S fromArm(S x, int) { return x; }
  static S fromSpin(S x, int) { return x; }
  static S fromSpeed(S x) { return x; }
  static S fromTurn(S x, int) { return x; }
  static S fromWay(S x, int) { return x; }
  static S fromSum(S x) { return x; }
};

/// Conversion to integers.
template <Scalar S, std::derived_from<IntegerUnits> N>
class SoftUnits<S, N> {
 public:
  static constexpr bool kWide = std::same_as<N, WideNumbers>;
  using Speed = typename N::Speed;
  using Sum = typename N::Sum;

  /// Chooses the units of a step.
  /// @param mostKept  no kept impulse is larger, as a speed of the lighter body, m/s
  /// @return false if there are none
  bool choose(const SoftSettings<S>& of, const std::vector<SoftStart<S>>& starts, S mostKept) {
    using units::wholeBits;
    speedBits_ = 32;
    if constexpr (!kWide) {
      int fastest = 0;
      for (const SoftStart<S>& start : starts) {
        const auto most = [&](int k) {
          return raw::magnitude(start.velocity[k].raw()) |
                 raw::magnitude(start.push[k].raw()) * static_cast<std::uint64_t>(of.substeps);
        };
        fastest =
            max(fastest, max(wholeBits(most(0) | most(1)), wholeBits(most(2)) + radius(start.radiusBits)));
      }
      // Every magnitude is below twice the power of two that its bits say. An impulse is up to twice the
      // speed that it gives the lighter body, and totals of more than four substeps want room.
      const int total = max(static_cast<int>(std::bit_width(static_cast<unsigned>(of.substeps))) - 3, 0);
      speedBits_ = min(min(kSpeedBits - kSpareBits - fastest,
                           kSpeedBits - 2 - total - wholeBits(raw::magnitude(mostKept.raw()))),
                       kMostSpeedBits);
      if (speedBits_ < kLeastSpeedBits) return false;
    }
    const std::int64_t step = of.substep.raw() * of.substeps;
    finer_ = clamp(-wholeBits(static_cast<std::uint64_t>(step)), 0, kMostFiner);
    wayBits_ = speedBits_ + finer_;
    return fits(rate(of.perSubstep)) && fits(rate(of.softness[0].biasRate)) &&
           fits(rate(of.softness[1].biasRate));
  }
  SoftConstants<N> constants(const SoftSettings<S>& of, S mostSum) const {
    SoftConstants<N> to{};
    for (int i = 0; i < 2; ++i) {
      const Softness<S>& soft = of.softness[i];
      to.softness[i] = {narrow(rate(soft.biasRate)), unit(soft.massScale), unit(soft.impulseScale)};
    }
    to.perSubstep = narrow(rate(of.perSubstep));
    std::int64_t held = 0;
    to.pushSpeed = speed(of.pushSpeed, held);
    to.mostSum = sum(mostSum, held);
    if constexpr (kWide) {
      to.substep = of.substep.raw() << finer_;
      to.halfSubstep = to.substep / 2;
      to.mostGap = to.mostOverlap = std::int64_t{1} << (kMostNearBits + wayBits_);
    } else {
      to.substep = narrow(units::shifted(of.substep.raw(), 32 - finer_ - N::kUnitBits));
      to.halfSubstep = narrow(units::shifted(of.substep.raw(), 33 - finer_ - N::kUnitBits));
      // A distance beyond these bounds is not reached within a substep at any speed in range; an overlap
      // beyond them is pushed apart as if it were not.
      const std::int64_t perSubstep = max(std::int64_t{to.perSubstep}, std::int64_t{1});
      to.mostGap = narrow(min((std::int64_t{N::kRange} << N::kRateBits) / perSubstep, kMost));
      to.mostOverlap =
          narrow(min((7 * std::int64_t{N::kRange} << N::kRateBits) / perSubstep, std::int64_t{1} << 30));
    }
    return to;
  }

  static Shares<std::int32_t> shares(S massA, S massB) {
    return units::shares(raw::magnitude(massA.raw()), raw::magnitude(massB.raw()));
  }
  /// A kept impulse as u.
  [[gnu::always_inline]] static Sum perUnit(Sum kept, std::int32_t perSpeed) {
    if (perSpeed == 1 << units::kPerSpeedBits) return kept;
    if (perSpeed == 1 << (units::kPerSpeedBits + 1)) return kept + kept;
    return static_cast<Sum>(units::scaled<units::kPerSpeedBits>(perSpeed, kept));
  }
  /// Larger one of both bodies' shares.
  static std::int32_t larger(std::int32_t share) { return max(share, (1 << N::kUnitBits) - share); }
  /// An impulse u as the speed of the body of that share.
  [[gnu::always_inline]] S perMass(std::int32_t share, Sum sum) const {
    if constexpr (kWide) {
      return S::fromRaw(units::scaled<N::kUnitBits>(share, sum));
    } else {
      return S::fromRaw(units::shifted(std::int64_t{share} * sum, N::kUnitBits + speedBits_ - 32));
    }
  }
  /// Converts a number in [-1, 1].
  [[gnu::always_inline]] static std::int32_t unit(S x) {
    return narrow(units::rounded<32 - N::kUnitBits>(x.raw()));
  }
  /// Converts a factor of a speed, in [0, 1].
  static Speed factor(S x) {
    if constexpr (kWide) return x.raw();
    return unit(x);
  }
  /// A limit of speeds, or the largest number; of a turning by the radius, else for 0.
  Speed mostSpeed(S x, int radiusBits) const {
    const std::int64_t most = units::shifted(x.raw(), 32 - speedBits_ - radius(radiusBits));
    if constexpr (kWide) return most;
    return static_cast<Speed>(min(most, kMost));
  }
  /// Bits by which the bend of a kernel is told of the radius.
  std::uint8_t bendBits(int radiusBits) const {
    if constexpr (kWide) return static_cast<std::uint8_t>(finer_ + radius(radiusBits));
    // Half the square. In units so coarse that less is meant, none is as large as the limit of bends.
    return static_cast<std::uint8_t>(clamp(wayBits_ + radius(radiusBits) + 1, 1, 63));
  }
  /// A way in a body's coordinates, by its radius.
  [[gnu::always_inline]] std::int32_t arm(S x, int radiusBits) const {
    const int bits = radius(radiusBits);
    const std::int64_t most = std::int64_t{1} << (32 + min(bits, 29));
    const std::int64_t in = clamp(x.raw(), -most, most);
    if (bits > N::kUnitBits - 32) [[likely]] {
      return narrow((in + (std::int64_t{1} << (31 - N::kUnitBits + bits)) - (in < 0)) >>
                    (32 - N::kUnitBits + bits));
    }
    return narrow(in << (N::kUnitBits - 32 - bits));
  }
  [[gnu::always_inline]] Speed speed(S x, std::int64_t& misfit) const { return speedOf(x, 0, misfit); }
  [[gnu::always_inline]] Speed turn(S x, int radiusBits, std::int64_t& misfit) const {
    return speedOf(x, radius(radiusBits), misfit);
  }
  [[gnu::always_inline]] Speed way(S x) const {
    return static_cast<Speed>(clamp(units::shifted(x.raw(), 32 - wayBits_), -kMost, kMost));
  }
  [[gnu::always_inline]] Sum sum(S x, std::int64_t& misfit) const {
    return static_cast<Sum>(speedOf(x, 0, misfit));
  }

  static S fromUnit(std::int32_t x) {
    return S::fromRaw(std::int64_t{x} * (std::int64_t{1} << (32 - N::kUnitBits)));
  }
  S fromArm(std::int32_t x, int radiusBits) const {
    return S::fromRaw(units::shifted(x, N::kUnitBits - 32 - radius(radiusBits)));
  }
  S fromSpin(std::int32_t x, int radiusBits) const {
    return S::fromRaw(units::shifted(x, N::kSpinBits - 32 + radius(radiusBits)));
  }
  [[gnu::always_inline]] S fromSpeed(Speed x) const { return S::fromRaw(units::shifted(x, speedBits_ - 32)); }
  S fromTurn(Speed x, int radiusBits) const {
    return S::fromRaw(units::shifted(x, speedBits_ + radius(radiusBits) - 32));
  }
  /// @param radiusBits  of a turning; 0 for a way
  S fromWay(Speed x, int radiusBits) const {
    return S::fromRaw(units::shifted(x, wayBits_ + radius(radiusBits) - 32));
  }
  [[gnu::always_inline]] S fromSum(Sum x) const { return S::fromRaw(units::shifted(x, speedBits_ - 32)); }

  /// Bits by which turnings are kept. In 64 bits it is not less than what ways are finer by, so that a bend
  /// is never finer than its angle's square.
  int radius(int bits) const { return clamp(bits, kWide ? -finer_ : -16, kAnyRadiusBits); }

 private:
  /// Bits that bound speeds, impulses and ways.
  static constexpr int kSpeedBits = kWide ? 61 : 28;
  static constexpr std::int64_t kMost = (std::int64_t{1} << kSpeedBits) - 1;
  /// Room that speeds have for growing within the step: contacts push, and a difference is twice as large.
  static constexpr int kSpareBits = 3;
  /// Speeds of less than 1 m/s get no finer; none are coarser than a millimetre in four seconds.
  static constexpr int kMostSpeedBits = 24, kLeastSpeedBits = 12;
  /// A step of less than 2^-14 s has no finer ways.
  static constexpr int kMostFiner = 14;

  static std::int32_t narrow(std::int64_t x) { return static_cast<std::int32_t>(x); }
  static bool fits(std::int64_t x) { return x == std::int64_t{narrow(x)}; }
  [[gnu::always_inline]] Speed speedOf(S x, int finer, std::int64_t& misfit) const {
    // Saturates, but only for what does not move: speeds by radius are below 2^18 m/s, impulses below 2^21.
    if constexpr (kWide) return finer == 0 ? x.raw() : units::shifted(x.raw(), -finer);
    const std::int64_t wide = units::shifted(x.raw(), 32 - speedBits_ - finer);
    const std::int64_t in = clamp(wide, -kMost, kMost);
    misfit |= wide ^ in;
    return static_cast<Speed>(in);
  }
  std::int64_t rate(S x) const { return units::shifted(x.raw(), 32 + finer_ - N::kRateBits); }

  /// Fraction bits of speeds and of ways.
  int speedBits_ = 0, wayBits_ = 0, finer_ = 0;
};

}  // namespace samestep
