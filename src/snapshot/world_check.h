// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/state.h>

#include "contacts/contact_geometry.h"
#include "contacts/contact_row.h"

namespace samestep {

/// True if the settings of sleeping are those a Space may have.
template <Scalar S>
bool flawlessRest(const Settings<S>& settings) {
  return settings.sleepTimeThreshold >= S(0) && settings.sleepTimeThreshold <= kMaxRestTime<S> &&
         settings.idleSpeedThreshold >= S(0) && settings.idleSpeedThreshold <= kMaxSpeed<S>;
}

template <Scalar S>
const char* flawOfSettings(const Settings<S>& settings) {
  const auto in = [](S value, S low, S high) { return value >= low && value <= high; };
  const bool both = settings.solver <= SolverKind::softStep && settings.precision <= ContactPrecision::fast &&
                    settings.continuous <= 1 && within(settings.gravity, kMaxAcceleration<S>) &&
                    in(settings.damping, S(0), S(1)) && settings.worldExtent > S(0) &&
                    settings.worldExtent <= kMaxWorldExtent<S> && flawlessRest(settings);
  const bool sequential = settings.iterations >= 1 && settings.iterations <= 1000 &&
                          in(settings.collisionSlop, S(0), S(256)) && in(settings.collisionBias, S(0), S(1));
  const S fastest = kMaxSpeed<S>;
  const bool soft = settings.substeps >= 1 && settings.substeps <= 100 &&
                    in(settings.contactHertz, S(0), S(1000)) && in(settings.contactDamping, S(0), S(100)) &&
                    in(settings.contactPushSpeed, S(0), fastest) && in(settings.contactMargin, S(0), S(1)) &&
                    in(settings.bounceThreshold, S(0), fastest);
  return both && sequential && soft ? nullptr : "a setting is out of range";
}

template <Scalar S>
const char* flawOfContact(const Contact<S>& contact) {
  // Points of shapes at the end of their range, and those a callback may have set.
  const S far = S(1 << 23);
  // A push of the soft step, and what friction may make of it.
  const bool kept = contact.normalSpeed >= S(0) && contact.normalSpeed <= kMaxSum<S> &&
                    contact.tangentSpeed > -kMaxForce<S> && contact.tangentSpeed < kMaxForce<S>;
  const bool good = within(contact.anchorA, far) && within(contact.anchorB, far) && kept;
  return good ? nullptr : "a contact is out of range";
}

/// Flaw of a normal and points that the next step may solve without colliding the shapes again.
template <Scalar S>
const char* flawOfKept(const Pair<S>& pair) {
  const S far = S(2 * kMaxExtent), slack = ratio<S>(1, 64);
  const auto isUnit = [&](S lengthSquared) {
    return lengthSquared >= S(1) - slack && lengthSquared <= S(1) + slack;
  };
  bool good = pair.count > 0 && isUnit(lengthSq(pair.localNormal)) &&
              isUnit(lengthSq(rotationOf<S>(pair.rotationA))) &&
              isUnit(lengthSq(rotationOf<S>(pair.rotationB)));
  for (const Contact<S>& contact : pair.contacts) {
    good = good && within(contact.anchorA, far) && within(contact.anchorB, far);
  }
  return good ? nullptr : "a contact that is kept is out of range";
}

/// Finds what makes fields and records of a world ones that no Space could have. Each kind of field and
/// record has its flawOf, which answers the reason or null.
template <Scalar S>
class WorldCheck {
 public:
  /// @param world  its bodies are read before shapes are checked, and its shapes before pairs
  WorldCheck(const WorldState<S>& world, const WorldLimits& limits) : world_(world), limits_(limits) {}

  const char* flawOf(const Settings<S>& settings) const {
    if (const char* flaw = flawOfSettings(settings)) return flaw;
    if (static_cast<std::uint32_t>(settings.iterations) > limits_.iterations) {
      return "more iterations than allowed";
    }
    const bool few = static_cast<std::uint32_t>(settings.substeps) <= limits_.substeps;
    return few ? nullptr : "more substeps than allowed";
  }
  /// The count of steps: any is one that a Space can reach.
  const char* flawOf(std::uint64_t) const { return nullptr; }
  const char* flawOf(S timeStep) const {
    const bool good = timeStep >= S(0) && timeStep <= kMaxTimeStep<S>;
    return good ? nullptr : "the time step is out of range";
  }
  const char* flawOf(BodyId staticBody) const {
    const Body<S>* body = world_.bodies.find(staticBody);
    const bool good = body != nullptr && body->type() == BodyType::staticBody;
    return good ? nullptr : "there is no static body";
  }

