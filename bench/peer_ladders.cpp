// SPDX-License-Identifier: MIT
// The ladders of contact_ladders.h climbed by Chipmunk and Box2D: rows for docs/stability.md.
#include <box2d/box2d.h>
#include <chipmunk/chipmunk.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "study/contact_ladders.h"
#include "study/envelope.h"

namespace samestep::bench {
namespace {

constexpr int kRate = 60;

/// A world of Chipmunk with 10 iterations.
class ChipmunkTrial {
 public:
  using Number = double;
  static constexpr int kStepsPerSecond = kRate;

  explicit ChipmunkTrial(int gravity) : space_(cpSpaceNew()) {
    cpSpaceSetIterations(space_, 10);
    cpSpaceSetGravity(space_, cpv(0, -gravity));
    cpSpaceSetCollisionSlop(space_, 0.005);
  }
  ~ChipmunkTrial() {
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
  ChipmunkTrial(const ChipmunkTrial&) = delete;
  ChipmunkTrial& operator=(const ChipmunkTrial&) = delete;

  void addStaticBox(const Vector<double>& center, double width, double height,
                    const TrialSurface<double>& surface) {
    cpBody* body = add(cpBodyNewStatic(), center, {});
    add(cpBoxShapeNew(body, width, height, 0), surface);
  }
  void addStaticSegment(const Vector<double>& a, const Vector<double>& b,
                        const TrialSurface<double>& surface) {
    cpBody* body = add(cpBodyNewStatic(), {}, {});
    add(cpSegmentShapeNew(body, cpv(a.x, a.y), cpv(b.x, b.y), 0), surface);
  }
  cpBody* addBox(const Vector<double>& center, double width, double height, const Vector<double>& velocity,
                 const TrialSurface<double>& surface, bool turns) {
    const double mass = width * height;
    const double moment = turns ? cpMomentForBox(mass, width, height) : static_cast<double>(INFINITY);
    cpBody* body = add(cpBodyNew(mass, moment), center, velocity);
    add(cpBoxShapeNew(body, width, height, 0), surface);
    return body;
  }
  cpBody* addBall(const Vector<double>& center, double radius, const Vector<double>& velocity,
                  const TrialSurface<double>& surface) {
    const double mass = cpAreaForCircle(0, radius);
    cpBody* body = add(cpBodyNew(mass, cpMomentForCircle(mass, 0, radius, cpvzero)), center, velocity);
    add(cpCircleShapeNew(body, radius, cpvzero), surface);
    return body;
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) cpSpaceStep(space_, 1.0 / kRate);
  }
  static Vector<double> center(const cpBody* body) {
    const cpVect place = cpBodyGetPosition(body);
    return {place.x, place.y};
  }
  static Vector<double> velocity(const cpBody* body) {
    const cpVect velocity = cpBodyGetVelocity(body);
    return {velocity.x, velocity.y};
  }
  static double angle(const cpBody* body) { return cpBodyGetAngle(body); }

 private:
  cpBody* add(cpBody* body, const Vector<double>& center, const Vector<double>& velocity) {
    cpSpaceAddBody(space_, body);
    cpBodySetPosition(body, cpv(center.x, center.y));
    if (cpBodyGetType(body) != CP_BODY_TYPE_STATIC) cpBodySetVelocity(body, cpv(velocity.x, velocity.y));
    bodies_.push_back(body);
    return body;
  }
  void add(cpShape* shape, const TrialSurface<double>& surface) {
    cpShapeSetFriction(shape, surface.friction);
    cpShapeSetElasticity(shape, surface.elasticity);
    shapes_.push_back(cpSpaceAddShape(space_, shape));
  }

  cpSpace* space_;
  std::vector<cpShape*> shapes_;
  std::vector<cpBody*> bodies_;
};

/// A world of Box2D with 8 velocity and 3 position iterations.
class Box2dTrial {
 public:
  using Number = double;
  static constexpr int kStepsPerSecond = kRate;

