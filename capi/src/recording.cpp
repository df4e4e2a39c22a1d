// SPDX-License-Identifier: MIT
// Commands, recordings and their verification.
#include <algorithm>
#include <cstring>

#include <samestep/named_handlers.h>
#include <samestep/recorder.h>
#include <samestep/verify.h>

#include "base/require_ieee.h"
#include "definitions.h"
#include "limits_of.h"
#include "replay_wiring.h"

/// A recording being made.
struct samestep_recorder {
  explicit samestep_recorder(samestep_world& of) : world(of) { ++world.users; }
  samestep_recorder(const samestep_recorder&) = delete;
  samestep_recorder& operator=(const samestep_recorder&) = delete;
  virtual ~samestep_recorder() { --world.users; }
  samestep_world& world;
  samestep::c::Calls calls;
};

namespace samestep::c {
namespace {

template <Scalar S>
Spawn<S> toSpawn(const samestep_command& from) {
  const samestep_body_def& body = current(from.spawned);
  if (from.shape_count != 0) at(from.shapes);
  Spawn<S> spawn;
  spawn.body = toBody<S>(body);
  spawn.id = fromC<BodyId>(body.id);
  spawn.shapes.reserve(std::min(from.shape_count, 256u));
  for (std::uint32_t i = 0; i < from.shape_count; ++i) {
    Shape<S> shape = toShape<S>({}, from.shapes[i]);
    if (from.shapes[i].id != 0) shape.attach(fromC<ShapeId>(from.shapes[i].id));
    spawn.shapes.push_back(std::move(shape));
  }
  return spawn;
}

UserInput toInput(const samestep_command& from) {
  if (from.byte_count != 0) at(from.bytes);
  UserInput input;
  if (from.byte_count != 0) input.bytes.assign(from.bytes, from.bytes + from.byte_count);
  return input;
}

template <Scalar S>
Command<S> toCommand(const samestep_command& from) {
  const BodyId body = fromC<BodyId>(from.body);
  switch (from.kind) {
    case SAMESTEP_APPLY_IMPULSE:
      return ApplyImpulse<S>{body, vector<S>(from.value), vector<S>(from.arm)};
    case SAMESTEP_APPLY_FORCE:
      return ApplyForce<S>{body, vector<S>(from.value), vector<S>(from.arm)};
    case SAMESTEP_SET_VELOCITY:
      return SetVelocity<S>{body, vector<S>(from.value)};
    case SAMESTEP_SET_ANGULAR_VELOCITY:
      return SetAngularVelocity<S>{body, number<S>(from.value.x)};
    case SAMESTEP_SET_POSITION:
      return SetPosition<S>{body, vector<S>(from.value)};
    case SAMESTEP_SET_ANGLE:
      return SetAngle<S>{body, number<S>(from.value.x)};
    case SAMESTEP_SPAWN:
      return toSpawn<S>(from);
    case SAMESTEP_REMOVE:
      return Remove{body};
    case SAMESTEP_USER_INPUT:
      return toInput(from);
    case SAMESTEP_JOIN:
      return Join<S>{fromC<JointId>(current(from.joined).id), toJoint<S>(*from.joined)};
    case SAMESTEP_ADJUST:
      return Adjust<S>{fromC<JointId>(from.joint), toJoint<S>(current(from.joined))};
    case SAMESTEP_UNJOIN:
      return Unjoin{fromC<JointId>(from.joint)};
    default:
      refuse(SAMESTEP_UNKNOWN_VALUE);
  }
}

template <Scalar S>
void applyInputOf(Space<S>&, std::span<const std::uint8_t> bytes, void* data) {
  auto& world = *static_cast<WorldOf<S>*>(data);
  applyInput(world, world.input, bytes, world.inputData);
}

template <Scalar S>
Wiring<S> wiringOf(WorldOf<S>& world) {
  Wiring<S> wiring;
  wiring.applyInput = applyInputOf<S>;
  wiring.data = &world;
  return wiring;
}

template <Scalar S>
struct RecorderOf : samestep_recorder {
  RecorderOf(WorldOf<S>& of, std::uint32_t rate)
      : samestep_recorder(of), recorder(of.space, timeStepOf<S>(rate), bytes, wiringOf(of)) {}
  std::vector<std::uint8_t> bytes;
  Recorder<S> recorder;
};

/// Runs action(recorder) on a recorder of either scalar; messages are its world's.
template <class Action>
samestep_status callRecorder(samestep_recorder* recorder, Action&& action) noexcept {
  if (recorder == nullptr) return callFree([] { refuse(SAMESTEP_NULL_ARGUMENT); });
  const InCall inCall(*recorder);
  return call(&recorder->world, [&]<class World>(World&) {
    action(static_cast<RecorderOf<typename World::Number>&>(*recorder));
  });
}

VerifyOptions toOptions(const samestep_verify_options& from) {
  current(&from);
  const auto expects = [&](std::uint32_t bit) { return (from.expected & bit) != 0; };
  VerifyOptions options;
  options.limits = toLimits(&from.limits);
  options.mostFirstTick = from.most_first_tick;
  options.progress = nullptr;
  options.expected.commands = from.commands;
  if (expects(SAMESTEP_EXPECT_FIRST_HASH)) options.expected.firstHash = from.first_hash;
  if (expects(SAMESTEP_EXPECT_RATE)) options.expected.stepsPerSecond = from.rate;
  if (expects(SAMESTEP_EXPECT_TICKS)) options.expected.ticks = from.ticks;
  if (expects(SAMESTEP_EXPECT_FIRST_TICK)) options.expected.firstTick = from.first_tick;
  if (expects(SAMESTEP_EXPECT_SCALAR)) {
    requireOr(from.scalar == SAMESTEP_FIXED || from.scalar == SAMESTEP_DOUBLE, SAMESTEP_UNKNOWN_VALUE);
    options.expected.scalar = static_cast<ScalarKind>(from.scalar);
  }
  return options;
}

bool progressOf(std::uint64_t done, std::uint64_t total, void* data) {
  const auto& options = *static_cast<const samestep_verify_options*>(data);
  return options.progress(done, total, options.progress_data) != 0;
}

bool interruptOf(void* data) {
  const auto& options = *static_cast<const samestep_verify_options*>(data);
  return options.interrupt(options.interrupt_data) != 0;
}

samestep_verify_result resultOf(const VerifyResult& from) {
  samestep_verify_result result{};
  result.matches = from.matches ? 1 : 0;
  result.stopped = from.stopped ? 1 : 0;
  result.ticks = from.ticks;
  result.first_wrong_tick = from.firstWrongTick;
  result.recorded_hash = from.recordedHash;
  result.computed_hash = from.computedHash;
  const char* unexpected = from.unexpected == nullptr ? "" : from.unexpected;
  std::strncpy(result.unexpected, unexpected, sizeof result.unexpected - 1);
  return result;
}

template <Scalar S>
VerifyResult verifyWith(std::span<const std::uint8_t> bytes, const samestep_wiring* wiring,
                        const VerifyOptions& options) {
  if (wiring == nullptr) return verify<S>(bytes, namedHandlerWiring<S>(), options);
  ReplayWiring<S> own(*wiring);
  return verify<S>(bytes, own.engine(), options);
}

}  // namespace
}  // namespace samestep::c

