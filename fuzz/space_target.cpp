// SPDX-License-Identifier: MIT
// Sequences of operations on a Space, with both solvers: what is refused changes nothing, what is accepted
// keeps every invariant, overflows nowhere, and happens again in the same way.
#include <samestep/space.h>

#include <algorithm>
#include <vector>

#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>
#include <samestep/space_codec.h>

#include "cases.h"
#include "check.h"
#include "input.h"

namespace samestep::fuzz {
namespace {

constexpr std::size_t kMostBodies = 12;
constexpr std::size_t kMostShapes = 24;
constexpr std::uint32_t kMostJoints = 16;
constexpr int kMostOperations = 48;
constexpr int kMostSteps = 40;

/// Model of what the world should hold.
struct Model {
  struct ShapeEntry {
    ShapeId id;
    BodyId body;
  };
  std::vector<BodyId> bodies;
  std::vector<ShapeEntry> shapes;
  std::vector<BodyId> deadBodies;
  std::vector<ShapeId> deadShapes;

  void forget(ShapeId id) {
    std::erase_if(shapes, [&](const ShapeEntry& entry) { return entry.id == id; });
    deadShapes.push_back(id);
  }
  void forget(BodyId id) {
    for (const ShapeEntry& entry : std::vector<ShapeEntry>(shapes)) {
      if (entry.body == id) forget(entry.id);
    }
    std::erase(bodies, id);
    deadBodies.push_back(id);
  }
};

template <Scalar S>
class World {
 public:
  /// @param checks  whether to look at everything after each operation, or at the hashes alone
  World(Input input, bool checks) : input_(input), checks_(checks) { connect(space_); }

  /// Runs the whole input. @return the hash after each operation
  const std::vector<std::uint64_t>& run() {
    before_ = space_.hash();
    for (int i = 0; i < kMostOperations && !input_.atEnd(); ++i) {
      try {
        operate(input_.word());
      } catch (const Error&) {
        // Steps may stop half-way by a callback's fault only, and ours throw nothing.
        expect(space_.hash() == before_, "what is refused changes nothing");
      }
      for (const std::uint64_t key : removedByCallbacks_) model_.forget(bodyOfKey(key));
      removedByCallbacks_.clear();
      if (checks_) check();
      before_ = space_.hash();
      hashes_.push_back(before_);
    }
    check();
    continueTwice();
    return hashes_;
  }

 private:
  struct Kept {
    SavedSpace<S> saved;
    Model model;
    bool used = false;
  };

  static std::uint64_t keyOf(BodyId id) { return std::uint64_t{id.generation} << 32 | id.index; }
  static BodyId bodyOfKey(std::uint64_t key) {
    return {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)};
  }

  S number(Fixed low, Fixed high) { return as<S>(input_.numberIn(low, high)); }
  Vector<S> vector(Fixed limit) {
    const S x = number(-limit, limit);
    return {x, number(-limit, limit)};
  }

  // ---- callbacks

  template <class Call>
  static void expectLocked(Call&& call) {
    bool refused = false;
    try {
      call();
    } catch (const SpaceLocked&) {
      refused = true;
    }
    expect(refused, "a locked Space refuses to be changed");
  }

