// SPDX-License-Identifier: MIT
// Recordings played for somebody to look at.
#include <cstring>
#include <string>

#include <samestep/named_handlers.h>
#include <samestep/player.h>
#include <samestep/state_diff.h>

#include "base/require_ieee.h"
#include "limits_of.h"
#include "replay_wiring.h"

/// A recording being played, whatever it computes with.
struct samestep_player {
  samestep_player(samestep::ScalarKind of, std::span<const std::uint8_t> recording)
      : scalar(of), bytes(recording.begin(), recording.end()) {}
  samestep_player(const samestep_player&) = delete;
  samestep_player& operator=(const samestep_player&) = delete;
  virtual ~samestep_player() = default;

  const samestep::ScalarKind scalar;
  const std::vector<std::uint8_t> bytes;
  std::vector<std::uint64_t> hashes;
  std::vector<std::uint64_t> keyframes;
  std::vector<samestep_player_command> commands;
};

namespace samestep::c {
namespace {

template <Scalar S>
struct PlayerOf : samestep_player {
  PlayerOf(std::span<const std::uint8_t> recording, const samestep_wiring* from, const PlayerOptions& options)
      : samestep_player(ScalarTraits<S>::kKind, recording),
        wiring(from == nullptr ? samestep_wiring{} : *from),
        player(bytes, from == nullptr ? namedHandlerWiring<S>() : wiring.engine(), options),
        // A Player shows its Space as const, for a change would refute the recording; the header says so.
        world(const_cast<Space<S>&>(player.space())) {
    for (const Keyframe& keyframe : player.reader().keyframes()) keyframes.push_back(keyframe.tick);
    list();
  }

  ReplayWiring<S> wiring;
  Player<S> player;
  WorldOf<S> world;

  /// Calls visit(item, reader) for each item of the recording.
  template <class Visit>
  void eachItem(Visit&& visit) const {
    RecordingReader<S> reader = player.reader();
    reader.seek(0);
    for (RecordingItem item = reader.next(); item != RecordingItem::end; item = reader.next()) {
      visit(item, reader);
    }
  }

 private:
  void list() {
    hashes.push_back(player.reader().initialHash());
    eachItem([&](RecordingItem item, const RecordingReader<S>& reader) {
      if (item == RecordingItem::step) hashes.push_back(reader.hash());
      if (item == RecordingItem::command) commands.push_back(listed(reader.command()));
    });
  }
  samestep_player_command listed(const Command<S>& command) const {
    const BodyId body = std::visit(
        [](const auto& of) -> BodyId {
          if constexpr (std::is_same_v<decltype(of), const Spawn<S>&>) {
            return of.id;
          } else if constexpr (requires { of.body; }) {
            return of.body;
          } else {
            return {};
          }
        },
        command);
    return {hashes.size() - 1, body.valid() ? toC(body) : 0, static_cast<std::int32_t>(command.index()), 0};
  }
};

/// Runs action(player) on a player of either scalar; messages are the thread's.
template <class Action>
samestep_status callPlayer(const samestep_player* player, Action&& action) noexcept {
  return callFree([&] {
    at(player);
    auto& all = const_cast<samestep_player&>(*player);
    forScalar(static_cast<std::int32_t>(all.scalar),
              [&](auto number) { action(static_cast<PlayerOf<decltype(number)>&>(all)); });
  });
}

/// The command at a place among all, in words.
template <Scalar S>
std::string commandInWords(const PlayerOf<S>& of, std::size_t index) {
  require<Fault::IndexOutOfBounds>(index < of.commands.size());
  std::string words;
  std::size_t found = 0;
  of.eachItem([&](RecordingItem item, const RecordingReader<S>& reader) {
    if (item == RecordingItem::command && found++ == index) words = describe<S>(reader.command());
  });
  return words;
}

}  // namespace
}  // namespace samestep::c

using namespace samestep::c;

extern "C" {

samestep_status samestep_player_create(const uint8_t* bytes, size_t size, const samestep_wiring* wiring,
                                       const samestep_limits* limits, samestep_player** player) {
  return callFree([&] {
    at(player), at(bytes);
    samestep::PlayerOptions options;
    options.limits = toLimits(limits);
    const std::span<const uint8_t> recording(bytes, size);
    const auto scalar = static_cast<int32_t>(samestep::recordingInfo(recording).scalar);
    forScalar(scalar,
              [&](auto number) { *player = new PlayerOf<decltype(number)>(recording, wiring, options); });
  });
}

void samestep_player_destroy(samestep_player* player) { delete player; }

samestep_status samestep_player_get_info(const samestep_player* player, samestep_player_info* info) {
  return callPlayer(player, [&](auto& of) {
    const samestep::RecordingInfo about = samestep::recordingInfo(of.bytes);
    at(info) = {about.version,
                about.revision,
                static_cast<int32_t>(of.scalar),
                of.player.reader().isWhole() ? 1 : 0,
                of.player.ticks(),
                toDouble(of.player.timeStep())};
  });
}

samestep_status samestep_player_get_world(samestep_player* player, samestep_world** world) {
  return callPlayer(player, [&](auto& of) { at(world) = &of.world; });
}

samestep_status samestep_player_get_state(const samestep_player* player, samestep_player_state* state) {
  return callPlayer(player, [&](auto& of) {
    const std::optional<uint64_t> wrong = of.player.wrongTick();
    const uint64_t tick = of.player.tick();
    at(state) = {
        tick,          of.hashes[static_cast<size_t>(tick)],   of.player.provenTicks(), wrong.value_or(0),
        wrong ? 1 : 0, static_cast<int32_t>(of.player.trust())};
  });
}

samestep_status samestep_player_step(samestep_player* player, int32_t* made) {
  return callPlayer(player, [&](auto& of) {
    at(made);
    *made = of.player.step() ? 1 : 0;
  });
}

samestep_status samestep_player_seek(samestep_player* player, uint64_t tick) {
  return callPlayer(player, [&](auto& of) { of.player.seek(tick); });
}

samestep_status samestep_player_get_hashes(const samestep_player* player, const uint64_t** hashes,
                                           size_t* count) {
  return callPlayer(player, [&](auto& of) {
    at(hashes), at(count);
    give(of.hashes, hashes, count);
  });
}

samestep_status samestep_player_get_keyframes(const samestep_player* player, const uint64_t** ticks,
                                              size_t* count) {
  return callPlayer(player, [&](auto& of) {
    at(ticks), at(count);
    give(of.keyframes, ticks, count);
  });
}

samestep_status samestep_player_get_commands(const samestep_player* player,
                                             const samestep_player_command** commands, size_t* count) {
  return callPlayer(player, [&](auto& of) {
    at(commands), at(count);
    give(of.commands, commands, count);
  });
}

samestep_status samestep_player_write_command(const samestep_player* player, size_t index, char* text,
                                              size_t capacity, size_t* size) {
  return callPlayer(player, [&](auto& of) {
    at(size);
    const std::string words = commandInWords(of, index);
    giveSize(words.size() + 1, text, capacity, size);
    if (text != nullptr) std::memcpy(text, words.c_str(), words.size() + 1);
  });
}

}  // extern "C"
