// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <samestep/error.h>
#include <samestep/expects.h>

namespace samestep {

/// Boxes of the tree live on a grid of 2^-kGridBits m, rounded outward: half the memory of boxes of numbers,
/// and one integer tree for every scalar. Coordinates are clamped to +-kGridLimit, which only ever adds
/// overlaps.
inline constexpr int kGridBits = 10;
inline constexpr std::int32_t kGridLimit = (1 << 30) - 1;

/// Edges included; in grid units.
struct GridBox {
  std::int32_t left;
  std::int32_t bottom;
  std::int32_t right;
  std::int32_t top;

  friend constexpr bool operator==(const GridBox&, const GridBox&) = default;
};

/// One branch instead of four: an overlap has four differences that are not negative.
[[gnu::always_inline]] inline constexpr bool overlaps(const GridBox& a, const GridBox& b) {
  return ((a.right - b.left) | (b.right - a.left) | (a.top - b.bottom) | (b.top - a.bottom)) >= 0;
}

/// A thick segment on the grid, for queries. `overlaps` may report a box that it misses by a few units, but
/// never misses one that it touches.
struct GridSegment {
  GridBox bounds;     ///< Box of the segment and its thickness.
  std::int32_t x[2];  ///< The ends, rounded down.
  std::int32_t y[2];
  std::int32_t reach;  ///< Half the thickness, rounded up.
  bool endsOnGrid;     ///< True if no end was clamped; otherwise only the bounds count.
};
bool overlaps(const GridSegment& segment, const GridBox& box);

/// A binary tree of boxes in flat arrays: the boxes of both children stand in their parent, leaves are keys.
/// Grown by perimeter, with rotations; rebuilt from its leaves when it gets too high. Its shape depends on
/// the history of calls, so no order of results is promised.
class BoxTree {
 public:
  using Key = std::uint32_t;
  /// A node's index, or kLeaf | key.
  using Ref = std::uint32_t;

  static constexpr Ref kLeaf = 0x80000000u;
  static constexpr Ref kNone = 0x7fffffffu;
  /// Keys are below this: they index arrays.
  static constexpr Key kMaxKeys = 1u << 24;
  /// Height limit: what would be higher is put in elsewhere, or the tree is rebuilt.
  static constexpr std::uint32_t kMaxHeight = 60;

  explicit BoxTree(std::uint32_t maxLeaves = kMaxKeys);

  std::uint32_t count() const { return count_; }
  bool contains(Key key) const { return key < places_.size() && places_[key] != kNone; }
  /// The box of a key that is there.
  const GridBox& box(Key key) const {
    expects(contains(key));
    return nodes_[places_[key] >> 1].box[places_[key] & 1];
  }
  /// 0 for a single leaf.
  std::uint32_t height() const { return nodes_[kAnchor].height[0]; }
  /// All keys in the tree are below this.
  Key keyEnd() const { return static_cast<Key>(places_.size()); }

  /// Puts in a key that is not there. O(height).
  /// @throws IndexOutOfBounds if key >= kMaxKeys, InsufficientBufferSize if the tree is full
  void insert(Key key, const GridBox& box);
  /// Takes out a key that is there. O(height).
  void remove(Key key);
  /// Does what remove and insert do, but cheaper for a small move.
  void move(Key key, const GridBox& box);
  void clear();

  /// A balanced tree from the same leaves: for tests, and after many changes. O(n log n)
  void rebuild();
  /// Number of times the tree was built anew, by itself or by a call.
  std::uint64_t rebuilds() const { return rebuilds_; }

  /// Calls visit(key) for every leaf whose box overlaps the area (GridBox or GridSegment), in any order.
  /// visit must not change the tree.
  /// @throws InsufficientBufferSize if the tree is higher than it can be
  template <class Area, class Visit>
  void query(const Area& area, Visit&& visit) const {
    Search search;
    search.open[search.depth++] = kAnchor;
    finish(search, area, visit);
  }
  /// Calls visit(other) for every other leaf whose box overlaps that of `key`; otherwise as query, and
  /// faster: from the leaf upwards only the boxes beside the path are compared.
  template <class Visit>
  void queryAround(Key key, Visit&& visit) const {
    const GridBox area = box(key);
    Search search;
    for (Place place = places_[key]; place >> 1 != kAnchor; place = nodes_[place >> 1].parent) {
      search.look(nodes_[place >> 1], 1 - (place & 1), area);
      search.check();
    }
    finish(search, area, visit);
  }

