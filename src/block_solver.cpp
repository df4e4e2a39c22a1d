// SPDX-License-Identifier: MIT
#include "block_solver.h"

#include <samestep/high_water.h>

#include <bit>

#include "contact_geometry.h"
#include "contact_row.h"
#include "kernels/kernels.h"
#include "kernels/scalar_lanes.h"
#include "kernels/soft_passes.h"
#include "require_ieee.h"

namespace samestep {
namespace {

template <class S, class N>
SoftPasses<N> passesFor(KernelTarget target) {
  if constexpr (std::same_as<N, WideNumbers>) {
    // A scalar that checks has one kernel, which tells.
    if constexpr (!S::kChecks) {
      if (target == KernelTarget::avx2 && kernels::wideAvx2 != nullptr) return *kernels::wideAvx2;
      if (target == KernelTarget::neon && kernels::wideNeon != nullptr) return *kernels::wideNeon;
      if (target == KernelTarget::simd128 && kernels::wideSimd128 != nullptr) return *kernels::wideSimd128;
      if (target == KernelTarget::sse42 && kernels::wideSse42 != nullptr) return *kernels::wideSse42;
    }
    return kPassesOf<WideScalarLanes<S>>;
  } else if constexpr (std::same_as<N, FastNumbers>) {
    if (target == KernelTarget::avx2 && kernels::fastAvx2 != nullptr) return *kernels::fastAvx2;
    if (target == KernelTarget::neon && kernels::fastNeon != nullptr) return *kernels::fastNeon;
    if (target == KernelTarget::simd128 && kernels::fastSimd128 != nullptr) return *kernels::fastSimd128;
    if (target == KernelTarget::sse42 && kernels::fastSse42 != nullptr) return *kernels::fastSse42;
    return kernels::fastBy1;
  } else if constexpr (FixedNumber<S>) {
    return kPassesOf<ScalarLanes<S>>;
  } else {
    if (target == KernelTarget::avx2 && kernels::doubleAvx2 != nullptr) return *kernels::doubleAvx2;
    return kernels::doubleBy2;
  }
}

template <class N>
void clearAxis(BlockAxis<N>& axis, int lane) {
  using Coefficient = typename N::Coefficient;
  axis.armA[lane] = axis.armB[lane] = axis.mass[lane] = Coefficient(0);
  axis.sum[lane] = typename N::Sum(0);
  if constexpr (N::kStoresSpins) axis.spinA[lane] = axis.spinB[lane] = Coefficient(0);
}

/// A point that changes nothing.
template <class N>
void clearPoint(ContactBlock<N>& block, BlockRest<N>& rest, int lane, int point) {
  clearAxis(block.point[point].normal, lane);
  clearAxis(block.point[point].tangent, lane);
  block.point[point].separation[lane] = typename N::Speed(0);
  rest.normalTotal[point][lane] = rest.tangentTotal[point][lane] = rest.bounce[point][lane] =
      typename N::Sum(0);
}

/// Of a contact's points, from the centres of mass, each in the coordinates of its body.
template <Scalar S>
struct AnchorArms {
  Vector<S> a, b;
};
template <Scalar S>
AnchorArms<S> anchorArms(const Contact<S>& contact, const Body<S>& a, const Body<S>& b) {
  return {contact.anchorA - a.centerOfMass(), contact.anchorB - b.centerOfMass()};
}

/// As respond(), from the bodies' own moments by mass.
template <Scalar S>
PairResponse<S> respondWith(const Body<S>& a, S momentPerMassA, const Body<S>& b, S momentPerMassB) {
  const Scaled<S> none{};
  if (b.inverseMass() == none) return {S(1), S(0), momentPerMassA, S(0)};
  if (a.inverseMass() == none) return {S(0), S(1), S(0), momentPerMassB};
  if (a.inverseMass() == b.inverseMass()) return {S(1), S(1), momentPerMassA, momentPerMassB};
  const bool aIsLighter = a.inverseMass() > b.inverseMass();
  const S heavy = aIsLighter ? toScalar<S>(b.inverseMass() * toScaled(a.mass()))
                             : toScalar<S>(a.inverseMass() * toScaled(b.mass()));
  if (aIsLighter) return {S(1), heavy, momentPerMassA, momentPerMassB * heavy};
  return {heavy, S(1), momentPerMassA * heavy, momentPerMassB};
}

/// How often springs are solved once more where something strikes.
constexpr int kMorePasses = 2;

/// The largest inverse moment by the squared radius that a pair holds, in units of spins: 32 and more.
constexpr std::int64_t kMostMoment = std::int64_t{1} << 32;

/// What a base is held below in size, in the units of speeds: one impulse more leaves no 64 bits.
constexpr std::int64_t kMostBase = std::int64_t{1} << 61;

/// factor * x / 2^bits of an impulse.
template <class N, int kBits>
[[gnu::always_inline]] inline std::int64_t impulseBy(std::int32_t factor, std::int64_t x) {
  // Two impulses of 32 bits and a factor of one more leave no 64.
  if constexpr (sizeof(typename N::Sum) == 4) return units::rounded<kBits>(factor * x);
  return units::scaled<kBits>(factor, x);
}

/// One body of a pair, in units of its radius.
template <class S, class N>
class IntegerSide {
 public:
  /// Where a contact point is, by the normal: across it and along it, by the radius, and along it in metres.
  struct Place {
    std::int32_t across, along;
    S depth;
  };

