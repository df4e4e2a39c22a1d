// SPDX-License-Identifier: MIT
// The ladders: worlds that a number makes harder, and when they have failed.
#include <algorithm>

#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "base/require_ieee.h"
#include "study/contact_ladders.h"
#include "study/degenerate_shapes.h"
#include "study/envelope.h"

namespace samestep {
namespace {

/// A world with a static box in it, solved by a setting.
template <Scalar S>
class Trial {
 public:
  using Number = S;
  static constexpr int kStepsPerSecond = 60;

  Trial(const Setting& setting, const Vector<S>& gravity) {
    useMethod(space_, *setting.method, setting.count);
    space_.setGravity(gravity);
  }

  void addStaticBox(const Vector<S>& center, S width, S height) {
    Body<S> body = Body<S>::fixedInPlace();
    body.setPosition(center);
    add(body, boxShape<S>({}, width, height), ratio<S>(6, 10));
  }
  /// A box of 1 m by 1 m.
  BodyId addBox(const Vector<S>& center, S mass) {
    Body<S> body;
    body.setPosition(center);
    Shape<S> shape = boxShape<S>({}, S(1), S(1));
    shape.setMass(mass);
    return add(body, shape, ratio<S>(6, 10));
  }
  /// Turns continuous collision on.
  void stopOnTheWay() { space_.setContinuous(true); }
  BodyId addBullet(const Vector<S>& center, S radius, const Vector<S>& velocity) {
    Body<S> body;
    body.setPosition(center);
    body.setVelocity(velocity);
    Shape<S> shape = circleShape<S>({}, radius, Vector<S>());
    shape.setDensity(S(1));
    return add(body, shape, ratio<S>(6, 10));
  }

  void addStaticBox(const Vector<S>& center, S width, S height, const TrialSurface<S>& surface) {
    Body<S> body = Body<S>::fixedInPlace();
    body.setPosition(center);
    add(body, boxShape<S>({}, width, height), surface);
  }
  void addStaticSegment(const Vector<S>& a, const Vector<S>& b, const TrialSurface<S>& surface) {
    add(Body<S>::fixedInPlace(), segmentShape<S>({}, a, b, S(0)), surface);
  }
  /// A box of 1 kg per square metre.
  BodyId addBox(const Vector<S>& center, S width, S height, const Vector<S>& velocity,
                const TrialSurface<S>& surface, bool turns) {
    Body<S> body = turns ? Body<S>() : Body<S>::nonRotating(width * height);
    body.setPosition(center);
    body.setVelocity(velocity);
    Shape<S> shape = boxShape<S>({}, width, height);
    if (turns) shape.setDensity(S(1));
    return add(body, shape, surface);
  }
  BodyId addBall(const Vector<S>& center, S radius, const Vector<S>& velocity,
                 const TrialSurface<S>& surface) {
    Body<S> body;
    body.setPosition(center);
    body.setVelocity(velocity);
    Shape<S> shape = circleShape<S>({}, radius, Vector<S>());
    shape.setDensity(S(1));
    return add(body, shape, surface);
  }

  /// A static body of any shape.
  void addStatic(const Shape<S>& shape, const Vector<S>& position, S angle) {
    Body<S> body = Body<S>::fixedInPlace();
    body.setPosition(position);
    body.setAngle(angle);
    add(body, shape, ratio<S>(6, 10));
  }
  /// A body of 1 kg, with the moment of its shape where that is one a body may have.
  BodyId addFree(const Shape<S>& shape, const Vector<S>& position, S angle) {
    Body<S> body(S(1), max(toScalar<S>(shape.massInfo().unitMoment), ratio<S>(1, 1 << 10)));
    body.setCenterOfMass(shape.centerOfMass());
    body.setAngle(angle);
    body.setPosition(position);
    return add(body, shape, ratio<S>(6, 10));
  }

