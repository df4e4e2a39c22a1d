// SPDX-License-Identifier: MIT
// Scene files: settings, handlers and bodies. See docs/formats.md.
#include "scenes/scene_builder.h"

#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>
#include <samestep/segment_shape.h>

#include "base/require_ieee.h"
#include "dynamics/body_access.h"
#include "scenes/scene_settings.h"

namespace samestep {

template <Scalar S>
void SceneBuilder<S>::build() {
  registerNamedHandlers(scene_.space_);
  scene_.timeStep_ = ratio<S>(1, 60);
  scene_.file_ = document_.file;
  if (document_.family == "pyramid") {
    buildPyramid(document_.size);
  } else if (document_.family == "soup") {
    buildSoup(document_.size);
  } else {
    buildFile();
  }
  if (document_.tuned) {
    const std::uint32_t rate = readTuned(scene_.space_, Cursor(*document_.tuned, document_.tunedFile));
    if (rate != 0) scene_.timeStep_ = ratio<S>(1, static_cast<int>(rate));
  }
}

template <Scalar S>
void SceneBuilder<S>::buildFile() {
  const Cursor root(document_.root, document_.file);
  root.allow({"samestep", "about", "ticks", "stepsPerSecond", "settings", "handlers", "bodies", "joints",
              "events", "inputs"});
  root.at("samestep").integer(1, 1);
  if (root.has("about")) root.at("about").text();
  if (root.has("ticks")) root.at("ticks").integer(1, 1u << 20);
  if (root.has("stepsPerSecond")) {
    scene_.timeStep_ = ratio<S>(1, static_cast<int>(readStepsPerSecond(root)));
  }
  if (root.has("settings")) readSettings(scene_.space_, root.at("settings"));
  if (root.has("handlers")) readHandlers(root.at("handlers"));
  if (root.has("bodies")) readBodies(root.at("bodies"));
  if (root.has("joints")) readJoints(root.at("joints"));
  if (root.has("events")) readEvents(root.at("events"));
  if (root.has("inputs")) readInputs(root.at("inputs"));
  const auto byTick = [](const Event& a, const Event& b) { return a.tick < b.tick; };
  std::stable_sort(scene_.events_.begin(), scene_.events_.end(), byTick);
}

template <Scalar S>
void SceneBuilder<S>::readHandlers(const Cursor& at) {
  const auto type = [](const Cursor& c) { return static_cast<CollisionType>(c.integer(0, 0xffffffffu)); };
  for (std::uint32_t i = 0; i < at.size(); ++i) {
    const Cursor entry = at.item(i);
    entry.allow({"types", "type", "all", "do"});
    const CallbackNumber number = handlerNumber(entry.at("do").text());
    if (number == 0) {
      std::string known;
      for (const NamedHandler& handler : kNamedHandlers) {
        known += (known.empty() ? "" : ", ") + std::string(handler.name);
      }
      entry.at("do").fail("no handler of this name; there are: " + known);
    }
    if (entry.has("types") + entry.has("type") + entry.has("all") != 1) {
      entry.fail("one of \"types\", \"type\" and \"all\" is wanted here");
    }
    Space<S>& space = scene_.space_;
    if (entry.has("types")) {
      const Cursor types = entry.at("types");
      if (types.size() != 2) types.fail("two collision types are wanted here");
      space.addCollisionHandler(type(types.item(0)), type(types.item(1)), number);
    } else if (entry.has("type")) {
      space.addWildcardHandler(type(entry.at("type")), number);
    } else {
      if (!entry.at("all").boolean()) entry.at("all").fail("only true makes sense here");
      space.addDefaultCollisionHandler(number);
    }
  }
}

template <Scalar S>
void SceneBuilder<S>::readBodies(const Cursor& at) {
  for (std::uint32_t i = 0; i < at.size(); ++i) {
    const Cursor entry = at.item(i);
    if (entry.has("csv")) {
      readCsvBodies(entry);
      continue;
    }
    const Spawn<S> body = readBody(entry);
    const std::string name = entry.has("name") ? entry.at("name").text() : std::string();
    if (entry.has("grid")) {
      readGrid(entry.at("grid"), body, name);
    } else {
      addNamed(entry, name, body);
    }
  }
}

/// Copies of a body in rows and columns.
template <Scalar S>
void SceneBuilder<S>::readGrid(const Cursor& at, const Spawn<S>& body, const std::string& name) {
  at.allow({"columns", "rows", "across", "up"});
  const auto columns = static_cast<int>(at.has("columns") ? at.at("columns").integer(1, 10000) : 1);
  const auto rows = static_cast<int>(at.has("rows") ? at.at("rows").integer(1, 10000) : 1);
  const Vector<S> across = at.has("across") ? at.at("across").template vector<S>() : Vector<S>();
  const Vector<S> up = at.has("up") ? at.at("up").template vector<S>() : Vector<S>();
  // So that no product below can overflow.
  const auto check = [&](const char* key, const Vector<S>& step, int count) {
    if (!within(step, kMaxWorldExtent<S> / S(count))) at.at(key).fail("leads out of the world");
  };
  check("across", across, columns);
  check("up", up, rows);
  Spawn<S> copy = body;
  const Vector<S> origin = body.body.position();
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      at.guard([&] { copy.body.setPosition(origin + across * S(column) + up * S(row)); });
      const std::string number = std::to_string(row * columns + column);
      addNamed(at, name.empty() ? name : name + "." + number, copy);
    }
  }
}