  /// @param normal  in the body's coordinates
  /// @param moment  how an impulse at the radius turns it, in units of spins
  [[gnu::always_inline]] IntegerSide(const Vector<S>& normal, const Vector<S>& center, int radiusBits,
                                     std::int64_t moment)
      : normal_(normal),
        center_(center),
        x_(Units::unit(normal.x)),
        y_(Units::unit(normal.y)),
        radiusBits_(Units::radius(radiusBits)),
        moment_(moment) {}

  [[gnu::always_inline]] Place place(const Vector<S>& anchor) const {
    const Vector<S> to = anchor - center_;
    // No arm matters of what does not move.
    if (radiusBits_ == kAnyRadiusBits) return {0, 0, dot(to, normal_)};
    const std::int64_t x = Units::arm(to.x, radiusBits_), y = Units::arm(to.y, radiusBits_);
    const std::int32_t across = held(units::rounded<N::kUnitBits>(x * y_ - y * x_));
    const std::int32_t along = held(units::rounded<N::kUnitBits>(x * x_ + y * y_));
    // To 2^-27 m and better.
    if (radiusBits_ <= 3) [[likely]]
      return {across, along, Units::fromArm(along, radiusBits_)};
    return {across, along, dot(to, normal_)};
  }
  [[gnu::always_inline]] std::int32_t spin(std::int32_t arm, std::int64_t& misfit) const {
    const std::int64_t spin = units::rounded<N::kUnitBits>(moment_ * arm);
    misfit |= spin ^ static_cast<std::int32_t>(spin);
    return static_cast<std::int32_t>(spin);
  }

 private:
  using Units = SoftUnits<S, N>;
  [[gnu::always_inline]] static std::int32_t held(std::int64_t x) {
    constexpr std::int64_t kOne = std::int64_t{1} << N::kUnitBits;
    return static_cast<std::int32_t>(clamp(x, -kOne, kOne));
  }