  explicit Box2dTrial(int gravity) : world_(b2Vec2(0, static_cast<float>(-gravity))) {
    world_.SetAllowSleeping(false);
  }

  void addStaticBox(const Vector<double>& center, double width, double height,
                    const TrialSurface<double>& surface) {
    b2PolygonShape shape;
    shape.SetAsBox(narrow(width / 2), narrow(height / 2));
    add(b2_staticBody, center, {}, shape, surface);
  }
  void addStaticSegment(const Vector<double>& a, const Vector<double>& b,
                        const TrialSurface<double>& surface) {
    b2EdgeShape shape;
    shape.SetTwoSided(narrow(a), narrow(b));
    add(b2_staticBody, {}, {}, shape, surface);
  }
  b2Body* addBox(const Vector<double>& center, double width, double height, const Vector<double>& velocity,
                 const TrialSurface<double>& surface, bool turns) {
    b2PolygonShape shape;
    shape.SetAsBox(narrow(width / 2), narrow(height / 2));
    b2Body* body = add(b2_dynamicBody, center, velocity, shape, surface);
    body->SetFixedRotation(!turns);
    return body;
  }
  b2Body* addBall(const Vector<double>& center, double radius, const Vector<double>& velocity,
                  const TrialSurface<double>& surface) {
    b2CircleShape shape;
    shape.m_radius = narrow(radius);
    return add(b2_dynamicBody, center, velocity, shape, surface);
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) world_.Step(1.0F / kRate, 8, 3);
  }
  static Vector<double> center(const b2Body* body) { return wide(body->GetWorldCenter()); }
  static Vector<double> velocity(const b2Body* body) { return wide(body->GetLinearVelocity()); }
  static double angle(const b2Body* body) { return body->GetAngle(); }

 private:
  static float narrow(double x) { return static_cast<float>(x); }
  static b2Vec2 narrow(const Vector<double>& v) { return {narrow(v.x), narrow(v.y)}; }
  static Vector<double> wide(const b2Vec2& v) { return {v.x, v.y}; }

  b2Body* add(b2BodyType type, const Vector<double>& center, const Vector<double>& velocity,
              const b2Shape& shape, const TrialSurface<double>& surface) {
    b2BodyDef definition;
    definition.type = type;
    definition.position = narrow(center);
    definition.linearVelocity = narrow(velocity);
    b2Body* body = world_.CreateBody(&definition);
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.density = 1;
    fixture.friction = narrow(surface.friction);
    fixture.restitution = narrow(surface.elasticity);
    body->CreateFixture(&fixture);
    return body;
  }

  b2World world_;
};

/// A row of the table: how high an engine gets.
template <class Trial>
void climb(const char* engine) {
  const int walker = lastThatHolds(kWalkerTop, [](int top) {
    for (int rung = 1; rung <= top; ++rung) {
      Trial trial(10);
      if (!walkerArrives(trial, rung)) return false;
    }
    return true;
  });
  const int pass = lastThatHolds(kPassTop, [](int rung) {
    Trial trial(0);
    return passIsLeftAlone(trial, rung);
  });
  const int bounce = lastThatHolds(kBounceTop, [](int rung) {
    Trial trial(10);
    return bouncesKeepTheirHeight(trial, rung);
  });
  std::printf("| %s |", engine);
  const auto cell = [](int holds, int top) { std::printf(holds == top ? " at least %d |" : " %d |", holds); };
  cell(walker, kWalkerTop);
  cell(pass, kPassTop);
  cell(bounce, kBounceTop);
  std::printf("\n");
}

}  // namespace
}  // namespace samestep::bench

int main() {
  using namespace samestep::bench;
  std::printf("| engine | walker | pass | bounce |\n|---|---|---|---|\n");
  climb<ChipmunkTrial>("Chipmunk 7.0.3, 10 iterations");
  climb<Box2dTrial>("Box2D 2.4.1, 8 and 3 iterations");
}
