// SPDX-License-Identifier: MIT
// Ladders of contacts that are over-eager: walkers on flat floors, passes close by, bounces. They are written
// for any engine, so that peers climb the same ones.
#pragma once

#include <iterator>

#include <samestep/math.h>
#include <samestep/vector.h>

namespace samestep {

/// Surface of a body in a trial.
template <class S>
struct TrialSurface {
  S friction{};
  S elasticity{};
};

/// Speeds at which a walker tries a floor, m/s; each on a floor of boxes and on one of segments.
inline constexpr int kWalkerSpeeds[] = {1, 2, 3, 4, 6, 8, 12, 16};
inline constexpr int kWalkerTop = 2 * static_cast<int>(std::size(kWalkerSpeeds));

/// True if a box of 1 m that may not turn crosses 12 m of a floor without friction that is made of flush
/// parts of 1 m, and still has its speed.
/// @tparam Trial  a world with gravity, of one engine: addStaticBox, addStaticSegment, addBox, addBall, run,
///                center, velocity, angle; its Number computes places
/// @param rung  the number of the speed and the floor, from 1 on
template <class Trial>
bool walkerArrives(Trial& trial, int rung) {
  using S = typename Trial::Number;
  constexpr int kTiles = 20;
  const int speed = kWalkerSpeeds[(rung - 1) / 2];
  const bool segments = rung % 2 == 0;
  for (int i = -2; i < kTiles; ++i) {
    if (segments) {
      trial.addStaticSegment({S(i), S(0)}, {S(i + 1), S(0)}, {});
    } else {
      trial.addStaticBox({S(i) + ratio<S>(1, 2), ratio<S>(-1, 2)}, S(1), S(1), {});
    }
  }
  const auto walker = trial.addBox({S(0), ratio<S>(1, 2)}, S(1), S(1), {S(speed), S(0)}, {}, false);
  // 12 m take 12 / speed seconds.
  trial.run((12 * Trial::kStepsPerSecond + speed - 1) / speed + 1);
  return trial.center(walker).x >= ratio<S>(119, 10) &&
         trial.velocity(walker).x >= ratio<S>(99 * speed, 100) &&
         abs(trial.center(walker).y - ratio<S>(1, 2)) <= ratio<S>(1, 20);
}

/// A pass is as close as 64 mm / rung.
inline constexpr int kPassTop = 64;

/// True if a ball that flies past the corner of a box at 2 m/s without touching it flies on as before.
template <class Trial>
bool passIsLeftAlone(Trial& trial, int rung) {
  using S = typename Trial::Number;
  const S radius = ratio<S>(1, 4);
  trial.addStaticBox({S(0), S(-1)}, S(2), S(2), {S(1), S(0)});
  // The corner is at (1, 0); the ball comes from above it and falls beside the box, 45 degrees being nearest.
  const S apart = radius + ratio<S>(64, 1000 * rung);
  const S half = ratio<S>(7071068, 10000000);
  const Vector<S> nearest{S(1) + apart * half, apart * half};
  const Vector<S> velocity{S(2) * half, -S(2) * half};
  const Vector<S> start = nearest - velocity * ratio<S>(1, 2);
  const auto ball = trial.addBall(start, radius, velocity, {S(1), S(0)});
  trial.run(Trial::kStepsPerSecond);
  const Vector<S> now = trial.velocity(ball);
  return abs(now.x - velocity.x) <= ratio<S>(1, 1000) && abs(now.y - velocity.y) <= ratio<S>(1, 1000);
}

inline constexpr int kBounceTop = 60;

/// True if an elastic box that falls flat from 1.8 m still bounces as high, and flat, after so many bounces.
template <class Trial>
bool bouncesKeepTheirHeight(Trial& trial, int bounces) {
  using S = typename Trial::Number;
  trial.addStaticBox({S(0), S(-1)}, S(20), S(2), {S(0), S(1)});
  const S fall = ratio<S>(18, 10);
  const auto box = trial.addBox({S(0), fall + ratio<S>(1, 2)}, S(1), S(1), {}, {S(0), S(1)}, true);
  // It takes 1.2 s from one highest point to the next.
  for (int i = 0; i < bounces; ++i) {
    S highest = S(0);
    for (int step = 0; step < 12 * Trial::kStepsPerSecond / 10; ++step) {
      trial.run(1);
      highest = max(highest, trial.center(box).y - ratio<S>(1, 2));
    }
    if (abs(highest - fall) > fall / S(10) || abs(trial.angle(box)) > ratio<S>(1, 100)) return false;
  }
  return true;
}

}  // namespace samestep
