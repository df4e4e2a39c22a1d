// SPDX-License-Identifier: MIT
#include <samestep/recorder.h>

#include <samestep/version.h>

#include <memory>
#include <new>
#include <variant>

#include "base/require_ieee.h"
#include "recording/recording_format.h"
#include "recording/recording_writer.h"
#include "state/canonical_bytes.h"

namespace samestep {
namespace {

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
  void operator()(const Join<S>& join) const { putJoint(join.id, join.joint); }
  void operator()(const Adjust<S>& adjust) const { putJoint(adjust.id, adjust.joint); }
  /// As the Space takes it: without what another one kept.
  void putJoint(JointId id, Joint<S> joint) const {
    joint.kept = {};
    joint.latch = S(0);
    write.put(id);
    write.put(joint);
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

void requireKey(std::string_view key) {
  require<Fault::ValueOutOfRange>(!key.empty() && key.size() <= kMaxKeyBytes, "A key has 1 to 255 bytes.");
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
        wiring(wiringIn),
        startStamp(space.stamp()),
        stamp(space.stamp()),
        broughtIn(space.worldsBroughtIn()),
        out(sinkIn, dataIn) {}

  void begin() {
    std::vector<std::uint8_t> header;
    BytesSink sink(header);
    CanonicalWriter<BytesSink> put(sink);
    for (const std::uint8_t byte : kRecordingMagic) put.put(byte);
    put.put(kRecordingVersion);
    put.put(kSimulationRevision);
    put.put(ScalarTraits<S>::kKind);
    for (int i = 0; i < 3; ++i) put.put(std::uint8_t{0});
    put.put(timeStep);
    std::vector<std::uint8_t> world;
    encodeWorld(space.state(), world);
    lastHash = space.hash();
    out.begin(header, lastHash, world);
  }

  void rewind(std::uint64_t tick) {
    out.rewind(tick);
    lastHash = out.hashAfter(tick);
    stamp = startStamp + tick;
  }
  /// Goes back to the step that the Space was restored to, if it was.
  /// @param made  steps made since
  void followRestore(std::uint64_t made) {
    if (space.worldsBroughtIn() == broughtIn) return;
    const std::uint64_t to = space.stamp() - made;
    const bool known = to >= startStamp + out.oldest() && to <= stamp;
    require<Fault::ForeignWorld>(known,
                                 "The world was restored to a step that the recorder cannot go back to.");
    const std::uint64_t tick = to - startStamp;
    require<Fault::ForeignWorld>(made > 0 || out.hashAfter(tick) == space.hash(),
                                 "The world was restored to one that is not the recording's after a step.");
    rewind(tick);
    broughtIn = space.worldsBroughtIn();
  }
  void check() const {
    require<Fault::ForeignWorld>(!checking || space.hash() == lastHash,
                                 "The world was changed by something that was not recorded.");
  }
  /// A function of the game's that a step or command calls would write between what is written of that.
  void requireIdle() const {
    require<Fault::SpaceLocked>(!busy, "A recorder is used from within its own step or command.");
  }
  /// Notes that the world is being changed by the recorder.
  class Change {
   public:
    explicit Change(Impl& impl) : impl_(impl) {
      impl_.requireIdle();
      impl_.busy = true;
    }
    ~Change() { impl_.busy = false; }
    Change(const Change&) = delete;
    Change& operator=(const Change&) = delete;

   private:
    Impl& impl_;
  };
  /// Writes `written`, then does what it says: what cannot be written is not done, and what cannot be done is
  /// cut off again.
  template <class Apply, class Written>
  BodyId record(CommandKind kind, const Written& written, Apply&& apply) {
    const Change change(*this);
    require<Fault::SpaceLocked>(!space.isLocked(), "Commands are recorded between steps.");
    struct CutOff {
      std::vector<std::uint8_t>& items;
      std::size_t end;
      ~CutOff() { items.resize(end); }
    };
    followRestore(0);
    check();
    CutOff kept{out.items(), out.items().size()};
    write.put(RecordingItem::command);
    write.put(kind);
    CommandWriter<S> writer{write, itemsSink};
    if constexpr (requires { std::visit(writer, written); }) {
      std::visit(writer, written);
    } else {
      writer(written);
    }
    const BodyId id = apply();
    kept.end = out.items().size();
    if (checking) lastHash = space.hash();
    return id;
  }
  /// Takes a keyframe, or none where there is no memory for it: the step is recorded.
  void takeKeyframe() {
#if defined(__cpp_exceptions)
    try {
      if (std::vector<std::uint8_t>* keyframe = out.keyframeDue()) {
        encodeWorld(space.state(), *keyframe);
        out.endKeyframe();
      }
    } catch (const std::bad_alloc&) {
      out.dropKeyframe();
    }
#else
    if (std::vector<std::uint8_t>* keyframe = out.keyframeDue()) {
      encodeWorld(space.state(), *keyframe);
      out.endKeyframe();
    }
#endif
  }
  /// @pre out.prepareTick(): takes no memory
  std::uint64_t recordStep() {
    stamp = space.stamp();
    lastHash = space.hash();
    write.put(RecordingItem::step);
    write.put(lastHash);
    out.endTick(lastHash);
    takeKeyframe();
    return lastHash;
  }
  void claim(std::string_view key, std::span<const std::uint8_t> value) {
    requireIdle();
    followRestore(0);
    std::vector<std::uint8_t>& item = claimItem;
    item.clear();
    BytesSink sink(item);
    CanonicalWriter<BytesSink> put(sink);
    put.put(RecordingItem::claim);
    put.put(static_cast<std::uint8_t>(key.size()));
    item.insert(item.end(), key.begin(), key.end());
    put.put(static_cast<std::uint32_t>(value.size()));
    item.insert(item.end(), value.begin(), value.end());
    out.insertAfterTick(item);
  }

  Space<S>& space;
  S timeStep;
  Wiring<S> wiring;
  std::uint64_t startStamp;
  std::uint64_t stamp;
  std::uint64_t broughtIn;  ///< Number of the worlds given to the Space that are known here.
  std::uint64_t lastHash = 0;
  bool checking = false;
  bool finished = false;
  bool busy = false;  ///< A step or command is under way.
  RecordingWriter out;
  BytesSink itemsSink{out.items()};
  CanonicalWriter<BytesSink> write{itemsSink};
  std::vector<std::uint8_t> claimItem;
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
    require<Fault::MissingCallback>(impl_->wiring.applyInput != nullptr, "an input of ", bytes.size(),
                                    " bytes: no function of the game's applies inputs");
    impl_->wiring.applyInput(impl_->space, bytes, impl_->wiring.data);
    return BodyId{};
  });
}

template <Scalar S>
std::uint64_t Recorder<S>::step() {
  const typename Impl::Change change(*impl_);
  impl_->followRestore(0);
  impl_->check();
  impl_->out.prepareTick();
  impl_->space.step(impl_->timeStep);
  return impl_->recordStep();
}

template <Scalar S>
std::uint64_t Recorder<S>::stepped() {
  impl_->requireIdle();
  impl_->followRestore(1);
  require<Fault::ForeignWorld>(impl_->space.stamp() == impl_->stamp + 1,
                               "stepped() is called once after each step.");
  require<Fault::ForeignWorld>(impl_->space.currentTimeStep() == impl_->timeStep,
                               "The step was not as long as those of the recording.");
  impl_->out.prepareTick();
  return impl_->recordStep();
}

template <Scalar S>
void Recorder<S>::confirm(std::uint64_t ticks) {
  impl_->requireIdle();
  require<Fault::ValueOutOfRange>(ticks <= impl_->out.ticks(),
                                  "Only steps that are recorded can be confirmed.");
  impl_->out.confirm(ticks);
}

template <Scalar S>
void Recorder<S>::setRewindTicks(std::uint32_t ticks) {
  impl_->requireIdle();
  require<Fault::ValueOutOfRange>(ticks <= kMostRewindTicks, "At most 2^15 steps can be taken back.");
  impl_->out.setRewindTicks(ticks);
}

template <Scalar S>
void Recorder<S>::setKeyframes(const KeyframeBudget& budget) {
  impl_->requireIdle();
  impl_->out.setKeyframes(budget);
}

template <Scalar S>
void Recorder<S>::setPacking(bool packing) {
  impl_->requireIdle();
  impl_->out.setPacking(packing);
}

template <Scalar S>
void Recorder<S>::claim(std::string_view key, std::span<const std::uint8_t> value) {
  requireKey(key);
  require<Fault::ValueOutOfRange>(value.size() <= kMaxClaimBytes, "A claim has at most 4096 bytes.");
  impl_->claim(key, value);
}

template <Scalar S>
void Recorder<S>::claim(std::string_view key, std::string_view value) {
  claim(key, std::span(reinterpret_cast<const std::uint8_t*>(value.data()), value.size()));
}

template <Scalar S>
void Recorder<S>::note(std::string_view key, std::string_view value) {
  impl_->requireIdle();
  requireKey(key);
  require<Fault::ValueOutOfRange>(value.size() <= kMaxNoteBytes, "A note has at most 2^16 bytes.");
  impl_->out.note(key, value);
}

template <Scalar S>
void Recorder<S>::setChecking(bool checking) {
  impl_->requireIdle();
  impl_->checking = checking;
  if (checking) impl_->lastHash = impl_->space.hash();
}

template <Scalar S>
void Recorder<S>::finish() {
  impl_->requireIdle();
  if (impl_->finished) return;
  impl_->followRestore(0);
  finish(impl_->out.ticks());
}

template <Scalar S>
void Recorder<S>::finish(std::uint64_t ticks) {
  impl_->requireIdle();
  if (impl_->finished) return;
  require<Fault::ValueOutOfRange>(ticks >= impl_->out.oldest() && ticks <= impl_->out.ticks(),
                                  "The recorder cannot end after that step.");
  impl_->rewind(ticks);
  impl_->finished = true;
  impl_->out.finish();
}

template <Scalar S>
std::uint64_t Recorder<S>::ticks() const {
  return impl_->out.ticks();
}

#define SAMESTEP_EACH_SCALAR template class Recorder<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