  static bool begin(Arbiter<S>& arbiter, Space<S>& space, void*) {
    expect(space.isLocked(), "callbacks run locked");
    expectLocked([&] { space.add(Body<S>(S(1), S(1))); });
    expectLocked([&] { space.remove(arbiter.shapeA()); });
    expectLocked([&] { space.step(S(1)); });
    expectLocked([&] { static_cast<void>(space.save()); });
    arbiter.setFriction(S(1));
    return (arbiter.shapeA().index + arbiter.shapeB().index) % 7 != 0 || arbiter.ignore();
  }
  static bool preSolve(Arbiter<S>& arbiter, Space<S>& space, void*) {
    const ContactPointSet<S> points = arbiter.contactPointSet();
    expect(points.count == arbiter.count() && points.count <= kMaxContactsPerPair, "the points are counted");
    arbiter.setRestitution(S(0));
    if (space.stamp() % 5 == 0) arbiter.setContactPointSet(points);
    return space.stamp() % 3 != 0;
  }
  static void postSolve(Arbiter<S>& arbiter, Space<S>& space, void* data) {
    static_cast<void>(arbiter.totalImpulse());
    if (arbiter.bodyDataA().isDynamic() || arbiter.bodyDataB().isDynamic())
      static_cast<void>(arbiter.totalKE());
    if (space.stamp() % 11 == 0 && arbiter.bodyB() != space.staticBody()) {
      space.addPostStepCallback(&World::removeLater, keyOf(arbiter.bodyB()), data);
    }
  }
  static void separate(Arbiter<S>& arbiter, Space<S>& space, void*) {
    Body<S>& body = space.body(arbiter.bodyA());
    if (body.isDynamic()) body.setVelocity({S(1), S(2)});
  }
  static void removeLater(Space<S>& space, std::uint64_t key, void* data) {
    const BodyId id = bodyOfKey(key);
    if (!space.contains(id)) return;
    space.removeWithShapes(id);
    if (data != nullptr) static_cast<World*>(data)->removedByCallbacks_.push_back(key);
  }
  static void drift(Body<S>& body, S dt, void*) { body.updatePosition(dt); }
  static void fall(Body<S>& body, const Vector<S>& gravity, S damping, S dt, void*) {
    body.updateVelocity(-gravity, damping, dt);
  }

  void connect(Space<S>& space) {
    // A copy of the world keeps its own count of what callbacks remove: none.
    void* const data = &space == &space_ ? this : nullptr;
    space.registerHandler(1, {&World::begin, nullptr, nullptr, &World::separate, data});
    space.registerHandler(2, {nullptr, &World::preSolve, &World::postSolve, nullptr, data});
    space.registerHandler(3, {&World::begin, &World::preSolve, &World::postSolve, &World::separate, data});
    space.registerPositionFunc(1, &World::drift);
    space.registerVelocityFunc(1, &World::fall);
  }

  // ---- operations

  BodyId someBody(std::uint64_t op) {
    const std::size_t which = byteOf(op, 1);
    if (model_.bodies.empty() || which == 255) return space_.staticBody();
    if (which == 254 && !model_.deadBodies.empty()) return model_.deadBodies.back();
    return model_.bodies[which % model_.bodies.size()];
  }
  ShapeId someShape(std::uint64_t op) {
    const std::size_t which = byteOf(op, 1);
    if (model_.shapes.empty()) return {};
    if (which == 254 && !model_.deadShapes.empty()) return model_.deadShapes.back();
    return model_.shapes[which % model_.shapes.size()].id;
  }

  void operate(std::uint64_t op) {
    switch (byteOf(op, 0) % 24) {
      case 0:
      case 1:
        return addBody(op);
      case 2:
      case 3:
      case 4:
        return addShape(op);
      case 5:
        return removeSomething(op);
      case 6:
      case 7:
        return moveBody(op);
      case 8:
        return push(op);
      case 9:
        return changeShape(op);
      case 10:
      case 11:
        return changeSettings(op);
      case 12:
        return bind(op);
      case 13:
        return ask(op);
      case 14:
        return save(op);
      case 15:
        return restore(op);
      case 16:
        return housekeeping(op);
      case 17:
        return addJoint(op);
      case 18:
        return changeJoint(op);
      default:
        return step(op);
    }
  }

