// SPDX-License-Identifier: MIT
#include <samestep/hash_tree.h>

#include <algorithm>

#include "base/require_ieee.h"
#include "state/state_hash.h"

namespace samestep {
namespace {

/// Mixes a number in, in the same way on every machine, whatever the order of its bytes.
std::uint64_t mixed(std::uint64_t before, std::uint64_t next) {
  std::uint8_t bytes[8];
  for (int i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(next >> (8 * i));
  return XXH3_64bits_withSeed(bytes, sizeof bytes, before);
}
std::uint64_t hashOf(const std::string& text) { return XXH3_64bits(text.data(), text.size()); }

/// "body" of "body 7": objects of a section follow each other, and their names begin alike.
std::string sectionOf(const std::string& object) { return object.substr(0, object.find(' ')); }

}  // namespace

std::optional<TreeDifference> firstDifference(HashTree& a, HashTree& b) {
  TreeDifference difference;
  const auto differs = [&](const TreePath& path, std::uint32_t count) {
    ++difference.questions;
    return a.hashOfFirst(path, count) != b.hashOfFirst(path, count);
  };
  while (true) {
    const TreePath& path = difference.path;
    ++difference.questions;
    const std::uint32_t inA = a.children(path);
    const std::uint32_t inB = b.children(path);
    const std::uint32_t common = std::min(inA, inB);
    if (common == 0 || !differs(path, common)) {
      if (inA == inB) {
        if (path.empty()) return std::nullopt;
        return difference;
      }
      difference.path.push_back(common);
      difference.onlyInOne = true;
      return difference;
    }
    // The first so many children are the same for `same` of them, and not for `other`.
    std::uint32_t same = 0;
    std::uint32_t other = common;
    while (other - same > 1) {
      const std::uint32_t middle = same + (other - same) / 2;
      (differs(path, middle) ? other : same) = middle;
    }
    difference.path.push_back(other - 1);
  }
}

WorldTree::WorldTree(std::vector<WorldValue> values) : values_(std::move(values)) {
  auto& [worlds, sections, objects, fields] = levels_;
  worlds.emplace_back();
  const auto size = [](const std::vector<Node>& level) { return static_cast<std::uint32_t>(level.size()); };
  for (const WorldValue& value : values_) {
    const std::string section = sectionOf(value.object);
    if (sections.empty() || sections.back().name != section) {
      sections.push_back({section, 0, size(objects), 0});
    }
    const bool sameObject =
        !objects.empty() && objects.back().name == value.object && sections.back().first < size(objects);
    if (!sameObject) objects.push_back({value.object, 0, size(fields), 0});
    fields.push_back({value.field, hashOf(value.object + "\n" + value.field + "\n" + value.value), 0, 0});
    objects.back().end = size(fields);
    sections.back().end = size(objects);
  }
  worlds.back().end = size(sections);
  for (int level = 2; level >= 0; --level) {
    for (Node& node : levels_[level]) {
      for (std::uint32_t i = node.first; i < node.end; ++i)
        node.hash = mixed(node.hash, levels_[level + 1][i].hash);
    }
  }
}

const WorldTree::Node* WorldTree::find(std::span<const std::uint32_t> path) const {
  const Node* node = &levels_[0][0];
  if (path.size() > 3) return nullptr;
  for (std::size_t level = 0; level < path.size(); ++level) {
    if (path[level] >= node->end - node->first) return nullptr;
    node = &levels_[level + 1][node->first + path[level]];
  }
  return node;
}

std::uint32_t WorldTree::children(std::span<const std::uint32_t> path) const {
  const Node* node = find(path);
  return node == nullptr ? 0 : node->end - node->first;
}

std::uint64_t WorldTree::hashOfFirst(std::span<const std::uint32_t> path, std::uint32_t count) const {
  const Node* node = find(path);
  if (node == nullptr) return 0;
  // A field has none, and a hash of its own.
  if (path.size() == 3) return node->hash;
  std::uint64_t hash = 0;
  const std::uint32_t end = std::min(node->end, node->first + std::min(count, node->end - node->first));
  for (std::uint32_t i = node->first; i < end; ++i) hash = mixed(hash, levels_[path.size() + 1][i].hash);
  return hash;
}

std::string WorldTree::name(std::span<const std::uint32_t> path) const {
  const Node* node = find(path);
  return node == nullptr ? std::string() : node->name;
}

std::string WorldTree::value(std::span<const std::uint32_t> path) const {
  const Node* node = path.size() == 3 ? find(path) : nullptr;
  return node == nullptr ? std::string() : values_[static_cast<std::size_t>(node - levels_[3].data())].value;
}

template <Scalar S>
RecordingTree<S>::RecordingTree(std::span<const std::uint8_t> bytes, const Wiring<S>& wiring,
                                const RecordingLimits& limits)
    : replay_(bytes, wiring, limits, {}, Ending::mayBeCut) {
  RecordingReader<S> reader = replay_.reader();
  chain_.push_back(mixed(0, reader.initialHash()));
  for (RecordingItem item = reader.next(); item != RecordingItem::end; item = reader.next()) {
    if (item == RecordingItem::step) chain_.push_back(mixed(chain_.back(), reader.hash()));
  }
}

template <Scalar S>
const std::vector<typename RecordingTree<S>::StageOfTick>& RecordingTree<S>::stagesOf(std::uint32_t tick) {
  if (tick_ == tick) return stages_;
  stages_.clear();
  tick_.reset();
  const auto keep = [this](const Space<S>& space, const char* name) {
    stages_.push_back({name, WorldTree(valuesOf(space.state()))});
  };
  replay_.seek(tick == 0 ? 0 : tick - 1);
  if (tick == 0) {
    keep(replay_.space(), "start");
  } else {
    replay_.applyCommands();
    keep(replay_.space(), "commands");
    struct Observer {
      decltype(keep)& take;
    } observer{keep};
    replay_.space().setStageObserver(
        [](const Space<S>& space, Stage stage, void* data) {
          static_cast<Observer*>(data)->take(space, stageName(stage));
        },
        &observer);
    replay_.step();
    replay_.space().setStageObserver(nullptr, nullptr);
    keep(replay_.space(), "end of the step");
  }
  tick_ = tick;
  return stages_;
}

template <Scalar S>
const typename RecordingTree<S>::StageOfTick* RecordingTree<S>::stageAt(const TreePath& path) {
  if (path.size() < 2 || path[0] >= chain_.size()) return nullptr;
  const std::vector<StageOfTick>& stages = stagesOf(path[0]);
  return path[1] < stages.size() ? &stages[path[1]] : nullptr;
}

template <Scalar S>
std::uint32_t RecordingTree<S>::children(const TreePath& path) {
  if (path.empty()) return static_cast<std::uint32_t>(chain_.size());
  if (path[0] >= chain_.size()) return 0;
  if (path.size() == 1) return static_cast<std::uint32_t>(stagesOf(path[0]).size());
  const StageOfTick* stage = stageAt(path);
  return stage == nullptr ? 0 : stage->tree.children(std::span(path).subspan(2));
}

template <Scalar S>
std::uint64_t RecordingTree<S>::hashOfFirst(const TreePath& path, std::uint32_t count) {
  if (path.empty()) return count == 0 || count > chain_.size() ? 0 : chain_[count - 1];
  if (path.size() > 1) {
    const StageOfTick* stage = stageAt(path);
    return stage == nullptr ? 0 : stage->tree.hashOfFirst(std::span(path).subspan(2), count);
  }
  if (path[0] >= chain_.size()) return 0;
  std::uint64_t hash = 0;
  const std::vector<StageOfTick>& stages = stagesOf(path[0]);
  for (std::size_t i = 0; i < stages.size() && i < count; ++i) hash = mixed(hash, stages[i].tree.hash());
  return hash;
}

template <Scalar S>
std::string RecordingTree<S>::name(const TreePath& path) {
  if (path.empty()) return "match";
  if (path.size() == 1) return "tick " + std::to_string(path[0]);
  const StageOfTick* stage = stageAt(path);
  if (stage == nullptr) return {};
  return path.size() == 2 ? stage->name : stage->tree.name(std::span(path).subspan(2));
}

template <Scalar S>
std::string RecordingTree<S>::value(const TreePath& path) {
  const StageOfTick* stage = path.size() > 2 ? stageAt(path) : nullptr;
  return stage == nullptr ? std::string() : stage->tree.value(std::span(path).subspan(2));
}

#define SAMESTEP_EACH_SCALAR template class RecordingTree<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
