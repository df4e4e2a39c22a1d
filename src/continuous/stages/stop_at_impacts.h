// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/time_of_impact.h>

#include "context/step_context.h"

namespace samestep {

/// The stage that stops bodies that went far where they first met something: docs/continuous.md. Each body is
/// followed by itself, from where it and all others began and ended; what becomes of one changes nothing for
/// another but in the second pass, in which bullets meet what contacts move.
template <Scalar S>
class StopAtImpacts {
 public:
  /// Stops them, once the shapes are placed where their bodies ended.
  void run(StepContext<S>& step);
  /// Tells of the sensors that were passed, as of pairs that touch from this step on.
  void tellSeen(StepContext<S>& step);
  /// Takes away the pairs that were made in a step that is refused.
  void takeBack(StepContext<S>& step);

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  /// Things that a body is taken along by, one after the other, in a step.
  static constexpr int kMaxRides = 4;

  /// A shape that moves, with a box around its whole way.
  struct Mover {
    std::uint32_t shape, body;
    BB<S> around;
  };
  /// A body that is followed.
  struct Subject {
    std::uint32_t body = kNone;
    bool isBullet = false;
    bool moved = false;  ///< True if it ends elsewhere than the solver had it.
    Vector<S> center{};
    S angle{};
  };
  /// The first thing that a body meets.
  struct Hit {
    std::uint32_t own = kNone, other = kNone;
    Impact<S> impact{};

    bool isBetterThan(const Hit& before) const;
  };
  /// A sensor on the way, or something on the way of one.
  struct Seen {
    std::uint32_t a, b;
    std::uint32_t order;  ///< The number of those before it.
    S part{};
    Vector<S> pointA{}, pointB{}, normal{};  ///< Points in the coordinates of the bodies.
  };
  /// The part of a body's way that is looked at.
  struct Leg {
    RigidMotion<S> motion;
    S begins{};  ///< Part of the step that is over by then.
  };

  void takeMovers(StepContext<S>& step);
  void takeSubjects(StepContext<S>& step);
  void takeBullets(StepContext<S>& step);
  bool isOvertaken(StepContext<S>& step, std::uint32_t body) const;
  void follow(StepContext<S>& step, Subject& subject);
  Hit firstHit(StepContext<S>& step, const Subject& subject, const Leg& leg);
  void meet(StepContext<S>& step, const Subject& subject, const Leg& leg, std::uint32_t own,
            std::uint32_t other, Hit& first);
  bool isAccepted(StepContext<S>& step, const Subject& subject, const Leg& leg, const Hit& hit);
  static bool mayBeAsked(StepContext<S>& step, std::uint32_t a, std::uint32_t b);
  Pair<S>* pairFor(StepContext<S>& step, std::uint32_t a, std::uint32_t b);
  void endAt(const StepContext<S>& step, Subject& subject, const RigidMotion<S>& motion, S part) const;
  void apply(StepContext<S>& step);

  RigidMotion<S> motionOf(const StepContext<S>& step, std::uint32_t body) const;
  BB<S> sweptBox(const StepContext<S>& step, std::uint32_t shape, const RigidMotion<S>& motion) const;

  std::vector<Mover> kinematics_;
  std::vector<Mover> dynamics_;  // Empty in the first pass.
  std::vector<std::uint32_t> fastKinematics_;
  std::vector<Subject> subjects_;
  std::vector<Seen> seen_;
  std::vector<std::uint64_t> made_;  // Pairs of this step, by the shapes' slots.
  // These belong to the body that is followed.
  std::vector<IndexKey> found_;
  std::vector<Seen> seenOnLeg_;
  std::vector<std::uint32_t> ridden_;
  std::vector<std::uint64_t> refused_;
  std::uint64_t tests_ = 0;
};

#define SAMESTEP_EACH_SCALAR extern template class StopAtImpacts<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
