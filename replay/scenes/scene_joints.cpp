// SPDX-License-Identifier: MIT
// Scene files: joints. See docs/formats.md.
#include "base/require_ieee.h"
#include "scenes/scene_builder.h"

namespace samestep {
namespace {

struct KindName {
  std::string_view name;
  JointKind kind;
};
constexpr KindName kKinds[] = {
    {"revolute", JointKind::revolute}, {"prismatic", JointKind::prismatic}, {"distance", JointKind::distance},
    {"weld", JointKind::weld},         {"wheel", JointKind::wheel},         {"target", JointKind::target},
    {"gear", JointKind::gear},         {"ratchet", JointKind::ratchet},
};

JointKind kindOf(const Cursor& at) {
  std::string known;
  for (const auto& [name, kind] : kKinds) {
    if (name == at.text()) return kind;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  at.fail("no kind of joint of this name; there are: " + known);
}

/// Number of joints of an entry, and the way the names of their bodies are numbered.
struct Repeated {
  std::uint32_t count = 1;
  bool isChain = false;
  bool numbered = false;
};

Repeated repeatedOf(const Cursor& at) {
  if (at.has("links") && at.has("copies")) at.fail("\"links\" or \"copies\" is wanted here, not both");
  if (at.has("links")) return {static_cast<std::uint32_t>(at.at("links").integer(1, 10000)), true, true};
  if (at.has("copies")) return {static_cast<std::uint32_t>(at.at("copies").integer(1, 10000)), false, true};
  return {};
}

}  // namespace

template <Scalar S>
BodyId SceneBuilder<S>::jointBody(const Cursor& at, const std::string& suffix) const {
  if (at.text() == "static") return scene_.space_.staticBody();
  const std::uint32_t name = nameOf(at.text() + suffix);
  if (name == kNoName) at.fail("no body is named \"" + at.text() + suffix + "\"");
  return scene_.names_[name];
}

/// Reads what may also be adjusted later.
template <Scalar S>
void SceneBuilder<S>::readJointFields(const Cursor& at, Joint<S>& joint) {
  const auto number = [&](const char* key, S& field) {
    at.optional(key, [&](const Cursor& v) { field = v.template number<S>(); });
  };
  const auto vector = [&](const char* key, Vector<S>& field) {
    at.optional(key, [&](const Cursor& v) { field = v.template vector<S>(); });
  };
  vector("anchorA", joint.anchorA);
  vector("anchorB", joint.anchorB);
  at.optional("axis", [&](const Cursor& v) { joint.axis = normalize(v.template vector<S>()); });
  vector("velocity", joint.velocity);
  number("rest", joint.rest);
  number("angle", joint.angle);
  number("lower", joint.lower);
  number("upper", joint.upper);
  number("motorSpeed", joint.motorSpeed);
  number("motorMax", joint.motorMax);
  number("hertz", joint.hertz);
  number("damping", joint.damping);
  number("angularHertz", joint.angularHertz);
  number("angularDamping", joint.angularDamping);
  number("maxForce", joint.maxForce);
  number("maxTorque", joint.maxTorque);
  number("breakForce", joint.breakForce);
  number("breakTorque", joint.breakTorque);
  number("ratio", joint.ratio);
  at.optional("collide", [&](const Cursor& v) { joint.collideConnected = v.boolean() ? 1 : 0; });
  at.optional("userData", [&](const Cursor& v) { joint.userData = v.integer(0, ~std::uint64_t{0}); });
  const bool isPull = joint.kind == JointKind::weld || joint.kind == JointKind::target;
  if (at.has("lower") || at.has("upper")) joint.limited = 1;
  if (at.has("motorMax")) joint.motor = 1;
  if (at.has("hertz") && !isPull) joint.spring = 1;
}

template <Scalar S>
void SceneBuilder<S>::readJoints(const Cursor& at) {
  for (std::uint32_t i = 0; i < at.size(); ++i) readJoint(at.item(i));
}

template <Scalar S>
void SceneBuilder<S>::readJoint(const Cursor& at) {
  at.allow(
      {"name",     "kind",       "a",          "b",           "links",   "copies",       "at",
       "anchorA",  "anchorB",    "axis",       "velocity",    "rest",    "angle",        "lower",
       "upper",    "motorSpeed", "motorMax",   "hertz",       "damping", "angularHertz", "angularDamping",
       "maxForce", "maxTorque",  "breakForce", "breakTorque", "ratio",   "collide",      "userData"});
  Joint<S> joint;
  joint.kind = kindOf(at.at("kind"));
  const Repeated repeated = repeatedOf(at);
  for (std::uint32_t i = 0; i < repeated.count; ++i) {
    const std::string number = repeated.numbered ? "." + std::to_string(i) : "";
    joint.bodyA = jointBody(at.at("a"), number);
    joint.bodyB = jointBody(at.at("b"), repeated.isChain ? "." + std::to_string(i + 1) : number);
    addJoint(at, joint, number);
  }
}

template <Scalar S>
void SceneBuilder<S>::addJoint(const Cursor& at, Joint<S> joint, const std::string& number) {
  Space<S>& space = scene_.space_;
  if (space.jointCount() >= kMaxSceneJoints) at.fail(tooMany("joints", kMaxSceneJoints));
  const Body<S>&a = std::as_const(space).body(joint.bodyA), &b = std::as_const(space).body(joint.bodyB);
  // Bodies stay as they stand now.
  joint.angle =
      joint.kind == JointKind::gear || joint.kind == JointKind::ratchet ? S(0) : b.angle() - a.angle();
  at.optional("at", [&](const Cursor& v) {
    const Vector<S> place = v.template vector<S>();
    joint.anchorA = a.toLocal(place);
    joint.anchorB = b.toLocal(place);
  });
  readJointFields(at, joint);
  const JointId id = at.guard([&] { return space.add(joint); });
  if (!at.has("name")) return;
  const std::string name = at.at("name").text() + number;
  if (!joints_.emplace(name, NamedJoint{id, joint}).second) {
    at.fail("there is a joint named \"" + name + "\" already");
  }
}

template <Scalar S>
typename SceneBuilder<S>::NamedJoint& SceneBuilder<S>::jointNamed(const Cursor& at) {
  const auto found = joints_.find(at.text());
  if (found == joints_.end()) at.fail("no joint of this name");
  return found->second;
}

/// Events that name a joint: each goes on from what those before it in the list have made of it.
template <Scalar S>
void SceneBuilder<S>::readJointEvent(const Cursor& at, CommandKind kind, std::uint64_t tick) {
  NamedJoint& named = jointNamed(at.at("joint"));
  if (kind == CommandKind::unjoin) {
    at.allow({"tick", "do", "joint"});
    addEvent(at, tick, kNoName, Unjoin{named.id});
    return;
  }
  at.allow({"tick",     "do",         "joint",      "anchorA", "anchorB",      "axis",           "velocity",
            "rest",     "angle",      "lower",      "upper",   "motorSpeed",   "motorMax",       "hertz",
            "damping",  "maxForce",   "maxTorque",  "ratio",   "angularHertz", "angularDamping", "collide",
            "userData", "breakForce", "breakTorque"});
  readJointFields(at, named.joint);
  const char* flaw = flawOfJoint(named.joint);
  if (flaw != nullptr) at.fail(flaw);
  addEvent(at, tick, kNoName, Adjust<S>{named.id, named.joint});
}

#define SAMESTEP_EACH_SCALAR                                \
  template void SceneBuilder<S>::readJoints(const Cursor&); \
  template void SceneBuilder<S>::readJointEvent(const Cursor&, CommandKind, std::uint64_t);
#include <samestep/each_scalar.h>

}  // namespace samestep