  /// A free body on its way.
  BodyId addFlying(const Shape<S>& shape, const Vector<S>& position, const Vector<S>& velocity, S spin) {
    const BodyId id = addFree(shape, position, S(0));
    space_.body(id).setVelocity(velocity);
    space_.body(id).setAngularVelocity(spin);
    return id;
  }

  /// Makes steps for so long, and stops where `stands` says no, asked after each second.
  template <class Stands>
  bool stand(int seconds, Stands&& stands) {
    for (int second = 0; second < seconds; ++second) {
      run(kStepsPerSecond);
      if (!stands()) return false;
    }
    return true;
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) space_.step(ratio<S>(1, kStepsPerSecond));
  }

  const Body<S>& body(BodyId id) const { return space_.body(id); }
  Vector<S> center(BodyId id) const { return body(id).worldCenter(); }
  Vector<S> velocity(BodyId id) const { return body(id).velocity(); }
  S angle(BodyId id) const { return body(id).angle(); }

 private:
  BodyId add(const Body<S>& body, const Shape<S>& shape, S friction) {
    return add(body, shape, TrialSurface<S>{friction, S(0)});
  }
  BodyId add(const Body<S>& body, Shape<S> shape, const TrialSurface<S>& surface) {
    const BodyId id = space_.add(body);
    shape.setBody(id);
    shape.setFriction(surface.friction);
    shape.setElasticity(surface.elasticity);
    space_.add(shape);
    return id;
  }

  Space<S> space_;
};

/// Calls visit(S()) with the scalar of the setting.
template <class Visit>
bool inScalarOf(const Setting& setting, Visit&& visit) {
  return withScalarOf(*setting.method, std::forward<Visit>(visit));
}

bool upright(auto angle) {
  using S = decltype(angle);
  return abs(angle) <= ratio<S>(1, 5);
}

template <Scalar S>
bool stackHolds(const Setting& setting, int boxes) {
  Trial<S> trial(setting, {S(0), S(-10)});
  trial.addStaticBox({S(0), S(-1)}, S(20), S(2));
  std::vector<BodyId> stack;
  for (int i = 0; i < boxes; ++i) {
    const S aside = ratio<S>(i % 2 == 0 ? -1 : 1, 100);
    stack.push_back(trial.addBox({aside, ratio<S>(2 * i + 1, 2)}, S(1)));
  }
  const S sunk = ratio<S>(boxes, 20);
  return trial.stand(10, [&] {
    for (int i = 0; i < boxes; ++i) {
      const Body<S>& box = trial.body(stack[static_cast<std::uint32_t>(i)]);
      const Vector<S>& center = box.worldCenter();
      if (!upright(box.angle()) || abs(center.x) > ratio<S>(1, 2)) return false;
      if (center.y < ratio<S>(2 * i + 1, 2) - sunk) return false;
    }
    return true;
  });
}

template <Scalar S>
bool massRatioHolds(const Setting& setting, int kilograms) {
  Trial<S> trial(setting, {S(0), S(-10)});
  trial.addStaticBox({S(0), S(-1)}, S(20), S(2));
  const BodyId light = trial.addBox({S(0), ratio<S>(1, 2)}, S(1));
  const BodyId heavy = trial.addBox({ratio<S>(1, 100), ratio<S>(3, 2)}, S(kilograms));
  return trial.stand(10, [&] {
    const Vector<S>& center = trial.body(heavy).worldCenter();
    return upright(trial.body(light).angle()) && upright(trial.body(heavy).angle()) &&
           abs(center.x) <= ratio<S>(1, 2) && center.y >= ratio<S>(14, 10);
  });
}

/// Bullets side by side, each a 16th of a step's way farther off than the last, so that some step ends
/// anywhere between in front of the wall and behind it.
template <Scalar S>
bool bulletsHold(const Setting& setting, int speed, S thickness) {
  constexpr int kBullets = 16;
  constexpr int kFlight = 2;
  Trial<S> trial(setting, {});
  trial.stopOnTheWay();
  trial.addStaticBox({thickness / S(2), S(kBullets / 2)}, thickness, S(kBullets + 4));
  std::vector<BodyId> bullets;
  for (int i = 0; i < kBullets; ++i) {
    const S distance = S(kFlight) + ratio<S>(speed, Trial<S>::kStepsPerSecond) * ratio<S>(i, kBullets);
    bullets.push_back(trial.addBullet({-distance, S(i)}, ratio<S>(1, 10), {S(speed), S(0)}));
  }
  trial.run(kFlight * Trial<S>::kStepsPerSecond / speed + Trial<S>::kStepsPerSecond);
  for (const BodyId id : bullets) {
    if (trial.body(id).worldCenter().x > S(0)) return false;
  }
  return true;
}

template <int kSixteenths>
bool bulletsHoldAt(const Setting& setting, int speed) {
  return inScalarOf(setting, [&](auto scalar) {
    using S = decltype(scalar);
    return bulletsHold<S>(setting, speed, ratio<S>(kSixteenths, 16));
  });
}

/// Numbers that look like chance and are the same everywhere.
class Dice {
 public:
  /// A number in [-1, 1], in steps of 2^-10.
  template <Scalar S>
  S unit() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return ratio<S>(static_cast<int>(state_ >> 53) - 1024, 1024);
  }