  const char* flawOf(BodyId id, const Body<S>& body) const {
    return body.wellFormed() && body.island() <= id.index + 1 ? nullptr : "a body is malformed";
  }
  /// @param shape  stays where it is as long as this object lives
  const char* flawOf(ShapeId id, const Shape<S>& shape);
  const char* flawOf(const Pair<S>& pair) const;
  const char* flawOf(JointId, const Joint<S>& joint) const {
    if (flawOfJoint(joint) != nullptr) return "a joint is out of range";
    const bool both = world_.bodies.contains(joint.bodyA) && world_.bodies.contains(joint.bodyB);
    if (!both) return "a joint is on a body that does not exist";
    return joint.bodyA == joint.bodyB ? "a joint is of one body" : nullptr;
  }
  /// Flaw of both lists of pairs, when they are read.
  const char* flawOfRest() const;
  const char* flawOf(const HandlerBinding& binding) const {
    const bool good = binding.kind <= HandlerBinding::Kind::fallback && binding.number != 0;
    return good ? nullptr : "a handler is malformed";
  }

 private:
  bool hasGoodGeometry(const Shape<S>& shape);

  const WorldState<S>& world_;
  const WorldLimits& limits_;
  // Worlds have many shapes of one geometry in a row, which is then looked at once.
  const Shape<S>* last_ = nullptr;
  S extent_{};
};

template <Scalar S>
const char* WorldCheck<S>::flawOf(ShapeId id, const Shape<S>& shape) {
  if (shape.id() != id) return "a shape has another's id";
  if (!shape.surfaceWellFormed() || !hasGoodGeometry(shape)) return "a shape is malformed";
  const Body<S>* body = world_.bodies.find(shape.body());
  if (body == nullptr) return "a shape is on a body that does not exist";
  if (body->type() != BodyType::staticBody && extent_ > S(kMaxDynamicExtent)) {
    return "a shape of a moving body is too large";
  }
  return nullptr;
}

template <Scalar S>
bool WorldCheck<S>::hasGoodGeometry(const Shape<S>& shape) {
  if (last_ != nullptr && shape.sameGeometry(*last_)) return true;
  if (!shape.geometryWellFormed()) return false;
  last_ = &shape;
  extent_ = shape.extent();
  return true;
}

template <Scalar S>
const char* WorldCheck<S>::flawOf(const Pair<S>& pair) const {
  const Shape<S>* a = world_.shapes.find(pair.a);
  const Shape<S>* b = world_.shapes.find(pair.b);
  if (a == nullptr || b == nullptr) return "a pair names a shape that does not exist";
  if (a->body() == b->body()) return "a pair is of one body";
  if (pair.count > kMaxContactsPerPair || pair.state > ArbiterState::cached ||
      pair.manifold > Manifold::apart) {
    return "a pair is malformed";
  }
  if (!within(pair.localNormal, ratio<S>(1026, 1024))) return "a pair is out of range";
  for (const Contact<S>& contact : pair.contacts) {
    if (const char* flaw = flawOfContact(contact)) return flaw;
  }
  return pair.manifold == Manifold::touching ? flawOfKept(pair) : nullptr;
}

template <Scalar S>
const char* WorldCheck<S>::flawOfRest() const {
  const auto rests = [&](ShapeId shape) {
    const std::uint32_t body = world_.shapes.valueAt(shape.index).body().index;
    return world_.bodies.valueAt(body).activity() == Activity::asleep;
  };
  auto resting = world_.restingPairs.begin();
  for (const Pair<S>& pair : world_.pairs) {
    if (rests(pair.a) && rests(pair.b)) return "a pair rests among those that do not";
    while (resting != world_.restingPairs.end() && Pair<S>::before(*resting, pair)) ++resting;
    if (resting != world_.restingPairs.end() && !Pair<S>::before(pair, *resting))
      return "a pair is there twice";
  }
  return nullptr;
}

/// Looks for the first flaw of a whole world.
template <Scalar S>
class WorldFlaw {
 public:
  WorldFlaw(const WorldState<S>& world, const WorldLimits& limits) : check_(world, limits), limits_(limits) {}

  template <class T>
  void operator()(const char*, const T& field) {
    if (found == nullptr) found = check_.flawOf(field);
  }
  template <class T, class IdType>
  void operator()(const Section& section, const SlotMap<T, IdType>& records) {
    if (found == nullptr && records.slots() > limits_.*section.limit) found = section.tooMany;
    if (found != nullptr) return;
    records.each([&](IdType id, const T& record) {
      if (found == nullptr) found = check_.flawOf(id, record);
    });
  }
  template <class T>
  void operator()(const Section& section, const std::vector<T>& records) {
    if (found == nullptr && records.size() > limits_.*section.limit) found = section.tooMany;
    const T* before = nullptr;
    for (const T& record : records) {
      if (found != nullptr) return;
      found = check_.flawOf(record);
      if (found == nullptr && before != nullptr && !T::before(*before, record)) found = kNotInOrder;
      before = &record;
    }
  }

  /// Checks what needs all sections to have been visited.
  void finish() {
    if (found == nullptr) found = check_.flawOfRest();
  }

  static constexpr const char* kNotInOrder = "a list is not in order";
  const char* found = nullptr;

 private:
  WorldCheck<S> check_;
  const WorldLimits& limits_;
};

}  // namespace samestep
