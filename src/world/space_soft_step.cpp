// SPDX-License-Identifier: MIT
// The stages of the step that belong to the soft-step solver.
#include <bit>

#include "base/require_ieee.h"
#include "world/space_impl.h"

namespace samestep {

namespace {

/// The power of two metres that nothing of a body is beyond, seen from its centre of mass.
template <Scalar S, class Impl>
int radiusBits(const Impl& impl, std::uint32_t index, const Body<S>& body) {
  S most = S(0);
  for (std::uint32_t i = impl.firstShape[index]; i != Impl::kNone; i = impl.nextShape[i]) {
    const CircleAround<S>& shape = impl.around[i];
    const Vector<S> aside = shape.center - body.centerOfMass();
    most = max(most, shape.radius + (abs(aside.x) + abs(aside.y)));
  }
  return most == S(0) ? 0 : static_cast<int>(std::bit_width(raw::magnitude(most.raw()) - 1)) - 32;
}

/// How many pairs ahead pairs and bodies are fetched.
constexpr std::uint32_t kAhead = 8;

/// Puts the pairs into blocks, group by group.
/// @return false where a number does not fit
template <Scalar S, class Solver, class Impl>
bool takePairs(Solver& solver, Impl& impl, const std::vector<Pair<S>>& pairs, S bounceThreshold) {
  Finding misfit, bounces, strikes;
  const std::vector<SoftFrame<S>>& frames = impl.soft.frames;
  const auto solvedAt = [&](std::uint32_t i) -> const typename Impl::SolvedPair& {
    return impl.solvedPairs[impl.groupOrder[i]];
  };
  const auto last = static_cast<std::uint32_t>(impl.groupOrder.size());
  // The lot between groups scatters what is asked for.
  const auto fetchAhead = [&](std::uint32_t i) {
    if (i + kAhead >= last) return;
    const typename Impl::SolvedPair& next = solvedAt(i + kAhead);
    const auto* pair = reinterpret_cast<const char*>(&pairs[next.pair]);
    for (std::uint32_t line = 0; line < sizeof(Pair<S>); line += 64) __builtin_prefetch(pair + line);
    __builtin_prefetch(&frames[next.a]);
    __builtin_prefetch(&frames[next.b]);
  };
  const auto takeBlock = [&](std::uint32_t block, std::uint32_t begin, std::uint32_t end) {
    const auto count = static_cast<int>(end - begin);
    typename Solver::Taken taken;
    solver.openBlock(block, count, taken);
    for (std::uint32_t i = begin; i < end; ++i) {
      fetchAhead(i);
      const typename Impl::SolvedPair& solved = solvedAt(i);
      misfit.note(!solver.addPair(block, static_cast<int>(i - begin), pairs[solved.pair], solved.pair,
                                  frames[solved.a], frames[solved.b], solved.roundA, solved.roundB, taken));
    }
    misfit.note(!solver.closeBlock(block, count, bounceThreshold, taken));
    bounces.note(solver.bounces(block));
    strikes.note(solver.strikes(block));
  };
  impl.crew.during(impl.crew.helpsWith(impl.solvedPairs.size(), Impl::kFewPairs), [&] {
    std::uint32_t first = 0;
    std::uint32_t group = 0;
    for (const BlockGroup& blockGroup : impl.soft.groups) {
      while (impl.groups.size(group) == 0) ++group;
      const std::uint32_t count = impl.groups.size(group++);
      const std::uint32_t lanes = blockGroup.inOrder ? 1 : Solver::Numbers::kLanes;
      const std::uint32_t start = blockGroup.begin;
      const auto take = [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
          const std::uint32_t from = first + i * lanes;
          takeBlock(start + i, from, min(from + lanes, first + count));
        }
      };
      if (blockGroup.inOrder) {
        take(0, blockGroup.end - start);
      } else {
        impl.crew.each(blockGroup.end - start, kBlockGrain<typename Solver::Numbers>, take);
      }
      first += count;
    }
  });
  impl.soft.bounces = static_cast<bool>(bounces);
  impl.soft.strikes = static_cast<bool>(strikes);
  return !static_cast<bool>(misfit);
}

}  // namespace

