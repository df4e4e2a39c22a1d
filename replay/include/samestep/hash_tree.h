// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <samestep/replay.h>
#include <samestep/state_diff.h>

namespace samestep {

// A match as a tree of hashes, by which two machines that hold a recording each find where they part without
// sending it: match -> tick -> stage of its step -> section of the world -> object -> field. The children of
// a node are numbered from 0; a node's hash is that of all below it.

/// A node, by the number of each child on the way from the root; empty for the root.
using TreePath = std::vector<std::uint32_t>;
/// Levels below the root.
enum class TreeLevel : std::uint8_t { match = 0, tick = 1, stage = 2, section = 3, object = 4, field = 5 };

/// One side's answers. A side on another machine answers by whatever carries its numbers.
class HashTree {
 public:
  virtual ~HashTree() = default;
  /// Number of children of a node; 0 for a field.
  virtual std::uint32_t children(const TreePath& path) = 0;
  /// A hash of the first `count` children of a node, which are as many at most.
  virtual std::uint64_t hashOfFirst(const TreePath& path, std::uint32_t count) = 0;
  /// Words for a node: "tick 7", "collide", "body", "body 3", "velocity.x".
  virtual std::string name(const TreePath& path) = 0;
  /// Value of a field; empty for other nodes.
  virtual std::string value(const TreePath& path) = 0;
};

/// The place at which two trees part.
struct TreeDifference {
  /// The first node that is not the same in both and has no child that is: a field, or a node that only one
  /// has. A tick where the recorded hashes differ and the worlds computed here do not: one was made by
  /// another build.
  TreePath path;
  /// True if only one of the two has it.
  bool onlyInOne = false;
  /// Number of questions that each side was asked.
  std::uint32_t questions = 0;
};

/// Finds the first difference, by a number of questions that grows as the logarithm of what there is.
/// @return nothing where the two are the same
std::optional<TreeDifference> firstDifference(HashTree& a, HashTree& b);

/// The tree of one world: section -> object -> field.
class WorldTree {
 public:
  explicit WorldTree(std::vector<WorldValue> values);

  std::uint32_t children(std::span<const std::uint32_t> path) const;
  std::uint64_t hashOfFirst(std::span<const std::uint32_t> path, std::uint32_t count) const;
  std::string name(std::span<const std::uint32_t> path) const;
  std::string value(std::span<const std::uint32_t> path) const;
  /// Hash of the whole.
  std::uint64_t hash() const { return hashOfFirst({}, children({})); }

 private:
  struct Node {
    std::string name;
    std::uint64_t hash = 0;
    std::uint32_t first = 0;  ///< First of its children, in the level below.
    std::uint32_t end = 0;
  };

  const Node* find(std::span<const std::uint32_t> path) const;

  std::vector<WorldValue> values_;
  std::vector<Node> levels_[4];  ///< The world, sections, objects, fields.
};

/// The tree of a recording. Hashes of ticks are those recorded; below them is what this build computes, by
/// way of the last keyframe before.
template <Scalar S>
class RecordingTree : public HashTree {
 public:
  /// @throws FormatError; MissingCallback
  explicit RecordingTree(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring = {},
                         const RecordingLimits& limits = {});

  std::uint32_t children(const TreePath& path) override;
  std::uint64_t hashOfFirst(const TreePath& path, std::uint32_t count) override;
  std::string name(const TreePath& path) override;
  std::string value(const TreePath& path) override;

 private:
  struct StageOfTick {
    std::string name;
    WorldTree tree;
  };
  const std::vector<StageOfTick>& stagesOf(std::uint32_t tick);
  const StageOfTick* stageAt(const TreePath& path);

  Replay<S> replay_;
  std::vector<std::uint64_t> chain_;  ///< Chain of the hashes up to each tick, the first world's first.
  std::vector<StageOfTick> stages_;
  std::optional<std::uint32_t> tick_;
};

#define SAMESTEP_EACH_SCALAR extern template class RecordingTree<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
