// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <samestep/body.h>
#include <samestep/collision.h>
#include <samestep/id.h>
#include <samestep/shape.h>

namespace samestep {

template <Scalar S>
struct ContactCallbacks;

/// State of the contact of two shapes. MIS: ArbiterState
enum class ArbiterState : std::uint8_t {
  apart = 0,           ///< The boxes overlap, the shapes have not touched yet.
  firstCollision = 1,  ///< Touching since this step.
  normal = 2,          ///< Touching for longer.
  ignored = 3,         ///< Ignored until the shapes separate.
  cached = 4,          ///< Touched lately; the impulses are kept for a while.
};

/// One contact point of a pair, as it is kept from step to step.
template <Scalar S>
struct Contact {
  /// Anchors on the surface of each shape, in the coordinates of its body: where the body goes, the point
  /// goes.
  Vector<S> anchorA{};
  Vector<S> anchorB{};
  /// The accumulated impulses along the normal and its left perpendicular, as the change of speed they give
  /// the lighter body, m/s: at full precision whatever the masses are.
  S normalSpeed{};
  S tangentSpeed{};
  /// The whole impulses of the last step in the same measure: with substeps the sums over all of them. No
  /// state: only callbacks and visits read them.
  S normalTotal{};
  S tangentTotal{};
  /// Identity of the features that touch; it tells which point of the last step this one continues.
  std::uint32_t feature = 0;
  std::uint32_t unused = 0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("anchorA", self.anchorA);
    visit("anchorB", self.anchorB);
    visit("normalSpeed", self.normalSpeed);
    visit("tangentSpeed", self.tangentSpeed);
    visit("feature", self.feature);
  }
};

/// Pose of one body relative to another when their shapes were collided: enough to tell whether it still
/// holds.
struct RelativePose {
  /// Its origin in the other's coordinates, in units of 2^-16 m toward zero, modulo 2^16 m.
  std::int32_t x = 0;
  std::int32_t y = 0;
  /// The smaller in size of cosine and sine of its angle to the other, in units of 2^-29 toward zero, times
  /// 4; plus 2 if it is the sine, plus 1 if the other one is negative.
  std::uint32_t turn = 0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x", self.x);
    visit("y", self.y);
    visit("turn", self.turn);
  }
};

/// Rotation of a body when a contact of its was collided: cosine and sine in units of 2^-30 toward zero; 0
/// where nothing was.
struct KeptRotation {
  std::int32_t x = 0;
  std::int32_t y = 0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x", self.x);
    visit("y", self.y);
  }
  friend bool operator==(const KeptRotation&, const KeptRotation&) = default;
};

/// Recycling state of a pair: what is known from the last time it was collided.
enum class Manifold : std::uint8_t {
  unknown = 0,   ///< Nothing that holds: to be collided in any case.
  touching = 1,  ///< Normal and points hold while the bodies stand as in `pose`, if they touched last.
  apart = 2,     ///< The shapes do not touch while the bodies stand as in `pose`.
};

/// The state of a pair of shapes whose boxes overlap: the lower id is a. A new one stands apart.
/// MIS: arbiterInit
template <Scalar S>
struct Pair {
  // First what every step asks of every pair: it shares a cache line.

  /// The state has only the slots: a shape that goes takes its pairs with it.
  LocalId<ShapeTag> a{};
  LocalId<ShapeTag> b{};
  /// Pose of the smaller shape's body relative to the other's when the shapes were collided.
  RelativePose pose{};
  /// Start of the closest-feature search of the next step.
  CollisionId collisionId = 0;
  /// Steps since the shapes last touched, saturated; 0 while they stand apart.
  std::uint32_t age = 0;
  std::uint8_t count = 0;
  ArbiterState state = ArbiterState::apart;
  Manifold manifold = Manifold::unknown;
  /// 1 if this step solves the pair: touching, wanted by its callbacks, no sensor. No state.
  std::uint8_t solved = 0;
  /// Normal from a to b, a unit vector in the coordinates of a's body.
  Vector<S> localNormal{};
  /// Rotations of the bodies as the soft step takes them for the normal and the arms of the contact: those of
  /// the last collision, until a body has turned too far from there.
  KeptRotation rotationA{};
  KeptRotation rotationB{};
  Contact<S> contacts[kMaxContactsPerPair]{};
  /// Restitution for this step, from the shapes or from Arbiter's setters. No state.
  S elasticity{};
  S friction{};
  Vector<S> surfaceVelocity{};
  /// Result of the solver in the last step, 0 where nothing was solved. No state: only callbacks and visits
  /// read it. The impulse on b, as the change of speed of the lighter body, m/s; along which normal, from a
  /// to b in the world; and how b's body stood turned then (cosine, sine).
  Vector<S> solvedImpulse{};
  Vector<S> solvedNormal{};
  Vector<S> solvedTurn{};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("a", self.a.index);
    visit("b", self.b.index);
    visit("localNormal", self.localNormal);
    visit("contact[0]", self.contacts[0]);
    visit("contact[1]", self.contacts[1]);
    visit("rotationA", self.rotationA);
    visit("rotationB", self.rotationB);
    visit("pose", self.pose);
    visit("collisionId", self.collisionId);
    visit("age", self.age);
    visit("count", self.count);
    visit("state", self.state);
    visit("manifold", self.manifold);
  }
  /// The order of a world's list, by the slots of both shapes.
  static bool before(const Pair& x, const Pair& y) {
    return x.a.index != y.a.index ? x.a.index < y.a.index : x.b.index < y.b.index;
  }
};

