// SPDX-License-Identifier: MIT
// The stages of the step that belong to the soft-step solver.
#include "require_ieee.h"
#include "space_impl.h"

namespace samestep {

template <Scalar S>
void Space<S>::softPreStep(S dt) {
  Impl& impl = *impl_;
  SoftSolver<S>& soft = impl.soft;
  const Settings<S>& settings = state_.settings;
  const S substep = dt / S(settings.substeps);
  const S perSubstep = reciprocal(max(substep, ratio<S>(1, 1 << 14)));
  const S hertz = min(settings.contactHertz, perSubstep * ratio<S>(1, 4));
  soft.constants = {{makeSoftness(hertz, settings.contactDamping, substep),
                     makeSoftness(S(2) * hertz, settings.contactDamping, substep)},
                    substep,
                    perSubstep,
                    settings.contactPushSpeed,
                    kMaxSum<S>,
                    S(0)};
  softFindGroups();
  softTakeBodies(dt);
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
  for (std::uint32_t i = 0; i < state_.pairs.size(); ++i) {
    const Pair<S>& pair = state_.pairs[i];
    if (pair.solved == 0) continue;
    const std::uint32_t a = impl.traits[pair.a.index].body;
    const std::uint32_t b = impl.traits[pair.b.index].body;
    impl.solverIndex[a] = impl.solverIndex[b] = 0;
    impl.solvedPairs.push_back(i);
    impl.groups.add(a, state_.bodies.valueAt(a).isDynamic(), b, state_.bodies.valueAt(b).isDynamic(),
                    pair.count == 1);
  }
  impl.groups.sort(impl.groupOrder);
}

/// Makes the solver's bodies, by rising slot, so that what was added together is near in memory: the first
/// stands for all that never move, and those that touch nothing make their substeps by themselves.
template <Scalar S>
void Space<S>::softTakeBodies(S dt) {
  Impl& impl = *impl_;
  SoftSolver<S>& soft = impl.soft;
  const S substep = soft.constants.substep;
  const S keptInSubstep = damping() == S(1) ? S(1) : pow(damping(), substep);
  const S keptInStep = damping() == S(1) ? S(1) : pow(damping(), dt);
  soft.clear();
  for (std::uint32_t i = 0; i < state_.bodies.slots(); ++i) {
    if (!state_.bodies.aliveAt(i)) continue;
    Body<S>& body = state_.bodies.valueAt(i);
    SoftDrive<SolverNumbers<S>> drive{};
    drive.kept = S(1);
    if (body.type() == BodyType::staticBody) {
      // Nothing moves it, and no function is asked to.
    } else if (body.velocityFunc() != 0) [[unlikely]] {
      callVelocityFunc(i, keptInStep, dt);
    } else if (body.isDynamic()) {
      const typename Body<S>::Motion motion = body.acceleration(gravity());
      drive.push[0] = motion.velocity.x * substep;
      drive.push[1] = motion.velocity.y * substep;
      drive.push[2] = motion.angularVelocity * substep;
      drive.kept = keptInSubstep;
    }
    body.force_ = {};
    body.torque_ = S(0);
    if (body.type() == BodyType::staticBody) continue;
    if (impl.solverIndex[i] == Impl::kNone) {
      impl.solverIndex[i] = Impl::kFree | static_cast<std::uint32_t>(soft.freeBodies.size());
      soft.addFree(body, drive, state_.settings.substeps);
    } else {
      impl.solverIndex[i] = soft.addBody(body, drive);
    }
  }
}

/// Puts the pairs into blocks, group by group.
template <Scalar S>
void Space<S>::softTakePairs() {
  Impl& impl = *impl_;
  SoftSolver<S>& soft = impl.soft;
  std::uint32_t blocks = 0;
  for (std::uint32_t group = 0; group < ContactGroups::kGroups; ++group) {
    // The pairs of the last group may share bodies.
    const bool inOrder = group == ContactGroups::kGroups - 1;
    const std::uint32_t pairs = impl.groups.size(group);
    const std::uint32_t end = blocks + (inOrder ? pairs : (pairs + kBlockLanes - 1) / kBlockLanes);
    if (pairs > 0) soft.groups.push_back({blocks, end, inOrder});
    blocks = end;
  }
  soft.makeRoom();
  Finding bounces;
  impl.crew.during(impl.crew.helpsWith(impl.solvedPairs.size(), Impl::kFewPairs), [&] {
    std::uint32_t first = 0;
    std::uint32_t group = 0;
    for (const BlockGroup& blockGroup : soft.groups) {
      while (impl.groups.size(group) == 0) ++group;
      const std::uint32_t pairs = impl.groups.size(group++);
      const std::uint32_t lanes = blockGroup.inOrder ? 1 : kBlockLanes;
      const std::uint32_t start = blockGroup.begin;
      const auto take = [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
          const std::uint32_t from = first + i * lanes;
          softTakeBlock(start + i, from, min(from + lanes, first + pairs));
          bounces.note(soft.blocks[start + i].bounces != 0);
        }
      };
      if (blockGroup.inOrder) {
        take(0, blockGroup.end - start);
      } else {
        impl.crew.each(blockGroup.end - start, kBlockGrain, take);
      }
      first += pairs;
    }
  });
  soft.bounces = static_cast<bool>(bounces);
}

