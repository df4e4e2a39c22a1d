// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "solver/joints/joint_row.h"
#include "solver/joints/joint_work.h"

namespace samestep {

/// Solves what joints hold together, where passes over one joint after the other would come there slowly: in
/// bodies joined as trees that weigh far more than the lightest of them, such as a load on a chain. What they
/// hold is eliminated from the leaves to the root of a tree and found on the way back, in as many operations
/// as there are joints. Joints that close a loop, or hold with a greatest force, are left to the passes.
/// Source: D. Baraff, "Linear-Time Dynamics using Lagrange Multipliers" (SIGGRAPH 1996).
template <Scalar S>
class JointTrees {
 public:
  bool empty() const { return nodes_.empty(); }
  void clear() { nodes_.clear(); }
  /// Finds the trees of a step.
  void begin(const SlotMap<Body<S>, BodyId>& world, std::vector<JointWork<S>>& joints,
             const std::vector<JointBody<S>>& bodies);
  /// Takes the rows of the joints as they are now.
  void build(const std::vector<JointWork<S>>& joints, const std::vector<JointRow<S>>& rows);
  /// @param corrects  whether places are corrected, too
  void solve(const std::vector<JointWork<S>>& joints, std::vector<JointRow<S>>& rows,
             std::vector<JointBody<S>>& bodies, bool corrects);

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr int kMostRows = 3;

  /// A symmetric matrix of up to three rows as the product of a triangle, a diagonal and the triangle.
  struct Factors {
    Scaled<S> inverse[3]{};
    Scaled<S> low10{}, low20{}, low21{};

    /// @param m  xx, yx, yy, zx, zy, zz
    void factor(const Scaled<S> (&m)[6], int rows);
    void solve(Scaled<S> (&x)[3], int rows) const;
  };
  /// Rows of a joint, by the body on the side of the leaves and the other one.
  struct Link {
    std::uint32_t joint = kNone;
    bool leafIsA = false;
    int rows = 0;
    std::uint32_t row[kMostRows]{};
    /// Rows by the velocities of both bodies.
    Scaled<S> leaf[kMostRows][3]{}, rest[kMostRows][3]{};
    /// Factors from an impulse to u.
    Scaled<S> perImpulse[kMostRows]{};
    Factors inverse;
    /// Speeds that the rows lack.
    Scaled<S> lacks[3]{};
  };
  /// A body, and what holds it to the one nearer to the root.
  struct Node {
    std::uint32_t body = 0;
    std::uint32_t parent = kNone;
    Link link;
    /// The joints with what nothing moves: links_ from one to the other.
    std::uint32_t firstFixed = 0, lastFixed = 0;
    Scaled<S> mass{}, moment{};
    bool turns = false;
    Scaled<S> inertia[6]{};
    Factors inverse;
    Scaled<S> pull[3]{};
    Scaled<S> change[3]{};
  };

  void findNeighbours(const std::vector<JointWork<S>>& joints);
  void addTree(std::vector<JointWork<S>>& joints, std::uint32_t root);
  bool isWorthIt(const std::vector<JointWork<S>>& joints, std::uint32_t root);
  void takeRows(Link& link, const JointWork<S>& joint, const std::vector<JointRow<S>>& rows, const Node* leaf,
                const Node* rest);
  void findLacks(Link& link, const JointWork<S>& joint, const std::vector<JointRow<S>>& rows,
                 const std::vector<JointBody<S>>& bodies, bool corrects);
  void give(const Link& link, const Scaled<S> (&impulse)[3], const JointWork<S>& joint,
            std::vector<JointRow<S>>& rows, std::vector<JointBody<S>>& bodies);

  // Those nearer to a root first.
  std::vector<Node> nodes_;
  std::vector<Link> fixed_;
  // Joints of each body of the solver, as ranges of one list; its node; marks of the search.
  std::vector<std::uint32_t> start_, list_;
  std::vector<std::uint32_t> nodeOf_;
  std::vector<std::uint8_t> isSeen_;
  std::vector<std::uint32_t> reached_;
};

#define SAMESTEP_EACH_SCALAR extern template class JointTrees<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
