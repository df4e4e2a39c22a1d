// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <vector>

#include <samestep/scalar.h>

#include "contact_block.h"

namespace samestep {

/// What the soft step is told of a body that touches something.
template <Scalar S>
struct SoftStart {
  S velocity[3]{};  ///< x, y, angular: m/s, rad/s.
  S push[3]{};      ///< What a substep adds to it.
  S kept = S(1);    ///< What damping leaves of it in one substep.
  /// Inverse moment times mass, 1/m^2.
  S momentPerMass{};
  /// Nothing of the body is farther from its centre of mass than two to the power of it, m.
  int radiusBits = 0;
};

/// What the soft step made of it.
template <Scalar S>
struct SoftMotion {
  S velocity[3]{};
  S moved[3]{};
  /// Which velocities had to be held at their limits: bits of Body::Held.
  std::uint8_t held = 0;
};

/// What holds for a whole step.
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
inline std::int64_t shifted(std::int64_t x, int bits) {
  if (bits <= 0) {
    const std::int64_t limit = std::int64_t{1} << (62 + bits);
    return clamp(x, -limit, limit) << -bits;
  }
  if (bits > 62) return 0;
  return (x + (std::int64_t{1} << (bits - 1)) - (x < 0)) >> bits;
}

/// How many bits the whole part of a Q32.32 has, less than 0 for small ones.
inline int wholeBits(std::uint64_t raw) { return static_cast<int>(std::bit_width(raw)) - 32; }

}  // namespace units

/// How the numbers of a scalar are written into the records of a kernel, and read from them. Where a number
/// does not fit, `misfit` is no longer 0.
template <Scalar S, class N>
class SoftUnits;

/// As they are.
template <Scalar S, bool kSpins>
class SoftUnits<S, PlainNumbers<S, kSpins>> {
 public:
  bool choose(const SoftSettings<S>&, const std::vector<SoftStart<S>>&) { return true; }
  SoftConstants<PlainNumbers<S, kSpins>> constants(const SoftSettings<S>& of, S mostSum) const {
    return {{of.softness[0], of.softness[1]}, of.perSubstep, of.pushSpeed, mostSum, S(0)};
  }

  static S unit(S x) { return x; }
  static S arm(S x, int) { return x; }
  static S spin(S x, int, std::int64_t&) { return x; }
  static S friction(S x) { return x; }
  static S inverse(S k) { return reciprocal(k); }
  static S speed(S x, std::int64_t&) { return x; }
  static S turn(S x, int, std::int64_t&) { return x; }
  static S way(S x) { return x; }
  static S sum(S x) { return x; }

  static S fromUnit(S x) { return x; }
  static S fromArm(S x, int) { return x; }
  static S fromSpin(S x, int) { return x; }
  static S fromSpeed(S x) { return x; }
  static S fromTurn(S x, int) { return x; }
  static S fromWay(S x, int) { return x; }
  static S fromSum(S x) { return x; }
};

/// As integers.
template <Scalar S, std::derived_from<IntegerUnits> N>
class SoftUnits<S, N> {
 public:
  static constexpr bool kWide = sizeof(typename N::Speed) == 8;
  using Speed = typename N::Speed;

  /// Chooses the units of a step. @return false if there are none
  bool choose(const SoftSettings<S>& of, const std::vector<SoftStart<S>>& starts) {
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
      // Every magnitude is below twice the power of two that its bits say.
      speedBits_ = min(kSpeedBits - kSpareBits - fastest, kMostSpeedBits);
      if (speedBits_ < 1) return false;
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
    to.pushSpeed = static_cast<Speed>(min(units::shifted(of.pushSpeed.raw(), 32 - speedBits_), kMost / 2));
    to.mostSum = sum(mostSum);
    // What is farther apart is not reached within a substep at any speed in range.
    to.mostGap = static_cast<Speed>(min(
        kWide ? kMost : (kMost / 2 << N::kRateBits) / max(std::int64_t{to.perSubstep}, std::int64_t{1}), kMost));
    return to;
  }

