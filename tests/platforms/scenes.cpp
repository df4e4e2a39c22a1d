// SPDX-License-Identifier: MIT
#include "scenes.h"

#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "../support/random.h"

namespace samestep {
namespace {

template <Scalar S>
void addGround(Space<S>& space, S halfWidth) {
  const auto wall = [&](S ax, S ay, S bx, S by) {
    Shape<S> shape = segmentShape<S>(space.staticBody(), {ax, ay}, {bx, by}, ratio<S>(1, 8));
    shape.setFriction(S(1));
    space.add(shape);
  };
  wall(-halfWidth, S(0), halfWidth, S(0));
  wall(-halfWidth, S(0), -halfWidth, S(64));
  wall(halfWidth, S(0), halfWidth, S(64));
}

template <Scalar S>
BodyId addBody(Space<S>& space, const Vector<S>& position, S angle, Shape<S> shape, S friction,
               S elasticity) {
  Body<S> body;
  body.setPosition(position);
  body.setAngle(angle);
  const BodyId id = space.add(body);
  shape.setBody(id);
  shape.setDensity(S(1));
  shape.setFriction(friction);
  shape.setElasticity(elasticity);
  space.add(shape);
  return id;
}

template <Scalar S>
void buildPyramid(Space<S>& space) {
  space.setGravity({S(0), S(-10)});
  addGround(space, S(16));
  for (int row = 0; row < 12; ++row) {
    for (int i = row; i < 12; ++i) {
      const S x = ratio<S>(2 * (i - row) + row - 12, 2), y = ratio<S>(5 + 8 * row, 8);
      addBody(space, {x, y}, S(0), boxShape<S>(BodyId(), S(1), S(1)), ratio<S>(3, 4), S(0));
    }
  }
}

template <Scalar S>
Shape<S> randomShape(Random& random) {
  const S size = random.number<S>(1, 2) / S(4);
  switch (random.below(3)) {
    case 0:
      return circleShape<S>(BodyId(), size);
    case 1:
      return segmentShape<S>(BodyId(), {-size, S(0)}, {size, size}, size / S(3));
    default: {
      Vector<S> points[7];
      for (Vector<S>& point : points)
        point = {random.number<S>(-1, 1) * size, random.number<S>(-1, 1) * size};
      points[0] = {-size, -size};
      points[1] = {size, -size};
      points[2] = {S(0), size};
      return polyShape<S>(BodyId(), points, Transform<S>(), random.oneIn(2) ? S(0) : size / S(8));
    }
  }
}

/// Numbers are drawn one by one into names: compilers evaluate arguments in different orders.
template <Scalar S>
BodyId addRandom(Space<S>& space, Random& random, const Vector<S>& position) {
  const S angle = random.number<S>(-3, 3);
  const Shape<S> shape = randomShape<S>(random);
  const S friction = random.number<S>(0, 1);
  const S elasticity = random.number<S>(0, 1);
  return addBody(space, position, angle, shape, friction, elasticity);
}

template <Scalar S>
void dropRandom(Space<S>& space, Random& random) {
  Vector<S> position;
  position.x = random.number<S>(-7, 7);
  position.y = random.number<S>(2, 40);
  Body<S>& body = space.body(addRandom(space, random, position));
  Vector<S> velocity;
  velocity.x = random.number<S>(-4, 4);
  velocity.y = random.number<S>(-4, 4);
  body.setVelocity(velocity);
  body.setAngularVelocity(random.number<S>(-8, 8));
}

template <Scalar S>
void buildSoup(Space<S>& space) {
  space.setGravity({S(0), S(-10)});
  space.setDamping(ratio<S>(7, 8));
  addGround(space, S(8));
  Random random(1);
  for (int i = 0; i < 150; ++i) dropRandom(space, random);
}

template <Scalar S>
void buildTumbler(Space<S>& space) {
  space.setGravity({S(0), S(-10)});
  Body<S> drum = Body<S>::kinematic();
  drum.setAngularVelocity(ratio<S>(-3, 4));
  const BodyId id = space.add(drum);
  const Vector<S> corners[] = {{S(-8), S(-8)}, {S(8), S(-8)}, {S(8), S(8)}, {S(-8), S(8)}};
  for (int i = 0; i < 4; ++i) {
    Shape<S> wall = segmentShape<S>(id, corners[i], corners[(i + 1) % 4], S(1));
    wall.setFriction(S(1));
    wall.setSurfaceVelocity({S(1), S(0)});
    space.add(wall);
  }
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    Vector<S> position;
    position.x = random.number<S>(-6, 6);
    position.y = random.number<S>(-6, 6);
    addRandom(space, random, position);
  }
}

/// The oldest bodies leave, new ones come, others are kicked.
template <Scalar S>
void comeAndGo(Space<S>& space, std::uint64_t tick) {
  if (tick % 8 != 0) return;
  Random random(tick);
  BodyId oldest;
  std::uint32_t count = 0;
  space.eachBody([&](const Body<S>& body) {
    if (!body.isDynamic()) return;
    if (random.oneIn(++count)) oldest = body.id();
  });
  space.removeWithShapes(oldest);
  dropRandom(space, random);
  space.eachBody([&](const Body<S>& body) { oldest = body.id(); });
  const Vector<S> place = space.body(oldest).worldCenter();
  space.body(oldest).applyImpulse({S(1), S(2)}, {place.x + ratio<S>(1, 8), place.y});
}

template <Scalar S>
void leaveAlone(Space<S>&, std::uint64_t) {}

}  // namespace

template <Scalar S>
PlatformScene<S> platformScene(int index) {
  const PlatformScene<S> scenes[kPlatformScenes] = {{"pyramid", buildPyramid<S>, leaveAlone<S>},
                                                    {"soup", buildSoup<S>, comeAndGo<S>},
                                                    {"tumbler", buildTumbler<S>, leaveAlone<S>}};
  return scenes[index];
}

#ifndef SAMESTEP_FIXED_ONLY
template PlatformScene<double> platformScene(int);
#endif
template PlatformScene<Fixed> platformScene(int);

}  // namespace samestep
