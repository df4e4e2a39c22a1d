// SPDX-License-Identifier: MIT
#pragma once

#include <samestep/expects.h>

#include "context/step_context.h"

namespace samestep {

/// States what each stage of a step leaves to those after it. Checked in builds with SAMESTEP_EXPECTS.
template <Scalar S>
class StageExpectations {
 public:
  static void after(Stage stage, const StepContext<S>& step) {
    switch (stage) {
      case Stage::updateShapes:
        return expectPlacedShapes(step);
      case Stage::findPairs:
        return expectPairs(step);
      case Stage::collide:
      case Stage::preStep:
        expectPairs(step);
        return expectContacts(step);
      case Stage::integratePositions:
      case Stage::integrateVelocities:
      case Stage::solve:
      case Stage::callbacks:
        return expectBodies(step);
    }
  }

 private:
  /// Shapes stand where their bodies do.
  static void expectPlacedShapes(const StepContext<S>& step) {
    expects(step.derived.cached && step.derived.poses.size() == step.state.bodies.slots());
    step.state.bodies.each([&](BodyId id, const Body<S>& body) {
      const bool bare = step.derived.firstShape[id.index] == Derived<S>::kNone;
      expects(bare || step.derived.poses[id.index] == PlacedPose<S>::of(body));
    });
  }

  /// Pairs are in order, each once, and name shapes of two bodies.
  static void expectPairs(const StepContext<S>& step) {
    const Pair<S>* before = nullptr;
    for (const Pair<S>& pair : step.state.pairs) {
      expects(before == nullptr || Pair<S>::before(*before, pair));
      before = &pair;
      expects(step.state.shapes.contains(pair.a) && step.state.shapes.contains(pair.b));
      expects(bodyOf(step, pair.a).id() != bodyOf(step, pair.b).id());
    }
  }

  /// Expects of contacts to be solved that they touch, in points whose normal is one, and move something.
  static void expectContacts(const StepContext<S>& step) {
    const S slack = ratio<S>(1, 64);
    for (const Pair<S>& pair : step.state.pairs) {
      expects(pair.count <= kMaxContactsPerPair && pair.state <= ArbiterState::cached);
      if (pair.solved == 0) continue;
      expects(pair.count > 0 && pair.state != ArbiterState::ignored);
      expects(bodyOf(step, pair.a).isDynamic() || bodyOf(step, pair.b).isDynamic());
      // A sleeper that is touched was woken.
      for (const ShapeId shape : {ShapeId(pair.a), ShapeId(pair.b)}) {
        expects(step.derived.sleeps[bodyOf(step, shape).id().index] == 0);
      }
      const S unit = lengthSq(pair.localNormal);
      expects(unit >= S(1) - slack && unit <= S(1) + slack);
    }
  }

  /// Bodies are such that a snapshot of them could be read.
  static void expectBodies(const StepContext<S>& step) {
    step.state.bodies.each([](BodyId, const Body<S>& body) { expects(body.wellFormed()); });
  }

  static const Body<S>& bodyOf(const StepContext<S>& step, ShapeId shape) {
    return step.state.bodies.valueAt(step.state.shapes.valueAt(shape.index).body().index);
  }
};

}  // namespace samestep
