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
  soft.rows.clear();
  impl.groups.clear(state_.bodies.slots());
  impl.solvedPairs.clear();
  const auto bodyIndex = [&](ShapeId id) { return state_.shapes.valueAt(id.index).body().index; };
  const auto round = [&](ShapeId id) { return state_.shapes.valueAt(id.index).type() == ShapeType::circle; };
  for (std::uint32_t i = 0; i < state_.pairs.size(); ++i) {
    const Pair<S>& pair = state_.pairs[i];
    if (pair.solved == 0) continue;
    const std::uint32_t a = bodyIndex(pair.a);
    const std::uint32_t b = bodyIndex(pair.b);
    impl.solvedPairs.push_back(i);
    impl.groups.add(a, state_.bodies.valueAt(a).isDynamic(), b, state_.bodies.valueAt(b).isDynamic());
  }
  impl.groups.sort(impl.groupOrder);
  impl.solverBodies.clear();
  impl.solverIndex.assign(state_.bodies.slots(), Impl::kNone);
  // By rising slot: what is added together is near in memory.
  for (std::uint32_t i = 0; i < state_.bodies.slots(); ++i) {
    if (state_.bodies.aliveAt(i)) impl.solverIndexOf(i);
  }
  for (const std::uint32_t ordinal : impl.groupOrder) {
    const std::uint32_t index = impl.solvedPairs[ordinal];
    const Pair<S>& pair = state_.pairs[index];
    const std::uint32_t a = bodyIndex(pair.a);
    const std::uint32_t b = bodyIndex(pair.b);
    soft.preStep(pair, index, impl.solverIndex[a], impl.solverIndex[b], state_.bodies.valueAt(a),
                 state_.bodies.valueAt(b), round(pair.a), round(pair.b), settings.bounceThreshold);
  }

  soft.substep = dt / S(settings.substeps);
  soft.perSubstep = reciprocal(max(soft.substep, ratio<S>(1, 1 << 14)));
  soft.pushSpeed = settings.contactPushSpeed;
  soft.kept = damping() == S(1) ? S(1) : pow(damping(), soft.substep);
  const S hertz = min(settings.contactHertz, soft.perSubstep * ratio<S>(1, 4));
  soft.softness[0] = makeSoftness(hertz, settings.contactDamping, soft.substep);
  soft.softness[1] = makeSoftness(S(2) * hertz, settings.contactDamping, soft.substep);

  soft.bodies.clear();
  soft.drives.clear();
  for (const std::uint32_t index : impl.solverBodies) {
    Body<S>& body = state_.bodies.valueAt(index);
    SoftDrive<S> drive;
    if (body.type() == BodyType::staticBody) {
      // Nothing moves it, and no function is asked to.
    } else if (body.velocityFunc() != 0) [[unlikely]] {
      callVelocityFunc(index, damping() == S(1) ? S(1) : pow(damping(), dt), dt);
    } else if (body.isDynamic()) {
      const typename Body<S>::Motion motion = body.acceleration(gravity());
      drive.velocity = motion.velocity * soft.substep;
      drive.angularVelocity = motion.angularVelocity * soft.substep;
    }
    soft.bodies.push_back({body.velocity_, body.angularVelocity_, {}, S(0), S(0)});
    soft.drives.push_back(drive);
    body.force_ = {};
    body.torque_ = S(0);
  }
  endStage(Stage::preStep);
}

template <Scalar S>
void Space<S>::softSolve() {
  Impl& impl = *impl_;
  SoftSolver<S>& soft = impl.soft;
  for (int i = 0; i < state_.settings.substeps; ++i) {
    soft.integrateVelocities();
    soft.warmStart();
    soft.solve();
    soft.integratePositions();
    soft.relax();
    soft.sum();
  }
  soft.bounce();

  for (const SoftRow<S>& row : soft.rows) {
    Contact<S>& contact = state_.pairs[row.pair].contacts[row.contact];
    contact.normalSpeed = row.normalSum * row.normalScale;
    contact.tangentSpeed = row.tangentSum * row.tangentScale;
    contact.normalTotal = min(row.normalTotal, kMaxSum<S>) * row.normalScale;
    contact.tangentTotal = clamp(row.tangentTotal, -kMaxSum<S>, kMaxSum<S>) * row.tangentScale;
  }
  endStage(Stage::solve);
}

template <Scalar S>
void Space<S>::softFinish(S dt) {
  Impl& impl = *impl_;
  for (std::size_t i = 0; i < impl.solverBodies.size(); ++i) {
    const std::uint32_t index = impl.solverBodies[i];
    Body<S>& body = state_.bodies.valueAt(index);
    if (body.type() == BodyType::staticBody) continue;
    const SoftBody<S>& solved = impl.soft.bodies[i];
    if (body.isDynamic()) impl.held[index] |= body.holdVelocity({solved.velocity, solved.angularVelocity});
    if (body.positionFunc() != 0) [[unlikely]] {
      callPositionFunc(index, dt);
    } else {
      impl.held[index] |= body.holdMoved(solved.moved, solved.turned, worldExtent());
    }
  }
  endStage(Stage::integratePositions);
}

#ifndef SAMESTEP_FIXED_ONLY
template class Space<double>;
#endif
template class Space<Fixed>;
template class Space<CheckedFixed>;
void file_of::spaceSoftStep() {}

}  // namespace samestep
