// SPDX-License-Identifier: MIT
#include "solver/joints/joint_trees.h"

#include "base/require_ieee.h"
#include "joints/joint_limits.h"

namespace samestep {
namespace {

/// Bodies that weigh so many times as much as the lightest of them are solved as trees.
constexpr int kHeavy = 16;

/// Compliance of a row, as a part of its response: so little that a pass leaves nothing to see, and enough
/// that what nothing moves may hold a body more than once.
template <Scalar S>
Scaled<S> compliance() {
  return toScaled(ratio<S>(1, 1 << 24));
}

}  // namespace

template <Scalar S>
void JointTrees<S>::Factors::factor(const Scaled<S> (&m)[6], int rows) {
  const Scaled<S> none{}, one = toScaled(S(1));
  const auto inverseOf = [&](const Scaled<S>& x) { return x > none ? one / x : none; };
  inverse[0] = inverseOf(m[0]);
  if (rows < 2) return;
  low10 = m[1] * inverse[0];
  inverse[1] = inverseOf(m[2] - low10 * m[1]);
  if (rows < 3) return;
  low20 = m[3] * inverse[0];
  const Scaled<S> rest = m[4] - low20 * m[1];
  low21 = rest * inverse[1];
  inverse[2] = inverseOf(m[5] - low20 * m[3] - low21 * rest);
}

template <Scalar S>
void JointTrees<S>::Factors::solve(Scaled<S> (&x)[3], int rows) const {
  if (rows > 1) x[1] = x[1] - low10 * x[0];
  if (rows > 2) x[2] = x[2] - low20 * x[0] - low21 * x[1];
  for (int i = 0; i < rows; ++i) x[i] = x[i] * inverse[i];
  if (rows > 2) x[1] = x[1] - low21 * x[2];
  if (rows > 2) x[0] = x[0] - low20 * x[2];
  if (rows > 1) x[0] = x[0] - low10 * x[1];
}

template <Scalar S>
void JointTrees<S>::findNeighbours(const std::vector<JointWork<S>>& joints) {
  const auto eachEnd = [&](auto&& visit) {
    for (std::uint32_t i = 0; i < joints.size(); ++i) {
      if (!joints[i].isHard) continue;
      if (!joints[i].fixedA) visit(joints[i].a, i);
      if (!joints[i].fixedB) visit(joints[i].b, i);
    }
  };
  start_.assign(nodeOf_.size() + 1, 0);
  eachEnd([&](std::uint32_t body, std::uint32_t) { ++start_[body + 1]; });
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  list_.resize(start_.back());
  std::vector<std::uint32_t>& next = reached_;
  next.assign(start_.begin(), start_.end());
  eachEnd([&](std::uint32_t body, std::uint32_t joint) { list_[next[body]++] = joint; });
}

/// True if the bodies joined with one weigh so much more than the lightest, and hardly any loop is among
/// them.
template <Scalar S>
bool JointTrees<S>::isWorthIt(const std::vector<JointWork<S>>& joints, std::uint32_t root) {
  reached_.assign(1, root);
  isSeen_[root] = 1;
  Scaled<S> sum{}, least{};
  std::size_t ends = 0;
  for (std::size_t i = 0; i < reached_.size(); ++i) {
    const std::uint32_t body = reached_[i];
    const Scaled<S> mass = nodes_[body].mass;
    sum = sum + mass;
    if (i == 0 || mass < least) least = mass;
    for (std::uint32_t k = start_[body]; k < start_[body + 1]; ++k) {
      const JointWork<S>& joint = joints[list_[k]];
      if (joint.fixedA || joint.fixedB) continue;
      ++ends;
      const std::uint32_t other = joint.a == body ? joint.b : joint.a;
      if (isSeen_[other] != 0) continue;
      isSeen_[other] = 1;
      reached_.push_back(other);
    }
  }
  const std::size_t between = ends / 2, loops = between + 1 - reached_.size();
  return between > 0 && loops <= 1 + between / 4 && sum >= toScaled(S(kHeavy)) * least;
}

template <Scalar S>
void JointTrees<S>::begin(const SlotMap<Body<S>, BodyId>& world, std::vector<JointWork<S>>& joints,
                          const std::vector<JointBody<S>>& bodies) {
  fixed_.clear();
  nodeOf_.assign(bodies.size(), kNone);
  isSeen_.assign(bodies.size(), 0);
  findNeighbours(joints);
  // The first nodes hold the masses by number; the nodes of trees follow.
  nodes_.assign(bodies.size(), {});
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    const Body<S>& body = world.valueAt(bodies[i].slot);
    nodes_[i].mass = toScaled(body.mass());
    nodes_[i].moment = body.exactMoment();
    nodes_[i].turns = body.inverseMoment() > Scaled<S>{};
    nodes_[i].body = i;
  }
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (isSeen_[i] == 0 && start_[i] < start_[i + 1] && isWorthIt(joints, i)) addTree(joints, i);
  }
  nodes_.erase(nodes_.begin(), nodes_.begin() + static_cast<std::ptrdiff_t>(bodies.size()));
  for (Node& node : nodes_) {
    if (node.parent != kNone) node.parent -= static_cast<std::uint32_t>(bodies.size());
  }
}

