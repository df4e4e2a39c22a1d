// SPDX-License-Identifier: MIT
// Settings of scene files, and those that are given for another scene or for a Space.
#include "scenes/scene_settings.h"

#include "base/require_ieee.h"

namespace samestep {

template <Scalar S>
void readSettings(Space<S>& space, const Cursor& at) {
  at.allow({"solver", "precision", "gravity", "iterations", "substeps", "damping", "collisionSlop",
            "collisionBias", "collisionPersistence", "contactHertz", "contactDamping", "contactPushSpeed",
            "contactMargin", "bounceThreshold", "worldExtent", "sleepTimeThreshold", "idleSpeedThreshold",
            "continuous"});
  at.optional("continuous", [&](const Cursor& v) { space.setContinuous(v.boolean()); });
  at.optional("solver", [&](const Cursor& v) {
    const std::string& solver = v.text();
    if (solver == "soft step") return space.setSolver(SolverKind::softStep);
    if (solver == "sequential impulses") return space.setSolver(SolverKind::sequentialImpulses);
    v.fail("\"sequential impulses\" or \"soft step\" is wanted here");
  });
  at.optional("precision", [&](const Cursor& v) {
    const std::string& precision = v.text();
    if (precision == "fast") return space.setPrecision(ContactPrecision::fast);
    if (precision == "accurate") return space.setPrecision(ContactPrecision::accurate);
    v.fail("\"accurate\" or \"fast\" is wanted here");
  });
  at.optional("substeps",
              [&](const Cursor& v) { space.setSubsteps(static_cast<int>(v.integer(0, 1u << 30))); });
  at.optional("contactHertz", [&](const Cursor& v) {
    space.setContactSoftness(v.template number<S>(), space.settings().contactDamping);
  });
  at.optional("contactDamping", [&](const Cursor& v) {
    space.setContactSoftness(space.settings().contactHertz, v.template number<S>());
  });
  at.optional("contactPushSpeed",
              [&](const Cursor& v) { space.setContactPushSpeed(v.template number<S>()); });
  at.optional("contactMargin", [&](const Cursor& v) { space.setContactMargin(v.template number<S>()); });
  at.optional("bounceThreshold", [&](const Cursor& v) { space.setBounceThreshold(v.template number<S>()); });
  at.optional("gravity", [&](const Cursor& v) { space.setGravity(v.template vector<S>()); });
  at.optional("iterations",
              [&](const Cursor& v) { space.setIterations(static_cast<int>(v.integer(0, 1u << 30))); });
  at.optional("damping", [&](const Cursor& v) { space.setDamping(v.template number<S>()); });
  at.optional("collisionSlop", [&](const Cursor& v) { space.setCollisionSlop(v.template number<S>()); });
  at.optional("collisionBias", [&](const Cursor& v) { space.setCollisionBias(v.template number<S>()); });
  at.optional("collisionPersistence", [&](const Cursor& v) {
    space.setCollisionPersistence(static_cast<std::uint32_t>(v.integer(0, 0xffffffffu)));
  });
  at.optional("worldExtent", [&](const Cursor& v) { space.setWorldExtent(v.template number<S>()); });
  at.optional("sleepTimeThreshold",
              [&](const Cursor& v) { space.setSleepTimeThreshold(v.template number<S>()); });
  at.optional("idleSpeedThreshold",
              [&](const Cursor& v) { space.setIdleSpeedThreshold(v.template number<S>()); });
}

std::uint32_t readStepsPerSecond(const Cursor& at) {
  return static_cast<std::uint32_t>(at.at("stepsPerSecond").integer(1, 10000));
}

template <Scalar S>
std::uint32_t readTuned(Space<S>& space, const Cursor& at) {
  at.allow({"scalar", "stepsPerSecond", "settings", "evidence"});
  if (at.has("settings")) readSettings(space, at.at("settings"));
  return at.has("stepsPerSecond") ? readStepsPerSecond(at) : 0;
}

template <Scalar S>
std::uint32_t useSettings(Space<S>& space, std::string_view text, const std::string& file) {
  const json::Node root = json::parse(text, file);
  const Cursor at(root, file);
  // A setting that is refused is refused before the world changes.
  Space<S> trial;
  readTuned(trial, at);
  return readTuned(space, at);
}

#define SAMESTEP_EACH_SCALAR                                     \
  template void readSettings<S>(Space<S>&, const Cursor&);       \
  template std::uint32_t readTuned<S>(Space<S>&, const Cursor&); \
  template std::uint32_t useSettings<S>(Space<S>&, std::string_view, const std::string&);
#include <samestep/each_scalar.h>

}  // namespace samestep