  void addBody(std::uint64_t op) {
    if (model_.bodies.size() >= kMostBodies) return;
    const int kind = byteOf(op, 1) % 8;
    const bool stated = (op >> 16 & 1) != 0;
    Body<S> body;
    if (kind == 0) body = Body<S>::kinematic();
    if (kind == 1) body = Body<S>::fixedInPlace();
    if (kind == 2) body = Body<S>::nonRotating(S(1));
    if (kind > 2 && stated)
      body = Body<S>(number(Fixed(0), Fixed(1000000)), number(Fixed(0), Fixed(1 << 30)));
    const bool far = byteOf(op, 3) == 255;
    body.setPosition(vector(far ? Fixed(1 << 15) : Fixed(6)));
    if (kind != 1) {
      body.setVelocity(vector(byteOf(op, 4) == 255 ? Fixed(1 << 10) : Fixed(8)));
      body.setAngularVelocity(number(Fixed(-256), Fixed(256)));
    }
    body.setAngle(number(Fixed(-4), Fixed(4)));
    body.setBullet((op >> 17 & 1) != 0);
    if (byteOf(op, 5) % 16 == 0) body.setPositionFunc(1);
    if (byteOf(op, 5) % 16 == 1) body.setVelocityFunc(1);
    if (byteOf(op, 5) % 16 == 2) body.setCenterOfMass(vector(Fixed(2)));
    model_.bodies.push_back(space_.add(body));
  }

  Shape<S> readShapeFor(BodyId body, std::uint64_t op) {
    const Fixed size = byteOf(op, 3) == 255 ? Fixed(300) : Fixed(3);
    const S radius = (op >> 17 & 1) != 0 ? number(Fixed(0), Fixed(1)) : S(0);
    Shape<S> shape;
    switch (byteOf(op, 4) % 5) {
      case 0:
        shape = circleShape<S>(body, number(Fixed(0), size), vector(Fixed(1)));
        break;
      case 1: {
        const Vector<S> a = vector(size);
        shape = segmentShape<S>(body, a, vector(size), radius);
        break;
      }
      case 2:
        shape = boxShape<S>(body, number(Fixed(0), size), number(Fixed(0), size), radius);
        break;
      case 3: {
        Vector<S> points[5];
        for (Vector<S>& point : points) point = vector(size);
        shape = polyShape<S>(body, points, Transform<S>(), radius);
        break;
      }
      default: {
        const std::optional<Shape<S>> made = build<S>(readShape(input_));
        require<Fault::DegenerateShape>(made.has_value());
        shape = *made;
        shape.setBody(body);
        break;
      }
    }
    if ((op >> 18 & 1) != 0) shape.setMass(number(Fixed(0), Fixed(1000)));
    if ((op >> 19 & 1) == 0 && shape.mass() == S(0)) shape.setMass(S(1));
    return shape;
  }

  void addShape(std::uint64_t op) {
    if (model_.shapes.size() >= kMostShapes) return;
    const BodyId body = someBody(op);
    Shape<S> shape = readShapeFor(body, op);
    const std::uint64_t look = input_.word();
    shape.setFriction(S(byteOf(look, 0) % 4));
    shape.setElasticity(ratio<S>(byteOf(look, 1) % 5, 4));
    shape.setSensor(byteOf(look, 2) % 8 == 1);
    shape.setCollisionType(byteOf(look, 3) % 4);
    if (byteOf(look, 4) % 8 == 1) shape.setFilter({byteOf(look, 5) % 3u, byteOf(look, 6), 0xffu});
    if (byteOf(look, 4) % 8 == 3) shape.setRollingResistance(S(byteOf(look, 5)));
    if (byteOf(look, 4) % 8 == 2) shape.setSurfaceVelocity(vector(Fixed(1 << 10)));
    const ShapeId id = space_.add(shape);
    model_.shapes.push_back({id, body});
  }

  void removeSomething(std::uint64_t op) {
    if ((op >> 16 & 1) != 0) {
      const ShapeId id = someShape(op);
      space_.remove(id);
      model_.forget(id);
    } else if ((op >> 16 & 2) != 0) {
      const BodyId id = someBody(op);
      space_.remove(id);
      model_.forget(id);
    } else {
      const BodyId id = someBody(op);
      space_.removeWithShapes(id);
      model_.forget(id);
    }
  }