  Vector<S> normal_, center_;
  std::int64_t x_, y_;
  int radiusBits_;
  std::int64_t moment_;
};

}  // namespace

template <Scalar S, class N>
BlockSolver<S, N>::BlockSolver() : passes_(passesFor<S, N>(nextBestKernel(KernelTarget::best))) {}

template <Scalar S, class N>
void BlockSolver<S, N>::setKernel(KernelTarget target) {
  passes_ = passesFor<S, N>(target);
}

template <Scalar S, class N>
bool BlockSolver<S, N>::begin(const SoftSettings<S>& settings, const std::vector<SoftStart<S>>& starts,
                              const std::vector<BlockGroup>& groups, S mostKept) {
  settings_ = &settings;
  starts_ = &starts;
  groups_ = &groups;
  if (!units_.choose(settings, starts, mostKept)) return false;
  constants_ = units_.constants(settings, kMaxSum<S>);
  bodies_.assign(starts.size(), {});
  drives_.resize(starts.size());
  marks_.resize(starts.size());
  if constexpr (kIntegers) moments_.resize(starts.size());
  std::int64_t misfit = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const SoftStart<S>& from = starts[i];
    if constexpr (kIntegers) {
      const int perRadius = 32 - N::kSpinBits - 2 * units_.radius(from.radiusBits);
      moments_[i] = min(units::shifted(from.momentPerMass.raw(), perRadius), std::int64_t{1} << 44);
    }
    SoftBody<N>& body = bodies_[i];
    SoftDrive<N>& drive = drives_[i];
    for (int k = 0; k < 2; ++k) {
      body.velocity[k] = units_.speed(from.velocity[k], misfit);
      drive.push[k] = units_.speed(from.push[k], misfit);
    }
    body.velocity[2] = units_.turn(from.velocity[2], from.radiusBits, misfit);
    drive.push[2] = units_.turn(from.push[2], from.radiusBits, misfit);
    for (int k = 0; k < 3; ++k) drive.base[k] = body.velocity[k];
    drive.push[3] = drive.base[3] = Speed(0);
    drive.limit[0] = drive.limit[1] = units_.mostSpeed(kMaxSpeed<S>, 0);
    drive.limit[2] = units_.mostSpeed(kMaxAngularSpeed<S>, from.radiusBits);
    drive.limit[3] = units_.factor(from.kept);
    marks_[i] = {0, units_.bendBits(from.radiusBits)};
  }
  blockCount_ = groups.empty() ? 0 : groups.back().end;
  if (blocks_.size() < blockCount_) {
    blocks_.resize(blockCount_);
    rests_.resize(blockCount_);
  }
  return misfit == 0;
}

template <Scalar S, class N>
void BlockSolver<S, N>::openBlock(std::uint32_t at) {
  Block& block = blocks_[at];
  block.points = block.bounces = block.strikes = block.frictionShift = 0;
  block.roundA = block.roundB = block.stiff = 0;
  block.fixedA = block.fixedB = 0;
}

template <Scalar S, class N>
void BlockSolver<S, N>::closeBlock(std::uint32_t at, int lanes) {
  using Coefficient = typename N::Coefficient;
  Block& block = blocks_[at];
  Rest& rest = rests_[at];
  for (int lane = lanes; lane < N::kLanes; ++lane) {
    const auto bit = static_cast<std::uint8_t>(1 << lane);
    block.fixedA = static_cast<std::uint8_t>(block.fixedA | bit);
    block.fixedB = static_cast<std::uint8_t>(block.fixedB | bit);
    block.bodyA[lane] = block.bodyB[lane] = 0;
    block.count[lane] = 0;
    block.normalX[lane] = block.normalY[lane] = block.shareA[lane] = Coefficient(0);
    block.friction[lane] = Coefficient(0);
    block.surface[lane] = Speed(0);
    if constexpr (!N::kStoresSpins) {
      block.moments.momentA[lane] = block.moments.momentB[lane] = Coefficient(0);
    }
    rest.pair[lane] = Rest::kNoPair;
    for (int i = 0; i < kMaxContactsPerPair; ++i) clearPoint(block, rest, lane, i);
  }
}

/// Takes from a body's base what contacts gave its velocity: (x, y), and the spin, in the kernel's units.
template <Scalar S, class N>
template <class T>
void BlockSolver<S, N>::give(std::uint32_t body, T x, T y, T turn, std::int64_t& misfit) {
  Speed* const base = drives_[body].base;
  const T given[3] = {x, y, turn};
  for (int k = 0; k < 3; ++k) {
    if constexpr (!kIntegers) {
      base[k] += given[k];
    } else {
      // What one pair gives is far below the limit, but a body may have any number of them.
      const std::int64_t sum = clamp(base[k] + given[k], -kMostBase, kMostBase);
      base[k] = static_cast<Speed>(sum);
      misfit |= sum ^ base[k];
    }
  }
}

/// What the points of a pair are filled from.
template <Scalar S, class N>
struct BlockSolver<S, N>::Frames {
  const Body<S>&a, &b;
  std::uint32_t indexA, indexB;
  PairResponse<S> response;
  Vector<S> normal;
  S perMass, shareA, bounceThreshold;
};

