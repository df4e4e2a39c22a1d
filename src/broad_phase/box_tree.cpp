// SPDX-License-Identifier: MIT
#include <samestep/box_tree.h>

#include <algorithm>

namespace samestep {

namespace {

/// Overlaps no box within the limits.
constexpr GridBox kEmptyBox = {1 << 30, 1 << 30, -(1 << 30), -(1 << 30)};

[[gnu::always_inline]] inline GridBox merge(const GridBox& a, const GridBox& b) {
  return {std::min(a.left, b.left), std::min(a.bottom, b.bottom), std::max(a.right, b.right),
          std::max(a.top, b.top)};
}

[[gnu::always_inline]] inline bool holds(const GridBox& outer, const GridBox& inner) {
  return ((inner.left - outer.left) | (inner.bottom - outer.bottom) | (outer.right - inner.right) |
          (outer.top - inner.top)) >= 0;
}

/// Half the perimeter. Never the area, which overflows for boxes as large as a world.
[[gnu::always_inline]] inline std::int64_t cost(const GridBox& box) {
  return (std::int64_t{box.right} - box.left) + (std::int64_t{box.top} - box.bottom);
}

[[gnu::always_inline]] inline std::int64_t distance(std::int64_t a, std::int64_t b) {
  return a < b ? b - a : a - b;
}

/// Twice the distance of the centres along the axes.
inline std::int64_t proximity(const GridBox& a, const GridBox& b) {
  return distance(std::int64_t{a.left} + a.right, std::int64_t{b.left} + b.right) +
         distance(std::int64_t{a.bottom} + a.top, std::int64_t{b.bottom} + b.top);
}

}  // namespace

// In units of four, so that no product leaves 64 bits: factors are below 2^30.
bool overlaps(const GridSegment& segment, const GridBox& box) {
  if (!overlaps(segment.bounds, box)) return false;
  if (!segment.endsOnGrid) return true;

  const std::int64_t x = segment.x[0] >> 2;
  const std::int64_t y = segment.y[0] >> 2;
  const std::int64_t dx = (segment.x[1] >> 2) - x;
  const std::int64_t dy = (segment.y[1] >> 2) - y;
  // One unit for the ends' rounding, one for the box's, one for the reach's.
  const std::int64_t slack = (segment.reach >> 2) + 3;
  const std::int64_t left = (box.left >> 2) - slack;
  const std::int64_t right = (box.right >> 2) + slack;
  const std::int64_t bottom = (box.bottom >> 2) - slack;
  const std::int64_t top = (box.top >> 2) + slack;

  // The segment's line separates the box from it if the centre is further off than the half-diagonal; all
  // times two.
  const std::int64_t offset = dx * (bottom + top - 2 * y) - dy * (left + right - 2 * x);
  const std::int64_t extent = distance(dx, 0) * (top - bottom) + distance(dy, 0) * (right - left);
  return distance(offset, 0) <= extent;
}

BoxTree::BoxTree(std::uint32_t maxLeaves) : maxLeaves_(maxLeaves) { nodes_.push_back(emptyNode()); }

BoxTree::Node BoxTree::emptyNode() { return {{kEmptyBox, kEmptyBox}, {kNone, kNone}, kNone, {0, 0}}; }

void BoxTree::clear() {
  nodes_.clear();
  nodes_.push_back(emptyNode());
  places_.clear();
  freeNodes_ = kNone;
  count_ = 0;
}

BoxTree::Ref BoxTree::newNode() {
  if (freeNodes_ == kNone) {
    nodes_.push_back(emptyNode());
    return static_cast<Ref>(nodes_.size() - 1);
  }
  const Ref node = freeNodes_;
  freeNodes_ = nodes_[node].child[0];
  return node;
}

void BoxTree::freeNode(Ref node) {
  nodes_[node].child[0] = freeNodes_;
  freeNodes_ = node;
}

void BoxTree::hang(Place place, Ref ref, const GridBox& box, std::uint32_t height) {
  Node& node = nodes_[place >> 1];
  node.box[place & 1] = box;
  node.child[place & 1] = ref;
  node.height[place & 1] = static_cast<std::uint16_t>(height);
  if ((ref & kLeaf) != 0) {
    places_[ref & ~kLeaf] = place;
  } else if (ref != kNone) {
    nodes_[ref].parent = place;
  }
}

// The place whose sharing with `box` adds the least perimeter to the tree: a descent that stops when no
// deeper place can be better. Ties go to the nearer centre, then to the lower subtree, which keeps even
// a heap of equal boxes balanced.
BoxTree::Place BoxTree::findSibling(const GridBox& box, Place start) const {
  const std::int64_t own = cost(box);
  Place place = start;
  Place best = start;
  GridBox here = nodes_[start >> 1].box[start & 1];
  std::int64_t grown = cost(merge(here, box));
  std::int64_t bestCost = grown;
  std::int64_t inherited = 0;
  for (Ref ref = nodes_[start >> 1].child[start & 1]; (ref & kLeaf) == 0;
       ref = nodes_[place >> 1].child[place & 1]) {
    inherited += grown - cost(here);
    const Node& node = nodes_[ref];
    std::int64_t bound[2];
    std::int64_t merged[2];
    for (int side = 0; side < 2; ++side) {
      merged[side] = cost(merge(node.box[side], box));
      const bool leaf = (node.child[side] & kLeaf) != 0;
      const std::int64_t direct = inherited + merged[side];
      bound[side] = leaf ? direct : direct + std::min<std::int64_t>(own - cost(node.box[side]), 0);
      const bool better = direct < bestCost || (direct == bestCost && leaf);
      if (better) {
        bestCost = direct;
        best = ref << 1 | static_cast<Place>(side);
      }
    }
    int next = bound[1] < bound[0] ? 1 : 0;
    if (bound[0] == bound[1]) {
      const std::int64_t near = proximity(node.box[0], box) - proximity(node.box[1], box);
      next = near > 0 || (near == 0 && node.height[1] < node.height[0]) ? 1 : 0;
    }
    if (bound[next] > bestCost) break;
    place = ref << 1 | static_cast<Place>(next);
    if ((node.child[next] & kLeaf) != 0) {
      if (bound[next] == bestCost) best = place;
      break;
    }
    here = node.box[next];
    grown = merged[next];
  }
  return best;
}

void BoxTree::insert(Key key, const GridBox& box) {
  require<Fault::IndexOutOfBounds>(key < kMaxKeys, "a tree: key is ", key, ", allowed are 0 to ",
                                   kMaxKeys - 1);
  require<Fault::InsufficientBufferSize>(count_ < maxLeaves_);
  expects(!contains(key));
  if (key >= places_.size()) places_.resize(key + 1, kNone);
  ++count_;
  const Ref leaf = kLeaf | key;
  if (root() == kNone) {
    hang(0, leaf, box, 0);
  } else {
    insertBelow(0, leaf, box);
  }
}

std::uint32_t BoxTree::depthOf(Place place) const {
  std::uint32_t depth = 0;
  for (; place >> 1 != kAnchor; place = nodes_[place >> 1].parent) ++depth;
  return depth;
}

// Always into the lower subtree: what is above the leaf grows only where both sides are equally high, all the
// way down.
BoxTree::Place BoxTree::findShallow() const {
  Place place = 0;
  for (Ref ref = root(); (ref & kLeaf) == 0; ref = nodes_[place >> 1].child[place & 1]) {
    const Node& node = nodes_[ref];
    place = ref << 1 | (node.height[1] < node.height[0] ? 1u : 0u);
  }
  return place;
}

// Boxes one in the other would each go above all others and make a list of the tree. One that is as high as
// it may be takes leaves where it is low, whatever their perimeter, so that it is rebuilt for the first of n
// such boxes and not for every fortieth.
BoxTree::Place BoxTree::choosePlace(const GridBox& box, Place start) {
  const Place best = findSibling(box, start);
  if (height() < kMaxHeight) return best;
  const auto grows = [this](Place place) {
    return depthOf(place) + 1 + nodes_[place >> 1].height[place & 1] > kMaxHeight;
  };
  if (!grows(best)) return best;
  const Place shallow = findShallow();
  if (!grows(shallow)) return shallow;
  rebuild();
  return findSibling(box, 0);
}

// Makes the tree higher by one at the most: a rotation makes its node one higher where the other side is at
// least as high as this one has become, and then what this one gained does not count.
void BoxTree::insertBelow(Place start, Ref leaf, const GridBox& box) {
  const Place place = choosePlace(box, start);
  const bool tall = height() >= kMaxHeight;
  const Ref node = newNode();
  const Node& parent = nodes_[place >> 1];
  const Ref sibling = parent.child[place & 1];
  const GridBox siblingBox = parent.box[place & 1];
  const std::uint32_t siblingHeight = parent.height[place & 1];
  hang(node << 1, sibling, siblingBox, siblingHeight);
  hang(node << 1 | 1, leaf, box, 0);
  hang(place, node, merge(siblingBox, box), siblingHeight + 1);

  Place changed = place;
  while (changed >> 1 != kAnchor) {
    const Ref above = changed >> 1;
    rotate(above, static_cast<int>(changed & 1), tall);
    const Node& n = nodes_[above];
    const GridBox merged = merge(n.box[0], n.box[1]);
    const std::uint16_t height = static_cast<std::uint16_t>(1 + std::max(n.height[0], n.height[1]));
    changed = n.parent;
    Node& up = nodes_[changed >> 1];
    if (up.box[changed & 1] == merged && up.height[changed & 1] == height) break;
    up.box[changed & 1] = merged;
    up.height[changed & 1] = height;
  }
}

// The child on the other side changes places with one of this side's children if that makes this side
// smaller. In a tree as high as it may be, only if it gets no higher.
void BoxTree::rotate(Ref node, int side, bool tall) {
  Node& upper = nodes_[node];
  const Ref inner = upper.child[side];
  if ((inner & kLeaf) != 0) return;
  Node& lower = nodes_[inner];
  const int other = 1 - side;
  if (tall && upper.height[other] >= upper.height[side]) return;
  const GridBox kept0 = merge(upper.box[other], lower.box[1]);
  const GridBox kept1 = merge(upper.box[other], lower.box[0]);
  const std::int64_t now = cost(upper.box[side]);
  const std::int64_t cost0 = cost(kept0);
  const std::int64_t cost1 = cost(kept1);
  if (now <= cost0 && now <= cost1) return;

  const int moved = cost0 <= cost1 ? 0 : 1;
  const Ref down = upper.child[other];
  const GridBox downBox = upper.box[other];
  const std::uint32_t downHeight = upper.height[other];
  hang(node << 1 | static_cast<Place>(other), lower.child[moved], lower.box[moved], lower.height[moved]);
  hang(inner << 1 | static_cast<Place>(moved), down, downBox, downHeight);
  upper.box[side] = moved == 0 ? kept0 : kept1;
  upper.height[side] = static_cast<std::uint16_t>(1 + std::max(lower.height[0], lower.height[1]));
}

void BoxTree::refit(Ref node) {
  while (node != kAnchor) {
    const Place place = nodes_[node].parent;
    const GridBox box = boxOf(node);
    const std::uint16_t height = static_cast<std::uint16_t>(heightOf(node));
    Node& up = nodes_[place >> 1];
    if (up.box[place & 1] == box && up.height[place & 1] == height) return;
    up.box[place & 1] = box;
    up.height[place & 1] = height;
    node = place >> 1;
  }
}

GridBox BoxTree::boxOf(Ref ref) const {
  if ((ref & kLeaf) != 0) return box(ref & ~kLeaf);
  return merge(nodes_[ref].box[0], nodes_[ref].box[1]);
}

std::uint32_t BoxTree::heightOf(Ref ref) const {
  if ((ref & kLeaf) != 0) return 0;
  return 1u + std::max(nodes_[ref].height[0], nodes_[ref].height[1]);
}

void BoxTree::replaceChild(Ref parent, Ref child, Ref value) {
  require<Fault::LeafError>((parent & kLeaf) == 0);
  require<Fault::InvalidChild>(parent < nodes_.size() && child != kNone &&
                               (nodes_[parent].child[0] == child || nodes_[parent].child[1] == child));
  const Place side = nodes_[parent].child[0] == child ? 0 : 1;
  hang(parent << 1 | side, value, boxOf(value), heightOf(value));
  refit(parent);
}

void BoxTree::remove(Key key) {
  expects(contains(key));
  const Place place = places_[key];
  const Ref node = place >> 1;
  if (node == kAnchor) {
    hang(0, kNone, kEmptyBox, 0);
  } else {
    const Ref sibling = nodes_[node].child[1 - (place & 1)];
    replaceChild(nodes_[node].parent >> 1, node, sibling);
    freeNode(node);
  }
  places_[key] = kNone;
  --count_;
}

// A leaf seldom goes far: the search for its new place begins at the lowest subtree that holds its new box.
void BoxTree::move(Key key, const GridBox& box) {
  expects(contains(key));
  const Place place = places_[key];
  const Ref node = place >> 1;
  if (node == kAnchor) {
    nodes_[kAnchor].box[0] = box;
    return;
  }
  Place start = nodes_[node].parent;
  while (start != 0 && !holds(nodes_[start >> 1].box[start & 1], box)) start = nodes_[start >> 1].parent;
  replaceChild(nodes_[node].parent >> 1, node, nodes_[node].child[1 - (place & 1)]);
  freeNode(node);
  places_[key] = kNone;
  insertBelow(start, kLeaf | key, box);
}

void BoxTree::rebuild() {
  ++rebuilds_;
  std::vector<Leaf> leaves;
  leaves.reserve(count_);
  for (Key key = 0; key < places_.size(); ++key) {
    if (contains(key)) leaves.push_back({box(key), key});
  }
  nodes_.clear();
  nodes_.push_back(emptyNode());
  freeNodes_ = kNone;
  if (leaves.empty()) return;
  splitAll(leaves);
  // Children have higher indices than their parents.
  for (Ref node = static_cast<Ref>(nodes_.size() - 1); node > kAnchor; --node) {
    hang(nodes_[node].parent, node, boxOf(node), heightOf(node));
  }
}

// Halves each range at the median centre of its wider axis, from the top down.
void BoxTree::splitAll(std::vector<Leaf>& leaves) {
  struct Range {
    std::size_t begin, end;
    Place place;
  };
  std::vector<Range> open{{0, leaves.size(), 0}};
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    if (range.end - range.begin == 1) {
      hang(range.place, kLeaf | leaves[range.begin].key, leaves[range.begin].box, 0);
      continue;
    }
    GridBox centers = kEmptyBox;  // Box of the doubled centres, halved to stay within 32 bits.
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const GridBox& box = leaves[i].box;
      const std::int32_t x = (box.left + box.right) / 2;
      const std::int32_t y = (box.bottom + box.top) / 2;
      centers = merge(centers, {x, y, x, y});
    }
    const bool wide =
        std::int64_t{centers.right} - centers.left >= std::int64_t{centers.top} - centers.bottom;
    const auto before = [wide](const Leaf& a, const Leaf& b) {
      const std::int32_t ca = wide ? a.box.left + a.box.right : a.box.bottom + a.box.top;
      const std::int32_t cb = wide ? b.box.left + b.box.right : b.box.bottom + b.box.top;
      return ca != cb ? ca < cb : a.key < b.key;
    };
    const std::size_t middle = range.begin + (range.end - range.begin) / 2;
    const auto at = [&leaves](std::size_t i) { return leaves.begin() + static_cast<std::ptrdiff_t>(i); };
    // total order: keys are unique, so each half is one set; the order within it is asked for nowhere
    std::nth_element(at(range.begin), at(middle), at(range.end), before);

    const Ref node = newNode();
    nodes_[node].parent = range.place;
    open.push_back({range.begin, middle, node << 1});
    open.push_back({middle, range.end, node << 1 | 1});
  }
}

bool BoxTree::valid() const {
  std::uint32_t leaves = 0;
  if (root() == kNone) return count_ == 0;
  return validBelow(kAnchor, leaves) && leaves == count_;
}

// Recursion as deep as the tree is high.
bool BoxTree::validBelow(Ref node, std::uint32_t& leaves) const {
  for (int side = 0; side < (node == kAnchor ? 1 : 2); ++side) {
    const Ref below = nodes_[node].child[side];
    const Place place = node << 1 | static_cast<Place>(side);
    if ((below & kLeaf) != 0) {
      ++leaves;
      if (nodes_[node].height[side] != 0 || places_[below & ~kLeaf] != place) return false;
      continue;
    }
    if (below >= nodes_.size() || nodes_[below].parent != place) return false;
    if (nodes_[node].box[side] != boxOf(below)) return false;
    if (nodes_[node].height[side] != heightOf(below)) return false;
    if (!validBelow(below, leaves)) return false;
  }
  return true;
}

}  // namespace samestep