  void moveBody(std::uint64_t op) {
    const BodyId id = someBody(op);
    Body<S>& body = space_.body(id);
    switch (byteOf(op, 2) % 15) {
      case 11:
        return body.setGravityScale(S(byteOf(op, 3)) - S(128));
      case 12:
        return body.setLinearDamping(S(byteOf(op, 3))), body.setAngularDamping(S(byteOf(op, 4)));
      case 13:
        return body.setSpeedLimit(S(byteOf(op, 3))), body.setSpinLimit(S(byteOf(op, 4)));
      case 14:
        return body.setRotates(byteOf(op, 3) % 2 != 0);
      case 8:
        return body.setMaySleep(byteOf(op, 3) % 4 != 0);
      case 9:
        return body.activate();
      case 10:
        return body.sleep();
      case 0:
        return body.setPosition(vector(byteOf(op, 3) == 255 ? Fixed(1 << 16) : Fixed(6)));
      case 1:
        return body.setVelocity(vector(Fixed(1 << 10)));
      case 2:
        return body.setAngle(number(Fixed(-kMaxNumber), Fixed(kMaxNumber)));
      case 3:
        return body.setAngularVelocity(number(Fixed(-256), Fixed(256)));
      case 4:
        return body.setMass(number(Fixed(0), Fixed(1000000)));
      case 5:
        return body.setMoment(number(Fixed(0), Fixed(1 << 30)));
      case 6:
        return body.setCenterOfMass(vector(Fixed(256)));
      default:
        return space_.setType(id, static_cast<BodyType>(byteOf(op, 3) % 3));
    }
  }

  void push(std::uint64_t op) {
    Body<S>& body = space_.body(someBody(op));
    const Fixed most(kMaxNumber);
    switch (byteOf(op, 2) % 4) {
      case 0: {
        const Vector<S> impulse = vector(most);
        return body.applyImpulse(impulse, body.position() + vector(Fixed(8)));
      }
      case 1: {
        const Vector<S> force = vector(most);
        return body.applyForce(force, body.position() + vector(Fixed(8)));
      }
      case 2:
        return body.setForce(vector(most));
      default:
        return body.setTorque(number(-most, most));
    }
  }

  void changeShape(std::uint64_t op) {
    const ShapeId id = someShape(op);
    if ((op >> 16 & 1) != 0) {
      return space_.change(id, [&](Shape<S>& shape) {
        shape.setFriction(number(Fixed(0), Fixed(2)));
        shape.setElasticity(number(Fixed(0), Fixed(2)));
        shape.setSensor(byteOf(op, 3) % 2 == 1);
      });
    }
    space_.replace(id, readShapeFor(space_.shape(id).body(), op));
  }

  Joint<S> readJoint(std::uint64_t op) {
    Joint<S> joint;
    joint.kind = static_cast<JointKind>(byteOf(op, 2) % 9);
    joint.bodyA = someBody(op);
    joint.bodyB = someBody(op >> 16);
    const std::uint64_t look = input_.word();
    const Fixed far = byteOf(look, 0) == 255 ? Fixed(1025) : Fixed(4);
    joint.anchorA = vector(far);
    joint.anchorB = vector(far);
    joint.axis = byteOf(look, 1) == 255 ? vector(Fixed(2)) : forAngle(number(Fixed(-4), Fixed(4)));
    joint.collideConnected = byteOf(look, 2) & 1;
    joint.limited = byteOf(look, 2) >> 1 & 1;
    joint.motor = byteOf(look, 2) >> 2 & 1;
    joint.spring = byteOf(look, 2) >> 3 & 1;
    const Fixed wide = byteOf(look, 3) == 255 ? Fixed(1 << 21) : Fixed(4);
    for (S* one : {&joint.rest, &joint.angle, &joint.lower, &joint.upper}) *one = number(-wide, wide);
    const Fixed strong = byteOf(look, 4) == 255 ? Fixed(kMaxNumber) : Fixed(1000);
    for (S* one :
         {&joint.motorMax, &joint.maxForce, &joint.maxTorque, &joint.breakForce, &joint.breakTorque}) {
      *one = byteOf(input_.word(), 0) % 2 == 0 ? S(0) : number(Fixed(0), strong);
    }
    joint.motorSpeed = number(Fixed(-257), Fixed(257));
    joint.velocity = vector(Fixed(16));
    joint.ratio = number(Fixed(-300), Fixed(300));
    for (S* one : {&joint.hertz, &joint.angularHertz}) {
      *one = byteOf(input_.word(), 0) % 2 == 0 ? S(0) : number(Fixed(0), Fixed(1001));
    }
    joint.damping = number(Fixed(0), Fixed(101));
    joint.angularDamping = number(Fixed(0), Fixed(101));
    return joint;
  }
  JointId someJoint(std::uint64_t op) const {
    std::vector<JointId> ids;
    space_.eachJoint([&](JointId id, const Joint<S>&) { ids.push_back(id); });
    return ids.empty() ? JointId{} : ids[byteOf(op, 1) % ids.size()];
  }
  void addJoint(std::uint64_t op) {
    if (space_.jointCount() < kMostJoints) space_.add(readJoint(op));
  }
  void changeJoint(std::uint64_t op) {
    const JointId id = someJoint(op);
    if (byteOf(op, 3) % 4 == 0) {
      space_.remove(id);
    } else {
      space_.replace(id, readJoint(op));
    }
  }

