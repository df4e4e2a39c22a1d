// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <samestep/player.h>

namespace samestep {

/// Wishes for a film.
struct FilmOptions {
  /// First and last step shown; the last one is at most that of the recording.
  std::uint64_t from = 0;
  std::uint64_t to = ~std::uint64_t{0};
  /// Index of a body that the picture goes along with; without one the picture is as wide as all that moves.
  std::optional<std::uint32_t> follow;
  /// Number of pictures for a second of the match, at most; fewer are taken where the film would be too
  /// large.
  std::uint32_t rate = 30;
  /// Bytes that the film may have.
  std::uint64_t bytes = std::uint64_t{1} << 23;
};

/// Where two recordings part, as a film shows it.
struct FilmDifference {
  std::uint64_t tick = 0;
  /// First body, by its index, that is not the same in both; none where only other things differ.
  std::optional<std::uint32_t> body;
};

/// A stretch of a recording for somebody to look at: the tracks of all bodies, as pictures that any browser
/// plays. The same recording and wishes give the same bytes on every machine.
template <Scalar S>
class Film {
 public:
  /// Plays the stretch. With a second recording, the first body that is not the same in both is marked from
  /// the first step on after which the worlds differ, with its outline in the second one dashed.
  /// @param other  null for none
  /// @throws ValueOutOfRange for a stretch that is none, and a body to follow that is not there at its
  /// beginning;
  ///         as Player::seek
  Film(Player<S>& player, Player<S>* other, const FilmOptions& options);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// The whole as one SVG with animations, which repeats.
  /// @param caption  one line above the picture
  /// @throws ValueOutOfRange where two pictures of it already are too large
  std::string svg(const std::string& caption);

  /// Number of pictures, and the steps from each to the next.
  std::uint32_t pictures() const;
  std::uint64_t stride() const;
  /// One picture as an SVG that stands still.
  std::string still(std::uint32_t picture, const std::string& caption) const;
  std::uint64_t tickOf(std::uint32_t picture) const;

  const std::optional<FilmDifference>& difference() const;

 private:
  struct Impl;
  Impl* impl_;
};

#define SAMESTEP_EACH_SCALAR extern template class Film<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