template <Scalar S>
Spawn<S> SceneBuilder<S>::readBody(const Cursor& at) {
  at.allow({"name", "type", "mass", "moment", "rotates", "position", "angle", "velocity", "angularVelocity",
            "userData", "maySleep", "bullet", "gravityScale", "linearDamping", "angularDamping", "speedLimit",
            "spinLimit", "shapes", "grid"});
  Spawn<S> made;
  Body<S>& body = made.body;
  at.optional("rotates", [&](const Cursor& v) {
    if (!v.boolean()) body = Body<S>::nonRotating(S(0));
  });
  at.optional("bullet", [&](const Cursor& v) { body.setBullet(v.boolean()); });
  at.optional("type", [&](const Cursor& v) {
    const std::string& type = v.text();
    if (type == "static") {
      body.setType(BodyType::staticBody);
    } else if (type == "kinematic") {
      body.setType(BodyType::kinematicBody);
    } else if (type != "dynamic") {
      v.fail("\"dynamic\", \"kinematic\" or \"static\" is wanted here");
    }
  });
  at.optional("mass", [&](const Cursor& v) { body.setMass(v.template number<S>()); });
  at.optional("moment", [&](const Cursor& v) {
    if (!body.rotates()) v.fail("what does not rotate has no moment");
    body.setMoment(v.template number<S>());
  });
  at.optional("position", [&](const Cursor& v) { body.setPosition(v.template vector<S>()); });
  at.optional("angle", [&](const Cursor& v) { body.setAngle(v.template number<S>()); });
  at.optional("velocity", [&](const Cursor& v) { body.setVelocity(v.template vector<S>()); });
  at.optional("angularVelocity", [&](const Cursor& v) { body.setAngularVelocity(v.template number<S>()); });
  at.optional("userData", [&](const Cursor& v) { body.setUserData(v.integer(0, ~std::uint64_t{0})); });
  at.optional("gravityScale", [&](const Cursor& v) { body.setGravityScale(v.template number<S>()); });
  at.optional("linearDamping", [&](const Cursor& v) { body.setLinearDamping(v.template number<S>()); });
  at.optional("angularDamping", [&](const Cursor& v) { body.setAngularDamping(v.template number<S>()); });
  at.optional("speedLimit", [&](const Cursor& v) { body.setSpeedLimit(v.template number<S>()); });
  at.optional("spinLimit", [&](const Cursor& v) { body.setSpinLimit(v.template number<S>()); });
  at.optional("maySleep", [&](const Cursor& v) { body.setMaySleep(v.boolean()); });
  if (at.has("shapes")) {
    const Cursor shapes = at.at("shapes");
    for (std::uint32_t i = 0; i < shapes.size(); ++i) made.shapes.push_back(readShape(shapes.item(i)));
  }
  refuseSecondMass(at, made);
  return made;
}

/// A body has its mass from itself or from its shapes: what would not be used is an error.
template <Scalar S>
void SceneBuilder<S>::refuseSecondMass(const Cursor& at, const Spawn<S>& body) {
  const auto weighs = [](const Shape<S>& shape) { return shape.mass() > S(0); };
  if (std::none_of(body.shapes.begin(), body.shapes.end(), weighs)) return;
  for (const char* key : {"mass", "moment"}) {
    if (at.has(key))
      at.at(key).fail("means nothing to a body of which a shape has a mass: it has that of its shapes");
  }
}

/// Notes the place of the first body that no step could move: see Scene::refused.
template <Scalar S>
void SceneBuilder<S>::noteUnsteppable(const Cursor& at, const Body<S>& body) {
  const char* reason = BodyAccess<S>::cannotStep(body);
  if (reason != nullptr && !scene_.unsteppable_) scene_.unsteppable_ = at.error(reason);
}

template <Scalar S>
std::vector<Vector<S>> SceneBuilder<S>::readPoints(const Cursor& at) {
  std::vector<Vector<S>> points;
  for (std::uint32_t i = 0; i < at.size(); ++i) points.push_back(at.item(i).template vector<S>());
  return points;
}

