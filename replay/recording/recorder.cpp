// SPDX-License-Identifier: MIT
#include <samestep/recorder.h>

#include <samestep/make_room.h>
#include <samestep/version.h>

#include <memory>
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
  void operator()(const UserInput& input) const { (*this)(std::span<const std::uint8_t>(input.bytes)); }
  void operator()(std::span<const std::uint8_t> input) const {
    write.put(static_cast<std::uint32_t>(input.size()));
    for (const std::uint8_t byte : input) write.put(byte);
  }
};

void requireRecordableInput(std::size_t bytes) {
  require<Fault::ValueOutOfRange>(bytes <= kMaxInputBytes, "Recorder: an input has ", bytes,
                                  " bytes, allowed are up to ", kMaxInputBytes);
}

template <Scalar S>
void requireRecordable(const Command<S>& command) {
  if (const auto* spawn = std::get_if<Spawn<S>>(&command)) {
    require<Fault::ValueOutOfRange>(spawn->shapes.size() <= kMaxSpawnShapes,
                                    "A recorded spawn has at most 256 shapes.");
  } else if (const auto* input = std::get_if<UserInput>(&command)) {
    requireRecordableInput(input->bytes.size());
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
        startStamp(space.stamp()),
        stamp(space.stamp()),
        broughtIn(space.worldsBroughtIn()) {
    XXH3_64bits_reset(&checksum);
    setRewindTicks(kDefaultRewindTicks);
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
    addMark();
    piece.reserve(piece.size() + 2 * kPieceBytes);
    flushWhenFull();
  }

  /// The end of a step in the recording; the one with tick 0 is that of the first world.
  struct Mark {
    std::uint64_t end = 0;  ///< Bytes of the recording up to here.
    std::uint64_t hash = 0;
  };
  Mark& markOf(std::uint64_t tick) { return marks[static_cast<std::size_t>(tick % marks.size())]; }
  void addMark() {
    markOf(ticks) = {given + piece.size(), lastHash};
    if (ticks - oldest >= marks.size()) oldest = ticks - marks.size() + 1;
  }
  void setRewindTicks(std::uint32_t most) {
    std::vector<Mark> kept(std::size_t{most} + 1);
    const std::uint64_t first = ticks - oldest > most ? ticks - most : oldest;
    for (std::uint64_t tick = first; tick <= ticks && !marks.empty(); ++tick) {
      kept[static_cast<std::size_t>(tick % kept.size())] = markOf(tick);
    }
    marks = std::move(kept);
    oldest = first;
  }

  void give(std::size_t bytes) {
    // First, for it may throw: they are then given once more.
    sink({piece.data(), bytes}, data);
    XXH3_64bits_update(&checksum, piece.data(), bytes);
    piece.erase(piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(bytes));
    given += bytes;
  }
  /// Gives away what can no longer be taken back.
  void flushWhenFull() {
    const std::uint64_t settled = markOf(oldest).end;
    if (settled >= given + kPieceBytes) give(static_cast<std::size_t>(settled - given));
  }
  void cutAfter(std::uint64_t tick) {
    ticks = tick;
    piece.resize(static_cast<std::size_t>(markOf(tick).end - given));
    lastHash = markOf(tick).hash;
    stamp = startStamp + tick;
  }
  /// Goes back to the step that the Space was restored to, if it was.
  /// @param made  steps made since
  void followRestore(std::uint64_t made) {
    if (space.worldsBroughtIn() == broughtIn) return;
    const std::uint64_t to = space.stamp() - made;
    const bool known = to >= startStamp + oldest && to <= stamp;
    require<Fault::ForeignWorld>(known,
                                 "The world was restored to a step that the recorder cannot go back to.");
    const std::uint64_t tick = to - startStamp;
    require<Fault::ForeignWorld>(made > 0 || markOf(tick).hash == space.hash(),
                                 "The world was restored to one that is not the recording's after a step.");
    cutAfter(tick);
    broughtIn = space.worldsBroughtIn();
  }
  void check() const {
    require<Fault::ForeignWorld>(!checking || space.hash() == lastHash,
                                 "The world was changed by something that was not recorded.");
  }
  /// Writes `written`, then does what it says: what cannot be written is not done, and what cannot be done is
  /// cut off again.
  template <class Apply, class Written>
  BodyId record(CommandKind kind, const Written& written, Apply&& apply) {
    struct CutOff {
      std::vector<std::uint8_t>& piece;
      std::size_t end;
      ~CutOff() { piece.resize(end); }
    };
    followRestore(0);
    check();
    CutOff kept{piece, piece.size()};
    write.put(RecordingItem::command);
    write.put(kind);
    CommandWriter<S> writer{write, pieceSink};
    if constexpr (requires { std::visit(writer, written); }) {
      std::visit(writer, written);
    } else {
      writer(written);
    }
    const BodyId id = apply();
    kept.end = piece.size();
    if (checking) lastHash = space.hash();
    return id;
  }
  /// So that recordStep takes no memory.
  void makeRoomForStep() { makeRoom(piece, piece.size() + sizeof(RecordingItem) + sizeof lastHash); }
  void confirm(std::uint64_t upTo) {
    oldest = max(oldest, upTo);
    flushWhenFull();
  }
  void end() {
    makeRoom(piece, piece.size() + sizeof(RecordingItem) + 2 * sizeof(std::uint64_t));
    finished = true;
    write.put(RecordingItem::end);
    write.put(ticks);
    give(piece.size());
    write.put(static_cast<std::uint64_t>(XXH3_64bits_digest(&checksum)));
    sink(piece, data);
  }
  std::uint64_t recordStep() {
    stamp = space.stamp();
    ++ticks;
    lastHash = space.hash();
    write.put(RecordingItem::step);
    write.put(lastHash);
    addMark();
    flushWhenFull();
    return lastHash;
  }

  Space<S>& space;
  S timeStep;
  ByteSink sink;
  void* data;
  Wiring<S> wiring;
  std::uint64_t startStamp;
  std::uint64_t stamp;
  std::uint64_t broughtIn;  ///< Of the worlds that the Space was given, how many are known here.
  std::uint64_t ticks = 0;
  std::uint64_t oldest = 0;  ///< The first tick that can be gone back to.
  std::uint64_t given = 0;   ///< Bytes that the sink has.
  std::uint64_t lastHash = 0;
  bool checking = false;
  bool finished = false;
  std::vector<std::uint8_t> piece;  ///< Bytes that the sink does not have yet.
  std::vector<Mark> marks;          ///< A ring of the ticks that can be gone back to.
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
  require<Fault::ValueOutOfRange>(timeStep > S(0) && timeStep <= kMaxTimeStep<S>, "Recorder: time step is ",
                                  timeStep, " s, allowed are above 0 to ", kMaxTimeStep<S>, " s");
  if (const char* flaw = flawOf(space.state())) fail<Fault::ForeignWorld>(flaw);
  auto impl = std::make_unique<Impl>(space, timeStep, sink, data, wiring);
  impl->begin();
  impl_ = impl.release();
}

template <Scalar S>
Recorder<S>::~Recorder() {
  delete impl_;
}

template <Scalar S>
BodyId Recorder<S>::apply(const Command<S>& command) {
  requireRecordable(command);
  return impl_->record(kindOf(command), command,
                       [&] { return applyCommand(impl_->space, command, impl_->wiring); });
}

template <Scalar S>
void Recorder<S>::input(std::span<const std::uint8_t> bytes) {
  requireRecordableInput(bytes.size());
  impl_->record(CommandKind::userInput, bytes, [&] {
    require<Fault::MissingCallback>(impl_->wiring.applyInput != nullptr);
    impl_->wiring.applyInput(impl_->space, bytes, impl_->wiring.data);
    return BodyId{};
  });
}

template <Scalar S>
std::uint64_t Recorder<S>::step() {
  impl_->followRestore(0);
  impl_->check();
  impl_->makeRoomForStep();
  impl_->space.step(impl_->timeStep);
  return impl_->recordStep();
}

template <Scalar S>
std::uint64_t Recorder<S>::stepped() {
  impl_->followRestore(1);
  require<Fault::ForeignWorld>(impl_->space.stamp() == impl_->stamp + 1,
                               "stepped() is called once after each step.");
  require<Fault::ForeignWorld>(impl_->space.currentTimeStep() == impl_->timeStep,
                               "The step was not as long as those of the recording.");
  impl_->makeRoomForStep();
  return impl_->recordStep();
}

template <Scalar S>
void Recorder<S>::confirm(std::uint64_t ticks) {
  require<Fault::ValueOutOfRange>(ticks <= impl_->ticks, "Only steps that are recorded can be confirmed.");
  impl_->confirm(ticks);
}

template <Scalar S>
void Recorder<S>::setRewindTicks(std::uint32_t ticks) {
  require<Fault::ValueOutOfRange>(ticks <= kMostRewindTicks, "At most 2^15 steps can be taken back.");
  impl_->setRewindTicks(ticks);
}

template <Scalar S>
void Recorder<S>::setChecking(bool checking) {
  impl_->checking = checking;
  if (checking) impl_->lastHash = impl_->space.hash();
}

template <Scalar S>
void Recorder<S>::finish() {
  if (impl_->finished) return;
  impl_->followRestore(0);
  finish(impl_->ticks);
}

template <Scalar S>
void Recorder<S>::finish(std::uint64_t ticks) {
  if (impl_->finished) return;
  require<Fault::ValueOutOfRange>(ticks >= impl_->oldest && ticks <= impl_->ticks,
                                  "The recorder cannot end after that step.");
  impl_->cutAfter(ticks);
  impl_->end();
}

template <Scalar S>
std::uint64_t Recorder<S>::ticks() const {
  return impl_->ticks;
}

#define SAMESTEP_EACH_SCALAR template class Recorder<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
