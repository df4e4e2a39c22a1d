// SPDX-License-Identifier: MIT
#include "study/chart_track.h"

#include <algorithm>

#include "base/require_ieee.h"

namespace samestep {
namespace {

template <Scalar S>
double plain(S value) {
  return static_cast<double>(value);
}

/// Blocks on a slope: with friction mu one stays where tan(angle) <= mu, else it slides with
/// g (sin(angle) - mu cos(angle)). The slope's friction is 1, so that a contact has the block's own.
Spots slidBlocks(const StartWorld& start, double time) {
  Spots spots;
  for (const StartWorld::Moving& block : start.bodies) {
    const double along = start.gravityX * block.cosine + start.gravityY * block.sine;
    const double into = start.gravityX * block.sine - start.gravityY * block.cosine;
    const double held = std::min(block.friction * into, abs(along));
    const double path = (along < 0 ? along + held : along - held) * time * time / 2;
    spots.push_back({block.spot.body, block.spot.x + path * block.cosine, block.spot.y + path * block.sine});
  }
  return spots;
}

/// Height of a ball that falls from a height and bounces with restitution e: from each bounce it leaves with
/// e times the speed it came with.
double bouncedHeight(double height, double gravity, double e, double time) {
  double speed = sqrt(2 * gravity * height);
  const double fall = speed / gravity;
  if (time <= fall) return height - gravity * time * time / 2;
  time -= fall;
  // A flight shorter than this is rest.
  constexpr double kRest = 1e-6;
  for (;;) {
    speed *= e;
    const double flight = 2 * speed / gravity;
    if (flight < kRest) return 0;
    if (time <= flight) return speed * time - gravity * time * time / 2;
    time -= flight;
  }
}

/// Balls that do not spin, falling on a floor of elasticity 1.
Spots bouncedBalls(const StartWorld& start, double time) {
  Spots spots;
  for (const StartWorld::Moving& ball : start.bodies) {
    if (ball.radius == 0 || ball.turning != 0) continue;
    const double rest = start.floor + ball.radius;
    const double height = bouncedHeight(ball.spot.y - rest, -start.gravityY, ball.elasticity, time);
    spots.push_back({ball.spot.body, ball.spot.x, rest + height});
  }
  return spots;
}

/// Path of a body that friction brings from one speed to another with a constant acceleration, m.
double pathToSpeed(double from, double to, double acceleration, double time) {
  const double change = abs(to - from);
  // Without friction the change takes for ever.
  const double whole = acceleration > 0 ? change / acceleration : time;
  const double rubbed = std::min(time, whole);
  const double sign = to < from ? -1 : 1;
  return from * rubbed + sign * acceleration * rubbed * rubbed / 2 + to * (time - rubbed);
}

/// Flat boxes on a level floor, whose friction is 1 and whose surface may move.
Spots rubbedBoxes(const StartWorld& start, double time) {
  Spots spots;
  for (const StartWorld::Moving& box : start.bodies) {
    const double path = pathToSpeed(box.velocityX, start.belt, -start.gravityY * box.friction, time);
    spots.push_back({box.spot.body, box.spot.x + path, box.spot.y});
  }
  return spots;
}

/// Bodies that touch nothing.
Spots thrownBodies(const StartWorld& start, double time) {
  Spots spots;
  for (const StartWorld::Moving& body : start.bodies) {
    spots.push_back({body.spot.body, body.spot.x + body.velocityX * time + start.gravityX * time * time / 2,
                     body.spot.y + body.velocityY * time + start.gravityY * time * time / 2});
  }
  return spots;
}

/// Discs that roll down a slope: of the force along it a third turns them.
Spots rolledBalls(const StartWorld& start, double time) {
  Spots spots;
  for (const StartWorld::Moving& ball : start.bodies) {
    const double along = start.gravityX * ball.cosine + start.gravityY * ball.sine;
    const double path = along * 2 / 3 * time * time / 2;
    spots.push_back({ball.spot.body, ball.spot.x + path * ball.cosine, ball.spot.y + path * ball.sine});
  }
  return spots;
}

/// Pairs of balls of one density, left and right, that meet head-on; the elasticity of the right one is 1.
Spots metBalls(const StartWorld& start, double time) {
  Spots spots;
  for (std::size_t i = 0; i + 1 < start.bodies.size(); i += 2) {
    const StartWorld::Moving& a = start.bodies[i];
    const StartWorld::Moving& b = start.bodies[i + 1];
    const double massA = a.radius * a.radius;
    const double massB = b.radius * b.radius;
    const double closing = a.velocityX - b.velocityX;
    const double before = std::min(time, (b.spot.x - a.spot.x - a.radius - b.radius) / closing);
    const double blow = (1 + a.elasticity) * closing / (massA + massB);
    const double after = time - before;
    spots.push_back({a.spot.body, a.spot.x + a.velocityX * time - blow * massB * after, a.spot.y});
    spots.push_back({b.spot.body, b.spot.x + b.velocityX * time + blow * massA * after, b.spot.y});
  }
  return spots;
}

/// Rigid boxes in balance.
Spots whereTheyBegan(const StartWorld& start, double) {
  Spots spots;
  for (const StartWorld::Moving& body : start.bodies) spots.push_back(body.spot);
  return spots;
}

constexpr ExactAnswer kExactAnswers[] = {
    // The first block reaches the end of the slope after 190 steps.
    {"incline", 120, 180, "the blocks from where gravity and friction bring them", slidBlocks},
    {"bounce", 180, 1u << 20, "the balls from their exact paths", bouncedBalls},
    {"projectile", 120, 1u << 12, "the bodies from the parabolas of free flight", thrownBodies},
    {"slide", 120, 900, "the boxes from where friction brings them", rubbedBoxes},
    {"conveyor", 180, 900, "the boxes from where the belt brings them", rubbedBoxes},
    // The lowest ball reaches the end of the slope after 254 steps.
    {"roll", 180, 240, "the balls from where they roll without slipping", rolledBalls},
    {"impact", 120, 900, "the balls from where one blow each sends them", metBalls},
    {"pyramid", 330, 1u << 20, "the boxes from where they began, as rigid boxes stay there", whereTheyBegan},
};

}  // namespace

const ExactAnswer* exactAnswerOf(std::string_view scene) {
  for (const ExactAnswer& answer : kExactAnswers) {
    if (scene.starts_with(answer.scenes)) return &answer;
  }
  return nullptr;
}

template <Scalar S>
Spots spotsOf(const Space<S>& space) {
  Spots spots;
  space.eachBody([&](const Body<S>& body) {
    const Vector<S>& center = body.worldCenter();
    if (body.isDynamic()) spots.push_back({body.id(), plain(center.x), plain(center.y)});
  });
  return spots;
}

template <Scalar S>
StartWorld startOf(const Space<S>& space) {
  StartWorld start;
  start.gravityX = plain(space.gravity().x);
  start.gravityY = plain(space.gravity().y);
  bool found = false;
  space.eachBody([&](const Body<S>& body) {
    const Shape<S>* first = nullptr;
    space.eachShape(body.id(), [&](const Shape<S>& shape) {
      if (first == nullptr) first = &shape;
      if (!body.isDynamic() && shape.surfaceVelocity().x != S(0))
        start.belt = plain(shape.surfaceVelocity().x);
      const double top = plain(boundingBox(shape, body.transform()).top);
      if (body.isDynamic() || (found && top <= start.floor)) return;
      start.floor = top;
      found = true;
    });
    if (first == nullptr || !body.isDynamic()) return;
    const Vector<S>& center = body.worldCenter();
    start.bodies.push_back({{body.id(), plain(center.x), plain(center.y)},
                            plain(body.rotation().x),
                            plain(body.rotation().y),
                            plain(body.angularVelocity()),
                            first->type() == ShapeType::circle ? plain(first->radius()) : 0,
                            plain(first->friction()),
                            plain(first->elasticity()),
                            plain(body.velocity().x),
                            plain(body.velocity().y)});
  });
  return start;
}

namespace {

struct Sum {
  double squares = 0;
  double count = 0;

  void take(const Spots& a, const Spots& b) {
    auto other = b.begin();
    for (const Spot& spot : a) {
      while (other != b.end() && other->body.index < spot.body.index) ++other;
      if (other == b.end()) return;
      if (other->body != spot.body) continue;
      const double x = spot.x - other->x;
      const double y = spot.y - other->y;
      squares += x * x + y * y;
      count += 1;
    }
  }
  double root() const { return count > 0 ? sqrt(squares / count) : 0; }
};

}  // namespace

double distanceBetween(const Spots& a, const Spots& b) {
  Sum sum;
  sum.take(a, b);
  return sum.root();
}

double distanceBetween(const Track& a, const Track& b) {
  Sum sum;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) sum.take(a[i], b[i]);
  return sum.root();
}

#ifndef SAMESTEP_FIXED_ONLY
template Spots spotsOf<double>(const Space<double>&);
template StartWorld startOf<double>(const Space<double>&);
#endif
template Spots spotsOf<Fixed>(const Space<Fixed>&);
template StartWorld startOf<Fixed>(const Space<Fixed>&);

}  // namespace samestep