template <Scalar S>
Shape<S> SceneBuilder<S>::readGeometry(const Cursor& at) {
  const S radius = at.has("radius") ? at.at("radius").template number<S>() : S(0);
  const auto only = [&](std::string_view kind) {
    for (const std::string_view other : {"circle", "box", "polygon", "hull", "segment"}) {
      if (other != kind && at.has(other)) at.at(other).fail("a shape is one thing only");
    }
    const auto refuse = [&](std::string_view key, bool meant) {
      if (!meant && at.has(key)) at.at(key).fail("means nothing to a " + std::string(kind));
    };
    refuse("offset", kind == "circle");
    refuse("neighbors", kind == "segment");
    refuse("radius", kind != "circle");
    return at.at(kind);
  };
  if (at.has("circle")) {
    const Cursor circle = only("circle");
    const Vector<S> offset = at.has("offset") ? at.at("offset").template vector<S>() : Vector<S>();
    return circle.guard([&] { return circleShape<S>({}, circle.template number<S>(), offset); });
  }
  if (at.has("box")) {
    const Vector<S> size = only("box").template vector<S>();
    return at.at("box").guard([&] { return boxShape<S>({}, size.x, size.y, radius); });
  }
  if (at.has("polygon") || at.has("hull")) {
    const bool raw = at.has("polygon");
    const Cursor corners = only(raw ? "polygon" : "hull");
    const std::vector<Vector<S>> points = readPoints(corners);
    return corners.guard([&] {
      return raw ? polyShapeRaw<S>({}, points, radius) : polyShape<S>({}, points, Transform<S>(), radius);
    });
  }
  if (!at.has("segment")) at.fail("one of circle, box, polygon, hull and segment is wanted here");
  const Cursor segment = only("segment");
  const std::vector<Vector<S>> ends = readPoints(segment);
  if (ends.size() != 2) segment.fail("two points are wanted here");
  Shape<S> shape = segment.guard([&] { return segmentShape<S>({}, ends[0], ends[1], radius); });
  if (at.has("neighbors")) {
    const Cursor neighbors = at.at("neighbors");
    const std::vector<Vector<S>> points = readPoints(neighbors);
    if (points.size() != 2) neighbors.fail("two points are wanted here");
    neighbors.guard([&] { SegmentShape<S>(shape).setNeighbors(points[0], points[1]); });
  }
  return shape;
}

template <Scalar S>
Shape<S> SceneBuilder<S>::readShape(const Cursor& at) {
  at.allow({"circle", "offset",   "box",  "polygon",  "hull",       "segment",           "neighbors",
            "radius", "density",  "mass", "friction", "elasticity", "surfaceVelocity",   "collisionType",
            "group",  "category", "mask", "sensor",   "material",   "rollingResistance", "userData"});
  Shape<S> shape = readGeometry(at);
  const auto word = [](const Cursor& v) { return static_cast<std::uint32_t>(v.integer(0, 0xffffffffu)); };
  ShapeFilter filter;
  at.optional("density", [&](const Cursor& v) { shape.setDensity(v.template number<S>()); });
  at.optional("mass", [&](const Cursor& v) {
    if (at.has("density")) v.fail("a shape has a mass or a density");
    shape.setMass(v.template number<S>());
  });
  at.optional("friction", [&](const Cursor& v) { shape.setFriction(v.template number<S>()); });
  at.optional("elasticity", [&](const Cursor& v) { shape.setElasticity(v.template number<S>()); });
  at.optional("surfaceVelocity", [&](const Cursor& v) { shape.setSurfaceVelocity(v.template vector<S>()); });
  at.optional("collisionType", [&](const Cursor& v) { shape.setCollisionType(word(v)); });
  at.optional("group", [&](const Cursor& v) { filter.group = word(v); });
  at.optional("category", [&](const Cursor& v) { filter.category = word(v); });
  at.optional("mask", [&](const Cursor& v) { filter.mask = word(v); });
  at.optional("rollingResistance",
              [&](const Cursor& v) { shape.setRollingResistance(v.template number<S>()); });
  at.optional("material", [&](const Cursor& v) { shape.setMaterial(word(v)); });
  at.optional("sensor", [&](const Cursor& v) { shape.setSensor(v.boolean()); });
  at.optional("userData", [&](const Cursor& v) { shape.setUserData(v.integer(0, ~std::uint64_t{0})); });
  shape.setFilter(filter);
  return shape;
}

template <Scalar S>
BodyId SceneBuilder<S>::addBody(const Spawn<S>& body) {
  return applyCommand<S>(scene_.space_, body);
}

template <Scalar S>
void SceneBuilder<S>::addNamed(const Cursor& at, const std::string& name, const Spawn<S>& body) {
  if (scene_.space_.bodyCount() >= kMaxSceneBodies) {
    at.fail(tooMany("bodies", kMaxSceneBodies));
  }
  if (scene_.space_.shapeCount() + body.shapes.size() > kMaxSceneShapes) {
    at.fail(tooMany("shapes", kMaxSceneShapes));
  }
  const BodyId id = at.guard([&] { return addBody(body); });
  noteUnsteppable(at, scene_.space_.body(id));
  if (!name.empty()) scene_.names_[newName(at, name)] = id;
}

template <Scalar S>
std::uint32_t SceneBuilder<S>::newName(const Cursor& at, const std::string& name) {
  const auto number = static_cast<std::uint32_t>(scene_.names_.size());
  if (!names_.emplace(name, number).second) at.fail("there is a body named \"" + name + "\" already");
  scene_.names_.push_back({});
  return number;
}

#define SAMESTEP_EACH_SCALAR template class SceneBuilder<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
