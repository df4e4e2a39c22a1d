// SPDX-License-Identifier: MIT
#include <samestep/fingerprint.h>

#include <samestep/circle_shape.h>
#include <samestep/environment.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>
#include <samestep/space.h>
#include <samestep/version.h>

#include "base/require_ieee.h"
#include "state/state_hash.h"

namespace samestep {
namespace {

constexpr int kSamples = 64;
constexpr int kSteps = 6;

// Volatile, so that nothing is worked out by the compiler.
const volatile std::uint64_t kSeed = 0x9e3779b97f4a7c15u;

/// Numbers that are exact in every scalar: whole ones with 16 binary digits behind them.
template <Scalar S>
class Samples {
 public:
  /// Number in about [-limit, limit].
  S next(int limit) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    const int whole = static_cast<int>((state_ >> 33) % static_cast<unsigned>(2 * limit)) - limit;
    return S(whole) + ratio<S>(static_cast<int>(state_ >> 17 & 0xffff), 1 << 16);
  }
  /// Number in about [1, limit].
  S positive(int limit) { return S(1) + abs(next(limit - 1)); }

 private:
  std::uint64_t state_ = kSeed;
};

template <Scalar S>
void hashArithmetic(HashSink& sink, Samples<S>& samples) {
  const S a = samples.next(1000), b = samples.next(1000), c = samples.next(1000), d = samples.positive(1000);
  const S all[] = {a + b,
                   a - b,
                   a * b,
                   a / d,
                   reciprocal(d),
                   sqrt(d),
                   mulAdd(a, b, c),
                   mulDiv(a, b, d),
                   dot(a, b, c, d),
                   cross(a, b, c, d),
                   dot3(a, b, c, d, a, c),
                   dot4(a, b, c, d, a, c, b, d),
                   length(a, b),
                   normalize(a, b).x,
                   normalize(a, b).y};
  for (const S& result : all) sink.put(result);
  const Scaled<S> scaled = toScaled(d) * toScaled(a) + reciprocal(toScaled(d));
  sink.put(toScalar<S>(scaled / toScaled(d)));
  sink.put(static_cast<std::uint8_t>(sign(exactCross(a, b, c, d)) + 1));
}

template <Scalar S>
void hashFunctions(HashSink& sink, Samples<S>& samples) {
  const S angle = samples.next(1000), small = samples.next(8), large = samples.positive(1000);
  const SinCos<S> turn = sincos(angle);
  const S all[] = {turn.sin,    turn.cos,    atan2(small, angle),     exp(small),
                   exp2(small), log2(large), pow(large, small / S(8))};
  for (const S& result : all) sink.put(result);
}

/// Down to numbers so small that some processors give them up.
template <Scalar S>
void hashSmallNumbers(HashSink& sink, Samples<S>& samples) {
  const S factor = S(1) / (S(1 << 10) + samples.positive(1000));
  S product = samples.positive(1000);
  for (int i = 0; i < 110; ++i) {
    product = product * factor;
    if (i > 90 || i % 16 == 0) sink.put(product);
  }
}

/// A box and a disc that fall on a slope, and one that hits them.
template <Scalar S>
void hashScene(HashSink& sink, SolverKind solver, ContactPrecision precision = ContactPrecision::accurate) {
  Space<S> space;
  space.setSolver(solver);
  space.setPrecision(precision);
  space.setGravity({S(0), S(-10)});
  space.setDamping(ratio<S>(15, 16));
  space.add(segmentShape<S>(space.staticBody(), {S(-8), S(1)}, {S(8), S(-1)}, ratio<S>(1, 8)));
  const auto addBody = [&](const Vector<S>& position, const Vector<S>& velocity, S angle) {
    Body<S> body;
    body.setPosition(position);
    body.setVelocity(velocity);
    body.setAngle(angle);
    return space.add(body);
  };
  const auto addShape = [&](Shape<S> shape) {
    shape.setMass(S(2));
    shape.setFriction(ratio<S>(3, 4));
    shape.setElasticity(ratio<S>(1, 4));
    space.add(shape);
  };
  addShape(boxShape<S>(addBody({S(0), ratio<S>(3, 4)}, {}, ratio<S>(-1, 8)), S(2), S(1)));
  addShape(boxShape<S>(addBody({ratio<S>(1, 4), ratio<S>(7, 4)}, {}, S(0)), S(1), S(1)));
  addShape(circleShape<S>(addBody({S(-2), S(1)}, {S(8), S(0)}, S(0)), ratio<S>(1, 2), {}));
  for (int i = 0; i < kSteps; ++i) {
    space.step(ratio<S>(1, 60));
    sink.put(space.hash());
  }
}

/// Null where S is what it is everywhere.
template <Scalar S>
const char* flawOf() {
#ifndef SAMESTEP_FIXED_ONLY
  if constexpr (ScalarTraits<S>::kKind == ScalarKind::float64) return doubleFlaw();
#endif
  return nullptr;
}

}  // namespace

template <Scalar S>
std::uint64_t fingerprint() {
  HashSink sink;
  sink.put(kSimulationRevision);
  Samples<S> samples;
  for (int i = 0; i < kSamples; ++i) {
    hashArithmetic(sink, samples);
    hashFunctions(sink, samples);
  }
  hashSmallNumbers(sink, samples);
  // A world cannot be stepped otherwise.
  if (flawOf<S>() == nullptr) {
    hashScene<S>(sink, SolverKind::sequentialImpulses);
    hashScene<S>(sink, SolverKind::softStep);
    hashScene<S>(sink, SolverKind::softStep, ContactPrecision::fast);
  }
  return sink.finish();
}

#define SAMESTEP_EACH_SCALAR template std::uint64_t fingerprint<S>();
#include <samestep/each_scalar.h>

}  // namespace samestep
