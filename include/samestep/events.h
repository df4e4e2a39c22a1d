// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <samestep/arbiter.h>
#include <samestep/body.h>
#include <samestep/id.h>
#include <samestep/joint.h>

namespace samestep {

/// Functions of a collision handler. A null function does what the wildcard handlers of both shapes do, or
/// nothing. begin and preSolve answer whether the shapes shall collide: begin for as long as they touch,
/// preSolve for this step. What they throw comes out of the step or removal and leaves the world midway, see
/// Space; so it is with the functions and the observer below.
///
/// Shapes touch in a step that finds them overlapping or just meeting, to 2^-20 m, or, in the soft step, in
/// which their contact pushes; shapes that are only within Settings::contactMargin do not. begin is called
/// once in the first such step, preSolve in each, postSolve in each in which the pair was solved, and
/// separate once in the first step in which they do not touch, or when one of them goes. Every begin has its
/// separate. begin and preSolve are called before an impulse acts: pairs for which somebody has one of the
/// two are solved from the step on that finds them touching, others also before they touch, within the
/// margin.
template <Scalar S>
struct CollisionHandler {
  bool (*begin)(Arbiter<S>&, Space<S>&, void* data) = nullptr;
  bool (*preSolve)(Arbiter<S>&, Space<S>&, void* data) = nullptr;
  void (*postSolve)(Arbiter<S>&, Space<S>&, void* data) = nullptr;
  void (*separate)(Arbiter<S>&, Space<S>&, void* data) = nullptr;
  void* data = nullptr;
};

/// Function that moves a body in place of its velocity. MIS: bodySetPositionFunc
template <Scalar S>
using BodyPositionFunc = void (*)(Body<S>& body, S dt, void* data);
/// Function that changes a body's velocity in place of gravity, force and torque. MIS: bodySetVelocityFunc
template <Scalar S>
using BodyVelocityFunc = void (*)(Body<S>& body, const Vector<S>& gravity, S damping, S dt, void* data);

/// A value that had to be held at its limit during the last step.
struct RangeEvent {
  BodyId body;
  std::uint8_t held = 0;  ///< Bits of Body::Held.
};

/// Two shapes that began to touch, or ceased to: where begin and separate of a handler are called, or would
/// be if there were one. A has the lower id.
struct ContactEvent {
  ShapeId shapeA;
  ShapeId shapeB;
  BodyId bodyA;
  BodyId bodyB;
  std::uint8_t sensor = 0;   ///< 1 where one of the shapes is a sensor.
  std::uint8_t removal = 0;  ///< 1 of an end that a call between steps brought about: the shapes may be gone.

  friend constexpr bool operator==(const ContactEvent&, const ContactEvent&) = default;
};

/// Two shapes that struck each other: their contact was pushed in the step, at points that approached.
template <Scalar S>
struct ImpactEvent {
  ShapeId shapeA;
  ShapeId shapeB;
  BodyId bodyA;
  BodyId bodyB;
  Vector<S> point{};   ///< On the surface of A, of the contact point that approached fastest, m.
  Vector<S> normal{};  ///< Unit vector from A to B.
  S speed{};           ///< At which it approached when the step began, m/s.
  S impulse{};         ///< Impulse along the normal on B, of all points in the step, N s, saturated.

  friend constexpr bool operator==(const ImpactEvent&, const ImpactEvent&) = default;
};

/// Change of a joint in a step.
enum class JointChange : std::uint8_t {
  broke = 0,         ///< It is gone: its force or torque was more than it bears.
  reachedLower = 1,  ///< Its lower limit holds, and did not in the step before.
  reachedUpper = 2,
};

template <Scalar S>
struct JointEvent {
  JointId joint;
  BodyId bodyA;
  BodyId bodyB;
  JointChange change = JointChange::broke;
  std::uint64_t userData = 0;
  /// Force and torque on B in the step, N and N m.
  Vector<S> force{};
  S torque{};

  friend constexpr bool operator==(const JointEvent&, const JointEvent&) = default;
};

/// Events of contacts and joints that a Space lists: none at first, which costs nothing.
template <Scalar S>
struct EventListing {
  bool contacts = false;  ///< Lists contacts that began and that ended.
  bool impacts = false;
  S slowestImpact{1};  ///< Slower impacts are not listed, m/s, 0 to 2^11.
  bool joints = false;
};

/// Contact events of the last step, by rising ids of A and B.
template <Scalar S>
struct ContactEvents {
  std::uint64_t tick = 0;  ///< Space::stamp() after that step; 0 where none has been listed.
  std::span<const ContactEvent> begins;
  /// Contacts that ended, those included that calls between the steps ended: a shape removed, contacts
  /// filtered.
  std::span<const ContactEvent> ends;
  std::span<const ImpactEvent<S>> impacts;
};

/// The stages of a step. Sequential impulses make them in this order; the soft step integrates velocities
/// while it solves, and positions after that, and so places the shapes last.
enum class Stage : std::uint8_t {
  integratePositions,
  updateShapes,
  findPairs,
  collide,
  preStep,
  integrateVelocities,
  solve,
  callbacks,
};
const char* stageName(Stage stage);

/// Function that is called after each stage of a step.
template <Scalar S>
using StageObserverFunc = void (*)(const Space<S>& space, Stage stage, void* data);

}  // namespace samestep
