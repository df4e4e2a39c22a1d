// SPDX-License-Identifier: MIT
#include <samestep/circle_shape.h>
#include <samestep/decimal.h>
#include <samestep/poly_shape.h>
#include <samestep/space.h>

#include <cstdio>
#include <cstdlib>

#include "peer_worlds.h"

namespace samestep::bench {
namespace {

template <Scalar S>
S number(const std::string& text) {
  S value;
  if (parseDecimal(text, value) == DecimalStatus::ok) return value;
  std::fprintf(stderr, "not a number: %s\n", text.c_str());
  std::exit(2);
}

template <Scalar S>
class SamestepWorld : public World {
 public:
  explicit SamestepWorld(const PeerScene& scene) {
    space_.setGravity({number<S>(scene.gravityX), number<S>(scene.gravityY)});
    space_.setCollisionSlop(ratio<S>(1, 200));
    int last = -1;
    BodyId id;
    for (const SceneShape& shape : scene.shapes) {
      const bool first = shape.body != last;
      if (first) id = space_.add(bodyOf(shape));
      last = shape.body;
      Shape<S> made = shapeOf(shape, id);
      made.setFriction(sqrt(ratio<S>(6, 10)));
      if (first && shape.type == "dynamic") made.setDensity(S(1));
      space_.add(made);
    }
  }
  void step() override { space_.step(ratio<S>(1, 60)); }

 private:
  static Body<S> bodyOf(const SceneShape& shape) {
    Body<S> body = shape.type == "static"      ? Body<S>::fixedInPlace()
                   : shape.type == "kinematic" ? Body<S>::kinematic()
                                               : Body<S>();
    body.setPosition({number<S>(shape.x), number<S>(shape.y)});
    body.setAngle(number<S>(shape.angle));
    body.setVelocity({number<S>(shape.vx), number<S>(shape.vy)});
    body.setAngularVelocity(number<S>(shape.w));
    return body;
  }
  static Shape<S> shapeOf(const SceneShape& shape, BodyId body) {
    if (shape.shape == "circle") return circleShape<S>(body, number<S>(shape.radius), Vector<S>());
    std::vector<Vector<S>> vertices;
    for (std::size_t i = 0; i < shape.vertices.size(); i += 2) {
      vertices.push_back({number<S>(shape.vertices[i]), number<S>(shape.vertices[i + 1])});
    }
    return polyShapeRaw<S>(body, vertices, S(0));
  }

  Space<S> space_;
};

}  // namespace

std::unique_ptr<World> makeDouble(const PeerScene& scene) {
  return std::make_unique<SamestepWorld<double>>(scene);
}
std::unique_ptr<World> makeFixed(const PeerScene& scene) {
  return std::make_unique<SamestepWorld<Fixed>>(scene);
}

}  // namespace samestep::bench