  void changeSettings(std::uint64_t op) {
    switch (byteOf(op, 1) % 15) {
      case 0:
        return space_.setGravity(vector(byteOf(op, 2) == 255 ? Fixed(1 << 15) : Fixed(20)));
      case 1:
        return space_.setDamping(number(Fixed(-1), Fixed(2)));
      case 2:
        return space_.setIterations(byteOf(op, 2) % 16);
      case 3:
        return space_.setSubsteps(byteOf(op, 2) % 6);
      case 4:
        return space_.setCollisionSlop(number(Fixed(-1), Fixed(300)));
      case 5:
        return space_.setCollisionBias(number(Fixed(-1), Fixed(2)));
      case 6:
        return space_.setCollisionPersistence(byteOf(op, 2) % 5);
      case 7:
        return space_.setWorldExtent(number(Fixed(-1), Fixed(kMaxNumber)));
      case 8: {
        const S hertz = number(Fixed(-1), Fixed(1001));
        return space_.setContactSoftness(hertz, number(Fixed(-1), Fixed(101)));
      }
      case 9:
        return space_.setContactPushSpeed(number(Fixed(-1), Fixed(1025)));
      case 10:
        return space_.setContactMargin(number(Fixed(-1), Fixed(2)));
      case 13:
        // Short, for sequences are.
        return space_.setSleepTimeThreshold(number(Fixed(-1), Fixed(1)) * ratio<S>(1, 4));
      case 14:
        return space_.setIdleSpeedThreshold(number(Fixed(-1), Fixed(2)));
      case 11:
        return space_.setContinuous((op >> 16 & 1) != 0);
      case 12:
        // continueTwice gives the same limit to the world that it restores.
        return space_.setMaxPairs(byteOf(op, 2) % 8 == 0 ? byteOf(op, 3) % 32 : kDefaultMaxPairs);
      default:
        return space_.setSolver((op >> 16 & 1) != 0 ? SolverKind::softStep : SolverKind::sequentialImpulses);
    }
  }

  void bind(std::uint64_t op) {
    const CallbackNumber number = byteOf(op, 2) % 5;
    switch (byteOf(op, 1) % 3) {
      case 0:
        return space_.addCollisionHandler(byteOf(op, 3) % 4, byteOf(op, 4) % 4, number);
      case 1:
        return space_.addWildcardHandler(byteOf(op, 3) % 4, number);
      default:
        return space_.addDefaultCollisionHandler(number);
    }
  }

