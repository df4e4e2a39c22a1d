// SPDX-License-Identifier: MIT
// Scene files: what happens at which tick, from the scene itself or from a file of a player's inputs.
#include <charconv>
#include <optional>

#include "base/require_ieee.h"
#include "scenes/scene_builder.h"

namespace samestep {
namespace {

constexpr std::uint64_t kMaxTick = std::uint64_t{1} << 40;

std::optional<CommandKind> kindOfWord(std::string_view word) {
  for (std::uint8_t i = 0; i < kCommandKinds; ++i) {
    const auto kind = static_cast<CommandKind>(i);
    const bool isForScenes = kind != CommandKind::userInput && kind != CommandKind::join;
    if (word == commandName(kind) && isForScenes) return kind;
  }
  return std::nullopt;
}

/// The command that sets or applies `value` to a body yet to be named.
template <Scalar S>
Command<S> commandWith(CommandKind kind, const Vector<S>& value, const Vector<S>& arm) {
  switch (kind) {
    case CommandKind::applyImpulse:
      return ApplyImpulse<S>{{}, value, arm};
    case CommandKind::applyForce:
      return ApplyForce<S>{{}, value, arm};
    case CommandKind::setVelocity:
      return SetVelocity<S>{{}, value};
    case CommandKind::setAngularVelocity:
      return SetAngularVelocity<S>{{}, value.x};
    case CommandKind::setPosition:
      return SetPosition<S>{{}, value};
    case CommandKind::setAngle:
      return SetAngle<S>{{}, value.x};
    default:
      return Remove{};
  }
}

/// Number of numbers that the value of a command has.
int numbersOf(CommandKind kind) {
  switch (kind) {
    case CommandKind::setAngularVelocity:
    case CommandKind::setAngle:
      return 1;
    case CommandKind::spawn:
    case CommandKind::remove:
      return 0;
    default:
      return 2;
  }
}

bool isForJoint(CommandKind kind) { return kind == CommandKind::adjust || kind == CommandKind::unjoin; }

bool takesArm(CommandKind kind) {
  return kind == CommandKind::applyImpulse || kind == CommandKind::applyForce;
}

/// The fields of a line; of one with more than kMostFields, one more than those.
constexpr std::uint32_t kMostFields = 5;
std::vector<std::string_view> splitFields(std::string_view line) {
  std::vector<std::string_view> fields;
  while (fields.size() <= kMostFields) {
    const std::string_view::size_type comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) break;
    line.remove_prefix(comma + 1);
  }
  return fields;
}

}  // namespace

template <Scalar S>
typename SceneBuilder<S>::Event& SceneBuilder<S>::addEvent(const Cursor& at, std::uint64_t tick,
                                                           std::uint32_t name, Command<S>&& command) {
  if (scene_.events_.size() >= kMaxSceneEvents) at.fail(tooMany("events", kMaxSceneEvents));
  return scene_.events_.emplace_back(tick, name, at.line(), std::move(command));
}

template <Scalar S>
std::uint32_t SceneBuilder<S>::nameOf(const std::string& name) const {
  const auto found = names_.find(name);
  return found == names_.end() ? kNoName : found->second;
}

template <Scalar S>
void SceneBuilder<S>::readEvents(const Cursor& at) {
  // Spawns first: an event may name a body that a later line of the list brings in.
  std::vector<std::uint32_t> names(at.size(), kNoName);
  for (std::uint32_t i = 0; i < at.size(); ++i) {
    const Cursor entry = at.item(i);
    if (entry.at("do").text() != commandName(CommandKind::spawn)) continue;
    const Cursor body = entry.at("body");
    names[i] = newName(body, body.has("name") ? body.at("name").text() : "#" + std::to_string(i));
  }
  for (std::uint32_t i = 0; i < at.size(); ++i) readEvent(at.item(i), names[i]);
}