template <Scalar S, class N>
bool BlockSolver<S, N>::addPair(std::uint32_t at, int lane, const Pair<S>& pair, std::uint32_t pairIndex,
                                std::uint32_t indexA, std::uint32_t indexB, const Body<S>& a,
                                const Body<S>& b, bool roundA, bool roundB, S bounceThreshold) {
  Block& block = blocks_[at];
  Rest& rest = rests_[at];
  const PairResponse<S> response =
      respondWith(a, (*starts_)[indexA].momentPerMass, b, (*starts_)[indexB].momentPerMass);
  const S masses = response.massA + response.massB;
  const S perMass = masses == S(1) ? S(1) : masses == S(2) ? ratio<S>(1, 2) : reciprocal(masses);
  const auto bit = static_cast<std::uint8_t>(1 << lane);
  const auto mark = [&](std::uint8_t& bits, bool set) {
    if (set) bits = static_cast<std::uint8_t>(bits | bit);
  };
  const Vector<S> n = worldNormal(pair, a);
  block.bodyA[lane] = indexA;
  block.bodyB[lane] = indexB;
  block.count[lane] = pair.count;
  block.points = max(block.points, pair.count);
  mark(block.fixedA, !a.isDynamic());
  mark(block.fixedB, !b.isDynamic());
  mark(block.roundA, roundA);
  mark(block.roundB, roundB);
  mark(block.stiff, !a.isDynamic() || !b.isDynamic());
  block.normalX[lane] = units_.unit(n.x);
  block.normalY[lane] = units_.unit(n.y);
  const S shareA = response.massA * perMass;
  block.shareA[lane] = units_.unit(shareA);
  setFriction(block, lane, pair.friction);
  std::int64_t misfit = 0;
  block.surface[lane] = units_.speed(cross(n, pair.surfaceVelocity), misfit);
  rest.pair[lane] = pairIndex;
  for (int i = pair.count; i < kMaxContactsPerPair; ++i) clearPoint(block, rest, lane, i);
  const Frames frames{a, b, indexA, indexB, response, n, perMass, shareA, bounceThreshold};
  return fillPoints(block, rest, lane, pair, frames) && misfit == 0;
}

template <Scalar S, class N>
void BlockSolver<S, N>::setFriction(Block& block, int lane, S friction) {
  if constexpr (std::same_as<N, FastNumbers>) {
    // Below 8 as it is; all of a block have one unit.
    const S most = min(friction, S(511));
    const int whole = max(static_cast<int>(std::bit_width(raw::magnitude(most.raw()))) - 35, 0);
    if (whole > block.frictionShift) {
      for (int i = 0; i < lane; ++i) block.friction[i] >>= whole - block.frictionShift;
      block.frictionShift = static_cast<std::uint8_t>(whole);
    }
    block.friction[lane] = static_cast<std::int32_t>(min(
        units::shifted(most.raw(), 32 - N::kFrictionBits + block.frictionShift), std::int64_t{0x7fffffff}));
  } else if constexpr (kIntegers) {
    // Held at 511: hardly anything slips at a tenth of it.
    block.friction[lane] =
        static_cast<std::int32_t>(units::shifted(min(friction, S(511)).raw(), 32 - N::kFrictionBits));
  } else {
    block.friction[lane] = friction;
  }
}

