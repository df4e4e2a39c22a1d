// SPDX-License-Identifier: MIT
#include <samestep/transform.h>

#include <gtest/gtest.h>

#include "support/scalars.h"

namespace samestep {
namespace {

template <Scalar S>
class TransformTest : public ::testing::Test {
 protected:
  static Transform<S> of(int a, int b, int c, int d, int tx, int ty) {
    return {S(a), S(b), S(c), S(d), S(tx), S(ty)};
  }
  static Vector<S> at(int x, int y) { return {S(x), S(y)}; }
  static void expectNear(const Transform<S>& t, double a, double b, double c, double d, double tx,
                         double ty) {
    EXPECT_NEAR(double(t.a), a, 1e-8);
    EXPECT_NEAR(double(t.b), b, 1e-8);
    EXPECT_NEAR(double(t.c), c, 1e-8);
    EXPECT_NEAR(double(t.d), d, 1e-8);
    EXPECT_NEAR(double(t.tx), tx, 1e-8);
    EXPECT_NEAR(double(t.ty), ty, 1e-8);
  }
  static constexpr double kCos1 = 0.5403023058681398;
  static constexpr double kSin1 = 0.8414709848078965;
};
TYPED_TEST_SUITE(TransformTest, AllScalarsAndChecked);

TYPED_TEST(TransformTest, HoldsItsColumnsAndBeginsAsTheIdentity) {
  using S = TypeParam;
  const Transform<S> t(S(1), S(2), S(3), S(4), S(5), S(6));
  EXPECT_EQ(t.a, S(1));
  EXPECT_EQ(t.b, S(2));
  EXPECT_EQ(t.c, S(3));
  EXPECT_EQ(t.d, S(4));
  EXPECT_EQ(t.tx, S(5));
  EXPECT_EQ(t.ty, S(6));
  EXPECT_EQ(Transform<S>(), this->of(1, 0, 0, 1, 0, 0));
}

TYPED_TEST(TransformTest, FromRowsTakesTheSameNumbersRowByRow) {
  using S = TypeParam;
  EXPECT_EQ(Transform<S>::fromRows(S(1), S(3), S(5), S(2), S(4), S(6)), this->of(1, 2, 3, 4, 5, 6));
}

TYPED_TEST(TransformTest, PointsAreMovedAndVectorsAreNot) {
  const auto t = this->of(1, 2, 3, 4, 5, 6);
  EXPECT_EQ(transformPoint(t, this->at(10, 100)), this->at(315, 426));
  EXPECT_EQ(transformVect(t, this->at(10, 100)), this->at(310, 420));
}

TYPED_TEST(TransformTest, TranslationMovesAndScalingStretches) {
  using S = TypeParam;
  EXPECT_EQ(Transform<S>::translation(this->at(7, -8)), this->of(1, 0, 0, 1, 7, -8));
  EXPECT_EQ(Transform<S>::scaling(S(2), S(-3)), this->of(2, 0, 0, -3, 0, 0));
  EXPECT_EQ(transformPoint(Transform<S>::translation(this->at(7, -8)), this->at(1, 1)), this->at(8, -7));
  EXPECT_EQ(transformPoint(Transform<S>::scaling(S(2), S(-3)), this->at(5, 6)), this->at(10, -18));
}

TYPED_TEST(TransformTest, RotationTurnsCounterClockwise) {
  using S = TypeParam;
  EXPECT_EQ(Transform<S>::rotation(S(0)), Transform<S>());
  this->expectNear(Transform<S>::rotation(S(1)), this->kCos1, this->kSin1, -this->kSin1, this->kCos1, 0, 0);
}

TYPED_TEST(TransformTest, RigidTurnsThenMoves) {
  using S = TypeParam;
  this->expectNear(Transform<S>::rigid(this->at(3, 4), S(1)), this->kCos1, this->kSin1, -this->kSin1,
                   this->kCos1, 3, 4);
  const auto quarter = Transform<S>::rigid(this->at(3, 4), this->at(0, 1));
  EXPECT_EQ(quarter, this->of(0, 1, -1, 0, 3, 4));
  EXPECT_EQ(transformPoint(quarter, this->at(2, 0)), this->at(3, 6));
}

TYPED_TEST(TransformTest, ProductAppliesTheRightOneFirst) {
  using S = TypeParam;
  const auto outer = this->of(1, 2, 3, 4, 5, 6);
  const auto inner = this->of(2, 0, 1, 3, -1, 7);
  EXPECT_EQ(outer * inner, this->of(2, 4, 10, 14, 25, 32));
  EXPECT_EQ(transformPoint(outer * inner, this->at(1, 2)),
            transformPoint(outer, transformPoint(inner, this->at(1, 2))));
  EXPECT_EQ(outer * Transform<S>(), outer);
  EXPECT_EQ(Transform<S>() * outer, outer);
}

TYPED_TEST(TransformTest, InverseUndoesAnAffineMap) {
  using S = TypeParam;
  // The determinant is 2, whose reciprocal both numbers hold.
  const auto t = this->of(4, 1, 2, 1, 3, 5);
  const S half = ratio<S>(1, 2);
  EXPECT_EQ(inverse(t), Transform<S>(half, -half, S(-1), S(2), ratio<S>(7, 2), ratio<S>(-17, 2)));
  EXPECT_EQ(t * inverse(t), Transform<S>());
  EXPECT_EQ(inverse(t) * t, Transform<S>());
}

TYPED_TEST(TransformTest, RigidInverseUndoesARotationAndTranslation) {
  using S = TypeParam;
  const auto quarter = this->of(0, 1, -1, 0, 3, 4);
  EXPECT_EQ(rigidInverse(quarter), this->of(0, -1, 1, 0, -4, 3));
  EXPECT_EQ(quarter * rigidInverse(quarter), Transform<S>());
  const auto t = Transform<S>::rigid(this->at(30, -40), S(1));
  this->expectNear(rigidInverse(t) * t, 1, 0, 0, 1, 0, 0);
}

TYPED_TEST(TransformTest, BoxOfATurnedBoxIsTheSmallestAroundIt) {
  using S = TypeParam;
  const BB<S> box(S(0), S(0), S(4), S(2));
  EXPECT_EQ(transformBB(this->of(0, 1, -1, 0, 3, 4), box), BB<S>(S(1), S(4), S(3), S(8)));
  EXPECT_EQ(transformBB(this->of(-1, 0, 0, 1, 0, 0), box), BB<S>(S(-4), S(0), S(0), S(2)));
  EXPECT_EQ(transformBB(this->of(1, 1, -1, 1, 0, 0), box), BB<S>(S(-2), S(0), S(4), S(6)));
}

}  // namespace
}  // namespace samestep
