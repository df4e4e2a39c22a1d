// SPDX-License-Identifier: MIT
#include <samestep/replay.h>

#include "base/require_ieee.h"

namespace samestep {

namespace {

/// Whether the ids that a spawn asks for are beyond the limits: room is taken up to the highest.
template <Scalar S>
bool asksForMore(const Command<S>& command, const RecordingLimits& limits) {
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
                  const Interrupt& interrupt)
    : bytes_(bytes),
      interrupt_(interrupt),
      reader_(bytes, limits, interrupt),
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

template <Scalar S>
bool Replay<S>::applyCommands() {
  if (applied_ || ended_) return !ended_;
  commandsBegin_ = commandsEnd_ = reader_.nextOffset();
  RecordingItem item = reader_.next();
  for (; item == RecordingItem::command; item = reader_.next()) {
    if (asksForMore(reader_.command(), limits_)) {
      failFormat(reader_.offset(), "more bodies or shapes than allowed");
    }
    if (filter_ != nullptr && !filter_(reader_.command(), reader_.offset(), filterData_)) {
      ended_ = true;
      return false;
    }
    require<Fault::Interrupted>(!interrupt_.isWanted());
    // Recorded commands were accepted once.
    act([&] { applyCommand(space_, reader_.command(), wiring_); });
    if (space_.state().bodies.slots() > limits_.bodies || space_.state().shapes.slots() > limits_.shapes) {
      failFormat(reader_.offset(), "more bodies or shapes than allowed");
    }
  }
  commandsEnd_ = reader_.offset();
  applied_ = true;
  ended_ = item == RecordingItem::end;
  return !ended_;
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