template <Scalar S>
void Space<S>::softPreStep(S dt) {
  SoftStep<S>& soft = impl_->soft;
  const Settings<S>& settings = state_.settings;
  const S substep = dt / S(settings.substeps);
  const S perSubstep = reciprocal(max(substep, ratio<S>(1, 1 << 14)));
  // Stiffer, a pile of boxes no longer comes to rest.
  const S hertz = min(settings.contactHertz, perSubstep * ratio<S>(1, 6));
  soft.settings = {{makeSoftness(hertz, settings.contactDamping, substep),
                    makeSoftness(S(2) * hertz, settings.contactDamping, substep)},
                   substep,
                   perSubstep,
                   settings.contactPushSpeed,
                   settings.substeps};
  softFindGroups();
  softTakeBodies(dt);
  soft.solvers.begin(settings.precision == ContactPrecision::fast);
  softTakePairs();
  endStage(Stage::preStep);
}

/// Sorts the pairs to be solved into groups that share no body, and marks their bodies.
template <Scalar S>
void Space<S>::softFindGroups() {
  Impl& impl = *impl_;
  impl.groups.clear(state_.bodies.slots());
  impl.solvedPairs.clear();
  impl.solverIndex.assign(state_.bodies.slots(), Impl::kNone);
  impl.soft.mostKept = S(0);
  const bool fast = FixedNumber<S> && state_.settings.precision == ContactPrecision::fast;
  for (std::uint32_t i = 0; i < state_.pairs.size(); ++i) {
    const Pair<S>& pair = state_.pairs[i];
    if (pair.solved == 0) continue;
    const ShapeTraits<S>&shapeA = impl.traits[pair.a.index], &shapeB = impl.traits[pair.b.index];
    const std::uint32_t a = shapeA.body, b = shapeB.body;
    impl.solverIndex[a] = impl.solverIndex[b] = 0;
    impl.solvedPairs.push_back({i, a, b, shapeA.round, shapeB.round});
    for (int k = 0; fast && k < pair.count; ++k) {
      impl.soft.mostKept =
          max(impl.soft.mostKept, max(pair.contacts[k].normalSpeed, abs(pair.contacts[k].tangentSpeed)));
    }
    // As they were placed: the same as the bodies', and nearer.
    const auto moves = [&](std::uint32_t body) { return impl.poses[body].type == BodyType::dynamicBody; };
    impl.groups.add(a, moves(a), b, moves(b), pair.count == 1);
  }
  impl.groups.sort(impl.groupOrder);
}

/// Makes the solver's bodies, by rising slot, so that what was added together is near in memory: the first
/// stands for all that never move, and those that touch nothing make their substeps by themselves.
template <Scalar S>
void Space<S>::softTakeBodies(S dt) {
  Impl& impl = *impl_;
  SoftStep<S>& soft = impl.soft;
  const S substep = soft.settings.substep;
  const S keptInSubstep = damping() == S(1) ? S(1) : pow(damping(), substep);
  const S keptInStep = damping() == S(1) ? S(1) : pow(damping(), dt);
  soft.clear();
  soft.frames.resize(state_.bodies.slots());
  const auto frame = [&](std::uint32_t i, std::uint32_t index, int radiusBits) {
    const Body<S>& body = state_.bodies.valueAt(i);
    soft.frames[i] = {body.worldCenter(),
                      body.centerOfMass(),
                      body.rotation(),
                      body.isDynamic() ? body.mass() : S(0),
                      index,
                      radiusBits};
  };
  for (std::uint32_t i = 0; i < state_.bodies.slots(); ++i) {
    if (!state_.bodies.aliveAt(i)) continue;
    Body<S>& body = state_.bodies.valueAt(i);
    SoftStart<S> start;
    if (body.type() == BodyType::staticBody) {
      // Nothing moves it, and no function is asked to.
    } else if (body.velocityFunc() != 0) [[unlikely]] {
      callVelocityFunc(i, keptInStep, dt);
    } else if (body.isDynamic()) {
      const typename Body<S>::Motion motion = body.acceleration(gravity());
      start.push[0] = motion.velocity.x * substep;
      start.push[1] = motion.velocity.y * substep;
      start.push[2] = motion.angularVelocity * substep;
      start.kept = keptInSubstep;
    }
    body.force_ = {};
    body.torque_ = S(0);
    if (body.type() == BodyType::staticBody) {
      if (impl.solverIndex[i] != Impl::kNone) frame(i, 0, kAnyRadiusBits);
      continue;
    }
    start.velocity[0] = body.velocity().x;
    start.velocity[1] = body.velocity().y;
    start.velocity[2] = body.angularVelocity();
    if (impl.solverIndex[i] == Impl::kNone) {
      impl.solverIndex[i] = Impl::kFree | static_cast<std::uint32_t>(soft.free.size());
      soft.addFree(start);
    } else {
      start.momentPerMass = body.momentPerMass();
      if constexpr (FixedNumber<S>) start.radiusBits = radiusBits(impl, i, body);
      impl.solverIndex[i] = soft.add(start);
      frame(i, impl.solverIndex[i], start.radiusBits);
    }
  }
}