/// Fills the points of a pair and gives their kept impulses to the bodies.
template <Scalar S, class N>
bool BlockSolver<S, N>::fillPoints(Block& block, Rest& rest, int lane, const Pair<S>& pair,
                                   const Frames& of) {
  const Body<S>&a = of.a, &b = of.b;
  const std::uint32_t indexA = of.indexA, indexB = of.indexB;
  const PairResponse<S>& response = of.response;
  const Vector<S> n = of.normal;
  const S masses = response.massA + response.massB;
  const bool alone = masses == S(1);
  const bool equal = masses == S(2);
  const auto keptSum = [&](S kept) {
    // In units of u it is no less.
    const S speed = clamp(kept, -kMaxSum<S>, kMaxSum<S>);
    return alone ? speed : equal ? speed + speed : speed * masses;
  };
  // The speed that a bounce shall leave; notes a strike.
  const auto bounceOf = [&](const Contact<S>& contact, S armA, S armB) {
    const Vector<S> dv = b.velocity() - a.velocity();
    const S approach =
        dot(n.x, dv.x, n.y, dv.y) + cross(armB, b.angularVelocity(), armA, a.angularVelocity());
    if (approach >= -of.bounceThreshold) return S(0);
    if (contact.normalSpeed == S(0)) block.strikes = 1;
    if (pair.elasticity == S(0)) return S(0);
    block.bounces = 1;
    return -(pair.elasticity * approach);
  };
  const auto asksForSpeed = [&](const Contact<S>& contact) {
    return pair.elasticity != S(0) || contact.normalSpeed == S(0);
  };
  // An arm by the normal is the same in the body's coordinates, where points and A's normal are kept.
  const Vector<S> nA = pair.localNormal;
  const Vector<S> nB = unrotate(n, b.rotation());
  const S between = dot(n, b.worldCenter() - a.worldCenter());
  const auto apart = [&](S depthA, S depthB) {
    return units_.way(clamp(between + (depthB - depthA), S(-(1 << 10)), S(1 << 10)));
  };
  std::int64_t misfit = 0;
  if constexpr (kIntegers) {
    const std::int32_t share = block.shareA[lane];
    const std::int32_t shareB = (1 << N::kUnitBits) - share;
    const std::int64_t momentA = response.momentA == S(0) ? 0 : moments_[indexA];
    const std::int64_t momentB = response.momentB == S(0) ? 0 : moments_[indexB];
    const std::int64_t byA = units::scaled<N::kUnitBits>(share, momentA);
    const std::int64_t byB = units::scaled<N::kUnitBits>(shareB, momentB);
    if (max(byA, byB) > kMostMoment) return false;
    const IntegerSide<S, N> sideA(nA, a.centerOfMass(), (*starts_)[indexA].radiusBits, byA);
    const IntegerSide<S, N> sideB(nB, b.centerOfMass(), (*starts_)[indexB].radiusBits, byB);
    std::int64_t normalPart = 0, tangentPart = 0, turnA = 0, turnB = 0;
    for (int i = 0; i < pair.count; ++i) {
      const Contact<S>& contact = pair.contacts[i];
      auto& point = block.point[i];
      const auto fill = [&](auto& axis, std::int32_t armA, std::int32_t armB, typename N::Sum kept)
          __attribute__((always_inline)) {
        axis.armA[lane] = armA;
        axis.armB[lane] = armB;
        axis.spinA[lane] = sideA.spin(armA, misfit);
        axis.spinB[lane] = sideB.spin(armB, misfit);
        // 1 and more, in units of masses.
        const std::int64_t k =
            (std::int64_t{1} << N::kUnitBits) +
            ((std::int64_t{axis.spinA[lane]} * armA + std::int64_t{axis.spinB[lane]} * armB) >> N::kSpinBits);
        constexpr std::uint64_t one = std::uint64_t{1} << (2 * N::kUnitBits);
        axis.mass[lane] = static_cast<std::int32_t>((one + static_cast<std::uint64_t>(k) / 2) /
                                                    static_cast<std::uint64_t>(k));
        axis.sum[lane] = kept;
        turnA += impulseBy<N, N::kSpinBits>(axis.spinA[lane], kept);
        turnB += impulseBy<N, N::kSpinBits>(axis.spinB[lane], kept);
        highWater<S>("contact: kept impulse u", units_.fromSum(kept));
      };
      const auto placeA = sideA.place(contact.anchorA);
      const auto placeB = sideB.place(contact.anchorB);
      const auto normalKept = units_.sum(clamp(keptSum(contact.normalSpeed), S(0), kMaxSum<S>), misfit);
      const auto tangentKept =
          units_.sum(clamp(keptSum(contact.tangentSpeed), -kMaxSum<S>, kMaxSum<S>), misfit);
      fill(point.normal, placeA.across, placeB.across, normalKept);
      // r x t is r . n.
      fill(point.tangent, placeA.along, placeB.along, tangentKept);
      point.separation[lane] = apart(placeA.depth, placeB.depth);
      normalPart += normalKept;
      tangentPart += tangentKept;
      rest.normalTotal[i][lane] = rest.tangentTotal[i][lane] = 0;
      rest.bounce[i][lane] = 0;
      if (asksForSpeed(contact)) {
        rest.bounce[i][lane] =
            units_.sum(bounceOf(contact, units_.fromArm(placeA.across, (*starts_)[indexA].radiusBits),
                                units_.fromArm(placeB.across, (*starts_)[indexB].radiusBits)),
                       misfit);
      }
    }
    const auto along = [&](std::int32_t by, std::int64_t part) {
      return impulseBy<N, N::kUnitBits>(by, part);
    };
    const std::int64_t x = along(block.normalX[lane], normalPart) - along(block.normalY[lane], tangentPart);
    const std::int64_t y = along(block.normalY[lane], normalPart) + along(block.normalX[lane], tangentPart);
    if (a.isDynamic()) give(indexA, along(share, x), along(share, y), turnA, misfit);
    if (b.isDynamic()) give(indexB, -along(shareB, x), -along(shareB, y), -turnB, misfit);
  } else {
    S normalPart = S(0), tangentPart = S(0), turnA = S(0), turnB = S(0);
    Vector<S> reachA, reachB;
    for (int i = 0; i < pair.count; ++i) {
      const auto [toA, toB] = anchorArms(pair.contacts[i], a, b);
      reachA = {max(reachA.x, abs(toA.x)), max(reachA.y, abs(toA.y))};
      reachB = {max(reachB.x, abs(toB.x)), max(reachB.y, abs(toB.y))};
    }
    const PairResponse<S> held = response.at(reachA, reachB);
    const S momentA = held.momentA * of.perMass;
    const S momentB = held.momentB * of.perMass;
    if constexpr (!N::kStoresSpins) {
      block.moments.momentA[lane] = momentA;
      block.moments.momentB[lane] = momentB;
    }
    for (int i = 0; i < pair.count; ++i) {
      const Contact<S>& contact = pair.contacts[i];
      auto& point = block.point[i];
      const auto fill = [&](auto& axis, S inA, S inB, S kept) {
        const S turnPerA = momentA * inA;
        const S turnPerB = momentB * inB;
        axis.armA[lane] = inA;
        axis.armB[lane] = inB;
        axis.mass[lane] = reciprocal(S(1) + dot(turnPerA, inA, turnPerB, inB));
        axis.sum[lane] = kept;
        if constexpr (N::kStoresSpins) {
          axis.spinA[lane] = turnPerA;
          axis.spinB[lane] = turnPerB;
        }
        turnA += turnPerA * kept;
        turnB += turnPerB * kept;
        // Of a body that nothing turns the arm counts for nothing.
        highWater<S>("contact: r x n of a body that turns", held.momentA > S(0) ? inA : S(0));
        highWater<S>("contact: r x n of a body that turns", held.momentB > S(0) ? inB : S(0));
        highWater<S>("contact: spin per unit of u", max(abs(turnPerA), abs(turnPerB)));
        highWater<S>("contact: kept impulse u", kept);
      };
      const auto [toA, toB] = anchorArms(contact, a, b);
      // r x t is r . n.
      const S depthA = dot(toA, nA);
      const S depthB = dot(toB, nB);
      fill(point.normal, cross(toA, nA), cross(toB, nB),
           clamp(keptSum(contact.normalSpeed), S(0), kMaxSum<S>));
      fill(point.tangent, depthA, depthB, clamp(keptSum(contact.tangentSpeed), -kMaxSum<S>, kMaxSum<S>));
      point.separation[lane] = apart(depthA, depthB);
      normalPart += point.normal.sum[lane];
      tangentPart += point.tangent.sum[lane];
      rest.normalTotal[i][lane] = rest.tangentTotal[i][lane] = S(0);
      rest.bounce[i][lane] =
          asksForSpeed(contact) ? bounceOf(contact, point.normal.armA[lane], point.normal.armB[lane]) : S(0);
    }
    const S x = cross(n.x, normalPart, n.y, tangentPart);
    const S y = dot(n.y, normalPart, n.x, tangentPart);
    const S shareB = S(1) - of.shareA;
    if (a.isDynamic()) give(indexA, of.shareA * x, of.shareA * y, turnA, misfit);
    if (b.isDynamic()) give(indexB, shareB * -x, shareB * -y, -turnB, misfit);
  }
  return misfit == 0;
}