template <Scalar S>
void SceneBuilder<S>::readEvent(const Cursor& at, std::uint32_t spawned) {
  const Cursor word = at.at("do");
  const std::optional<CommandKind> kind = kindOfWord(word.text());
  if (!kind) word.fail("no command of this name");
  if (isForJoint(*kind)) return readJointEvent(at, *kind, at.at("tick").integer(1, kMaxTick));
  const int numbers = numbersOf(*kind);
  if (takesArm(*kind)) {
    at.allow({"tick", "do", "body", "value", "arm"});
  } else if (numbers > 0) {
    at.allow({"tick", "do", "body", "value"});
  } else {
    at.allow({"tick", "do", "body"});
  }
  const std::uint64_t tick = at.at("tick").integer(1, kMaxTick);
  if (*kind == CommandKind::spawn) {
    if (at.at("body").has("grid")) at.at("body").at("grid").fail("a spawn brings in one body");
    const Cursor body = at.at("body");
    const Spawn<S> made = readBody(body);
    // The event is tried out, so that what cannot come in is told before the scene runs.
    Space<S> trial;
    trial.setWorldExtent(scene_.space_.worldExtent());
    noteUnsteppable(body, trial.body(body.guard([&] { return applyCommand<S>(trial, made); })));
    addEvent(at, tick, spawned, made);
    return;
  }
  const std::uint32_t name = nameOf(at.at("body").text());
  if (name == kNoName) at.at("body").fail("no body of this name");
  Vector<S> value;
  if (numbers == 1) value.x = at.at("value").template number<S>();
  if (numbers == 2) value = at.at("value").template vector<S>();
  const Vector<S> arm = at.has("arm") ? at.at("arm").template vector<S>() : Vector<S>();
  addEvent(at, tick, name, commandWith<S>(*kind, value, arm));
}

/// A file of lines "tick,body,do,x,y", the first of which says so.
template <Scalar S>
void SceneBuilder<S>::readInputs(const Cursor& at) {
  const std::string file = document_.folder + at.text();
  const std::string text = document_.read(file);
  scene_.inputsFile_ = file;
  bool header = true;
  eachLine(text, [&](std::uint32_t line, std::string_view content) {
    const auto fail = [&](const std::string& reason) { throw SceneError(file, line, "", reason); };
    if (header) {
      if (content != "tick,body,do,x,y") fail("the first line must be: tick,body,do,x,y");
      header = false;
      return;
    }
    const std::vector<std::string_view> fields = splitFields(content);
    if (fields.size() != kMostFields) fail("five fields are wanted: tick,body,do,x,y");
    std::uint64_t tick = 0;
    const auto [end, error] = std::from_chars(fields[0].data(), fields[0].data() + fields[0].size(), tick);
    const bool whole = error == std::errc() && end == fields[0].data() + fields[0].size();
    if (!whole || tick < 1 || tick > kMaxTick)
      fail("the tick must be a whole number from 1 to " + std::to_string(kMaxTick));
    const std::uint32_t name = nameOf(std::string(fields[1]));
    if (name == kNoName) fail("no body is named \"" + std::string(fields[1]) + "\"");
    const std::optional<CommandKind> kind = kindOfWord(fields[2]);
    if (!kind || *kind == CommandKind::spawn || isForJoint(*kind))
      fail("no command \"" + std::string(fields[2]) + "\" for inputs");
    const int numbers = numbersOf(*kind);
    S value[2]{};
    for (int i = 0; i < 2; ++i) {
      const std::string column = i == 0 ? "x" : "y";
      const std::string_view digits = fields[static_cast<std::size_t>(3 + i)];
      if (i >= numbers) {
        if (!digits.empty()) fail(column + " means nothing to " + commandName(*kind) + ", and must be empty");
        continue;
      }
      const char* reason = reasonOf(parseDecimal(digits, value[i]));
      if (reason != nullptr) fail(column + ", \"" + std::string(digits) + "\": " + reason);
    }
    Event& event = addEvent(at, tick, name, commandWith<S>(*kind, {value[0], value[1]}, {}));
    event.line = line;
    event.isInput = true;
  });
  if (header) throw SceneError(file, 1, "", "the first line must be: tick,body,do,x,y");
}

#define SAMESTEP_EACH_SCALAR template class SceneBuilder<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
