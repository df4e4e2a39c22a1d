// SPDX-License-Identifier: MIT
#include "solver/soft_step/block_solver.h"

#include <samestep/high_water.h>

#include <algorithm>
#include <bit>
#include <iterator>

#include "base/require_ieee.h"
#include "contacts/contact_geometry.h"
#include "contacts/contact_row.h"
#include "solver/kernels/generic/coefficient_lanes.h"
#include "solver/kernels/generic/integer_vectors.h"
#include "solver/kernels/generic/scalar_lanes.h"
#include "solver/kernels/generic/soft_passes.h"
#include "solver/kernels/kernels.h"

namespace samestep {
namespace {

template <class S, class N>
SoftPasses<N> passesFor(KernelTarget target) {
  if constexpr (std::same_as<N, WideNumbers>) {
    // A scalar that checks has one kernel, which tells.
    if constexpr (!S::kChecks) {
      if (target == KernelTarget::avx512 && kernels::wideAvx512 != nullptr) return *kernels::wideAvx512;
      if (target == KernelTarget::avx2 && kernels::wideAvx2 != nullptr) return *kernels::wideAvx2;
      if (target == KernelTarget::neon && kernels::wideNeon != nullptr) return *kernels::wideNeon;
      if (target == KernelTarget::simd128 && kernels::wideSimd128 != nullptr) return *kernels::wideSimd128;
      if (target == KernelTarget::sse42 && kernels::wideSse42 != nullptr) return *kernels::wideSse42;
    }
    return kPassesOf<WideScalarLanes<S>, CoefficientLanes<OneAtATime, WideNumbers>>;
  } else if constexpr (std::same_as<N, FastNumbers>) {
    if (target == KernelTarget::avx512 && kernels::fastAvx512 != nullptr) return *kernels::fastAvx512;
    if (target == KernelTarget::avx2 && kernels::fastAvx2 != nullptr) return *kernels::fastAvx2;
    if (target == KernelTarget::neon && kernels::fastNeon != nullptr) return *kernels::fastNeon;
    if (target == KernelTarget::simd128 && kernels::fastSimd128 != nullptr) return *kernels::fastSimd128;
    if (target == KernelTarget::sse42 && kernels::fastSse42 != nullptr) return *kernels::fastSse42;
    return kernels::fastBy1;
  } else if constexpr (FixedNumber<S>) {
    return kPassesOf<ScalarLanes<S>>;
  } else {
    if (target == KernelTarget::avx512 && kernels::doubleAvx512 != nullptr) return *kernels::doubleAvx512;
    if (target == KernelTarget::avx2 && kernels::doubleAvx2 != nullptr) return *kernels::doubleAvx2;
    return kernels::doubleBy2;
  }
}

/// Coefficient of a point that is there, see BlockInput.
template <class N>
inline constexpr typename N::Coefficient kPresent{1};
template <std::derived_from<IntegerUnits> N>
inline constexpr std::int32_t kPresent<N> = -1;

/// A point that changes nothing.
template <class N>
void clearPoint(ContactBlock<N>& block, BlockRest<N>& rest, BlockInput<N>& in, int lane, int point) {
  constexpr typename N::Coefficient kNone(0);
  auto& from = in.point[point];
  from.armAX[lane] = from.armAY[lane] = from.armBX[lane] = from.armBY[lane] = from.present[lane] = kNone;
  block.point[point].separation[lane] = typename N::Speed(0);
  block.point[point].normal.sum[lane] = block.point[point].tangent.sum[lane] = typename N::Sum(0);
  rest.normalTotal[point][lane] = rest.tangentTotal[point][lane] = rest.bounce[point][lane] =
      typename N::Sum(0);
}

/// The share of a moment.
[[gnu::always_inline]] inline std::int32_t momentPart(std::int32_t share, std::int32_t moment) {
  return static_cast<std::int32_t>(units::rounded<IntegerUnits::kUnitBits>(std::int64_t{share} * moment));
}

/// A pair is pushed apart where it overlaps so many times deeper than a spring that carries what it does.
constexpr int kCarriedTimes = 64;
/// And by more than this, m: what overlaps less stays where it is.
template <Scalar S>
inline constexpr S kUnpushed = ratio<S>(1, 1 << 10);

/// Number of times springs are solved once more where something strikes.
constexpr int kMorePasses = 2;

/// The largest radius, in powers of two metres, at which a point along the normal is known to 2^-27 m by the
/// unit of arms.
constexpr int kNearBits = 3;

/// One of the velocities of a body, as held between two contacts.
template <class S, class N>
typename N::Speed heldSpeed(typename N::Speed speed, int which) {
  if constexpr (std::same_as<N, WideNumbers>) {
    return clamp(speed, -N::kMostSpeed, N::kMostSpeed);
  } else if constexpr (std::same_as<N, PlainNumbers<S, true>>) {
    const S most = which == 2 ? ScalarLanes<S>::kMostSpin : ScalarLanes<S>::kMostSpeed;
    return clamp(speed, -most, most);
  } else {
    return speed;
  }
}

}  // namespace

template <Scalar S, class N>
BlockSolver<S, N>::BlockSolver(BlockMemory& memory)
    : passes_(passesFor<S, N>(nextBestKernel(KernelTarget::best))), memory_(&memory) {}

template <Scalar S, class N>
void BlockSolver<S, N>::setKernel(KernelTarget target) {
  passes_ = passesFor<S, N>(target);
}

template <Scalar S, class N>
bool BlockSolver<S, N>::begin(const SoftSettings<S>& settings, const std::vector<SoftStart<S>>& starts,
                              const std::vector<BlockGroup>& groups, S mostKept, Budget& budget) {
  settings_ = &settings;
  starts_ = &starts;
  groups_ = &groups;
  if (!units_.choose(settings, starts, mostKept)) return false;
  constants_ = units_.constants(settings, kMaxSum<S>);
  bodies_.assign(starts.size(), {});
  drives_.resize(starts.size());
  marks_.resize(starts.size());
  // Here, though few steps push: within run() no memory is taken.
  pushes_.resize(starts.size());
  if constexpr (kIntegers) moments_.resize(starts.size());
  std::int64_t misfit = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const SoftStart<S>& from = starts[i];
    if constexpr (kIntegers) {
      const int perRadius = 32 - N::kSpinBits - 2 * units_.radius(from.radiusBits);
      const std::int64_t moment = units::shifted(from.momentPerMass.raw(), perRadius);
      moments_[i] = static_cast<std::int32_t>(moment);
      misfit |= moment ^ moments_[i];
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
  static_assert(sizeof(Block) % BlockMemory::kAlignment == 0);
  memory_->reserve(blockCount_ * (sizeof(Block) + sizeof(Rest)), budget);
  blocks_ = memory_->template at<Block>(0);
  rests_ = memory_->template at<Rest>(blockCount_ * sizeof(Block));
  return misfit == 0;
}

template <Scalar S, class N>
void BlockSolver<S, N>::openBlock(std::uint32_t at, int pairs, Taken& taken) {
  Block& block = blocks_[at];
  block.points = block.bounces = block.strikes = block.frictionShift = 0;
  block.roundA = block.roundB = block.stiff = block.stays = block.pushed = 0;
  block.fixedA = block.fixedB = 0;
  for (int lane = pairs; lane < N::kLanes; ++lane) clearLane(at, lane, taken);
}

/// Makes a lane that changes nothing.
template <Scalar S, class N>
void BlockSolver<S, N>::clearLane(std::uint32_t at, int lane, Taken& taken) {
  using Coefficient = typename N::Coefficient;
  constexpr Coefficient kNone(0);
  Block& block = blocks_[at];
  Rest& rest = rests_[at];
  BlockInput<N>& in = taken.input;
  const auto bit = static_cast<std::uint16_t>(1 << lane);
  block.fixedA = static_cast<std::uint16_t>(block.fixedA | bit);
  block.fixedB = static_cast<std::uint16_t>(block.fixedB | bit);
  block.bodyA[lane] = block.bodyB[lane] = 0;
  block.count[lane] = 0;
  block.shareA[lane] = block.friction[lane] = kNone;
  block.surface[lane] = Speed(0);
  rest.pair[lane] = Rest::kNoPair;
  in.cosA[lane] = in.sinA[lane] = in.cosB[lane] = in.sinB[lane] = kNone;
  in.normalX[lane] = in.normalY[lane] = in.momentA[lane] = in.momentB[lane] = kNone;
  for (int i = 0; i < kMaxContactsPerPair; ++i) clearPoint(block, rest, in, lane, i);
}

/// Fills how the bodies of a pair answer an impulse by turning.
template <Scalar S, class N>
inline void BlockSolver<S, N>::fillMoments(Block& block, int lane, const Pair<S>& pair, const SoftFrame<S>& a,
                                           const SoftFrame<S>& b, BlockInput<N>& in) const {
  const auto shareA = block.shareA[lane];
  if constexpr (kIntegers) {
    in.momentA[lane] = momentPart(shareA, moments_[a.start]);
    in.momentB[lane] = momentPart((1 << N::kUnitBits) - shareA, moments_[b.start]);
  } else {
    Vector<S> reachA, reachB;
    for (int i = 0; FixedNumber<S> && i < pair.count; ++i) {
      const Vector<S> toA = a.arm(pair.contacts[i].anchorA), toB = b.arm(pair.contacts[i].anchorB);
      reachA = {max(reachA.x, abs(toA.x)), max(reachA.y, abs(toA.y))};
      reachB = {max(reachB.x, abs(toB.x)), max(reachB.y, abs(toB.y))};
    }
    in.momentA[lane] = heldMoment((*starts_)[a.start].momentPerMass * shareA, reachA);
    in.momentB[lane] = heldMoment((*starts_)[b.start].momentPerMass * (S(1) - shareA), reachB);
    if constexpr (!N::kStoresSpins) {
      block.moments.momentA[lane] = in.momentA[lane];
      block.moments.momentB[lane] = in.momentB[lane];
    }
  }
}

/// Fills the arms of a contact point.
template <Scalar S, class N>
inline void BlockSolver<S, N>::fillPoint(typename BlockInput<N>::Point& to, int lane,
                                         const Contact<S>& contact, const SoftFrame<S>& a,
                                         const SoftFrame<S>& b) const {
  const auto put = [&](auto& x, auto& y, const Vector<S>& arm, int radiusBits) {
    if constexpr (kIntegers) {
      // No arm matters of what does not move.
      const bool any = radiusBits == kAnyRadiusBits;
      x[lane] = any ? 0 : units_.arm(arm.x, radiusBits);
      y[lane] = any ? 0 : units_.arm(arm.y, radiusBits);
    } else {
      x[lane] = arm.x;
      y[lane] = arm.y;
    }
  };
  put(to.armAX, to.armAY, a.arm(contact.anchorA), a.radiusBits);
  put(to.armBX, to.armBY, b.arm(contact.anchorB), b.radiusBits);
  to.present[lane] = kPresent<N>;
}

template <Scalar S, class N>
bool BlockSolver<S, N>::addPair(std::uint32_t at, int lane, const Pair<S>& pair, std::uint32_t pairIndex,
                                const SoftFrame<S>& a, const SoftFrame<S>& b, bool roundA, bool roundB,
                                Taken& taken) {
  Block& block = blocks_[at];
  Rest& rest = rests_[at];
  BlockInput<N>& in = taken.input;
  taken.pair[lane] = &pair;
  taken.a[lane] = &a;
  taken.b[lane] = &b;
  const auto bit = static_cast<std::uint16_t>(1 << lane);
  const auto mark = [&](std::uint16_t& bits, bool set) {
    if (set) bits = static_cast<std::uint16_t>(bits | bit);
  };
  block.bodyA[lane] = a.start;
  block.bodyB[lane] = b.start;
  block.count[lane] = pair.count;
  block.points = max(block.points, pair.count);
  mark(block.fixedA, a.isFixed());
  mark(block.fixedB, b.isFixed());
  mark(block.roundA, roundA);
  mark(block.roundB, roundB);
  mark(block.stiff, a.isFixed() || b.isFixed());
  setFriction(block, lane, pair.friction);
  rest.pair[lane] = pairIndex;
  const auto shares = units_.shares(a.mass, b.mass);
  block.shareA[lane] = shares.a;
  in.normalX[lane] = units_.unit(pair.localNormal.x);
  in.normalY[lane] = units_.unit(pair.localNormal.y);
  const Vector<S> rotationA = rotationOf<S>(pair.rotationA), rotationB = rotationOf<S>(pair.rotationB);
  in.cosA[lane] = units_.unit(rotationA.x);
  in.sinA[lane] = units_.unit(rotationA.y);
  in.cosB[lane] = units_.unit(rotationB.x);
  in.sinB[lane] = units_.unit(rotationB.y);
  fillMoments(block, lane, pair, a, b, in);
  std::int64_t misfit = 0;
  const auto kept = [&](S speed) { return units_.perUnit(units_.sum(speed, misfit), shares.perSpeed); };
  for (int i = 0; i < pair.count; ++i) {
    const Contact<S>& contact = pair.contacts[i];
    fillPoint(in.point[i], lane, contact, a, b);
    auto& point = block.point[i];
    point.normal.sum[lane] = kept(clamp(contact.normalSpeed, S(0), kMaxSum<S>));
    point.tangent.sum[lane] = kept(clamp(contact.tangentSpeed, -kMaxSum<S>, kMaxSum<S>));
    rest.normalTotal[i][lane] = rest.tangentTotal[i][lane] = rest.bounce[i][lane] = typename N::Sum(0);
  }
  for (int i = pair.count; i < kMaxContactsPerPair; ++i) clearPoint(block, rest, in, lane, i);
  return misfit == 0;
}

template <Scalar S, class N>
bool BlockSolver<S, N>::closeBlock(std::uint32_t at, int pairs, S bounceThreshold, const Taken& taken) {
  bool fits = passes_.prepare(taken.input, blocks_[at], bodies_.data()) == 0;
  for (int lane = 0; lane < pairs; ++lane) fits &= placePoints(at, lane, bounceThreshold, taken);
  if (blocks_[at].pushed != 0) {
    for (auto& sums : rests_[at].pushSum) std::fill(std::begin(sums), std::end(sums), typename N::Sum(0));
  }
  return fits;
}

/// Marks a pair that carries nothing, or overlaps far more than what it carries explains, as one that springs
/// do not push apart.
template <Scalar S, class N>
inline void BlockSolver<S, N>::markPushed(Block& block, int lane, const Pair<S>& pair, S overlap) const {
  S carried = S(0);
  for (int i = 0; i < pair.count; ++i) carried = max(carried, pair.contacts[i].normalSpeed);
  if (carried > S(0)) {
    if (overlap <= kUnpushed<S>) return;
    const Softness<S>& soft = settings_->softness[block.stiff >> lane & 1];
    const S explained = min(carried, S(1 << 14)) * (soft.impulseScale * S(kCarriedTimes));
    if (min(overlap, S(1)) * soft.biasRate * soft.massScale <= explained) return;
  }
  block.stays = static_cast<std::uint16_t>(block.stays | 1 << lane);
  if (overlap > kUnpushed<S>) block.pushed = static_cast<std::uint16_t>(block.pushed | 1 << lane);
}

/// Fills what a pair takes from where its bodies are, which 32 bits do not hold, and how fast.
template <Scalar S, class N>
bool BlockSolver<S, N>::placePoints(std::uint32_t at, int lane, S bounceThreshold, const Taken& taken) {
  Block& block = blocks_[at];
  const Pair<S>& pair = *taken.pair[lane];
  const SoftFrame<S>&a = *taken.a[lane], &b = *taken.b[lane];
  const Vector<S> n(units_.fromUnit(block.normalX[lane]), units_.fromUnit(block.normalY[lane]));
  const Vector<S> between = b.center - a.center;
  const S centers = dot(n, between);
  std::int64_t misfit = 0;
  block.surface[lane] =
      pair.surfaceVelocity == Vector<S>() ? Speed(0) : units_.speed(cross(n, pair.surfaceVelocity), misfit);
  const bool near = !kIntegers || max(a.radiusBits, b.radiusBits) <= kNearBits;
  // Separations follow the bodies, which have turned little since.
  const S turnedA = cross(rotationOf<S>(pair.rotationA), a.rotation);
  const S turnedB = cross(rotationOf<S>(pair.rotationB), b.rotation);
  S overlap = S(0);
  for (int i = 0; i < pair.count; ++i) {
    const Contact<S>& contact = pair.contacts[i];
    const auto& tangent = block.point[i].tangent;
    const auto& normal = block.point[i].normal;
    S apart;
    if (near) [[likely]] {
      apart = centers +
              (units_.fromArm(tangent.armB[lane], b.radiusBits) -
               units_.fromArm(tangent.armA[lane], a.radiusBits)) +
              cross(units_.fromArm(normal.armB[lane], b.radiusBits), turnedB,
                    units_.fromArm(normal.armA[lane], a.radiusBits), turnedA);
    } else {
      apart = dot(n, between + (rotate(b.arm(contact.anchorB), b.rotation) -
                                rotate(a.arm(contact.anchorA), a.rotation)));
    }
    overlap = max(overlap, -apart);
    block.point[i].separation[lane] = units_.way(clamp(apart, S(-(1 << 10)), S(1 << 10)));
    if (pair.elasticity != S(0) || contact.normalSpeed == S(0)) {
      rests_[at].bounce[i][lane] = units_.sum(bounceOf(block, lane, i, bounceThreshold, taken), misfit);
    }
  }
  markPushed(block, lane, pair, overlap);
  return misfit == 0;
}

/// The speed that a bounce shall leave; notes a strike.
template <Scalar S, class N>
S BlockSolver<S, N>::bounceOf(Block& block, int lane, int point, S bounceThreshold,
                              const Taken& taken) const {
  const Pair<S>& pair = *taken.pair[lane];
  const SoftFrame<S>&a = *taken.a[lane], &b = *taken.b[lane];
  const SoftStart<S>&startA = (*starts_)[a.start], &startB = (*starts_)[b.start];
  const auto& axis = block.point[point].normal;
  const S approach = dot(units_.fromUnit(block.normalX[lane]), startB.velocity[0] - startA.velocity[0],
                         units_.fromUnit(block.normalY[lane]), startB.velocity[1] - startA.velocity[1]) +
                     cross(units_.fromArm(axis.armB[lane], b.radiusBits), startB.velocity[2],
                           units_.fromArm(axis.armA[lane], a.radiusBits), startA.velocity[2]);
  if (approach >= -bounceThreshold) return S(0);
  if (pair.contacts[point].normalSpeed == S(0)) block.strikes = 1;
  if (pair.elasticity == S(0)) return S(0);
  block.bounces = 1;
  const S most = pair.elasticity > S(1) ? kMaxSum<S> / pair.elasticity : kMaxSum<S>;
  return pair.elasticity * min(-approach, most);
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

/// Counts what contacts gave a velocity in the last substep as its difference from the base. Preparing has
/// given what they kept to the velocities.
template <Scalar S, class N>
void BlockSolver<S, N>::tellKept(std::uint32_t begin, std::uint32_t end) {
  for (std::uint32_t i = begin; i < end; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Speed before = drives_[i].base[k];
      drives_[i].base[k] = static_cast<Speed>(before - (bodies_[i].velocity[k] - before));
      bodies_[i].velocity[k] = before;
    }
  }
}

template <Scalar S, class N>
void BlockSolver<S, N>::addPushes(std::uint32_t begin, std::uint32_t end) {
  for (std::uint32_t i = begin; i < end; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Speed own = bodies_[i].velocity[k];
      pushes_[i].moved[k] = own;
      bodies_[i].velocity[k] = static_cast<Speed>(own + pushes_[i].velocity[k]);
    }
  }
}

template <Scalar S, class N>
void BlockSolver<S, N>::takePushes(std::uint32_t begin, std::uint32_t end) {
  for (std::uint32_t i = begin; i < end; ++i) {
    for (int k = 0; k < 3; ++k) bodies_[i].velocity[k] = pushes_[i].moved[k];
  }
}

/// Tells joints where their bodies are now and how fast.
template <Scalar S, class N>
void BlockSolver<S, N>::showBodies(std::vector<JointBody<S>>& bodies) const {
  for (JointBody<S>& body : bodies) {
    const SoftBody<N>& from = bodies_[body.solver];
    const int radius = (*starts_)[body.solver].radiusBits;
    body.velocity = body.before = {units_.fromSpeed(from.velocity[0]), units_.fromSpeed(from.velocity[1])};
    body.spin = body.spinBefore = units_.fromTurn(from.velocity[2], radius);
    body.moved = {units_.fromWay(from.moved[0], 0), units_.fromWay(from.moved[1], 0)};
    const S turned = units_.fromWay(from.moved[2], radius);
    if (turned == body.turned) continue;
    body.turned = turned;
    body.turn = rotate(body.rotation, forAngle(turned));
  }
}

/// Takes over what joints changed.
/// @return false where a number does not fit
template <Scalar S, class N>
bool BlockSolver<S, N>::takeBodies(std::vector<JointBody<S>>& bodies) {
  std::int64_t misfit = 0;
  for (JointBody<S>& body : bodies) {
    if ((*starts_)[body.solver].mass == S(0)) continue;
    SoftBody<N>& to = bodies_[body.solver];
    const int radius = (*starts_)[body.solver].radiusBits;
    const Vector<S> change = body.velocity - body.before;
    const S spinChange = body.spin - body.spinBefore;
    to.velocity[0] = static_cast<Speed>(to.velocity[0] + units_.speed(change.x, misfit));
    to.velocity[1] = static_cast<Speed>(to.velocity[1] + units_.speed(change.y, misfit));
    to.velocity[2] = static_cast<Speed>(to.velocity[2] + units_.turn(spinChange, radius, misfit));
    body.given += change;
    body.spinGiven += spinChange;
  }
  return misfit == 0;
}

/// Gives again, in the directions of now, the impulses that joints gave in the last substep, and solves.
template <Scalar S, class N>
bool BlockSolver<S, N>::startJoints(JointSolver<S>& joints) {
  showBodies(joints.bodies);
  for (JointBody<S>& body : joints.bodies) {
    body.velocity -= body.given;
    body.spin -= body.spinGiven;
  }
  joints.build();
  joints.warmStart();
  joints.solve(true, false);
  return takeBodies(joints.bodies);
}

template <Scalar S, class N>
bool BlockSolver<S, N>::relaxJoints(JointSolver<S>& joints) {
  showBodies(joints.bodies);
  joints.keep();
  joints.build();
  joints.solve(false, true);
  joints.keep();
  joints.addTotals();
  return takeBodies(joints.bodies);
}

template <Scalar S, class N>
bool BlockSolver<S, N>::run(bool strikes, bool pushes, JointSolver<S>& joints, Crew& crew, Budget& budget) {
  const auto count = static_cast<std::uint32_t>(bodies_.size());
  const std::uint64_t perPass = Budget::kPerPairAndPass * N::kLanes * blockCount_;
  Finding left;
  const auto passOn = [&](ContactPass<N> kernel, std::vector<SoftBody<N>>& bodies) {
    if (left) return;
    left.note(passOverGroups(kernel, blocks_, rests_, *groups_, bodies, constants_, crew));
    left.note(budget.spend(perPass));
  };
  const auto pass = [&](ContactPass<N> kernel) { passOn(kernel, bodies_); };
  const auto eachBody = [&](auto&& part) { crew.each(count, kBodyGrain, part); };
  const auto bodyPass = [&](BodyPass<N> kernel) {
    eachBody([&](std::uint32_t begin, std::uint32_t end) {
      left.note(kernel(bodies_.data() + begin, drives_.data() + begin, marks_.data() + begin, end - begin,
                       constants_) != 0);
    });
  };
  eachBody([&](std::uint32_t begin, std::uint32_t end) { tellKept(begin, end); });
  if (pushes) {
    eachBody([&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t i = begin; i < end; ++i) pushes_[i] = {};
    });
  }
  const bool joined = !joints.empty();
  if (joined) joints.restart();
  for (int i = 0; i < settings_->substeps; ++i) {
    bodyPass(passes_.drive);
    if (joined) left.note(!startJoints(joints) || budget.spend(Budget::kPerPair * joints.size()));
    pass(i == 0 ? passes_.start : passes_.solve);
    for (int more = 0; strikes && more < kMorePasses; ++more) pass(passes_.solve);
    if (pushes) {
      passOn(passes_.push, pushes_);
      eachBody([&](std::uint32_t begin, std::uint32_t end) { addPushes(begin, end); });
    }
    bodyPass(passes_.move);
    if (pushes) eachBody([&](std::uint32_t begin, std::uint32_t end) { takePushes(begin, end); });
    if (joined) left.note(!relaxJoints(joints));
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
    if constexpr (kIntegers) {
      // Velocities finer than the unit of this step stay.
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
void BlockSolver<S, N>::bounce(const std::vector<Pair<S>>& pairs, S bounceThreshold,
                               Restitution<S>& restitution) {
  restitution.clear(bodies_.size());
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    const SoftStart<S>& start = (*starts_)[i];
    BounceBody<S>& body = restitution.bodies[i];
    for (int k = 0; k < 3; ++k) {
      const int radius = k == 2 ? start.radiusBits : 0;
      const Speed velocity = bodies_[i].velocity[k];
      body.before[k] = start.velocity[k];
      body.velocity[k] = k == 2 ? units_.fromTurn(velocity, radius) : units_.fromSpeed(velocity);
      body.moved[k] = units_.fromWay(bodies_[i].moved[k], radius);
      body.pushed[k] = start.push[k];
    }
    body.perSecond = settings_->perSubstep;
    body.mass = start.mass;
    body.momentPerMass = start.momentPerMass;
  }
  for (std::uint32_t i = 0; i < blockCount_; ++i) findBounces(i, pairs, bounceThreshold, restitution);
  if (restitution.points.empty()) return;
  restitution.markBouncing();
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < blockCount_; ++i) findOthers(i, pairs, next, restitution);
  restitution.solve();
  for (const BouncePoint<S>& point : restitution.points) takeBounce(point, restitution);
}

/// Adds the points of a block that give back: of pairs that struck or passed on a blow. What they held before
/// the step they hold, and do not give back.
template <Scalar S, class N>
void BlockSolver<S, N>::findBounces(std::uint32_t at, const std::vector<Pair<S>>& pairs, S bounceThreshold,
                                    Restitution<S>& restitution) const {
  const Block& block = blocks_[at];
  const Rest& rest = rests_[at];
  for (int lane = 0; lane < N::kLanes; ++lane) {
    if (block.count[lane] == 0) continue;
    const Pair<S>& pair = pairs[rest.pair[lane]];
    if (pair.elasticity == S(0)) continue;
    const S inverseShare = reciprocal(units_.fromUnit(units_.larger(block.shareA[lane])));
    S taken[kMaxContactsPerPair]{}, sum = S(0);
    bool strikes = false;
    for (int k = 0; k < block.count[lane]; ++k) {
      const S held = min(pair.contacts[k].normalSpeed, kMaxSum<S>) * inverseShare * S(settings_->substeps);
      const S total = min(units_.fromSum(rest.normalTotal[k][lane]), S(1 << 26));
      taken[k] = clamp(total - held, S(0), kMaxSum<S>);
      sum += taken[k];
      strikes = strikes || (rest.bounce[k][lane] != typename N::Sum(0) && total != S(0));
    }
    if (!strikes && sum <= bounceThreshold) continue;
    for (int k = 0; k < block.count[lane]; ++k) {
      if (taken[k] == S(0)) continue;
      restitution.points.push_back(bouncePoint(at, lane, k, pair));
      restitution.points.back().taken = taken[k];
    }
  }
}

/// Adds the points of a block that gave something to a body that bounces, and do not bounce.
/// @param next  the number of points that bounce in the blocks before
template <Scalar S, class N>
void BlockSolver<S, N>::findOthers(std::uint32_t at, const std::vector<Pair<S>>& pairs, std::size_t& next,
                                   Restitution<S>& restitution) const {
  const Block& block = blocks_[at];
  const Rest& rest = rests_[at];
  for (int lane = 0; lane < N::kLanes; ++lane) {
    if (block.count[lane] == 0) continue;
    if (!restitution.bounces(block.bodyA[lane]) && !restitution.bounces(block.bodyB[lane])) continue;
    for (int k = 0; k < block.count[lane]; ++k) {
      if (rest.normalTotal[k][lane] == typename N::Sum(0) || restitution.passPoint(at, lane, k, next))
        continue;
      restitution.others.push_back(bouncePoint(at, lane, k, pairs[rest.pair[lane]]));
    }
  }
}

template <Scalar S, class N>
BouncePoint<S> BlockSolver<S, N>::bouncePoint(std::uint32_t at, int lane, int index,
                                              const Pair<S>& pair) const {
  const Block& block = blocks_[at];
  const Rest& rest = rests_[at];
  const auto& normal = block.point[index].normal;
  const auto& tangent = block.point[index].tangent;
  BouncePoint<S> point;
  point.bodyA = block.bodyA[lane];
  point.bodyB = block.bodyB[lane];
  const int radiusA = (*starts_)[point.bodyA].radiusBits, radiusB = (*starts_)[point.bodyB].radiusBits;
  point.normal = {units_.fromUnit(block.normalX[lane]), units_.fromUnit(block.normalY[lane])};
  point.shareA = units_.fromUnit(block.shareA[lane]);
  point.armA = units_.fromArm(normal.armA[lane], radiusA);
  point.armB = units_.fromArm(normal.armB[lane], radiusB);
  point.tangentArmA = units_.fromArm(tangent.armA[lane], radiusA);
  point.tangentArmB = units_.fromArm(tangent.armB[lane], radiusB);
  if constexpr (N::kStoresSpins) {
    point.spinA = units_.fromSpin(normal.spinA[lane], radiusA);
    point.spinB = units_.fromSpin(normal.spinB[lane], radiusB);
    point.tangentSpinA = units_.fromSpin(tangent.spinA[lane], radiusA);
    point.tangentSpinB = units_.fromSpin(tangent.spinB[lane], radiusB);
  } else {
    point.spinA = block.moments.momentA[lane] * point.armA;
    point.spinB = block.moments.momentB[lane] * point.armB;
    point.tangentSpinA = block.moments.momentA[lane] * point.tangentArmA;
    point.tangentSpinB = block.moments.momentB[lane] * point.tangentArmB;
  }
  point.friction = pair.friction;
  point.pressed = units_.fromSum(rest.normalTotal[index][lane]);
  point.rubbed = units_.fromSum(rest.tangentTotal[index][lane]);
  point.surface = units_.fromSpeed(block.surface[lane]);
  point.elasticity = pair.elasticity;
  point.pair = rest.pair[lane];
  point.block = at;
  point.lane = static_cast<std::uint8_t>(lane);
  point.index = static_cast<std::uint8_t>(index);
  return point;
}

template <Scalar S, class N>
void BlockSolver<S, N>::takeBounce(const BouncePoint<S>& point, const Restitution<S>& restitution) {
  std::int64_t misfit = 0;
  // A contact that leaves holds nothing in the next step.
  BlockPoint<N>& from = blocks_[point.block].point[point.index];
  from.normal.sum[point.lane] = from.tangent.sum[point.lane] = typename N::Sum(0);
  auto& total = rests_[point.block].normalTotal[point.index][point.lane];
  total = units_.sum(point.pressed + point.rebound, misfit);
  rests_[point.block].tangentTotal[point.index][point.lane] = units_.sum(point.rubbed, misfit);
  for (const std::uint32_t index : {point.bodyA, point.bodyB}) {
    const BounceBody<S>& body = restitution.bodies[index];
    if (body.mass == S(0)) continue;
    const int radius = (*starts_)[index].radiusBits;
    Speed(&to)[4] = bodies_[index].velocity;
    to[0] = heldSpeed<S, N>(units_.speed(body.velocity[0], misfit), 0);
    to[1] = heldSpeed<S, N>(units_.speed(body.velocity[1], misfit), 1);
    to[2] = heldSpeed<S, N>(units_.turn(body.velocity[2], radius, misfit), 2);
  }
}

template <Scalar S, class N>
void BlockSolver<S, N>::store(std::vector<Pair<S>>& pairs, Crew& crew) const {
  crew.each(blockCount_, kBlockGrain<N>, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) storeBlock(i, pairs);
  });
}