template <Scalar S, class N>
bool BlockSolver<S, N>::run(bool strikes, Crew& crew) {
  const auto count = static_cast<std::uint32_t>(bodies_.size());
  Finding left;
  const auto pass = [&](ContactPass<N> kernel) {
    left.note(passOverGroups(kernel, blocks_, rests_, *groups_, bodies_, constants_, crew));
  };
  const auto bodyPass = [&](BodyPass<N> kernel) {
    crew.each(count, kBodyGrain, [&](std::uint32_t begin, std::uint32_t end) {
      left.note(kernel(bodies_.data() + begin, drives_.data() + begin, marks_.data() + begin, end - begin,
                       constants_) != 0);
    });
  };
  for (int i = 0; i < settings_->substeps; ++i) {
    bodyPass(passes_.drive);
    pass(passes_.solve);
    for (int more = 0; strikes && more < kMorePasses; ++more) pass(passes_.solve);
    bodyPass(passes_.move);
    pass(passes_.relax);
    if (left) return false;
  }
  return true;
}

template <Scalar S, class N>
SoftMotion<S> BlockSolver<S, N>::motion(std::uint32_t index) const {
  const SoftStart<S>& start = (*starts_)[index];
  const SoftBody<N>& body = bodies_[index];
  SoftMotion<S> motion;
  const unsigned held = marks_[index].held;
  if ((held & 3) != 0) motion.held = Body<S>::kHeldSpeed;
  if ((held & 4) != 0) motion.held = static_cast<std::uint8_t>(motion.held | Body<S>::kHeldSpin);
  for (int k = 0; k < 3; ++k) {
    const int radius = k == 2 ? start.radiusBits : 0;
    if constexpr (std::same_as<N, FastNumbers>) {
      // What is finer than the unit of this step stays.
      std::int64_t misfit = 0;
      const Speed from =
          k == 2 ? units_.turn(start.velocity[k], radius, misfit) : units_.speed(start.velocity[k], misfit);
      const Speed change = static_cast<Speed>(body.velocity[k] - from);
      motion.velocity[k] =
          start.velocity[k] + (k == 2 ? units_.fromTurn(change, radius) : units_.fromSpeed(change));
    } else {
      motion.velocity[k] =
          k == 2 ? units_.fromTurn(body.velocity[k], radius) : units_.fromSpeed(body.velocity[k]);
    }
    motion.moved[k] = units_.fromWay(body.moved[k], radius);
  }
  return motion;
}