  /// Of what is in [-1, 1].
  static std::int32_t unit(S x) { return narrow(units::shifted(x.raw(), 32 - N::kUnitBits)); }
  static std::int32_t arm(S x, int radiusBits) {
    constexpr std::int64_t kOne = std::int64_t{1} << N::kUnitBits;
    return narrow(clamp(units::shifted(x.raw(), 32 - N::kUnitBits + radius(radiusBits)), -kOne, kOne));
  }
  static std::int32_t spin(S x, int radiusBits, std::int64_t& misfit) {
    return held(units::shifted(x.raw(), 32 - N::kSpinBits - radius(radiusBits)), misfit);
  }
  /// Held at 511: hardly anything slips at a tenth of it.
  static std::int32_t friction(S x) {
    return narrow(units::shifted(min(x, S(511)).raw(), 32 - N::kFrictionBits));
  }
  /// 1 / k for a k of 1 or more.
  static std::int32_t inverse(S k) {
    const auto divisor = static_cast<std::uint64_t>(k.raw());
    return static_cast<std::int32_t>(((std::uint64_t{1} << (32 + N::kUnitBits)) + divisor / 2) / divisor);
  }
  Speed speed(S x, std::int64_t& misfit) const { return speedOf(x, 0, misfit); }
  Speed turn(S x, int radiusBits, std::int64_t& misfit) const {
    return speedOf(x, radius(radiusBits), misfit);
  }
  Speed way(S x) const {
    return static_cast<Speed>(clamp(units::shifted(x.raw(), 32 - wayBits_), -kMost, kMost));
  }
  std::int64_t sum(S x) const { return units::shifted(x.raw(), 32 - speedBits_); }
  std::int32_t rateOf(S x) const { return narrow(rate(x)); }

  static S fromUnit(std::int32_t x) {
    return S::fromRaw(std::int64_t{x} * (std::int64_t{1} << (32 - N::kUnitBits)));
  }
  static S fromArm(std::int32_t x, int radiusBits) {
    return S::fromRaw(units::shifted(x, N::kUnitBits - 32 - radius(radiusBits)));
  }
  static S fromSpin(std::int32_t x, int radiusBits) {
    return S::fromRaw(units::shifted(x, N::kSpinBits - 32 + radius(radiusBits)));
  }
  S fromSpeed(Speed x) const { return S::fromRaw(units::shifted(x, speedBits_ - 32)); }
  S fromTurn(Speed x, int radiusBits) const {
    return S::fromRaw(units::shifted(x, speedBits_ + radius(radiusBits) - 32));
  }
  /// @param radiusBits  of a turning; 0 for a way
  S fromWay(Speed x, int radiusBits) const {
    return S::fromRaw(units::shifted(x, wayBits_ + radius(radiusBits) - 32));
  }
  S fromSum(std::int64_t x) const { return S::fromRaw(units::shifted(x, speedBits_ - 32)); }

  int speedBits() const { return speedBits_; }
  int wayBits() const { return wayBits_; }
  /// How many bits finer than speeds ways are.
  int finer() const { return finer_; }
  /// In 64 bits no turning loses anything.
  static int radius(int bits) { return clamp(bits, kWide ? 0 : -16, 24); }

 private:
  /// What speeds and ways are held below.
  static constexpr int kSpeedBits = kWide ? 61 : 30;
  static constexpr std::int64_t kMost = (std::int64_t{1} << kSpeedBits) - 1;
  /// Room that speeds have for growing within the step: contacts push, and a difference is twice as large.
  static constexpr int kSpareBits = 4;
  /// Speeds of less than 1 m/s get no finer.
  static constexpr int kMostSpeedBits = 26;
  /// A step of less than 2^-14 s has no finer ways.
  static constexpr int kMostFiner = 14;

  static std::int32_t narrow(std::int64_t x) { return static_cast<std::int32_t>(x); }
  static bool fits(std::int64_t x) { return x == std::int64_t{narrow(x)}; }
  static std::int32_t held(std::int64_t x, std::int64_t& misfit) {
    misfit |= x ^ narrow(x);
    return narrow(x);
  }
  Speed speedOf(S x, int finer, std::int64_t& misfit) const {
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