/// Two touching shapes, as a callback sees them. MIS section 7.
///
/// Valid only during the callback or visit it was handed to. A and B are in the order of the handler's
/// collision types, else in the order of their ids; the normal points from A to B.
template <Scalar S>
class Arbiter {
 public:
  Arbiter(Pair<S>& pair, Body<S>& bodyA, Body<S>& bodyB, const Shape<S>& shapeA, const Shape<S>& shapeB)
      : pair_(pair), bodies_{&bodyA, &bodyB}, shapes_{&shapeA, &shapeB} {}

  /// The shapes. MIS: arbiterGetShapes
  ShapeId shapeA() const { return shapeDataA().id(); }
  ShapeId shapeB() const { return shapeDataB().id(); }
  const Shape<S>& shapeDataA() const { return *shapes_[swapped_ ? 1 : 0]; }
  const Shape<S>& shapeDataB() const { return *shapes_[swapped_ ? 0 : 1]; }
  /// The bodies. MIS: arbiterGetBodies
  BodyId bodyA() const { return bodyDataA().id(); }
  BodyId bodyB() const { return bodyDataB().id(); }
  const Body<S>& bodyDataA() const { return *bodies_[swapped_ ? 1 : 0]; }
  const Body<S>& bodyDataB() const { return *bodies_[swapped_ ? 0 : 1]; }

  /// MIS: arbiterGetRestitution
  S restitution() const { return pair_.elasticity; }
  /// MIS: arbiterGetFriction
  S friction() const { return pair_.friction; }
  /// Velocity of the surface of B against A, m/s. MIS: arbiterGetSurfaceVelocity
  Vector<S> surfaceVelocity() const { return swapped_ ? -pair_.surfaceVelocity : pair_.surfaceVelocity; }
  /// Sets the restitution for this step only; the next collision computes it from the shapes again.
  /// @throws NegativeElasticity, ValueOutOfRange
  /// MIS: arbiterSetRestitution
  void setRestitution(S restitution);
  /// Sets the friction for this step only.
  /// @throws NegativeFriction, ValueOutOfRange
  /// MIS: arbiterSetFriction
  void setFriction(S friction);
  /// Sets the surface velocity for this step only.
  /// @throws ValueOutOfRange
  /// MIS: arbiterSetSurfaceVelocity
  void setSurfaceVelocity(const Vector<S>& velocity);

  /// Number of contact points: 1 or 2, or 0 in separate. MIS: arbiterGetCount
  int count() const { return pair_.state == ArbiterState::cached ? 0 : pair_.count; }
  /// Contact normal from A to B, a unit vector: in postSolve and in visits between steps the one that the
  /// solver pushed along, before that the one the shapes were collided with, which follows A. MIS:
  /// arbiterGetNormal
  Vector<S> normal() const;
  /// On the surface of A, world coordinates, m: it goes where A goes since the shapes were last collided, and
  /// stands where A stands now; where A is rounded, it stays on the side towards the normal, however A turns.
  /// @throws ContactIndexOutOfBounds
  /// MIS: arbiterGetPointA
  Vector<S> pointA(int index) const;
  /// @throws ContactIndexOutOfBounds
  /// MIS: arbiterGetPointB
  Vector<S> pointB(int index) const;
  /// Separation along the normal, where the bodies stand now, m; negative where the shapes overlap.
  /// @throws ContactIndexOutOfBounds
  /// MIS: arbiterGetDepth
  S depth(int index) const;
  /// MIS: arbiterGetContactPointSet
  ContactPointSet<S> contactPointSet() const;
  /// Replaces normal and points for this step; the next one collides the shapes again.
  /// @throws ImmutableNumContacts, ValueOutOfRange for a normal that is no unit vector, a point out of the
  /// world, or one more than 2^10 m from the centre of mass of a body that moves, along either axis
  /// MIS: arbiterSetContactPointSet
  void setContactPointSet(const ContactPointSet<S>& set);

  /// True if the shapes began to touch in this step. MIS: arbiterIsFirstContact
  bool isFirstContact() const { return pair_.state == ArbiterState::firstCollision; }
  /// True if separate is called because a shape is being removed. MIS: arbiterIsRemoval
  bool isRemoval() const { return removal_; }
  /// Lets the shapes pass through each other until they separate. Returns false, so that a callback can end
  /// with it. MIS: arbiterIgnore
  bool ignore() {
    pair_.state = ArbiterState::ignored;
    return false;
  }
  bool ignored() const { return pair_.state == ArbiterState::ignored; }

  /// The impulse of the last step on B, friction included, N s, saturated: what the contact changed of B's
  /// momentum, and of A's with the other sign, all substeps together. It is a result and no state: 0 in a
  /// step until it is solved, so in begin, preSolve and separate, and 0 after a restore or load until the
  /// next step. MIS: arbiterTotalImpulse
  Vector<S> totalImpulse() const;
  /// Sum over the points of jn^2 / nMass (1 - e) / (1 + e) + jt^2 / tMass, as in Chipmunk: twice what an
  /// impact takes from the kinetic energy, J, saturated; 0 where nothing was solved.
  /// @throws UnsolvableCollision if nothing moves either body any more
  /// MIS: arbiterTotalKE
  S totalKE() const;

  /// The state behind it.
  const Pair<S>& pair() const { return pair_; }

 private:
  friend struct ContactCallbacks<S>;

  bool isSolved() const { return pair_.solvedNormal != Vector<S>(); }
  /// Normal from the first body of the pair to the second.
  Vector<S> pairNormal() const;
  /// Point on the surface of the first or the second body.
  Vector<S> surfacePoint(int body, int index) const;

  Pair<S>& pair_;
  Body<S>* bodies_[2];
  const Shape<S>* shapes_[2];
  bool swapped_ = false;
  bool removal_ = false;
};

#define SAMESTEP_EACH_SCALAR extern template class Arbiter<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
