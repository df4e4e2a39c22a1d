// SPDX-License-Identifier: MIT
#include <box2d/box2d.h>

#include "peer_worlds.h"

namespace samestep::bench {
namespace {

float narrow(const std::string& text) { return static_cast<float>(number(text)); }

class Box2dWorld : public World {
 public:
  explicit Box2dWorld(const PeerScene& scene)
      : world_(b2Vec2(narrow(scene.gravityX), narrow(scene.gravityY))) {
    world_.SetAllowSleeping(false);
    int last = -1;
    for (const SceneShape& row : scene.shapes) {
      const bool first = row.body != last;
      last = row.body;
      if (first) addBody(row);
      addShape(row, first);
    }
  }
  void step() override { world_.Step(1.0F / 60.0F, 8, 3); }
  std::vector<Motion> motions() const override {
    std::vector<Motion> all;
    for (const b2Body* body : bodies_) {
      const b2Vec2 position = body->GetPosition();
      const b2Vec2 velocity = body->GetLinearVelocity();
      all.push_back(
          {position.x, position.y, body->GetAngle(), velocity.x, velocity.y, body->GetAngularVelocity()});
    }
    return all;
  }

 private:
  void addBody(const SceneShape& row) {
    b2BodyDef body;
    body.type = row.type == "static"      ? b2_staticBody
                : row.type == "kinematic" ? b2_kinematicBody
                                          : b2_dynamicBody;
    body.position.Set(narrow(row.x), narrow(row.y));
    body.angle = narrow(row.angle);
    body.linearVelocity.Set(narrow(row.vx), narrow(row.vy));
    body.angularVelocity = narrow(row.w);
    bodies_.push_back(world_.CreateBody(&body));
  }
  void addShape(const SceneShape& row, bool first) {
    b2CircleShape circle;
    b2PolygonShape polygon;
    b2FixtureDef fixture;
    if (row.isCircle()) {
      circle.m_radius = narrow(row.radius);
      fixture.shape = &circle;
    } else {
      std::vector<b2Vec2> vertices;
      for (std::size_t i = 0; i < row.vertices.size(); i += 2) {
        vertices.emplace_back(narrow(row.vertices[i]), narrow(row.vertices[i + 1]));
      }
      polygon.Set(vertices.data(), static_cast<int32>(vertices.size()));
      fixture.shape = &polygon;
    }
    fixture.friction = 0.6F;
    fixture.density = first && row.isDynamic() ? 1.0F : 0.0F;
    bodies_.back()->CreateFixture(&fixture);
  }

  b2World world_;
  std::vector<b2Body*> bodies_;
};

}  // namespace

std::unique_ptr<World> makeBox2d(const PeerScene& scene) { return std::make_unique<Box2dWorld>(scene); }

}  // namespace samestep::bench
