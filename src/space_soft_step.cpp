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
                    kMaxSum<S>};
  softTakeBodies(dt);
  softTakePairs();
  endStage(Stage::preStep);
}

/// Makes the solver's bodies, by rising slot, so that what was added together is near in memory. The first
/// stands for all that never move.
template <Scalar S>
void Space<S>::softTakeBodies(S dt) {
  Impl& impl = *impl_;
  SoftSolver<S>& soft = impl.soft;
  const S substep = soft.constants.substep;
  const S keptInSubstep = damping() == S(1) ? S(1) : pow(damping(), substep);
  const S keptInStep = damping() == S(1) ? S(1) : pow(damping(), dt);
  impl.solverBodies.assign(1, Impl::kNone);
  impl.solverIndex.assign(state_.bodies.slots(), 0);
  soft.bodies.assign(1, {});
  soft.drives.assign(1, {});
  for (std::uint32_t i = 0; i < state_.bodies.slots(); ++i) {
    if (!state_.bodies.aliveAt(i)) continue;
    Body<S>& body = state_.bodies.valueAt(i);
    SoftDrive<S> drive{};
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
    impl.solverIndex[i] = static_cast<std::uint32_t>(impl.solverBodies.size());
    impl.solverBodies.push_back(i);
    drive.base[0] = body.velocity_.x;
    drive.base[1] = body.velocity_.y;
    drive.base[2] = body.angularVelocity_;
    soft.bodies.push_back({{body.velocity_.x, body.velocity_.y, body.angularVelocity_, S(0)}, {}});
    soft.drives.push_back(drive);
  }
}

/// Puts the pairs into blocks, group by group.
template <Scalar S>
void Space<S>::softTakePairs() {
  Impl& impl = *impl_;
  SoftSolver<S>& soft = impl.soft;
  const auto bodyIndex = [&](ShapeId id) { return state_.shapes.valueAt(id.index).body().index; };
  const auto round = [&](ShapeId id) { return state_.shapes.valueAt(id.index).type() == ShapeType::circle; };
  impl.groups.clear(state_.bodies.slots());
  impl.solvedPairs.clear();
  for (std::uint32_t i = 0; i < state_.pairs.size(); ++i) {
    const Pair<S>& pair = state_.pairs[i];
    if (pair.solved == 0) continue;
    const std::uint32_t a = bodyIndex(pair.a);
    const std::uint32_t b = bodyIndex(pair.b);
    impl.solvedPairs.push_back(i);
    impl.groups.add(a, state_.bodies.valueAt(a).isDynamic(), b, state_.bodies.valueAt(b).isDynamic(),
                    pair.count == 1);
  }
  impl.groups.sort(impl.groupOrder);
  soft.blocks.clear();
  soft.rests.clear();
  std::uint32_t next = 0;
  for (std::uint32_t group = 0; group < ContactGroups::kGroups; ++group) {
    // The pairs of the last group may share bodies.
    const int lanes = group == ContactGroups::kGroups - 1 ? 1 : kBlockLanes;
    int lane = lanes;
    for (const std::uint32_t end = next + impl.groups.size(group); next < end; ++next, ++lane) {
      if (lane == lanes) {
        soft.openBlock();
        lane = 0;
      }
      const std::uint32_t index = impl.solvedPairs[impl.groupOrder[next]];
      const Pair<S>& pair = state_.pairs[index];
      const std::uint32_t a = bodyIndex(pair.a);
      const std::uint32_t b = bodyIndex(pair.b);
      soft.addPair(lane, pair, index, impl.solverIndex[a], impl.solverIndex[b], state_.bodies.valueAt(a),
                   state_.bodies.valueAt(b), round(pair.a), round(pair.b), state_.settings.bounceThreshold);
    }
  }
}

template <Scalar S>
void Space<S>::softSolve() {
  SoftSolver<S>& soft = impl_->soft;
  for (int i = 0; i < state_.settings.substeps; ++i) soft.step();
  soft.bounce();
  soft.store(state_.pairs);
  endStage(Stage::solve);
}

template <Scalar S>
void Space<S>::softFinish(S dt) {
  Impl& impl = *impl_;
  for (std::size_t i = 1; i < impl.solverBodies.size(); ++i) {
    const std::uint32_t index = impl.solverBodies[i];
    Body<S>& body = state_.bodies.valueAt(index);
    const SoftBody<S>& solved = impl.soft.bodies[i];
    if (body.isDynamic()) {
      impl.held[index] |=
          body.holdVelocity({{solved.velocity[0], solved.velocity[1]}, solved.velocity[2]});
    }
    if (body.positionFunc() != 0) [[unlikely]] {
      callPositionFunc(index, dt);
    } else {
      impl.held[index] |=
          body.holdMoved({solved.moved[0], solved.moved[1]}, solved.moved[2], worldExtent());
    }
  }
  endStage(Stage::integratePositions);
}

#ifndef SAMESTEP_FIXED_ONLY
template class Space<double>;
#endif
template class Space<Fixed>;
template class Space<CheckedFixed>;

}  // namespace samestep
