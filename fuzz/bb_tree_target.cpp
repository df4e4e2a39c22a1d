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
    Vector<S> velocity;
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

/// A tree and a brute-force index that ask for the boxes of the same objects, each with a static one.
template <Scalar S>
class Indexes {
 public:
  explicit Indexes(Model<S>& model) : model_(model) {
    for (SpatialIndex<S>* index :
         {static_cast<SpatialIndex<S>*>(&tree_), static_cast<SpatialIndex<S>*>(&brute_)}) {
      index->setVelocityFunc(&Indexes::velocityOf, &remarks_);
    }
  }

  /// Brings in what the model says.
  void follow(bool withVelocities) {
    tree_.setVelocityFunc(withVelocities ? &Indexes::velocityOf : nullptr, nullptr);
    for (IndexKey key = 0; key < kKeys; ++key) {
      const auto& object = model_.objects[key];
      const auto set = [&](SpatialIndex<S>& index, bool present) {
        if (!present) return index.remove(key);
        index.contains(key) ? index.reindexObject(key) : index.insert(key);
      };
      set(tree_, object.present && !object.resting);
      set(brute_, object.present && !object.resting);
      set(restingTree_, object.present && object.resting);
      set(restingBrute_, object.present && object.resting);
    }
    expect(tree_.count() == brute_.count() && restingTree_.count() == restingBrute_.count(),
           "both indexes hold as many");
  }

  void compare(const BB<S>& box, IndexKey leftOut) {
    const auto pairsOf = [&](SpatialIndex<S>& index) {
      std::vector<IndexKeyPair> pairs;
      index.reindexQuery(
          [](void* to, IndexKey a, IndexKey b) {
            static_cast<std::vector<IndexKeyPair>*>(to)->push_back({a, b});
          },
          &pairs);
      expect(std::is_sorted(pairs.begin(), pairs.end()), "pairs come by rising keys");
      std::erase_if(pairs, [&](const IndexKeyPair& pair) {
        return !intersects(model_.objects[pair.a].box, model_.objects[pair.b].box);
      });
      return pairs;
    };
    expect(pairsOf(tree_) == pairsOf(brute_), "a tree finds the pairs that brute force finds");
    expect(pairsOf(restingTree_) == pairsOf(restingBrute_), "so does a static tree");
    // A tree beside a static index of another kind.
    const auto mixedPairs = [&](const SpatialIndex<S>& index, const SpatialIndex<S>& resting) {
      std::vector<IndexKeyPair> pairs;
      index.collideStatic(
          resting,
          [](void* to, IndexKey a, IndexKey b) {
            static_cast<std::vector<IndexKeyPair>*>(to)->push_back({a, b});
          },
          &pairs);
      std::erase_if(pairs, [&](const IndexKeyPair& pair) {
        return !intersects(model_.objects[pair.a].box, model_.objects[pair.b].box);
      });
      return pairs;
    };
    expect(mixedPairs(tree_, restingBrute_) == mixedPairs(brute_, restingTree_),
           "kinds of index can be mixed");
    std::vector<IndexKey> found, exact;
    tree_.collect(box, found, leftOut);
    brute_.collect(box, exact, leftOut);
    std::erase_if(found, [&](IndexKey key) { return !intersects(box, model_.objects[key].box); });
    expect(found == exact, "a query of a tree finds what brute force finds");
    std::vector<IndexKey> all, others;
    const auto add = [](void* to, IndexKey key) { static_cast<std::vector<IndexKey>*>(to)->push_back(key); };
    tree_.each(add, &all);
    brute_.each(add, &others);
    expect(all == others, "both indexes visit the same objects");
    expect(tree_.boxes().valid() && restingTree_.boxes().valid(),
           "every node knows its box, height and parent");
    expect(tree_.bytes() >= all.size() * sizeof(BB<S>), "a tree says how large it is");
  }

 private:
  static BB<S> boxOf(void* context, IndexKey key) {
    return static_cast<Indexes*>(context)->model_.objects[key].box;
  }
  static Vector<S> velocityOf(void* context, IndexKey key) {
    return static_cast<Indexes*>(context)->model_.objects[key].velocity;
  }