template <Scalar S, class N>
void BlockSolver<S, N>::bounce() {
  for (std::uint32_t i = 0; i < blockCount_; ++i) {
    Block& block = blocks_[i];
    if (block.bounces == 0) continue;
    Rest& rest = rests_[i];
    for (int lane = 0; lane < N::kLanes; ++lane) {
      const std::uint32_t indexA = block.bodyA[lane], indexB = block.bodyB[lane];
      const int radiusA = (*starts_)[indexA].radiusBits, radiusB = (*starts_)[indexB].radiusBits;
      const Vector<S> n(units_.fromUnit(block.normalX[lane]), units_.fromUnit(block.normalY[lane]));
      const S shareA = units_.fromUnit(block.shareA[lane]);
      for (int k = 0; k < block.count[lane]; ++k) {
        auto& axis = block.point[k].normal;
        const S wanted = units_.fromSum(rest.bounce[k][lane]);
        if (wanted == S(0) || units_.fromSum(rest.normalTotal[k][lane]) == S(0)) continue;
        const auto speedOf = [&](std::uint32_t body, int which) {
          return units_.fromSpeed(bodies_[body].velocity[which]);
        };
        const S speed =
            dot(n.x, speedOf(indexB, 0) - speedOf(indexA, 0), n.y, speedOf(indexB, 1) - speedOf(indexA, 1)) +
            cross(units_.fromArm(axis.armB[lane], radiusB),
                  units_.fromTurn(bodies_[indexB].velocity[2], radiusB),
                  units_.fromArm(axis.armA[lane], radiusA),
                  units_.fromTurn(bodies_[indexA].velocity[2], radiusA));
        const S before = units_.fromSum(axis.sum[lane]);
        const S after = clamp(before + units_.fromUnit(axis.mass[lane]) * (wanted - speed), S(0), kMaxSum<S>);
        const S change = after - before;
        std::int64_t misfit = 0;
        axis.sum[lane] = units_.sum(after, misfit);
        rest.normalTotal[k][lane] = units_.sum(units_.fromSum(rest.normalTotal[k][lane]) + change, misfit);
        const auto push = [&](std::uint32_t index, S share, S along, S turn, int radiusBits) {
          SoftBody<N>& body = bodies_[index];
          body.velocity[0] = units_.speed(speedOf(index, 0) + share * (n.x * along), misfit);
          body.velocity[1] = units_.speed(speedOf(index, 1) + share * (n.y * along), misfit);
          body.velocity[2] =
              units_.turn(units_.fromTurn(body.velocity[2], radiusBits) + turn, radiusBits, misfit);
        };
        const auto spin = [&](bool ofB) {
          if constexpr (N::kStoresSpins) {
            return ofB ? units_.fromSpin(axis.spinB[lane], radiusB)
                       : units_.fromSpin(axis.spinA[lane], radiusA);
          } else {
            return ofB ? block.moments.momentB[lane] * axis.armB[lane]
                       : block.moments.momentA[lane] * axis.armA[lane];
          }
        };
        if ((block.fixedA >> lane & 1) == 0) push(indexA, shareA, -change, -(spin(false) * change), radiusA);
        if ((block.fixedB >> lane & 1) == 0) {
          push(indexB, S(1) - shareA, change, spin(true) * change, radiusB);
        }
      }
    }
  }
}