  void ask(std::uint64_t op) {
    const Fixed limit(1 << 15);
    switch (byteOf(op, 1) % 4) {
      case 0: {
        std::vector<PointHit<S>> hits;
        const Vector<S> point = vector(byteOf(op, 2) == 255 ? limit : Fixed(8));
        space_.pointQuery(point, number(Fixed(0), Fixed(64)), ShapeFilter(), hits);
        for (std::size_t i = 1; i < hits.size(); ++i)
          expect(hits[i - 1].shape < hits[i].shape, "hits by rising id");
        break;
      }
      case 1: {
        std::vector<SegmentHit<S>> hits;
        const Vector<S> from = vector(Fixed(16)), to = vector(byteOf(op, 2) == 255 ? limit : Fixed(16));
        space_.segmentQuery(from, to, number(Fixed(0), Fixed(4)), ShapeFilter(), hits);
        for (std::size_t i = 0; i < hits.size(); ++i) {
          expect(i == 0 || hits[i - 1].shape < hits[i].shape, "hits by rising id");
          expect(hits[i].alpha >= S(0) && hits[i].alpha <= S(1), "a hit is on the way");
        }
        break;
      }
      case 2: {
        std::vector<ShapeId> hits;
        const Vector<S> middle = vector(Fixed(16));
        const BB<S> box = BB<S>::forExtents(middle, number(Fixed(0), limit), number(Fixed(0), limit));
        space_.boxQuery(box, ShapeFilter(), hits);
        std::vector<ShapeId> expected;
        for (const auto& entry : model_.shapes) {
          if (intersects(space_.boundingBox(entry.id), box)) expected.push_back(entry.id);
        }
        std::sort(expected.begin(), expected.end());
        std::erase_if(expected,
                      [&](ShapeId id) { return !accepts(space_.shape(id).filter(), ShapeFilter()); });
        expect(hits == expected, "a box query finds the shapes whose boxes overlap");
        break;
      }
      default: {
        int touching = 0;
        space_.eachArbiter([&](Arbiter<S>& arbiter) {
          ++touching;
          expect(arbiter.count() <= kMaxContactsPerPair, "an arbiter has its points");
        });
        int twice = 0;
        for (const BodyId id : model_.bodies) space_.eachArbiter(id, [&](Arbiter<S>&) { ++twice; });
        space_.eachArbiter(space_.staticBody(), [&](Arbiter<S>&) { ++twice; });
        expect(twice == 2 * touching, "each arbiter is in the threads of its two bodies");
        break;
      }
    }
  }

  void save(std::uint64_t op) {
    Kept& kept = kept_[byteOf(op, 1) % 2];
    space_.save(kept.saved);
    kept.model = model_;
    kept.used = true;
  }
  void restore(std::uint64_t op) {
    const Kept& kept = kept_[byteOf(op, 1) % 2];
    space_.restore(kept.saved);
    expect(kept.used, "nothing saved is nothing to restore");
    model_ = kept.model;
  }

  void housekeeping(std::uint64_t op) {
    switch (byteOf(op, 2) % 6) {
      case 0:
        return space_.dropCache();
      case 1:
        return space_.reindexStatic();
      case 2:
        return space_.reindexShape(someShape(op));
      case 3:
        return space_.reindexShapesForBody(someBody(op));
      case 4:
        return space_.filterArbiters(someBody(op));
      default:
        return space_.accumulateMassFromShapes(someBody(op));
    }
  }

  void step(std::uint64_t op) {
    constexpr int kTimes[] = {60, 64, 30, 120};
    S dt = ratio<S>(1, kTimes[byteOf(op, 1) % 4]);
    if (byteOf(op, 2) == 255) dt = number(Fixed(0), Fixed(1));
    for (int i = 0; i < 1 + byteOf(op, 3) % 4 && steps_ < kMostSteps; ++i, ++steps_) {
      if (i > 0) {
        before_ = space_.hash();
        hashes_.push_back(before_);
      }
      space_.step(dt);
    }
  }

  // ---- checks