 private:
  std::uint64_t state_ = 5;
};

/// Bullets of all shapes, with spins up to the limit, in a room of thin walls.
template <Scalar S>
bool bulletsStay(const Setting& setting, int speed) {
  constexpr int kBullets = 48;
  const S half(4), thin(0x1p-6), whole = half + half;
  Trial<S> trial(setting, {});
  trial.stopOnTheWay();
  for (const S side : {-half, half}) {
    trial.addStaticBox({side, S(0)}, thin, whole);
    trial.addStaticBox({S(0), side}, whole, thin);
  }
  const Shape<S> shapes[] = {circleShape<S>({}, ratio<S>(1, 10), Vector<S>()),
                             boxShape<S>({}, ratio<S>(1, 2), ratio<S>(1, 16)),
                             segmentShape<S>({}, {S(-1) / S(4), S(0)}, {S(1) / S(4), S(0)}, S(0x1p-5)),
                             boxShape<S>({}, ratio<S>(1, 4), ratio<S>(1, 4), ratio<S>(1, 32))};
  Dice dice;
  std::vector<BodyId> bullets;
  for (int i = 0; i < kBullets; ++i) {
    const Vector<S> position(S(2) * dice.unit<S>(), S(2) * dice.unit<S>());
    const Vector<S> velocity(S(speed) * dice.unit<S>(), S(speed) * dice.unit<S>());
    const S spin = i % 2 == 0 ? S(0) : kMaxAngularSpeed<S> * dice.unit<S>();
    bullets.push_back(trial.addFlying(shapes[i % 4], position, velocity, spin));
  }
  return trial.stand(2, [&] {
    return std::all_of(bullets.begin(), bullets.end(),
                       [&](BodyId id) { return within(trial.center(id), half); });
  });
}

/// True if a shape may be that of a body that moves.
bool mayMove(const NastyShape& shape) { return makeNasty<Fixed>(shape).extent() <= Fixed(kMaxDynamicExtent); }

template <Scalar S>
bool shapeRests(const Setting& setting, const NastyShape& nasty) {
  if (!mayMove(nasty)) return true;
  Trial<S> trial(setting, {S(0), S(-10)});
  trial.addStaticBox({S(0), S(-1)}, S(2000), S(2));
  const Shape<S> shape = makeNasty<S>(nasty);
  const S bottom = boundingBox(shape, Transform<S>()).bottom;
  const BodyId id = trial.addFree(shape, {S(0), ratio<S>(1, 10) - bottom}, S(0));
  return trial.stand(10, [&] {
    const BB<S> box = boundingBox(shape, trial.body(id).transform());
    return box.bottom >= -ratio<S>(1, 20) && box.bottom <= ratio<S>(1, 10);
  });
}