/// Lays out the blocks and has them filled by the first solver that holds all numbers.
template <Scalar S>
void Space<S>::softTakePairs() {
  Impl& impl = *impl_;
  SoftStep<S>& soft = impl.soft;
  const auto take = [&](auto& solver) {
    constexpr std::uint32_t kLanes = std::remove_reference_t<decltype(solver)>::Numbers::kLanes;
    std::uint32_t blocks = 0;
    soft.groups.clear();
    for (std::uint32_t group = 0; group < ContactGroups::kGroups; ++group) {
      // The pairs of the last group may share bodies.
      const bool inOrder = group == ContactGroups::kGroups - 1;
      const std::uint32_t pairs = impl.groups.size(group);
      const std::uint32_t end = blocks + (inOrder ? pairs : (pairs + kLanes - 1) / kLanes);
      if (pairs > 0) soft.groups.push_back({blocks, end, inOrder});
      blocks = end;
    }
    return solver.begin(soft.settings, soft.starts, soft.groups, soft.mostKept) &&
           takePairs(solver, impl, state_.pairs, state_.settings.bounceThreshold);
  };
  while (!soft.solvers.with(take)) soft.solvers.fallBack();
}

template <Scalar S>
void Space<S>::softSolve() {
  Impl& impl = *impl_;
  SoftStep<S>& soft = impl.soft;
  Crew& crew = impl.crew;
  const auto run = [&](auto& solver) {
    bool solved = false;
    crew.during(crew.helpsWith(impl.solvedPairs.size(), Impl::kFewPairs), [&] {
      solved = solver.run(soft.strikes, crew);
      if (!solved) return;
      if (soft.bounces) solver.bounce();
      solver.store(state_.pairs, crew);
    });
    return solved;
  };
  while (!soft.solvers.with(run)) {
    soft.solvers.fallBack();
    softTakePairs();
  }
  const bool fast = state_.settings.precision == ContactPrecision::fast && !soft.groups.empty();
  if (fast && !soft.solvers.isFast()) ++accurateInstead_;
  endStage(Stage::solve);
}

template <Scalar S>
void Space<S>::softFinish(S dt) {
  Impl& impl = *impl_;
  const std::uint32_t slots = state_.bodies.slots();
  // Position functions are called in order, and see the bodies before them moved, those after them not.
  impl.crew.during(impl.positionFuncs.empty() && impl.crew.helpsWith(slots, Impl::kFewBodies), [&] {
    impl.crew.each(slots, Impl::kPlacedGrain,
                   [&](std::uint32_t begin, std::uint32_t end) { softFinish(dt, begin, end); });
  });
  endStage(Stage::integratePositions);
}

template <Scalar S>
void Space<S>::softFinish(S dt, std::uint32_t begin, std::uint32_t end) {
  Impl& impl = *impl_;
  impl.soft.solvers.with([&](const auto& solver) {
    for (std::uint32_t i = begin; i < end; ++i) {
      if (!state_.bodies.aliveAt(i)) continue;
      Body<S>& body = state_.bodies.valueAt(i);
      if (body.type() == BodyType::staticBody) continue;
      const std::uint32_t index = impl.solverIndex[i];
      const SoftMotion<S> motion =
          (index & Impl::kFree) != 0 ? impl.soft.free[index & ~Impl::kFree] : solver.motion(index);
      if (body.isDynamic()) {
        // The substeps hold velocities, too.
        impl.held[i] |= motion.held;
        impl.held[i] |= body.holdVelocity({{motion.velocity[0], motion.velocity[1]}, motion.velocity[2]});
      }
      if (body.positionFunc() != 0) [[unlikely]] {
        callPositionFunc(i, dt);
      } else {
        impl.held[i] |= body.holdMoved({motion.moved[0], motion.moved[1]}, motion.moved[2], worldExtent());
      }
    }
  });
}

#ifndef SAMESTEP_FIXED_ONLY
template class Space<double>;
#endif
template class Space<Fixed>;
template class Space<CheckedFixed>;
void file_of::spaceSoftStep() {}

}  // namespace samestep