/// Adds the bodies joined with one, nearest first, each by the first joint that reaches it.
template <Scalar S>
void JointTrees<S>::addTree(std::vector<JointWork<S>>& joints, std::uint32_t root) {
  const auto add = [&](std::uint32_t body, std::uint32_t parent, std::uint32_t joint) {
    nodeOf_[body] = static_cast<std::uint32_t>(nodes_.size());
    Node node = nodes_[body];
    node.parent = parent;
    node.link.joint = joint;
    nodes_.push_back(node);
    if (joint != kNone) joints[joint].inTree = true;
  };
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  add(root, kNone, kNone);
  for (std::uint32_t i = first; i < nodes_.size(); ++i) {
    const std::uint32_t body = nodes_[i].body;
    nodes_[i].firstFixed = static_cast<std::uint32_t>(fixed_.size());
    for (std::uint32_t k = start_[body]; k < start_[body + 1]; ++k) {
      JointWork<S>& joint = joints[list_[k]];
      const bool isA = joint.a == body;
      if (joint.fixedA || joint.fixedB) {
        Link& link = fixed_.emplace_back();
        link.joint = list_[k];
        link.leafIsA = !isA;
        joint.inTree = true;
        continue;
      }
      const std::uint32_t other = isA ? joint.b : joint.a;
      if (nodeOf_[other] != kNone) continue;
      add(other, i, list_[k]);
      nodes_.back().link.leafIsA = !isA;
    }
    nodes_[i].lastFixed = static_cast<std::uint32_t>(fixed_.size());
  }
}

/// Takes the rows that hold with any force.
/// @param leaf  null where nothing moves that side
template <Scalar S>
void JointTrees<S>::takeRows(Link& link, const JointWork<S>& joint, const std::vector<JointRow<S>>& rows,
                             const Node* leaf, const Node* rest) {
  link.rows = 0;
  for (std::uint32_t i = joint.begin; i < joint.end; ++i) {
    const JointRow<S>& row = rows[i];
    if (row.corrects == 0 || row.low == S(0) || link.rows == kMostRows) continue;
    const int at = link.rows++;
    link.row[at] = i;
    const auto put = [&](Scaled<S>(&to)[3], const Node* node, bool isA) {
      if (node == nullptr) return;
      const S sign = isA ? S(-1) : S(1);
      to[0] = toScaled(sign * row.n.x);
      to[1] = toScaled(sign * row.n.y);
      to[2] = node->turns ? toScaled(sign * (isA ? row.armA : row.armB)) : Scaled<S>{};
    };
    put(link.leaf[at], leaf, link.leafIsA);
    put(link.rest[at], rest, !link.leafIsA);
    link.perImpulse[at] = toScaled(row.perKept) * (row.n == Vector<S>() ? joint.perTorque : joint.perForce);
  }
}

template <Scalar S>
void JointTrees<S>::build(const std::vector<JointWork<S>>& joints, const std::vector<JointRow<S>>& rows) {
  const Scaled<S> one = toScaled(S(1)), softness = compliance<S>();
  for (Node& node : nodes_) {
    for (Scaled<S>& part : node.inertia) part = {};
    node.inertia[0] = node.inertia[2] = node.mass;
    node.inertia[5] = node.turns ? node.moment : one;
  }
  // A link adds to the inertia of the body nearer to the root: its rows by the inverse of how they
  // answer.
  const auto stiffen = [&](Node& node, const Link& link) {
    Scaled<S> by[3][3];
    for (int axis = 0; axis < 3; ++axis) {
      for (int r = 0; r < link.rows; ++r) by[axis][r] = link.rest[r][axis];
      link.inverse.solve(by[axis], link.rows);
    }
    int place = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j <= i; ++j, ++place) {
        for (int r = 0; r < link.rows; ++r) {
          node.inertia[place] = node.inertia[place] + link.rest[r][i] * by[j][r];
        }
      }
    }
  };
  const auto invert = [&](Link& link, const Factors* leaf) {
    Scaled<S> answer[6]{};
    int place = 0;
    for (int i = 0; i < link.rows; ++i) {
      Scaled<S> moved[3] = {link.leaf[i][0], link.leaf[i][1], link.leaf[i][2]};
      if (leaf != nullptr) leaf->solve(moved, 3);
      for (int j = 0; j <= i; ++j, ++place) {
        if (leaf != nullptr) {
          for (int k = 0; k < 3; ++k) answer[place] = answer[place] + link.leaf[j][k] * moved[k];
        }
        if (i == j) answer[place] = answer[place] + softness * link.perImpulse[i];
      }
    }
    link.inverse.factor(answer, link.rows);
  };
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    for (std::uint32_t k = node.firstFixed; k < node.lastFixed; ++k) {
      takeRows(fixed_[k], joints[fixed_[k].joint], rows, nullptr, &node);
      invert(fixed_[k], nullptr);
      stiffen(node, fixed_[k]);
    }
    node.inverse.factor(node.inertia, 3);
    if (node.parent == kNone) continue;
    Node& parent = nodes_[node.parent];
    takeRows(node.link, joints[node.link.joint], rows, &node, &parent);
    invert(node.link, &node.inverse);
    stiffen(parent, node.link);
  }
}

