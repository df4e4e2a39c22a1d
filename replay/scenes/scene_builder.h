// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <samestep/named_handlers.h>
#include <samestep/scene.h>

#include "scenes/scene_cursor.h"
#include "scenes/scene_document.h"

namespace samestep {

/// Surface that a scene gives each shape of a CSV file of bodies.
template <Scalar S>
struct CsvSurface {
  S density{1};
  S friction{};
  S elasticity{};
};

/// Turns a document into a world and events.
template <Scalar S>
class SceneBuilder {
 public:
  SceneBuilder(Scene<S>& scene, const SceneSource::Document& document) : scene_(scene), document_(document) {}

  void build();

 private:
  using Event = typename Scene<S>::Event;
  static constexpr std::uint32_t kNoName = 0xffffffffu;
  struct NamedJoint {
    JointId id;
    Joint<S> joint;
  };

  void buildFile();
  void buildPyramid(std::uint32_t rows);
  void buildSoup(std::uint32_t count);

  void readHandlers(const Cursor& at);
  void readBodies(const Cursor& at);
  void readCsvBodies(const Cursor& at);
  void readGrid(const Cursor& at, const Spawn<S>& body, const std::string& name);
  void readJoints(const Cursor& at);
  void readJoint(const Cursor& at);
  void readJointFields(const Cursor& at, Joint<S>& joint);
  void addJoint(const Cursor& at, Joint<S> joint, const std::string& number);
  BodyId jointBody(const Cursor& at, const std::string& suffix) const;
  NamedJoint& jointNamed(const Cursor& at);
  void readJointEvent(const Cursor& at, CommandKind kind, std::uint64_t tick);
  void readEvents(const Cursor& at);
  void readInputs(const Cursor& at);

  Spawn<S> readBody(const Cursor& at);
  Shape<S> readShape(const Cursor& at);
  Shape<S> readGeometry(const Cursor& at);
  std::vector<Vector<S>> readPoints(const Cursor& at);
  void readEvent(const Cursor& at, std::uint32_t spawned);

  static void refuseSecondMass(const Cursor& at, const Spawn<S>& body);
  void noteUnsteppable(const Cursor& at, const Body<S>& body);

  BodyId addBody(const Spawn<S>& body);
  void addNamed(const Cursor& at, const std::string& name, const Spawn<S>& body);
  std::uint32_t newName(const Cursor& at, const std::string& name);
  /// kNoName where there is none.
  std::uint32_t nameOf(const std::string& name) const;
  Event& addEvent(const Cursor& at, std::uint64_t tick, std::uint32_t name, Command<S>&& command);

  Scene<S>& scene_;
  const SceneSource::Document& document_;
  std::map<std::string, std::uint32_t> names_;
  std::map<std::string, NamedJoint> joints_;
};

}  // namespace samestep