/// One of the two is held, the other free; so is A where B is too large to move.
template <Scalar S>
bool pairParts(const Setting& setting, const NastyPair& pair) {
  constexpr int kSeconds = 2;
  const NastyShape &nastyA = nastyShapes()[static_cast<std::size_t>(pair.shapeA)],
                   &nastyB = nastyShapes()[static_cast<std::size_t>(pair.shapeB)];
  const Shape<S> shapeA = makeNasty<S>(nastyA), shapeB = makeNasty<S>(nastyB);
  const Vector<S> placeA = fromUnits<S>(pair.positionA), placeB = fromUnits<S>(pair.positionB);
  const S angleA = fromUnits<S>(pair.angleA), angleB = fromUnits<S>(pair.angleB);
  Trial<S> trial(setting, {});
  const bool freeB = mayMove(nastyB);
  if (!freeB && !mayMove(nastyA)) return true;
  trial.addStatic(freeB ? shapeA : shapeB, freeB ? placeA : placeB, freeB ? angleA : angleB);
  const BodyId id = trial.addFree(freeB ? shapeB : shapeA, freeB ? placeB : placeA, freeB ? angleB : angleA);
  S most = S(0);
  for (int step = 0; step < kSeconds * Trial<S>::kStepsPerSecond; ++step) {
    const Vector<S> before = trial.body(id).worldCenter();
    trial.run(1);
    most = max(most, length(trial.body(id).worldCenter() - before) * S(Trial<S>::kStepsPerSecond));
  }
  return most <= S(10);
}

/// True if each of the first `rung` holds, as holds(S(), thing) has it.
template <class Thing, class Holds>
bool firstHold(const Setting& setting, std::span<const Thing> things, int rung, Holds&& holds) {
  return std::all_of(things.begin(), things.begin() + rung, [&](const Thing& thing) {
    return inScalarOf(setting, [&](auto scalar) { return holds(scalar, thing); });
  });
}

/// A ladder of contact_ladders.h: each rung in a world of its own.
template <class Climb>
bool holdsInScalarOf(const Setting& setting, int gravity, Climb&& climb) {
  return inScalarOf(setting, [&](auto scalar) {
    using S = decltype(scalar);
    Trial<S> trial(setting, {S(0), S(-gravity)});
    return climb(trial);
  });
}

/// True if the walker arrives at each speed and floor up to the rung.
bool walkersArrive(const Setting& setting, int rung) {
  for (int i = 1; i <= rung; ++i) {
    if (!holdsInScalarOf(setting, 10, [&](auto& trial) { return walkerArrives(trial, i); })) return false;
  }
  return true;
}

constexpr int kTopSpeed = 1024;
constexpr const char* kBulletTrial =
    "16 bullets of 0.1 m radius fly at a static wall, with continuous collision, each starting 1/16 of a "
    "step's way farther off than "
    "the "
    "last";
constexpr const char* kBulletFails =
    "a second after the impact the centre of any is in the wall or beyond it";