  // The structure itself, for tests.

  /// The top node, a leaf, or kNone.
  Ref root() const { return nodes_[kAnchor].child[0]; }
  /// Child on a side, 0 or 1, of a node.
  Ref child(Ref node, int side) const {
    expects(node < nodes_.size() && (side == 0 || side == 1));
    return nodes_[node].child[side];
  }
  /// Hangs `value` where `child` was and refits all boxes above.
  /// @throws LeafError if parent is a leaf, InvalidChild if child does not hang there
  void replaceChild(Ref parent, Ref child, Ref value);
  /// Bytes of memory that a copy takes.
  std::uint64_t bytes() const { return nodes_.size() * sizeof(Node) + places_.size() * sizeof(Place); }
  /// True if boxes, heights, links and counts agree with each other.
  bool valid() const;

 private:
  /// A side of a node: node << 1 | side.
  using Place = std::uint32_t;

  struct Node {
    GridBox box[2];
    Ref child[2];
    Place parent;
    std::uint16_t height[2];
  };

  struct Leaf {
    GridBox box;
    Key key;
  };

  /// Node 0 holds the root as its side 0, so that the root needs no special case.
  static constexpr Ref kAnchor = 0;
  static constexpr std::uint32_t kStackSize = kMaxHeight + 4;

  static Node emptyNode();

  /// State of a search: nodes still to look into, and keys found. Whether a box overlaps is as good as
  /// random, so a child is noted in any case, and kept by counting it.
  struct Search {
    // There is room for what is noted and not kept.
    Ref open[2 * kStackSize + 1];
    Ref found[2 * kStackSize + 1];
    std::uint32_t depth = 0;
    std::uint32_t count = 0;

    template <class Area>
    [[gnu::always_inline]] void look(const Node& node, Place side, const Area& area) {
      const Ref child = node.child[side];
      const std::uint32_t hit = overlaps(area, node.box[side]) ? 1 : 0;
      const std::uint32_t leaf = child >> 31;
      found[count] = child & ~kLeaf;
      count += hit & leaf;
      open[depth] = child;
      depth += hit & ~leaf;
    }
    void check() const {
      require<Fault::InsufficientBufferSize>(depth <= 2 * kStackSize - 1 && count <= 2 * kStackSize - 1);
    }
  };

  template <class Area, class Visit>
  void finish(Search& search, const Area& area, Visit& visit) const {
    while (search.depth > 0) {
      const Node& node = nodes_[search.open[--search.depth]];
      search.look(node, 0, area);
      search.look(node, 1, area);
      if (search.count > kStackSize) tell(search, visit);
      search.check();
    }
    tell(search, visit);
  }
  template <class Visit>
  static void tell(Search& search, Visit& visit) {
    for (std::uint32_t i = 0; i < search.count; ++i) visit(search.found[i]);
    search.count = 0;
  }

  Ref newNode();
  void freeNode(Ref node);
  void hang(Place place, Ref ref, const GridBox& box, std::uint32_t height);
  void insertBelow(Place start, Ref leaf, const GridBox& box);
  Place findSibling(const GridBox& box, Place start) const;
  std::uint32_t depthOf(Place place) const;
  Place findShallow() const;
  Place choosePlace(const GridBox& box, Place start);
  void rotate(Ref node, int side, bool tall);
  void refit(Ref node);
  GridBox boxOf(Ref ref) const;
  std::uint32_t heightOf(Ref ref) const;
  void splitAll(std::vector<Leaf>& leaves);
  bool validBelow(Ref node, std::uint32_t& leaves) const;

  std::vector<Node> nodes_;
  std::vector<Place> places_;  ///< Place of each key's leaf; kNone if there is none.
  Ref freeNodes_ = kNone;      ///< Linked by child[0].
  std::uint32_t count_ = 0;
  std::uint32_t maxLeaves_;
  std::uint64_t rebuilds_ = 0;
};

}  // namespace samestep
