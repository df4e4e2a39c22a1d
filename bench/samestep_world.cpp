// SPDX-License-Identifier: MIT
#include <samestep/circle_shape.h>
#include <samestep/decimal.h>
#include <samestep/poly_shape.h>
#include <samestep/space.h>
#include <samestep/workers.h>

#include <cstdio>
#include <cstdlib>

#include "peer_worlds.h"

namespace samestep::bench {
namespace {

template <Scalar S>
S exactly(const std::string& text) {
  S value;
  if (parseDecimal(text, value) == DecimalStatus::ok) return value;
  std::fprintf(stderr, "not a number: %s\n", text.c_str());
  std::exit(2);
}

template <Scalar S>
class SamestepWorld : public World {
 public:
  SamestepWorld(const PeerScene& scene, SolverChoice solver) : pool_(solver.workers) {
    if (solver.workers > 1) space_.setWorkers(&pool_);
    if (solver.soft) {
      space_.setSolver(SolverKind::softStep);
      space_.setSubsteps(solver.count);
      space_.setKernel(solver.kernel);
      if (solver.fast) space_.setPrecision(ContactPrecision::fast);
    } else {
      space_.setSolver(SolverKind::sequentialImpulses);
      space_.setIterations(solver.count);
    }
    space_.setGravity({exactly<S>(scene.gravityX), exactly<S>(scene.gravityY)});
    space_.setCollisionSlop(ratio<S>(1, 200));
    int last = -1;
    for (const SceneShape& shape : scene.shapes) {
      const bool first = shape.body != last;
      if (first) bodies_.push_back(space_.add(bodyOf(shape)));
      last = shape.body;
      Shape<S> made = shapeOf(shape, bodies_.back());
      made.setFriction(sqrt(ratio<S>(6, 10)));
      if (first && shape.isDynamic()) made.setDensity(S(1));
      space_.add(made);
      // The velocity is that of the centre of mass, which the shape has moved.
      if (first && shape.type != "static") {
        space_.body(bodies_.back()).setVelocity({exactly<S>(shape.vx), exactly<S>(shape.vy)});
      }
    }
  }
  void step() override { space_.step(ratio<S>(1, 60)); }
  std::vector<Motion> motions() const override {
    std::vector<Motion> all;
    for (const BodyId id : bodies_) {
      const Body<S>& body = space_.body(id);
      const Vector<S> position = body.position();
      const auto plain = [](S value) { return static_cast<double>(value); };
      all.push_back({plain(position.x), plain(position.y), plain(body.angle()), plain(body.velocity().x),
                     plain(body.velocity().y), plain(body.angularVelocity())});
    }
    return all;
  }

 private:
  static Body<S> bodyOf(const SceneShape& shape) {
    Body<S> body = shape.type == "static"      ? Body<S>::fixedInPlace()
                   : shape.type == "kinematic" ? Body<S>::kinematic()
                                               : Body<S>();
    body.setPosition({exactly<S>(shape.x), exactly<S>(shape.y)});
    body.setAngle(exactly<S>(shape.angle));
    body.setVelocity({exactly<S>(shape.vx), exactly<S>(shape.vy)});
    body.setAngularVelocity(exactly<S>(shape.w));
    return body;
  }
  static Shape<S> shapeOf(const SceneShape& shape, BodyId body) {
    if (shape.isCircle()) return circleShape<S>(body, exactly<S>(shape.radius), Vector<S>());
    std::vector<Vector<S>> vertices;
    for (std::size_t i = 0; i < shape.vertices.size(); i += 2) {
      vertices.push_back({exactly<S>(shape.vertices[i]), exactly<S>(shape.vertices[i + 1])});
    }
    return polyShapeRaw<S>(body, vertices, S(0));
  }

  WorkerPool pool_;
  Space<S> space_;
  std::vector<BodyId> bodies_;
};

}  // namespace

std::unique_ptr<World> makeDouble(const PeerScene& scene, SolverChoice solver) {
  return std::make_unique<SamestepWorld<double>>(scene, solver);
}
std::unique_ptr<World> makeFixed(const PeerScene& scene, SolverChoice solver) {
  return std::make_unique<SamestepWorld<Fixed>>(scene, solver);
}

}  // namespace samestep::bench
