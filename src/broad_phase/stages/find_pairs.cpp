// SPDX-License-Identifier: MIT
#include "broad_phase/stages/find_pairs.h"

#include <algorithm>

#include "base/require_ieee.h"

namespace samestep {

namespace {

/// Key by which pairs are sorted.
std::uint64_t sortKey(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

/// Tells whether boxes grown by a margin intersect, without a branch: for boxes that are near each other,
/// whether they overlap is as good as random.
template <Scalar S>
[[gnu::always_inline]] inline bool nearBoxes(const BB<S>& a, S margin, const BB<S>& b) {
  const BB<S> grown = inflate(a, margin);
  const int across = int{grown.left <= b.right} & int{b.left <= grown.right};
  const int up = int{grown.bottom <= b.top} & int{b.bottom <= grown.top};
  return (across & up) != 0;
}

}  // namespace

/// Has the trees say which boxes are near each other.
/// @return false where these are too many
template <Scalar S>
bool FindPairs<S>::findCandidates(StepContext<S>& step) {
  Derived<S>& derived = step.derived;
  BBTree<S>& tree = derived.dynamicTree;
  const S margin = step.pairMargin();
  if (tree.margin() != margin) {
    tree.setMargin(margin);
    derived.staticTree.setMargin(margin);
  }
  const std::uint64_t most = kCandidatesPerPair * step.wiring.maxPairs;
  if (tree.updatePairs(most, &step.wiring.budget)) return true;
  // The room boxes have to move follows from the past; whether a step is refused must not.
  for (std::uint32_t i = 0; i < step.state.shapes.slots(); ++i) {
    if (tree.contains(i)) tree.update(i, derived.placed[i].box);
  }
  return tree.updatePairs(most, &step.wiring.budget);
}

/// Says where each pair goes, which ones are new, and whose boxes overlap.
/// @return how many pairs there are now
template <Scalar S>
std::uint32_t FindPairs<S>::mergePairs(StepContext<S>& step) {
  const Derived<S>& derived = step.derived;
  const S margin = step.pairMargin();
  const std::uint32_t persistence = step.state.settings.collisionPersistence;
  const std::vector<IndexKeyPair>& candidates = derived.dynamicTree.pairs();
  overlapping_.resize(step.state.pairs.size() + candidates.size());
  newPairs_.clear();
  pairRuns_.clear();
  PairRun run{0, 0, 0};
  const std::uint32_t count = static_cast<std::uint32_t>(step.state.pairs.size());
  // Bytes may be a part of anything: what is not asked for again is not asked for after each of them.
  const Pair<S>* const pairs = step.state.pairs.data();
  const PlacedShape<S>* const placed = derived.placed.data();
  const ShapeTraits<S>* const traits = derived.traits.data();
  std::uint8_t* const overlapping = overlapping_.data();
  const bool jointed = !derived.keptApart.empty();
  std::uint32_t old = 0, to = 0;
  const auto beginRun = [&] {
    pairRuns_.push_back(run);
    run = {old, old, std::int64_t{to} - old};
  };
  const auto keep = [&](std::uint8_t overlap) {
    if (std::int64_t{to} - old != run.shift) [[unlikely]]
      beginRun();
    run.end = ++old;
    overlapping[to++] = overlap;
  };
  // Its boxes came apart: only a contact that may come back is kept, and one whose end is still to be told.
  const auto leave = [&] {
    const Pair<S>& pair = pairs[old];
    const bool forgotten = pair.state == ArbiterState::cached && pair.age + 1 >= persistence;
    if (pair.state == ArbiterState::apart || forgotten) {
      ++old;
    } else {
      keep(0);
    }
  };
  const auto keyOf = [](const Pair<S>& pair) { return sortKey(pair.a.index, pair.b.index); };
  constexpr std::size_t kChunk = 256;
  std::uint64_t close[kChunk];
  for (std::size_t begin = 0; begin < candidates.size(); begin += kChunk) {
    const std::size_t end = min(begin + kChunk, candidates.size());
    std::size_t found = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const auto [a, b] = candidates[i];
      close[found] = sortKey(a, b);
      found += nearBoxes(placed[a].box, margin, placed[b].box) ? 1 : 0;
    }
    for (std::size_t i = 0; i < found; ++i) {
      const std::uint64_t key = close[i];
      const std::uint32_t a = static_cast<std::uint32_t>(key >> 32), b = static_cast<std::uint32_t>(key);
      if (!mayCollide(traits[a], traits[b])) continue;
      if (jointed && derived.areKeptApart(traits[a].body, traits[b].body)) continue;
      while (old < count && keyOf(pairs[old]) < key) leave();
      if (old < count && keyOf(pairs[old]) == key) {
        keep(1);
      } else {
        newPairs_.push_back({to, a, b});
        overlapping[to++] = 1;
      }
    }
  }
  while (old < count) leave();
  pairRuns_.push_back(run);
  return to;
}

template <Scalar S>
void FindPairs<S>::run(StepContext<S>& step) {
  const std::uint32_t before = static_cast<std::uint32_t>(step.state.pairs.size());
  step.refused = !findCandidates(step);
  if (step.refused) return;
  step.derived.findKeptApart(step.state);
  step.pay(Budget::kPerCandidate * (step.derived.dynamicTree.pairs().size() + before));
  const std::uint32_t count = mergePairs(step);
  step.refused = count + step.state.restingPairs.size() > step.wiring.maxPairs;
  if (step.refused) return;
  if (count != before || pairRuns_.size() > 1 || !newPairs_.empty()) step.derived.bodyPairs.known = false;
  movePairs(step.state, count);
}

/// Puts all pairs where run wants them. Their order stays, so one that moves down finds its place free
/// once those below it that move down have moved, and the same upwards.
template <Scalar S>
void FindPairs<S>::movePairs(WorldState<S>& state, std::uint32_t count) {
  auto& pairs = state.pairs;
  overlapping_.resize(count);
  // Little room to spare: these are the largest records of a world.
  if (count > pairs.capacity()) pairs.reserve(count + count / 8);
  if (count > pairs.size()) pairs.resize(count);
  const auto first = pairs.begin();
  const auto& runs = pairRuns_;
  for (auto run = runs.begin(); run != runs.end(); ++run) {
    if (run->shift < 0) std::copy(first + run->from, first + run->end, first + (run->from + run->shift));
  }
  for (auto run = runs.rbegin(); run != runs.rend(); ++run) {
    if (run->shift > 0) {
      std::copy_backward(first + run->from, first + run->end, first + (run->end + run->shift));
    }
  }
  for (const NewPair& fresh : newPairs_) {
    Pair<S>& pair = pairs[fresh.to] = Pair<S>();
    pair.a = state.shapes.idAt(fresh.a);
    pair.b = state.shapes.idAt(fresh.b);
  }
  pairs.resize(count);
  // So many new pairs come when a world is built, and seldom again.
  if (newPairs_.size() > 4096 && newPairs_.size() == count) newPairs_ = {};
}

template <Scalar S>
void FindPairs<S>::mergeInto(std::vector<Pair<S>>& pairs, const std::vector<Pair<S>>& more) {
  std::size_t old = pairs.size(), fresh = more.size();
  pairs.resize(old + fresh);
  for (std::size_t to = pairs.size(); fresh > 0; --to) {
    const bool isOld = old > 0 && Pair<S>::before(more[fresh - 1], pairs[old - 1]);
    pairs[to - 1] = isOld ? pairs[--old] : more[--fresh];
  }
}

template <Scalar S>
void FindPairs<S>::addRested(StepContext<S>& step, const std::vector<Pair<S>>& more) {
  const S margin = step.pairMargin();
  const Derived<S>& derived = step.derived;
  std::vector<Pair<S>>& pairs = step.state.pairs;
  std::size_t old = pairs.size(), fresh = more.size();
  mergeInto(pairs, more);
  overlapping_.resize(pairs.size());
  for (std::size_t to = pairs.size(); fresh > 0; --to) {
    const Pair<S>& pair = pairs[to - 1];
    if (!Pair<S>::before(pair, more[fresh - 1]) && !Pair<S>::before(more[fresh - 1], pair)) {
      --fresh;
      const std::uint32_t a = pair.a.index, b = pair.b.index;
      const bool near = nearBoxes(derived.placed[a].box, margin, derived.placed[b].box);
      overlapping_[to - 1] = near && mayCollide(derived.traits[a], derived.traits[b]) ? 1 : 0;
    } else {
      overlapping_[to - 1] = overlapping_[--old];
    }
  }
  step.derived.bodyPairs.known = false;
}

#define SAMESTEP_EACH_SCALAR template class FindPairs<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
