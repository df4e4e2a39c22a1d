// SPDX-License-Identifier: MIT
// BBTree, with and without a static tree, against the index that compares every box with every other.
#include <samestep/bb_tree.h>
#include <samestep/brute_force_index.h>

#include <algorithm>
#include <array>
#include <vector>

#include "cases.h"
#include "check.h"
#include "input.h"

namespace samestep::fuzz {
namespace {

constexpr IndexKey kKeys = 24;

template <Scalar S>
struct Model {
  struct Object {
    bool present = false;
    bool resting = false;
    BB<S> box;
  };
  std::array<Object, kKeys> objects;
  S margin{};
};

template <Scalar S>
BB<S> readBox(Input& input) {
  const Fixed limit(kMaxNumber / 2);
  const Fixed x = input.numberIn(-limit, limit), y = input.numberIn(-limit, limit);
  const Fixed width = input.numberIn(Fixed(0), Fixed(1 << 15)),
              height = input.numberIn(Fixed(0), Fixed(1 << 15));
  return {as<S>(x), as<S>(y), as<S>(x + width), as<S>(y + height)};
}

template <Scalar S>
class Trees {
 public:
  Trees() : moving_(nullptr, nullptr, &resting_) {}

  void put(IndexKey key, const BB<S>& box, bool resting, const Vector<S>& velocity) {
    auto& object = model_.objects[key];
    if (object.present && object.resting != resting) remove(key);
    if (resting) {
      resting_.update(key, box);
    } else {
      moving_.update(key, box, velocity);
    }
    object = {true, resting, box};
  }
  void remove(IndexKey key) {
    moving_.remove(key);
    resting_.remove(key);
    model_.objects[key].present = false;
  }
  void setMargin(S margin) {
    moving_.setMargin(margin);
    resting_.setMargin(margin);
    model_.margin = margin;
  }
  void rebuild() {
    moving_.rebuild();
    resting_.rebuild();
  }
  /// Goes on with copies, as after a restore.
  void copy(BBTree<S>& resting, BBTree<S>& moving) {
    resting.copyFrom(resting_);
    moving.copyFrom(moving_);
    resting_.copyFrom(resting);
    moving_.copyFrom(moving);
  }
  void clear() {
    moving_.clear();
    resting_.clear();
    for (auto& object : model_.objects) object.present = false;
  }

  void checkPairs() {
    moving_.updatePairs();
    const std::vector<KeyPair>& pairs = moving_.pairs();
    expect(std::is_sorted(pairs.begin(), pairs.end()), "pairs are sorted");
    expect(std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end(), "no pair comes twice");
    for (IndexKey a = 0; a < kKeys; ++a) {
      for (IndexKey b = a + 1; b < kKeys; ++b) {
        const auto &first = model_.objects[a], &second = model_.objects[b];
        if (!first.present || !second.present || (first.resting && second.resting)) continue;
        if (!intersects(inflate(first.box, model_.margin), inflate(second.box, model_.margin))) continue;
        expect(std::binary_search(pairs.begin(), pairs.end(), KeyPair{a, b}),
               "boxes that overlap are a pair");
      }
    }
    for (const KeyPair& pair : pairs) {
      expect(pair.a < pair.b && pair.b < kKeys, "a pair names two objects, the lower first");
    }
  }

  template <class Touches>
  void checkFound(const BBTree<S>& tree, bool resting, const std::vector<IndexKey>& keys, Touches&& touches) {
    expect(std::is_sorted(keys.begin(), keys.end()), "answers come by rising key");
    expect(std::adjacent_find(keys.begin(), keys.end()) == keys.end(), "no answer comes twice");
    for (IndexKey key = 0; key < kKeys; ++key) {
      const auto& object = model_.objects[key];
      const bool here = object.present && object.resting == resting;
      expect(tree.contains(key) == here, "an object is in the tree it was put in");
      const bool found = std::binary_search(keys.begin(), keys.end(), key);
      expect(here || !found, "an answer is in the tree");
      if (here && touches(object.box)) expect(found, "what overlaps the question is an answer");
    }
  }

  void query(const BB<S>& box, const Vector<S>& to, S radius) {
    for (const bool resting : {false, true}) {
      const BBTree<S>& tree = resting ? resting_ : moving_;
      std::vector<IndexKey> keys;
      tree.collectIn(box, keys);
      checkFound(tree, resting, keys, [&](const BB<S>& other) { return intersects(box, other); });
      const Vector<S> corner(box.left, box.bottom);
      tree.collectAt(corner, keys);
      checkFound(tree, resting, keys, [&](const BB<S>& other) { return contains(other, corner); });
      tree.collectAlong(corner, to, radius, keys);
      checkFound(tree, resting, keys, [&](const BB<S>& other) {
        // Ends within the box: the rest is a matter of rounding.
        return contains(other, corner) || contains(other, to);
      });
    }
  }

  std::uint32_t count() const { return moving_.count() + resting_.count(); }
  const std::vector<KeyPair>& pairs() const { return moving_.pairs(); }

 private:
  BBTree<S> resting_;
  BBTree<S> moving_;
  Model<S> model_;
};

template <Scalar S>
void run(Input input) {
  Trees<S> trees;
  BBTree<S> restingCopy, movingCopy(nullptr, nullptr, &restingCopy);
  for (int operations = 0; !input.atEnd() && operations < 64; ++operations) {
    const std::uint64_t op = input.word();
    const IndexKey key = byteOf(op, 1) % kKeys;
    switch (op % 16) {
      case 0:
      case 1:
      case 2:
      case 3:
      case 4:
      case 5: {
        const BB<S> box = readBox<S>(input);
        const Fixed speed(1 << 10);
        const Vector<S> velocity(as<S>(input.numberIn(-speed, speed)), as<S>(input.numberIn(-speed, speed)));
        trees.put(key, box, (op >> 16 & 3) == 0, velocity);
        break;
      }
      case 6:
      case 7:
        trees.remove(key);
        break;
      case 8: {
        const Fixed limit(kMaxNumber / 2);
        const BB<S> box = readBox<S>(input);
        const Vector<S> to(as<S>(input.numberIn(-limit, limit)), as<S>(input.numberIn(-limit, limit)));
        trees.query(box, to, as<S>(input.numberIn(Fixed(0), Fixed(256))));
        break;
      }
      case 9:
        trees.setMargin(as<S>(input.numberIn(Fixed(0), Fixed(1))));
        break;
      case 10:
        trees.rebuild();
        break;
      case 11:
        trees.copy(restingCopy, movingCopy);
        break;
      case 12:
        if (byteOf(op, 2) == 0) trees.clear();
        break;
      default:
        trees.checkPairs();
        break;
    }
  }
  trees.checkPairs();
}

}  // namespace
}  // namespace samestep::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const samestep::fuzz::Input input(data, size);
  // Checked in place of Fixed: the same code, and every overflow is a finding.
  samestep::fuzz::guarded([&] {
    samestep::fuzz::run<samestep::CheckedFixed>(input);
    if (size > 0 && (data[0] & 1) != 0) samestep::fuzz::run<double>(input);
  });
  return 0;
}