template <Scalar S, class N>
void BlockSolver<S, N>::store(std::vector<Pair<S>>& pairs, Crew& crew) const {
  crew.each(blockCount_, kBlockGrain, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) storeBlock(i, pairs);
  });
}

template <Scalar S, class N>
void BlockSolver<S, N>::storeBlock(std::uint32_t at, std::vector<Pair<S>>& pairs) const {
  const Block& block = blocks_[at];
  const Rest& rest = rests_[at];
  for (int lane = 0; lane < N::kLanes; ++lane) {
    if (rest.pair[lane] == Rest::kNoPair) continue;
    // The lighter body has the larger share.
    const auto shareA = block.shareA[lane];
    Pair<S>& pair = pairs[rest.pair[lane]];
    const auto speedOf = [&](S sum) {
      if constexpr (kIntegers) {
        const std::int32_t lighter = max(shareA, (1 << N::kUnitBits) - shareA);
        return S::fromRaw(units::scaled<N::kUnitBits>(lighter, sum.raw()));
      } else {
        return sum * max(shareA, S(1) - shareA);
      }
    };
    for (int k = 0; k < block.count[lane]; ++k) {
      Contact<S>& contact = pair.contacts[k];
      const S normalTotal = units_.fromSum(rest.normalTotal[k][lane]);
      const S tangentTotal = units_.fromSum(rest.tangentTotal[k][lane]);
      contact.normalSpeed = speedOf(units_.fromSum(block.point[k].normal.sum[lane]));
      contact.tangentSpeed = speedOf(units_.fromSum(block.point[k].tangent.sum[lane]));
      contact.normalTotal = speedOf(min(normalTotal, kMaxSum<S>));
      contact.tangentTotal = speedOf(clamp(tangentTotal, -kMaxSum<S>, kMaxSum<S>));
      highWater<S>("soft step: impulse total", normalTotal);
    }
  }
}

#ifndef SAMESTEP_FIXED_ONLY
template class BlockSolver<double, PlainNumbers<double, false>>;
#endif
template class BlockSolver<Fixed, PlainNumbers<Fixed, true>>;
template class BlockSolver<Fixed, WideNumbers>;
template class BlockSolver<Fixed, FastNumbers>;
template class BlockSolver<CheckedFixed, PlainNumbers<CheckedFixed, true>>;
template class BlockSolver<CheckedFixed, WideNumbers>;
template class BlockSolver<CheckedFixed, FastNumbers>;

}  // namespace samestep
