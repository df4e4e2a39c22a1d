// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>
#include <samestep/space.h>
#include "support/random.h"

namespace samestep {

/// A dynamic body with a disc of the given mass and radius.
template <Scalar S>
ShapeId addDisc(Space<S>& space, const Vector<S>& position, S radius, S mass,
                const Vector<S>& velocity = Vector<S>()) {
  Body<S> body;
  body.setPosition(position);
  body.setVelocity(velocity);
  Shape<S> disc = circleShape(space.add(body), radius);
  disc.setMass(mass);
  return space.add(disc);
}

/// Adds a body with a box.
template <Scalar S>
ShapeId addBox(Space<S>& space, const Vector<S>& position, S width, S height, S mass,
               const Vector<S>& velocity = Vector<S>()) {
  Body<S> body;
  body.setPosition(position);
  body.setVelocity(velocity);
  Shape<S> box = boxShape(space.add(body), width, height);
  box.setMass(mass);
  return space.add(box);
}

/// A segment of the static body.
template <Scalar S>
ShapeId addWall(Space<S>& space, const Vector<S>& a, const Vector<S>& b, S radius = S(0)) {
  return space.add(segmentShape(space.staticBody(), a, b, radius));
}

template <Scalar S>
BodyId bodyOf(const Space<S>& space, ShapeId shape) {
  return space.shape(shape).body();
}

/// A kinematic disc in a static one, which are a resting pair after a step, in a world where things may
/// sleep.
template <Scalar S>
void addResting(Space<S>& space, const Vector<S>& position) {
  space.setSleepTimeThreshold(S(1));
  for (const Body<S>& body : {Body<S>::kinematic(), Body<S>::fixedInPlace()}) {
    const BodyId id = space.add(body);
    space.add(circleShape(id, S(1)));
    space.body(id).setPosition(position);
  }
}

/// Half a dozen to a score of discs, boxes and segments falling into a box, some of them sensors, kinematic,
/// compound or filtered: a little of everything. The same for each seed in every scalar.
template <Scalar S>
void fillAtRandom(Space<S>& space, std::uint64_t seed) {
  Random random(seed);
  space.setGravity({S(0), S(-10)});
  const auto dress = [&](Shape<S>& shape) {
    shape.setElasticity(random.number<S>(0, 1));
    shape.setFriction(random.number<S>(0, 1));
    shape.setCollisionType(random.below(3));
    if (random.oneIn(8)) shape.setSensor(true);
    if (random.oneIn(6)) shape.setFilter({random.below(3), 0xffffffffu, 0xffffffffu});
    if (random.oneIn(6)) shape.setSurfaceVelocity({random.number<S>(-2, 2), random.number<S>(-2, 2)});
  };
  for (const auto& [a, b] : {std::pair{Vector<S>(S(-8), S(-6)), Vector<S>(S(8), S(-5))},
                             std::pair{Vector<S>(S(-8), S(-6)), Vector<S>(S(-8), S(8))},
                             std::pair{Vector<S>(S(8), S(-6)), Vector<S>(S(8), S(8))}}) {
    Shape<S> wall = segmentShape(space.staticBody(), a, b, ratio<S>(1, 4));
    wall.setFriction(S(1));
    wall.setElasticity(ratio<S>(1, 2));
    space.add(wall);
  }
  const int count = random.between(6, 20);
  for (int i = 0; i < count; ++i) {
    Body<S> body = random.oneIn(8) ? Body<S>::kinematic() : Body<S>();
    body.setPosition({random.number<S>(-7, 7), random.number<S>(-5, 8)});
    body.setVelocity({random.number<S>(-4, 4), random.number<S>(-4, 4)});
    body.setAngle(random.number<S>(-3, 3));
    body.setAngularVelocity(random.number<S>(-3, 3));
    body.setUserData(random.next());
    const BodyId id = space.add(body);
    const int parts = random.oneIn(4) ? 2 : 1;
    for (int part = 0; part < parts; ++part) {
      const Vector<S> offset(S(part), random.number<S>(0, 1));
      const S size = S(1) + random.number<S>(0, 1);
      Shape<S> shape = circleShape(id, size * ratio<S>(1, 2), offset);
      if (random.oneIn(2)) shape = boxShape(id, BB<S>::forExtents(offset, size, size * ratio<S>(1, 2)));
      if (random.oneIn(5)) shape = segmentShape(id, offset - Vector<S>(size, S(0)), offset, ratio<S>(1, 8));
      shape.setMass(S(random.between(1, 4)));
      dress(shape);
      space.add(shape);
    }
  }
}

/// 1/64 s: exact in every scalar.
template <Scalar S>
inline constexpr S kTick = S(1) / S(64);

/// The hash after each of a number of steps.
template <Scalar S>
std::vector<std::uint64_t> hashesOf(Space<S>& space, int steps) {
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < steps; ++i) {
    space.step(kTick<S>);
    hashes.push_back(space.hash());
  }
  return hashes;
}

/// Calls that must throw E and leave the world as it was, bit by bit.
template <class E, Scalar S, class Call>
void expectRefused(Space<S>& space, Call&& call) {
  const std::uint64_t before = space.hash();
  EXPECT_THROW(call(), E);
  EXPECT_EQ(space.hash(), before);
}

}  // namespace samestep