  void check() {
    expect(!space_.isLocked(), "nothing keeps the Space locked");
    expect(space_.bodyCount() == model_.bodies.size() + 1, "the bodies are counted");
    expect(space_.shapeCount() == model_.shapes.size(), "the shapes are counted");
    for (const BodyId id : model_.bodies) expect(space_.contains(id), "a body that was added is there");
    for (const BodyId id : model_.deadBodies)
      expect(!space_.contains(id), "the id of a removed body names nothing");
    for (const ShapeId id : model_.deadShapes) expect(!space_.contains(id), "that of a shape neither");
    std::size_t onBodies = 0;
    space_.eachBody([&](const Body<S>& body) {
      ShapeId last{};
      std::as_const(space_).eachShape(body.id(), [&](const Shape<S>& shape) {
        expect(shape.body() == body.id(), "a body's shapes are its own");
        expect(!last.valid() || last < shape.id(), "shapes by rising id");
        last = shape.id();
        ++onBodies;
      });
    });
    expect(onBodies == model_.shapes.size(), "each shape is on one body");
    for (const auto& entry : model_.shapes) {
      expect(space_.contains(entry.id) && space_.shape(entry.id).body() == entry.body,
             "a shape stays on its body");
    }
    space_.eachJoint([&](JointId id, const Joint<S>& joint) {
      expect(space_.contains(id) && joint.bodyA != joint.bodyB, "a joint is of two bodies");
      expect(space_.contains(joint.bodyA) && space_.contains(joint.bodyB), "which are there");
    });
    const char* const flaw = flawOf(space_.state());
    if (flaw != nullptr) fail(flaw);
    const auto& pairs = space_.state().pairs;
    for (std::size_t i = 1; i < pairs.size(); ++i) {
      expect(std::pair(pairs[i - 1].a, pairs[i - 1].b) < std::pair(pairs[i].a, pairs[i].b),
             "pairs are sorted");
    }
    for (const Pair<S>& pair : space_.state().restingPairs) {
      expect(space_.state().shapes.contains(pair.a) && space_.state().shapes.contains(pair.b),
             "pairs that rest are of shapes that are there");
    }
  }

  /// Saved and brought into another Space, the world goes on as it does here, and so it does without its
  /// cache.
  void continueTwice() {
    Space<S> other;
    connect(other);
    other.setMaxPairs(space_.maxPairs());
    space_.save(kept_[0].saved);
    other.restore(kept_[0].saved);
    expect(other.hash() == space_.hash(), "a restored world has the same hash");
    for (int i = 0; i < 3; ++i) {
      bool refused = false, otherRefused = false;
      try {
        space_.step(ratio<S>(1, 60));
      } catch (const Error&) {
        refused = true;
      }
      other.dropCache();
      try {
        other.step(ratio<S>(1, 60));
      } catch (const Error&) {
        otherRefused = true;
      }
      expect(refused == otherRefused && other.hash() == space_.hash(), "a restored world goes on the same");
      hashes_.push_back(space_.hash());
    }
  }

  Input input_;
  bool checks_;
  Space<S> space_;
  Model model_;
  Kept kept_[2];
  std::vector<std::uint64_t> removedByCallbacks_;
  std::vector<std::uint64_t> hashes_;
  std::uint64_t before_ = 0;  ///< The hash before what is being done.
  int steps_ = 0;
};

template <Scalar S>
std::vector<std::uint64_t> hashesOf(const Input& input, bool checks) {
  World<S> world(input, checks);
  return world.run();
}

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace samestep;
  using namespace samestep::fuzz;
  Input input(data, size);
  const std::uint64_t head = input.word();
  // Worlds that have the same hashes need not be looked at twice: one in eight is.
  const bool twice = (mixed(data, size) & 7) == 0;
  guarded([&] {
    if ((head & 1) == 0) {
      // The checked numbers report every overflow; besides that they are the same.
      expect(hashesOf<CheckedFixed>(input, true) == hashesOf<Fixed>(input, twice),
             "Fixed does what CheckedFixed does");
    } else {
      expect(hashesOf<double>(input, true) == hashesOf<double>(input, twice),
             "the same again gives the same hashes");
    }
  });
  return 0;
}
