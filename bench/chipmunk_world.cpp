// SPDX-License-Identifier: MIT
#include <chipmunk/chipmunk.h>

#include <cmath>

#include "peer_worlds.h"

namespace samestep::bench {
namespace {

class ChipmunkWorld : public World {
 public:
  ChipmunkWorld(const PeerScene& scene, int iterations) : space_(cpSpaceNew()) {
    cpSpaceSetIterations(space_, iterations);
    cpSpaceSetGravity(space_, cpv(number(scene.gravityX), number(scene.gravityY)));
    cpSpaceSetCollisionSlop(space_, 0.005);
    int last = -1;
    for (const SceneShape& row : scene.shapes) {
      const bool first = row.body != last;
      last = row.body;
      if (first) bodies_.push_back(addBody(row));
      shapes_.push_back(addShape(row, bodies_.back(), first));
    }
  }
  ~ChipmunkWorld() override {
    for (cpShape* shape : shapes_) {
      cpSpaceRemoveShape(space_, shape);
      cpShapeFree(shape);
    }
    for (cpBody* body : bodies_) {
      cpSpaceRemoveBody(space_, body);
      cpBodyFree(body);
    }
    cpSpaceFree(space_);
  }
  void step() override { cpSpaceStep(space_, 1.0 / 60.0); }
  std::vector<Motion> motions() const override {
    std::vector<Motion> all;
    for (const cpBody* body : bodies_) {
      const cpVect position = cpBodyGetPosition(body);
      const cpVect velocity = cpBodyGetVelocity(body);
      all.push_back({position.x, position.y, cpBodyGetAngle(body), velocity.x, velocity.y,
                     cpBodyGetAngularVelocity(body)});
    }
    return all;
  }

 private:
  cpBody* addBody(const SceneShape& row) {
    cpBody* body = row.type == "static"      ? cpBodyNewStatic()
                   : row.type == "kinematic" ? cpBodyNewKinematic()
                                             : cpBodyNew(0, 0);
    cpSpaceAddBody(space_, body);
    cpBodySetPosition(body, cpv(number(row.x), number(row.y)));
    cpBodySetAngle(body, number(row.angle));
    if (row.type != "static") {
      cpBodySetVelocity(body, cpv(number(row.vx), number(row.vy)));
      cpBodySetAngularVelocity(body, number(row.w));
    }
    return body;
  }
  cpShape* addShape(const SceneShape& row, cpBody* body, bool first) {
    cpShape* shape;
    if (row.isCircle()) {
      shape = cpCircleShapeNew(body, number(row.radius), cpvzero);
    } else {
      std::vector<cpVect> vertices;
      for (std::size_t i = 0; i < row.vertices.size(); i += 2) {
        vertices.push_back(cpv(number(row.vertices[i]), number(row.vertices[i + 1])));
      }
      shape = cpPolyShapeNewRaw(body, static_cast<int>(vertices.size()), vertices.data(), 0);
    }
    cpShapeSetFriction(shape, std::sqrt(0.6));
    if (first && row.isDynamic()) cpShapeSetDensity(shape, 1);
    return cpSpaceAddShape(space_, shape);
  }

  cpSpace* space_;
  std::vector<cpShape*> shapes_;
  std::vector<cpBody*> bodies_;
};

}  // namespace

std::unique_ptr<World> makeChipmunk(const PeerScene& scene, int iterations) {
  return std::make_unique<ChipmunkWorld>(scene, iterations);
}

}  // namespace samestep::bench