/// Writes what the contacts of a pair gave its lighter body, by the directions that gave it.
template <Scalar S, class N>
void BlockSolver<S, N>::tellImpulse(std::uint32_t at, int lane, Pair<S>& pair) const {
  const Block& block = blocks_[at];
  const Rest& rest = rests_[at];
  const auto shareA = block.shareA[lane];
  auto x = block.pushAX[lane], y = block.pushAY[lane];
  if (units_.larger(shareA) != shareA) {
    x = block.normalX[lane] - x;
    y = block.normalY[lane] - y;
  }
  S along = S(0), aside = S(0);
  for (int k = 0; k < block.count[lane]; ++k) {
    along += units_.fromSum(rest.normalTotal[k][lane]);
    aside += units_.fromSum(rest.tangentTotal[k][lane]);
  }
  const Vector<S> push(units_.fromUnit(x), units_.fromUnit(y));
  pair.solvedImpulse = rotate(push, Vector<S>(along, aside));
  pair.solvedNormal = {units_.fromUnit(block.normalX[lane]), units_.fromUnit(block.normalY[lane])};
}

template <Scalar S, class N>
void BlockSolver<S, N>::storeBlock(std::uint32_t at, std::vector<Pair<S>>& pairs) const {
  const Block& block = blocks_[at];
  const Rest& rest = rests_[at];
  for (int lane = 0; lane < N::kLanes; ++lane) {
    if (rest.pair[lane] == Rest::kNoPair) continue;
    // The lighter body has the larger share.
    const auto share = units_.larger(block.shareA[lane]);
    Pair<S>& pair = pairs[rest.pair[lane]];
    tellImpulse(at, lane, pair);
    const auto speedOf = [&](typename N::Sum sum) { return units_.perMass(share, sum); };
    for (int k = 0; k < block.count[lane]; ++k) {
      Contact<S>& contact = pair.contacts[k];
      contact.normalSpeed = speedOf(block.point[k].normal.sum[lane]);
      contact.tangentSpeed = speedOf(block.point[k].tangent.sum[lane]);
      contact.normalTotal = min(speedOf(rest.normalTotal[k][lane]), kMaxSum<S>);
      contact.tangentTotal = clamp(speedOf(rest.tangentTotal[k][lane]), -kMaxSum<S>, kMaxSum<S>);
      highWater<S>("soft step: impulse total", contact.normalTotal);
    }
  }
}

#ifndef SAMESTEP_FIXED_ONLY
template class BlockSolver<double, PlainNumbers<double, false>>;
#endif
template class BlockSolver<Fixed, PlainNumbers<Fixed, true>>;
template class BlockSolver<Fixed, WideNumbers>;
template class BlockSolver<Fixed, FastNumbers>;
#ifndef SAMESTEP_NO_CHECKED
template class BlockSolver<CheckedFixed, PlainNumbers<CheckedFixed, true>>;
template class BlockSolver<CheckedFixed, WideNumbers>;
template class BlockSolver<CheckedFixed, FastNumbers>;
#endif

}  // namespace samestep