using namespace samestep::c;

extern "C" {

samestep_status samestep_world_apply(samestep_world* world, const samestep_command* command,
                                     samestep_body_id* body) {
  return call(world, [&]<class World>(World& of) {
    const auto made = toCommand<typename World::Number>(current(command));
    const samestep::BodyId spawned = samestep::applyCommand(of.space, made, wiringOf(of));
    if (body != nullptr) *body = toC(spawned);
  });
}

samestep_status samestep_world_set_input_function(samestep_world* world, samestep_input_function function,
                                                  void* data) {
  return call(world, [&](auto& of) {
    of.input = function;
    of.inputData = data;
  });
}

samestep_status samestep_recorder_create(samestep_world* world, uint32_t rate, samestep_recorder** recorder) {
  return call(world, [&]<class World>(World& of) {
    at(recorder);
    requireOr(of.destroyable, SAMESTEP_IN_USE);
    *recorder = new RecorderOf<typename World::Number>(of, rate);
  });
}

void samestep_recorder_destroy(samestep_recorder* recorder) { endAfterCalls(recorder); }

samestep_status samestep_recorder_apply(samestep_recorder* recorder, const samestep_command* command,
                                        samestep_body_id* body) {
  return callRecorder(recorder, [&]<samestep::Scalar S>(RecorderOf<S>& of) {
    const samestep::BodyId spawned = of.recorder.apply(toCommand<S>(current(command)));
    if (body != nullptr) *body = toC(spawned);
  });
}

samestep_status samestep_recorder_step(samestep_recorder* recorder, uint64_t* hash) {
  return callRecorder(recorder, [&](auto& of) {
    const uint64_t made = of.recorder.step();
    if (hash != nullptr) *hash = made;
  });
}

samestep_status samestep_recorder_set_rewind_ticks(samestep_recorder* recorder, uint32_t ticks) {
  return callRecorder(recorder, [&](auto& of) { of.recorder.setRewindTicks(ticks); });
}

samestep_status samestep_recorder_set_checking(samestep_recorder* recorder, int32_t checking) {
  return callRecorder(recorder, [&](auto& of) { of.recorder.setChecking(checking != 0); });
}

samestep_status samestep_recorder_finish(samestep_recorder* recorder, const uint8_t** bytes, size_t* size) {
  return callRecorder(recorder, [&](auto& of) {
    at(bytes), at(size);
    of.recorder.finish();
    give(of.bytes, bytes, size);
  });
}

void samestep_verify_options_init(samestep_verify_options* options) {
  if (options == nullptr) return;
  const samestep::VerifyOptions defaults;
  *options = {};
  options->version = SAMESTEP_C_VERSION;
  samestep_limits_init(&options->limits);
  options->most_first_tick = defaults.mostFirstTick;
  options->scalar = SAMESTEP_FIXED;
  options->rate = 60;
  options->commands = defaults.expected.commands;
}

samestep_status samestep_verify(const uint8_t* bytes, size_t size, const samestep_wiring* wiring,
                                const samestep_verify_options* options, samestep_verify_result* result) {
  return callFree([&] {
    at(result), at(bytes);
    samestep::VerifyOptions chosen = options == nullptr ? samestep::VerifyOptions{} : toOptions(*options);
    if (options != nullptr && options->progress != nullptr) {
      chosen.progress = progressOf;
      chosen.data = const_cast<samestep_verify_options*>(options);
    }
    if (options != nullptr && options->interrupt != nullptr) {
      chosen.interrupt = {interruptOf, const_cast<samestep_verify_options*>(options)};
    }
    const std::span<const uint8_t> recording(bytes, size);
    const auto scalar = static_cast<int32_t>(samestep::recordingInfo(recording).scalar);
    forScalar(scalar, [&](auto number) {
      *result = resultOf(verifyWith<decltype(number)>(recording, wiring, chosen));
    });
  });
}

}  // extern "C"
