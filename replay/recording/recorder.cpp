// SPDX-License-Identifier: MIT
#include <samestep/recorder.h>

#include <samestep/version.h>

#include <variant>

#include "base/require_ieee.h"
#include "recording/recording_format.h"
#include "state/canonical_bytes.h"
#include "state/state_hash.h"

namespace samestep {
namespace {

constexpr std::size_t kPieceBytes = 8192;

void appendTo(std::span<const std::uint8_t> bytes, void* data) {
  auto& all = *static_cast<std::vector<std::uint8_t>*>(data);
  all.insert(all.end(), bytes.begin(), bytes.end());
}

/// Writes the fields of one kind of command each.
template <Scalar S>
struct CommandWriter {
  CanonicalWriter<BytesSink>& write;
  BytesSink& sink;

  template <class T>
  void operator()(const T& plain) const {
    write.put(plain);
  }
  void operator()(const Spawn<S>& spawn) const {
    write.put(spawn.id);
    write.put(spawn.body);
    write.put(static_cast<std::uint32_t>(spawn.shapes.size()));
    for (const Shape<S>& shape : spawn.shapes) {
      Shape<S> free = shape.detached();
      free.setBody({});
      write.put(free);
      if (spawn.id.valid()) write.put(shape.id());
    }
  }
  void operator()(const UserInput& input) const {
    write.put(static_cast<std::uint32_t>(input.bytes.size()));
    for (const std::uint8_t byte : input.bytes) write.put(byte);
  }
};

template <Scalar S>
void requireRecordable(const Command<S>& command) {
  if (const auto* spawn = std::get_if<Spawn<S>>(&command)) {
    require<Fault::ValueOutOfRange>(spawn->shapes.size() <= kMaxSpawnShapes,
                                    "A recorded spawn has at most 256 shapes.");
  } else if (const auto* input = std::get_if<UserInput>(&command)) {
    require<Fault::ValueOutOfRange>(input->bytes.size() <= kMaxInputBytes,
                                    "A recorded input has at most 2^16 bytes.");
  }
}

}  // namespace

template <Scalar S>
struct Recorder<S>::Impl {
  Impl(Space<S>& spaceIn, S timeStepIn, ByteSink sinkIn, void* dataIn, const Wiring<S>& wiringIn)
      : space(spaceIn),
        timeStep(timeStepIn),
        sink(sinkIn),
        data(dataIn),
        wiring(wiringIn),
        stamp(space.stamp()) {
    XXH3_64bits_reset(&checksum);
  }

  void begin() {
    for (const std::uint8_t byte : kRecordingMagic) write.put(byte);
    write.put(kRecordingVersion);
    write.put(kSimulationRevision);
    write.put(ScalarTraits<S>::kKind);
    for (int i = 0; i < 3; ++i) write.put(std::uint8_t{0});
    write.put(timeStep);
    encodeWorld(space.state(), piece);
    lastHash = space.hash();
    write.put(lastHash);
  }
  void flush() {
    XXH3_64bits_update(&checksum, piece.data(), piece.size());
    sink(piece, data);
    piece.clear();
  }
  void flushWhenFull() {
    if (piece.size() >= kPieceBytes) flush();
  }
  void check() const {
    require<Fault::ForeignWorld>(!checking || space.hash() == lastHash,
                                 "The world was changed by something that was not recorded.");
  }
  std::uint64_t recordStep() {
    stamp = space.stamp();
    ++ticks;
    lastHash = space.hash();
    write.put(RecordingItem::step);
    write.put(lastHash);
    flushWhenFull();
    return lastHash;
  }

  Space<S>& space;
  S timeStep;
  ByteSink sink;
  void* data;
  Wiring<S> wiring;
  std::uint64_t stamp;
  std::uint64_t ticks = 0;
  std::uint64_t lastHash = 0;
  bool checking = false;
  bool finished = false;
  std::vector<std::uint8_t> piece;
  BytesSink pieceSink{piece};
  CanonicalWriter<BytesSink> write{pieceSink};
  XXH3_state_t checksum;
};

template <Scalar S>
Recorder<S>::Recorder(Space<S>& space, S timeStep, std::vector<std::uint8_t>& bytes, const Wiring<S>& wiring)
    : Recorder(space, timeStep, appendTo, &bytes, wiring) {}

template <Scalar S>
Recorder<S>::Recorder(Space<S>& space, S timeStep, ByteSink sink, void* data, const Wiring<S>& wiring) {
  require<Fault::SpaceLocked>(!space.isLocked());
  require<Fault::ValueOutOfRange>(timeStep > S(0) && timeStep <= kMaxTimeStep<S>);
  if (const char* flaw = flawOf(space.state())) fail<Fault::ForeignWorld>(flaw);
  impl_ = new Impl(space, timeStep, sink, data, wiring);
  impl_->begin();
}

template <Scalar S>
Recorder<S>::~Recorder() {
  delete impl_;
}

template <Scalar S>
BodyId Recorder<S>::apply(const Command<S>& command) {
  requireRecordable(command);
  impl_->check();
  const BodyId id = samestep::apply(impl_->space, command, impl_->wiring);
  if (impl_->checking) impl_->lastHash = impl_->space.hash();
  impl_->write.put(RecordingItem::command);
  impl_->write.put(kindOf(command));
  std::visit(CommandWriter<S>{impl_->write, impl_->pieceSink}, command);
  impl_->flushWhenFull();
  return id;
}

template <Scalar S>
std::uint64_t Recorder<S>::step() {
  impl_->check();
  impl_->space.step(impl_->timeStep);
  return impl_->recordStep();
}

template <Scalar S>
std::uint64_t Recorder<S>::stepped() {
  require<Fault::ForeignWorld>(impl_->space.stamp() == impl_->stamp + 1,
                               "stepped() is called once after each step.");
  require<Fault::ForeignWorld>(impl_->space.currentTimeStep() == impl_->timeStep,
                               "The step was not as long as those of the recording.");
  return impl_->recordStep();
}

template <Scalar S>
void Recorder<S>::setChecking(bool checking) {
  impl_->checking = checking;
  if (checking) impl_->lastHash = impl_->space.hash();
}

template <Scalar S>
void Recorder<S>::finish() {
  if (impl_->finished) return;
  impl_->finished = true;
  impl_->write.put(RecordingItem::end);
  impl_->write.put(impl_->ticks);
  impl_->flush();
  impl_->write.put(static_cast<std::uint64_t>(XXH3_64bits_digest(&impl_->checksum)));
  impl_->sink(impl_->piece, impl_->data);
}

template <Scalar S>
std::uint64_t Recorder<S>::ticks() const {
  return impl_->ticks;
}

#define SAMESTEP_EACH_SCALAR template class Recorder<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