/// Puts the pairs from `begin` to `end` of those sorted by group into a block.
template <Scalar S>
void Space<S>::softTakeBlock(std::uint32_t block, std::uint32_t begin, std::uint32_t end) {
  Impl& impl = *impl_;
  SoftSolver<S>& soft = impl.soft;
  soft.openBlock(block);
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::uint32_t index = impl.solvedPairs[impl.groupOrder[i]];
    const Pair<S>& pair = state_.pairs[index];
    const ShapeTraits<S>& shapeA = impl.traits[pair.a.index];
    const ShapeTraits<S>& shapeB = impl.traits[pair.b.index];
    const std::uint32_t a = shapeA.body;
    const std::uint32_t b = shapeB.body;
    soft.addPair(block, static_cast<int>(i - begin), pair, index, impl.solverIndex[a], impl.solverIndex[b],
                 state_.bodies.valueAt(a), state_.bodies.valueAt(b), shapeA.round, shapeB.round,
                 state_.settings.bounceThreshold);
  }
  soft.closeBlock(block, static_cast<int>(end - begin));
}

template <Scalar S>
void Space<S>::softSolve() {
  SoftSolver<S>& soft = impl_->soft;
  const int substeps = state_.settings.substeps;
  const bool fast = state_.settings.precision == ContactPrecision::fast && soft.blockCount != 0;
  if (fast) impl_->fast.makeRoom(soft);
  Crew& crew = impl_->crew;
  crew.during(crew.helpsWith(impl_->solvedPairs.size(), Impl::kFewPairs), [&] {
    const bool solved = fast && impl_->fast.run(soft, substeps, crew);
    if (fast && !solved) ++accurateInstead_;
    if (!solved) soft.run(substeps, crew);
    soft.bounce();
    soft.store(state_.pairs, crew);
  });
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
  for (std::uint32_t i = begin; i < end; ++i) {
    if (!state_.bodies.aliveAt(i)) continue;
    Body<S>& body = state_.bodies.valueAt(i);
    if (body.type() == BodyType::staticBody) continue;
    const std::uint32_t index = impl.solverIndex[i];
    const bool isFree = (index & Impl::kFree) != 0;
    const auto& solved = isFree ? impl.soft.freeBodies[index & ~Impl::kFree] : impl.soft.bodies[index];
    if (body.isDynamic()) {
      // The substeps hold velocities, too.
      impl.held[i] |= isFree ? impl.soft.freeHeld[index & ~Impl::kFree] : impl.soft.drives[index].held;
      impl.held[i] |= body.holdVelocity({{solved.velocity[0], solved.velocity[1]}, solved.velocity[2]});
    }
    if (body.positionFunc() != 0) [[unlikely]] {
      callPositionFunc(i, dt);
    } else {
      impl.held[i] |= body.holdMoved({solved.moved[0], solved.moved[1]}, solved.moved[2], worldExtent());
    }
  }
}

#ifndef SAMESTEP_FIXED_ONLY
template class Space<double>;
#endif
template class Space<Fixed>;
template class Space<CheckedFixed>;
void file_of::spaceSoftStep() {}

}  // namespace samestep
