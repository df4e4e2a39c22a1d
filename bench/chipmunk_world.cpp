// SPDX-License-Identifier: MIT
#include <chipmunk/chipmunk.h>

#include <cmath>
#include <cstdlib>

#include "peer_worlds.h"

namespace samestep::bench {
namespace {

double number(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

class ChipmunkWorld : public World {
 public:
  explicit ChipmunkWorld(const PeerScene& scene) : space_(cpSpaceNew()) {
    cpSpaceSetGravity(space_, cpv(number(scene.gravityX), number(scene.gravityY)));
    cpSpaceSetCollisionSlop(space_, 0.005);
    int last = -1;
    cpBody* body = nullptr;
    for (const SceneShape& row : scene.shapes) {
      const bool first = row.body != last;
      last = row.body;
      if (first) body = addBody(row);
      addShape(row, body, first);
    }
  }
  ~ChipmunkWorld() override {
    cpSpaceEachShape(
        space_, [](cpShape* shape, void* all) { static_cast<std::vector<cpShape*>*>(all)->push_back(shape); },
        &shapes_);
    cpSpaceEachBody(
        space_, [](cpBody* body, void* all) { static_cast<std::vector<cpBody*>*>(all)->push_back(body); },
        &bodies_);
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
  void addShape(const SceneShape& row, cpBody* body, bool first) {
    cpShape* shape;
    if (row.shape == "circle") {
      shape = cpCircleShapeNew(body, number(row.radius), cpvzero);
    } else {
      std::vector<cpVect> vertices;
      for (std::size_t i = 0; i < row.vertices.size(); i += 2) {
        vertices.push_back(cpv(number(row.vertices[i]), number(row.vertices[i + 1])));
      }
      shape = cpPolyShapeNewRaw(body, static_cast<int>(vertices.size()), vertices.data(), 0);
    }
    cpShapeSetFriction(shape, std::sqrt(0.6));
    if (first && row.type == "dynamic") cpShapeSetDensity(shape, 1);
    cpSpaceAddShape(space_, shape);
  }

  cpSpace* space_;
  std::vector<cpShape*> shapes_;
  std::vector<cpBody*> bodies_;
};

}  // namespace

std::unique_ptr<World> makeChipmunk(const PeerScene& scene) { return std::make_unique<ChipmunkWorld>(scene); }

}  // namespace samestep::bench
