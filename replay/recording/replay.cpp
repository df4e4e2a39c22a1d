// SPDX-License-Identifier: MIT
#include <samestep/replay.h>

#include <string>

#include <samestep/state_diff.h>

#include "base/require_ieee.h"

namespace samestep {

namespace {

/// True if the ids that a spawn asks for are beyond the limits: room is taken up to the highest.
template <Scalar S>
bool asksForMore(const Command<S>& command, const RecordingLimits& limits) {
  if (const auto* join = std::get_if<Join<S>>(&command)) {
    return join->id.valid() && join->id.index >= limits.joints;
  }
  const auto* spawn = std::get_if<Spawn<S>>(&command);
  if (spawn == nullptr || !spawn->id.valid()) return false;
  for (const Shape<S>& shape : spawn->shapes) {
    if (shape.id().index >= limits.shapes) return true;
  }
  return spawn->id.index >= limits.bodies;
}

}  // namespace

template <Scalar S>
Replay<S>::Replay(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring, const RecordingLimits& limits,
                  const Interrupt& interrupt, Ending ending)
    : interrupt_(interrupt),
      reader_(bytes, limits, interrupt, ending),
      wiring_(wiring),
      limits_(limits),
      recordedHash_(reader_.initialHash()) {
  if (wiring_.connect != nullptr) wiring_.connect(space_, wiring_.data);
  space_.setMaxPairs(limits.pairs);
  space_.setInterrupt(interrupt);
  space_.setMaxWork(limits.work);
  space_.adopt(reader_.initialWorld());
}

/// Does what the item read last says.
template <Scalar S>
template <class Action>
void Replay<S>::act(Action&& action) {
#if defined(__cpp_exceptions)
  try {
    orFailFormat(reader_.offset(), action);
  } catch (const Interrupted&) {
    if (space_.work() > limits_.work) failFormat(reader_.offset(), "more work than allowed");
    throw;
  }
#else
  action();
#endif
}

/// Applies the command read last; of a game's own input that is refused, an error tells the bytes.
template <Scalar S>
void Replay<S>::applyNow() {
  const Command<S>& command = reader_.command();
#if defined(__cpp_exceptions)
  const auto* input = std::get_if<UserInput>(&command);
  if (input != nullptr && wiring_.applyInput != nullptr) {
    try {
      applyCommand(space_, command, wiring_);
      return;
    } catch (const Interrupted&) {
      throw;
    } catch (const MissingCallback&) {
      throw;
    } catch (const Error& error) {
      const std::string words = "before tick " + std::to_string(tick_ + 1) + " the game refuses its input (" +
                                error.what() + "); " + describe(command);
      failFormat(reader_.offset(), words.c_str());
    }
  }
#endif
  applyCommand(space_, command, wiring_);
}

template <Scalar S>
bool Replay<S>::applyCommands() {
  if (applied_ || ended_) return !ended_;
  while (nextClaim() != nullptr) continue;
  RecordingItem item = reader_.next();
  commandsBegin_ = reader_.itemAt();
  for (; item == RecordingItem::command; item = reader_.next()) {
    if (asksForMore(reader_.command(), limits_)) {
      failFormat(reader_.offset(), "more bodies or shapes than allowed");
    }
    if (filter_ != nullptr && !filter_(reader_.command(), reader_.offset(), filterData_)) {
      commandsEnd_ = commandsBegin_;
      ended_ = true;
      return false;
    }
    require<Fault::Interrupted>(!interrupt_.isWanted());
    // Recorded commands were accepted once.
    act([&] { applyNow(); });
    if (space_.state().bodies.slots() > limits_.bodies || space_.state().shapes.slots() > limits_.shapes) {
      failFormat(reader_.offset(), "more bodies or shapes than allowed");
    }
  }
  commandsEnd_ = reader_.itemAt();
  applied_ = true;
  ended_ = item == RecordingItem::end;
  return !ended_;
}

template <Scalar S>
const Claim* Replay<S>::nextClaim() {
  if (applied_ || ended_ || !reader_.claimFollows()) return nullptr;
  reader_.next();
  return &reader_.claim();
}

template <Scalar S>
void Replay<S>::seek(std::uint64_t tick) {
  require<Fault::ValueOutOfRange>(tick <= ticks(), "The recording ends before that step.");
  const std::span<const Keyframe> keyframes = reader_.keyframes();
  std::size_t last = keyframes.size() - 1;
  while (keyframes[last].tick > tick) --last;
  // Playing on is enough where no keyframe is nearer.
  const bool ahead = tick_ <= tick && tick_ >= keyframes[last].tick && !applied_ && !ended_;
  if (!ahead) {
    space_.adopt(last == 0 ? reader_.initialWorld() : reader_.world(last, limits_));
    reader_.seek(last);
    tick_ = keyframes[last].tick;
    recordedHash_ = keyframes[last].hash;
    commandsBegin_ = commandsEnd_ = reader_.itemAt();
    applied_ = ended_ = false;
  }
  while (tick_ < tick && step()) continue;
}

template <Scalar S>
bool Replay<S>::step() {
  if (!applyCommands()) return false;
  applied_ = false;
  act([&] { space_.step(reader_.timeStep()); });
  recordedHash_ = reader_.hash();
  ++tick_;
  return true;
}

#define SAMESTEP_EACH_SCALAR template class Replay<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