const Ladder kLadders[] = {
    {"stack", "boxes in a stack that stands for 10 s",
     "boxes of 1 m and 1 kg stand on each other, alternately 1 cm to the left and to the right",
     "after any of 10 s a box has turned by more than 0.2 rad, is more than 0.5 m aside, or has sunk by more "
     "than 5 % of the stack's height",
     512,
     [](const Setting& setting, int rung) {
       return inScalarOf(setting, [&](auto scalar) { return stackHolds<decltype(scalar)>(setting, rung); });
     }},
    {"mass-ratio", "kg on a box of 1 kg that bears it for 10 s",
     "a heavy box of 1 m stands on one of 1 m and 1 kg, 1 cm aside",
     "after any of 10 s either has turned by more than 0.2 rad, or the heavy one is more than 0.5 m aside or "
     "has sunk by more than 0.1 m",
     1 << 19,
     [](const Setting& setting, int rung) {
       return inScalarOf(setting,
                         [&](auto scalar) { return massRatioHolds<decltype(scalar)>(setting, rung); });
     }},
    {"bullet-100cm", "m/s of a bullet that a wall of 1 m stops", kBulletTrial, kBulletFails, kTopSpeed,
     bulletsHoldAt<16>},
    {"bullet-25cm", "m/s that a wall of 25 cm stops", kBulletTrial, kBulletFails, kTopSpeed,
     bulletsHoldAt<4>},
    {"bullet-6cm", "m/s that a wall of 6.25 cm stops", kBulletTrial, kBulletFails, kTopSpeed,
     bulletsHoldAt<1>},
    {"bullets", "m/s of bullets of all shapes in a room of walls of 16 mm",
     "48 circles, boxes and segments, half of them with spins of up to 256 rad/s, fly about in a room of 8 m "
     "whose "
     "walls are 2^-6 m thick",
     "after either of 2 s the centre of any is outside of it", kTopSpeed,
     [](const Setting& setting, int rung) {
       return inScalarOf(setting, [&](auto scalar) { return bulletsStay<decltype(scalar)>(setting, rung); });
     }},
    {"walker", "speeds and floors, in turn, that a walker crosses",
     "a box of 1 m that may not turn walks without friction over 12 m of flush boxes, then of segments, of "
     "1 m each, at 1, 2, 3, 4, 6, 8, 12 and 16 m/s",
     "it has not arrived in time, has less than 99 % of its speed, or is more than 5 cm above or in the "
     "floor",
     kWalkerTop, walkersArrive},
    {"pass", "how close a ball passes a corner unmoved, 64 mm / n",
     "a ball of 25 cm radius flies past the corner of a box at 2 m/s without touching it",
     "either component of its velocity has changed by more than 1 mm/s", kPassTop,
     [](const Setting& setting, int rung) {
       return holdsInScalarOf(setting, 0, [&](auto& trial) { return passIsLeftAlone(trial, rung); });
     }},
    {"bounce", "bounces of an elastic box that is as high and flat as before",
     "a box of 1 m without friction falls flat from 1.8 m, elasticity 1 like the floor",
     "between one bounce and the next it comes more than 10 % higher or less high than 1.8 m, or it has "
     "turned "
     "by more than 0.01 rad",
     kBounceTop,
     [](const Setting& setting, int rung) {
       return holdsInScalarOf(setting, 10, [&](auto& trial) { return bouncesKeepTheirHeight(trial, rung); });
     }},
    {"shapes", "degenerate shapes, in turn, that rest on a floor for 10 s",
     "the shapes of replay/study/degenerate_shapes.cpp one by one, each alone on a body of 1 kg, fall from "
     "10 cm; "
     "those too large for a body that moves count as resting",
     "after any of 10 s one is more than 5 cm in the floor, or more than 10 cm above it",
     static_cast<int>(nastyShapes().size()),
     [](const Setting& setting, int rung) {
       return firstHold(setting, nastyShapes(), rung, [&](auto scalar, const NastyShape& shape) {
         return shapeRests<decltype(scalar)>(setting, shape);
       });
     }},
    {"pairs", "degenerate pairs, in turn, that part at 10 m/s at most",
     "the pairs of replay/study/degenerate_shapes.cpp one by one, many of them as deep in each other as can "
     "be, "
     "one held and the other a free body of 1 kg without gravity; two that are too large to move count as "
     "parted",
     "in any step of 2 s the free one moves faster", static_cast<int>(nastyPairs().size()),
     [](const Setting& setting, int rung) {
       return firstHold(setting, nastyPairs(), rung, [&](auto scalar, const NastyPair& pair) {
         return pairParts<decltype(scalar)>(setting, pair);
       });
     }},
};

}  // namespace

std::span<const Ladder> ladders() { return kLadders; }

}  // namespace samestep