template <Scalar S>
void JointTrees<S>::findLacks(Link& link, const JointWork<S>& joint, const std::vector<JointRow<S>>& rows,
                              const std::vector<JointBody<S>>& bodies, bool corrects) {
  const JointBody<S>&a = bodies[joint.a], &b = bodies[joint.b];
  for (int r = 0; r < link.rows; ++r) {
    const JointRow<S>& row = rows[link.row[r]];
    const S speed = relativeSpeed(row, b.velocity - a.velocity, a.spin, b.spin);
    link.lacks[r] = toScaled(-(speed + (corrects ? row.bias : S(0))));
  }
}

/// Gives the impulses of a link, each as its row does.
template <Scalar S>
void JointTrees<S>::give(const Link& link, const Scaled<S> (&impulse)[3], const JointWork<S>& joint,
                         std::vector<JointRow<S>>& rows, std::vector<JointBody<S>>& bodies) {
  JointBody<S>&a = bodies[joint.a], &b = bodies[joint.b];
  for (int r = 0; r < link.rows; ++r) {
    JointRow<S>& row = rows[link.row[r]];
    const S before = row.sum;
    const S change = toScalarWithin(impulse[r] * link.perImpulse[r], kMostKept<S>);
    row.sum = clamp(before + change, row.low, row.high);
    answer(row, row.sum - before, a.velocity, a.spin, b.velocity, b.spin);
  }
}

template <Scalar S>
void JointTrees<S>::solve(const std::vector<JointWork<S>>& joints, std::vector<JointRow<S>>& rows,
                          std::vector<JointBody<S>>& bodies, bool corrects) {
  for (Node& node : nodes_) {
    for (Scaled<S>& part : node.pull) part = {};
    for (std::uint32_t k = node.firstFixed; k < node.lastFixed; ++k) {
      findLacks(fixed_[k], joints[fixed_[k].joint], rows, bodies, corrects);
    }
    if (node.parent != kNone) findLacks(node.link, joints[node.link.joint], rows, bodies, corrects);
  }
  const auto pull = [&](Node& node, const Link& link, const Scaled<S>(&lacks)[3]) {
    Scaled<S> by[3] = {lacks[0], lacks[1], lacks[2]};
    link.inverse.solve(by, link.rows);
    for (int i = 0; i < 3; ++i) {
      for (int r = 0; r < link.rows; ++r) node.pull[i] = node.pull[i] + link.rest[r][i] * by[r];
    }
  };
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& node = nodes_[i];
    for (std::uint32_t k = node.firstFixed; k < node.lastFixed; ++k) pull(node, fixed_[k], fixed_[k].lacks);
    for (int k = 0; k < 3; ++k) node.change[k] = node.pull[k];
    node.inverse.solve(node.change, 3);
    if (node.parent == kNone) continue;
    for (int r = 0; r < node.link.rows; ++r) {
      for (int k = 0; k < 3; ++k) {
        node.link.lacks[r] = node.link.lacks[r] - node.link.leaf[r][k] * node.change[k];
      }
    }
    pull(nodes_[node.parent], node.link, node.link.lacks);
  }
  for (Node& node : nodes_) {
    const auto impulseOf = [&](Link& link, const Scaled<S>(&rest)[3]) {
      for (int r = 0; r < link.rows; ++r) {
        for (int k = 0; k < 3; ++k) link.lacks[r] = link.lacks[r] - link.rest[r][k] * rest[k];
      }
      link.inverse.solve(link.lacks, link.rows);
    };
    if (node.parent != kNone) {
      Link& link = node.link;
      impulseOf(link, nodes_[node.parent].change);
      for (int k = 0; k < 3; ++k) {
        for (int r = 0; r < link.rows; ++r) node.pull[k] = node.pull[k] + link.leaf[r][k] * link.lacks[r];
        node.change[k] = node.pull[k];
      }
      node.inverse.solve(node.change, 3);
      give(link, link.lacks, joints[link.joint], rows, bodies);
    }
    for (std::uint32_t k = node.firstFixed; k < node.lastFixed; ++k) {
      impulseOf(fixed_[k], node.change);
      give(fixed_[k], fixed_[k].lacks, joints[fixed_[k].joint], rows, bodies);
    }
  }
}

#define SAMESTEP_EACH_SCALAR template class JointTrees<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