  Model<S>& model_;
  Remarks remarks_;
  BBTree<S> restingTree_{&Indexes::boxOf, this}, tree_{&Indexes::boxOf, this, &restingTree_};
  BruteForceIndex<S> restingBrute_{&Indexes::boxOf, this}, brute_{&Indexes::boxOf, this, &restingBrute_};
};

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
    object = {true, resting, box, velocity};
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
    const std::uint64_t before = moving_.pairs().size();
    const std::uint64_t most = before % 2 == 0 ? before : before / 2;
    const bool noMore = moving_.updatePairs(most);
    moving_.updatePairs();
    const std::vector<IndexKeyPair>& pairs = moving_.pairs();
    expect(noMore == (pairs.size() <= most), "a search for so many pairs ends where there are more");
    expect(std::is_sorted(pairs.begin(), pairs.end()), "pairs are sorted");
    expect(std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end(), "no pair comes twice");
    struct Inflated {
      IndexKey key;
      bool resting;
      BB<S> box;
    };
    Inflated present[kKeys];
    int count = 0;
    for (IndexKey key = 0; key < kKeys; ++key) {
      const auto& object = model_.objects[key];
      if (object.present) present[count++] = {key, object.resting, inflate(object.box, model_.margin)};
    }
    // Both come in the same order, so that no pair need be searched for.
    auto pair = pairs.begin();
    for (int i = 0; i < count; ++i) {
      const Inflated& first = present[i];
      for (int j = i + 1; j < count; ++j) {
        const Inflated& second = present[j];
        if ((first.resting && second.resting) || !intersects(first.box, second.box)) continue;
        const IndexKeyPair wanted{first.key, second.key};
        while (pair != pairs.end() && *pair < wanted) ++pair;
        expect(pair != pairs.end() && *pair == wanted, "boxes that overlap are a pair");
      }
    }
    for (const IndexKeyPair& each : pairs) {
      expect(each.a < each.b && each.b < kKeys, "a pair names two objects, the lower first");
    }
  }

  template <class Touches>
  void checkFound(const BBTree<S>& tree, bool resting, const std::vector<IndexKey>& keys, Touches&& touches) {
    expect(std::is_sorted(keys.begin(), keys.end()), "answers come by rising key");
    expect(std::adjacent_find(keys.begin(), keys.end()) == keys.end(), "no answer comes twice");
    auto at = keys.begin();
    for (IndexKey key = 0; key < kKeys; ++key) {
      const auto& object = model_.objects[key];
      const bool here = object.present && object.resting == resting;
      expect(tree.contains(key) == here, "an object is in the tree it was put in");
      const bool found = at != keys.end() && *at == key;
      if (found) ++at;
      expect(here || !found, "an answer is in the tree");
      if (here && touches(object.box)) expect(found, "what overlaps the question is an answer");
    }
    expect(at == keys.end(), "an answer is an object");
  }

  void query(const BB<S>& box, const Vector<S>& to, S radius) {
    for (const bool resting : {false, true}) {
      const BBTree<S>& tree = resting ? resting_ : moving_;
      static std::vector<IndexKey> keys;
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

  Model<S>& model() { return model_; }
  bool isValid() const { return moving_.boxes().valid() && resting_.boxes().valid(); }
  std::uint32_t count() const { return moving_.count() + resting_.count(); }
  const std::vector<IndexKeyPair>& pairs() const { return moving_.pairs(); }

 private:
  BBTree<S> resting_;
  BBTree<S> moving_;
  Model<S> model_;
};

template <Scalar S>
void run(Input input) {
  Trees<S> trees;
  Indexes<S> indexes(trees.model());
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
      case 13: {
        indexes.follow((op >> 16 & 1) != 0);
        indexes.compare(readBox<S>(input), (op >> 17 & 1) != 0 ? key : kNoKey);
        break;
      }
      default:
        trees.checkPairs();
        break;
    }
  }
  trees.checkPairs();
  expect(trees.isValid(), "every node knows its box, height and parent");
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
