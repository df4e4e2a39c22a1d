// SPDX-License-Identifier: MIT
// Who is told of a collision, when, in which order, and what the answers do.
#include <samestep/circle_shape.h>
#include <samestep/space.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scalars.h"
#include "support/world.h"

namespace samestep {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Writes what it is called with as "name.begin(A,B)", A and B by the user data of the shapes.
template <Scalar S>
struct Recorder {
  std::string name;
  std::vector<std::string>* log;
  bool beginAnswer = true;
  bool preSolveAnswer = true;
  bool ignoreInBegin = false;
  bool ignoreInPreSolve = false;

  void write(const char* what, const Arbiter<S>& arbiter) {
    log->push_back(name + "." + what + "(" + std::to_string(arbiter.shapeDataA().userData()) + "," +
                   std::to_string(arbiter.shapeDataB().userData()) + (arbiter.isRemoval() ? ",removal" : "") +
                   ")");
  }
  static Recorder& of(void* data) { return *static_cast<Recorder*>(data); }

  CollisionHandler<S> handler() {
    CollisionHandler<S> all;
    all.data = this;
    all.begin = [](Arbiter<S>& arbiter, Space<S>&, void* data) {
      of(data).write("begin", arbiter);
      return of(data).ignoreInBegin ? arbiter.ignore() : of(data).beginAnswer;
    };
    all.preSolve = [](Arbiter<S>& arbiter, Space<S>&, void* data) {
      of(data).write("preSolve", arbiter);
      return of(data).ignoreInPreSolve ? arbiter.ignore() : of(data).preSolveAnswer;
    };
    all.postSolve = [](Arbiter<S>& arbiter, Space<S>&, void* data) { of(data).write("postSolve", arbiter); };
    all.separate = [](Arbiter<S>& arbiter, Space<S>&, void* data) { of(data).write("separate", arbiter); };
    return all;
  }
};

template <Scalar S>
class HandlersTest : public ::testing::Test {
 protected:
  /// A disc of radius 1 that nothing pushes about much, with a type and a name.
  ShapeId disc(S x, CollisionType type, std::uint64_t name) {
    const ShapeId id = addDisc<S>(world_, {x, S(0)}, S(1), S(1));
    world_.change(id, [&](Shape<S>& shape) {
      shape.setCollisionType(type);
      shape.setUserData(name);
    });
    return id;
  }
  Recorder<S>& recorder(const std::string& name) {
    recorders_.push_back(std::make_unique<Recorder<S>>(Recorder<S>{name, &log_}));
    return *recorders_.back();
  }
  Recorder<S>& bindPair(const std::string& name, CollisionType a, CollisionType b) {
    Recorder<S>& made = recorder(name);
    world_.registerHandler(++number_, made.handler());
    world_.addCollisionHandler(a, b, number_);
    return made;
  }
  Recorder<S>& bindWildcard(const std::string& name, CollisionType type) {
    Recorder<S>& made = recorder(name);
    world_.registerHandler(++number_, made.handler());
    world_.addWildcardHandler(type, number_);
    return made;
  }
  Recorder<S>& bindDefault(const std::string& name) {
    Recorder<S>& made = recorder(name);
    world_.registerHandler(++number_, made.handler());
    world_.addDefaultCollisionHandler(number_);
    return made;
  }
  std::vector<std::string> step() {
    log_.clear();
    world_.step(kTick<S>);
    return log_;
  }
  BodyId bodyNamed(std::uint64_t name) {
    BodyId found;
    world_.eachShape([&](const Shape<S>& shape) {
      if (shape.userData() == name) found = shape.body();
    });
    return found;
  }
  void moveTo(ShapeId shape, S x) {
    world_.body(bodyOf(world_, shape)).setPosition({x, S(0)});
    world_.body(bodyOf(world_, shape)).setVelocity({});
  }

  Space<S> world_;
  std::vector<std::string> log_;
  std::vector<std::unique_ptr<Recorder<S>>> recorders_;
  CallbackNumber number_ = 0;
};
TYPED_TEST_SUITE(HandlersTest, AllScalarsAndChecked);

TYPED_TEST(HandlersTest, BeginOnceThenPreAndPostSolveEachStepThenSeparateOnce) {
  using S = TypeParam;
  this->bindPair("h", 1, 2);
  this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);

  EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)", "h.preSolve(10,20)", "h.postSolve(10,20)"));
  EXPECT_THAT(this->step(), ElementsAre("h.preSolve(10,20)", "h.postSolve(10,20)"));
  this->moveTo(b, S(10));
  EXPECT_THAT(this->step(), ElementsAre("h.separate(10,20)"));
  EXPECT_THAT(this->step(), IsEmpty());
  for (int i = 0; i < 5; ++i) EXPECT_THAT(this->step(), IsEmpty());
}

TYPED_TEST(HandlersTest, TouchingAgainBeginsAgain) {
  using S = TypeParam;
  this->bindPair("h", 1, 2);
  const ShapeId a = this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  for (const int apart : {1, 2, 3, 6}) {
    this->moveTo(a, S(0));
    this->moveTo(b, S(1));
    EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)", "h.preSolve(10,20)", "h.postSolve(10,20)"))
        << apart;
    this->moveTo(b, S(10));
    EXPECT_THAT(this->step(), ElementsAre("h.separate(10,20)"));
    for (int i = 1; i < apart; ++i) EXPECT_THAT(this->step(), IsEmpty());
  }
}

TYPED_TEST(HandlersTest, AAndBAreInTheOrderOfTheHandlersTypes) {
  using S = TypeParam;
  this->bindPair("h", 2, 1);
  const ShapeId a = this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  struct Seen {
    Vector<S> normal;
    BodyId bodyA, bodyB;
    ShapeId shapeA, shapeB;
  } seen;
  CollisionHandler<S> handler;
  handler.data = &seen;
  handler.preSolve = [](Arbiter<S>& arbiter, Space<S>&, void* data) {
    *static_cast<Seen*>(data) = {arbiter.normal(), arbiter.bodyA(), arbiter.bodyB(), arbiter.shapeA(),
                                 arbiter.shapeB()};
    EXPECT_EQ(arbiter.shapeDataA().id(), arbiter.shapeA());
    EXPECT_EQ(arbiter.bodyDataB().id(), arbiter.bodyB());
    // The points lie on the surface of their own shape: A is the right disc, centred at 1.
    EXPECT_EQ(arbiter.pointA(0), Vector<S>(S(0), S(0)));
    EXPECT_EQ(arbiter.pointB(0), Vector<S>(S(1), S(0)));
    EXPECT_EQ(arbiter.depth(0), S(-1));
    return true;
  };
  this->world_.registerHandler(1, handler);
  this->step();

  EXPECT_EQ(seen.normal, Vector<S>(S(-1), S(0)));
  EXPECT_EQ(seen.shapeA, b);
  EXPECT_EQ(seen.shapeB, a);
  EXPECT_EQ(seen.bodyA, bodyOf(this->world_, b));
  EXPECT_EQ(seen.bodyB, bodyOf(this->world_, a));
}

TYPED_TEST(HandlersTest, AHandlerOfThePairTakesOverFromWildcardsAndDefault) {
  using S = TypeParam;
  this->bindDefault("d");
  this->bindWildcard("w1", 1);
  this->bindWildcard("w2", 2);
  this->bindPair("h", 1, 2);
  this->disc(S(0), 1, 10);
  this->disc(S(1), 2, 20);
  EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)", "h.preSolve(10,20)", "h.postSolve(10,20)"));
}

TYPED_TEST(HandlersTest, WildcardsSeeTheirOwnShapeAsA) {
  using S = TypeParam;
  this->bindWildcard("w1", 1);
  this->bindWildcard("w2", 2);
  this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  EXPECT_THAT(this->step(), ElementsAre("w1.begin(10,20)", "w2.begin(20,10)", "w1.preSolve(10,20)",
                                        "w2.preSolve(20,10)", "w1.postSolve(10,20)", "w2.postSolve(20,10)"));
  this->moveTo(b, S(10));
  EXPECT_THAT(this->step(), ElementsAre("w1.separate(10,20)", "w2.separate(20,10)"));
}

TYPED_TEST(HandlersTest, AWildcardOfBothShapesIsCalledForEach) {
  using S = TypeParam;
  this->bindWildcard("w", 7);
  this->disc(S(0), 7, 10);
  this->disc(S(1), 7, 20);
  EXPECT_THAT(this->step(), ElementsAre("w.begin(10,20)", "w.begin(20,10)", "w.preSolve(10,20)",
                                        "w.preSolve(20,10)", "w.postSolve(10,20)", "w.postSolve(20,10)"));
}

TYPED_TEST(HandlersTest, TheDefaultHandlerTakesThePlaceOfTheWildcards) {
  using S = TypeParam;
  this->bindWildcard("w1", 1);
  this->bindDefault("d");
  this->disc(S(0), 1, 10);
  this->disc(S(1), 2, 20);
  EXPECT_THAT(this->step(), ElementsAre("d.begin(10,20)", "d.preSolve(10,20)", "d.postSolve(10,20)"));
}

TYPED_TEST(HandlersTest, ANullFunctionFallsBackToTheWildcards) {
  using S = TypeParam;
  this->bindWildcard("w1", 1);
  this->bindWildcard("w2", 2);
  Recorder<S>& partly = this->recorder("h");
  CollisionHandler<S> handler = partly.handler();
  handler.begin = nullptr;
  handler.postSolve = nullptr;
  this->world_.registerHandler(50, handler);
  this->world_.addCollisionHandler(2, 1, 50);
  this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  EXPECT_THAT(this->step(), ElementsAre("w2.begin(20,10)", "w1.begin(10,20)", "h.preSolve(20,10)",
                                        "w2.postSolve(20,10)", "w1.postSolve(10,20)"));
  this->moveTo(b, S(10));
  EXPECT_THAT(this->step(), ElementsAre("h.separate(20,10)"));
}

TYPED_TEST(HandlersTest, BothWildcardsAreAskedAndBothMustAgree) {
  using S = TypeParam;
  this->bindWildcard("w1", 1).preSolveAnswer = false;
  this->bindWildcard("w2", 2);
  this->disc(S(0), 1, 10);
  this->disc(S(1), 2, 20);
  EXPECT_THAT(this->step(),
              ElementsAre("w1.begin(10,20)", "w2.begin(20,10)", "w1.preSolve(10,20)", "w2.preSolve(20,10)"));
  EXPECT_EQ(this->world_.state().pairs.at(0).solved, 0);
}

TYPED_TEST(HandlersTest, BeginSayingNoLetsTheShapesPassUntilTheySeparate) {
  using S = TypeParam;
  Recorder<S>& h = this->bindPair("h", 1, 2);
  h.beginAnswer = false;
  const ShapeId a = this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)"));
  EXPECT_THAT(this->step(), IsEmpty());
  EXPECT_EQ(this->world_.body(bodyOf(this->world_, a)).velocity(), Vector<S>());
  EXPECT_EQ(this->world_.body(bodyOf(this->world_, a)).position(), Vector<S>());
  this->moveTo(b, S(10));
  EXPECT_THAT(this->step(), ElementsAre("h.separate(10,20)"));
  h.beginAnswer = true;
  this->moveTo(b, S(1));
  EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)", "h.preSolve(10,20)", "h.postSolve(10,20)"));
}

TYPED_TEST(HandlersTest, PreSolveSayingNoLetsTheShapesPassForThisStepOnly) {
  using S = TypeParam;
  this->world_.setSolver(SolverKind::sequentialImpulses);  // Its bias velocity shows what was solved.
  Recorder<S>& h = this->bindPair("h", 1, 2);
  h.preSolveAnswer = false;
  const ShapeId a = this->disc(S(0), 1, 10);
  this->disc(S(1), 2, 20);
  EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)", "h.preSolve(10,20)"));
  EXPECT_THAT(this->step(), ElementsAre("h.preSolve(10,20)"));
  EXPECT_EQ(this->world_.body(bodyOf(this->world_, a)).velocityBias(), Vector<S>());
  h.preSolveAnswer = true;
  EXPECT_THAT(this->step(), ElementsAre("h.preSolve(10,20)", "h.postSolve(10,20)"));
  EXPECT_NE(this->world_.body(bodyOf(this->world_, a)).velocityBias(), Vector<S>());
}

TYPED_TEST(HandlersTest, IgnoreWorksFromBeginAndFromPreSolve) {
  using S = TypeParam;
  for (const bool inBegin : {true, false}) {
    Recorder<S>& h = this->bindPair("h", 1, 2);
    (inBegin ? h.ignoreInBegin : h.ignoreInPreSolve) = true;
    const ShapeId a = this->disc(S(0), 1, 10);
    const ShapeId b = this->disc(S(1), 2, 20);
    if (inBegin) {
      EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)"));
    } else {
      EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)", "h.preSolve(10,20)"));
    }
    EXPECT_THAT(this->step(), IsEmpty());
    int touching = 0;
    this->world_.eachArbiter([&](Arbiter<S>&) { ++touching; });
    EXPECT_EQ(touching, 0);
    this->world_.removeWithShapes(bodyOf(this->world_, a));
    this->world_.removeWithShapes(bodyOf(this->world_, b));
  }
}

TYPED_TEST(HandlersTest, SensorsAreToldOfButNotSolved) {
  using S = TypeParam;
  this->bindPair("h", 1, 2);
  const ShapeId a = this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  this->world_.change(b, [](Shape<S>& shape) { shape.setSensor(true); });
  EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)", "h.preSolve(10,20)"));
  EXPECT_THAT(this->step(), ElementsAre("h.preSolve(10,20)"));
  EXPECT_EQ(this->world_.body(bodyOf(this->world_, a)).velocityBias(), Vector<S>());
  this->world_.eachArbiter([&](Arbiter<S>& arbiter) { EXPECT_FALSE(arbiter.isFirstContact()); });
  this->moveTo(b, S(10));
  EXPECT_THAT(this->step(), ElementsAre("h.separate(10,20)"));
}

TYPED_TEST(HandlersTest, TwoBodiesThatNothingMovesAreToldOfButNotSolved) {
  using S = TypeParam;
  this->bindPair("h", 1, 2);
  const ShapeId a = this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  this->world_.setType(bodyOf(this->world_, a), BodyType::kinematicBody);
  this->world_.setType(bodyOf(this->world_, b), BodyType::staticBody);
  EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)", "h.preSolve(10,20)"));
}

TYPED_TEST(HandlersTest, FiltersKeepShapesApartAndChangingThemSeparates) {
  using S = TypeParam;
  this->bindPair("h", 1, 2);
  const ShapeId a = this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  const auto setFilters = [&](ShapeFilter fa, ShapeFilter fb) {
    this->world_.change(a, [&](Shape<S>& shape) { shape.setFilter(fa); });
    this->world_.change(b, [&](Shape<S>& shape) { shape.setFilter(fb); });
  };
  setFilters({3, ~0u, ~0u}, {3, ~0u, ~0u});
  EXPECT_THAT(this->step(), IsEmpty());
  setFilters({0, 1, 2}, {0, 4, 1});
  EXPECT_THAT(this->step(), IsEmpty());
  setFilters({0, 1, 2}, {0, 2, 1});
  EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)", "h.preSolve(10,20)", "h.postSolve(10,20)"));
  setFilters({0, 1, 2}, {0, 4, 1});
  EXPECT_THAT(this->step(), ElementsAre("h.separate(10,20)"));
}

TYPED_TEST(HandlersTest, ShapesOfOneBodyDoNotCollide) {
  using S = TypeParam;
  this->bindDefault("d");
  const ShapeId a = this->disc(S(0), 1, 10);
  this->world_.add(circleShape(bodyOf(this->world_, a), S(1), {S(1), S(0)}));
  EXPECT_THAT(this->step(), IsEmpty());
}

TYPED_TEST(HandlersTest, RemovingAShapeSeparatesItAsARemoval) {
  using S = TypeParam;
  this->bindPair("h", 1, 2);
  const ShapeId a = this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  this->disc(S(50), 2, 30);
  this->step();
  this->log_.clear();
  this->world_.removeWithShapes(bodyOf(this->world_, b));
  EXPECT_THAT(this->log_, ElementsAre("h.separate(10,20,removal)"));
  EXPECT_TRUE(this->world_.state().pairs.empty());
  EXPECT_THAT(this->step(), IsEmpty());
  // The slot is used again by a stranger: nothing of the old contact is left.
  const ShapeId c = this->disc(S(1), 2, 40);
  EXPECT_EQ(c.index, b.index);
  this->moveTo(a, S(0));
  EXPECT_THAT(this->step(), ElementsAre("h.begin(10,40)", "h.preSolve(10,40)", "h.postSolve(10,40)"));
}

TYPED_TEST(HandlersTest, ArbitersFilteredOutBeginAgain) {
  using S = TypeParam;
  this->bindDefault("d");
  const ShapeId a = this->disc(S(0), 1, 10);
  this->disc(S(1), 2, 20);
  this->disc(S(-1), 3, 30);
  this->step();
  this->log_.clear();
  const BodyId body = bodyOf(this->world_, a);
  EXPECT_THROW(this->world_.filterArbiters(this->world_.staticBody(), a), ShapeNotFound);
  this->world_.filterArbiters(body, a);
  EXPECT_THAT(this->log_, ElementsAre("d.separate(10,20,removal)", "d.separate(10,30,removal)"));
  const std::vector<std::string> next = this->step();
  EXPECT_EQ(std::count(next.begin(), next.end(), "d.begin(10,20)"), 1);
  EXPECT_EQ(std::count(next.begin(), next.end(), "d.begin(10,30)"), 1);
  this->log_.clear();
  this->world_.filterArbiters(body);
  EXPECT_THAT(this->log_, ElementsAre("d.separate(10,20,removal)", "d.separate(10,30,removal)"));
}

// MIS section 6, spaceArbiterSetFilter.
TYPED_TEST(HandlersTest, TwoBodiesMadeStaticKeepTheirContact) {
  using S = TypeParam;
  this->bindDefault("d");
  const ShapeId a = this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  this->step();
  this->world_.setType(bodyOf(this->world_, a), BodyType::staticBody);
  this->world_.setType(bodyOf(this->world_, b), BodyType::staticBody);
  for (int i = 0; i < 6; ++i) EXPECT_THAT(this->step(), IsEmpty());
  EXPECT_EQ(this->world_.state().pairs.size(), 1u);

  this->world_.setType(bodyOf(this->world_, b), BodyType::dynamicBody);
  EXPECT_THAT(this->step(), ElementsAre("d.preSolve(10,20)", "d.postSolve(10,20)"));
}

/// A world in which two discs touched, and of which nothing moves any more.
template <Scalar S>
struct RestingContact {
  Space<S> world;
  ShapeId a, b;
  int begins = 0, separates = 0;
  bool removal = false;

  explicit RestingContact(SolverKind solver, std::uint32_t persistence = 3) {
    world.setSolver(solver);
    world.setCollisionPersistence(persistence);
    a = addDisc<S>(world, {}, S(1), S(1));
    b = addDisc<S>(world, {ratio<S>(3, 2), S(0)}, S(1), S(1));
    CollisionHandler<S> handler;
    handler.data = this;
    handler.begin = [](Arbiter<S>&, Space<S>&, void* data) {
      ++static_cast<RestingContact*>(data)->begins;
      return true;
    };
    handler.separate = [](Arbiter<S>& arbiter, Space<S>&, void* data) {
      ++static_cast<RestingContact*>(data)->separates;
      static_cast<RestingContact*>(data)->removal = arbiter.isRemoval();
    };
    world.registerHandler(1, handler);
    world.addDefaultCollisionHandler(1);
    world.step(kTick<S>);
    for (const ShapeId id : {a, b}) world.setType(bodyOf(world, id), BodyType::staticBody);
    for (int i = 0; i < 6; ++i) world.step(kTick<S>);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) world.step(kTick<S>);
  }
};

/// Change that ends the contact of two static discs.
template <Scalar S>
struct EndOfRest {
  const char* name;
  void (*act)(RestingContact<S>&);
};

template <Scalar S>
std::vector<EndOfRest<S>> endsOfRest() {
  using R = RestingContact<S>;
  return {
      {"moved",
       [](R& r) {
         r.world.body(bodyOf(r.world, r.b)).setPosition({S(20), S(0)});
       }},
      {"moved a little",
       [](R& r) {
         r.world.body(bodyOf(r.world, r.b)).setPosition({ratio<S>(201, 100), S(0)});
       }},
      {"filtered", [](R& r) { r.world.change(r.a, [](Shape<S>& s) {
                                s.setFilter({0, 1, 0});
                              }); }},
      {"one group",
       [](R& r) {
         for (const ShapeId id : {r.a, r.b}) r.world.change(id, [](Shape<S>& s) { s.setFilter({7, 1, 1}); });
       }},
      {"smaller",
       [](R& r) { r.world.change(r.b, [](Shape<S>& s) { CircleShape<S>(s).setRadius(ratio<S>(1, 64)); }); }},
      {"replaced",
       [](R& r) {
         r.world.replace(r.b, circleShape<S>(bodyOf(r.world, r.b), S(1), {S(4), S(0)}));
       }},
      {"a sensor, then moved",
       [](R& r) {
         r.world.change(r.b, [](Shape<S>& s) { s.setSensor(true); });
         r.world.step(kTick<S>);
         EXPECT_EQ(r.separates, 0);
         r.world.body(bodyOf(r.world, r.b)).setPosition({S(20), S(0)});
       }},
      {"kinematic and moved",
       [](R& r) {
         r.world.setType(bodyOf(r.world, r.b), BodyType::kinematicBody);
         r.world.body(bodyOf(r.world, r.b)).setPosition({S(20), S(0)});
       }},
  };
}

TYPED_TEST(HandlersTest, AStaticContactThatEndsIsToldOnceAndLeavesNoPair) {
  using S = TypeParam;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    for (const EndOfRest<S>& end : endsOfRest<S>()) {
      RestingContact<S> rest(solver);
      ASSERT_EQ(rest.world.state().pairs.size(), 1u) << end.name;
      EXPECT_EQ(rest.separates, 0) << end.name;
      end.act(rest);
      rest.steps(1);
      EXPECT_EQ(rest.separates, 1) << end.name;
      EXPECT_FALSE(rest.removal) << end.name;
      rest.steps(4);
      EXPECT_EQ(rest.separates, 1) << end.name;
      EXPECT_TRUE(rest.world.state().pairs.empty()) << end.name;
      EXPECT_EQ(rest.begins, 1) << end.name;
    }
  }
}

TYPED_TEST(HandlersTest, AStaticContactWhoseShapeGoesIsToldOnceAsARemoval) {
  using S = TypeParam;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    RestingContact<S> rest(solver);
    rest.world.remove(rest.b);
    EXPECT_EQ(rest.separates, 1);
    EXPECT_TRUE(rest.removal);
    rest.steps(3);
    EXPECT_EQ(rest.separates, 1);
    EXPECT_TRUE(rest.world.state().pairs.empty());
  }
}

// A contact that had ended before both were static is kept as long as any.
TYPED_TEST(HandlersTest, AnEndedContactExpiresThoughBothBodiesAreStaticByThen) {
  using S = TypeParam;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    RestingContact<S> rest(solver, 5);
    for (const ShapeId id : {rest.a, rest.b}) {
      rest.world.setType(bodyOf(rest.world, id), BodyType::dynamicBody);
    }
    rest.steps(1);
    rest.world.body(bodyOf(rest.world, rest.b)).setPosition({S(20), S(0)});
    rest.steps(1);
    ASSERT_EQ(rest.world.state().pairs.size(), 1u);
    // Back in place, but as a static body: that makes no contact.
    rest.world.body(bodyOf(rest.world, rest.b)).setPosition({S(1), S(0)});
    for (const ShapeId id : {rest.a, rest.b})
      rest.world.setType(bodyOf(rest.world, id), BodyType::staticBody);
    rest.steps(5);
    EXPECT_TRUE(rest.world.state().pairs.empty());
    EXPECT_EQ(rest.separates, 1);
  }
}

TYPED_TEST(HandlersTest, ContactsThatAreIgnoredEndOnceToo) {
  using S = TypeParam;
  Recorder<S>& h = this->bindPair("h", 1, 2);
  h.beginAnswer = false;
  const ShapeId a = this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)"));
  for (const ShapeId id : {a, b}) this->world_.setType(bodyOf(this->world_, id), BodyType::staticBody);
  for (int i = 0; i < 6; ++i) EXPECT_THAT(this->step(), IsEmpty());
  this->moveTo(b, S(10));
  EXPECT_THAT(this->step(), ElementsAre("h.separate(10,20)"));
  for (int i = 0; i < 6; ++i) EXPECT_THAT(this->step(), IsEmpty());
  EXPECT_TRUE(this->world_.state().pairs.empty());
}

// The order of everything is that of the shapes' ids, whatever the order of adding or the places.
TYPED_TEST(HandlersTest, PairsAreToldOfInTheOrderOfTheirShapes) {
  using S = TypeParam;
  this->bindDefault("d");
  const ShapeId first = this->disc(S(3), 1, 99);
  this->disc(S(2), 1, 1);
  this->disc(S(1), 1, 2);
  this->world_.removeWithShapes(bodyOf(this->world_, first));
  this->disc(ratio<S>(3, 2), 1, 0);  // It takes the freed slot.
  EXPECT_THAT(this->step(), ElementsAre("d.begin(0,1)", "d.preSolve(0,1)", "d.begin(0,2)", "d.preSolve(0,2)",
                                        "d.begin(1,2)", "d.preSolve(1,2)", "d.postSolve(0,1)",
                                        "d.postSolve(0,2)", "d.postSolve(1,2)"));
}

// A handler that does something itself can also pass it on.
TYPED_TEST(HandlersTest, AHandlerMayAskTheWildcards) {
  using S = TypeParam;
  this->bindWildcard("w1", 1).beginAnswer = false;
  this->bindWildcard("w2", 2).preSolveAnswer = false;
  CollisionHandler<S> handler;
  handler.begin = [](Arbiter<S>& arbiter, Space<S>& space, void*) {
    EXPECT_FALSE(space.callWildcardBeginA(arbiter));
    EXPECT_TRUE(space.callWildcardBeginB(arbiter));
    return true;
  };
  handler.preSolve = [](Arbiter<S>& arbiter, Space<S>& space, void*) {
    EXPECT_TRUE(space.callWildcardPreSolveA(arbiter));
    EXPECT_FALSE(space.callWildcardPreSolveB(arbiter));
    return true;
  };
  handler.postSolve = [](Arbiter<S>& arbiter, Space<S>& space, void*) {
    space.callWildcardPostSolveB(arbiter);
    space.callWildcardPostSolveA(arbiter);
  };
  handler.separate = [](Arbiter<S>& arbiter, Space<S>& space, void*) {
    space.callWildcardSeparateB(arbiter);
    space.callWildcardSeparateA(arbiter);
  };
  this->world_.registerHandler(60, handler);
  this->world_.addCollisionHandler(1, 2, 60);
  this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  EXPECT_THAT(this->step(), ElementsAre("w1.begin(10,20)", "w2.begin(20,10)", "w1.preSolve(10,20)",
                                        "w2.preSolve(20,10)", "w2.postSolve(20,10)", "w1.postSolve(10,20)"));
  this->moveTo(b, S(10));
  EXPECT_THAT(this->step(), ElementsAre("w2.separate(20,10)", "w1.separate(10,20)"));
}

TYPED_TEST(HandlersTest, AHandlerForOneTypeAndAnyOtherIsCalledInItsOrder) {
  using S = TypeParam;
  this->bindPair("of2", kWildcardCollisionType, 2);
  this->disc(S(0), 5, 10);
  this->disc(S(1), 2, 20);
  this->disc(S(20), 2, 30);
  this->disc(S(21), 6, 40);
  this->disc(S(40), kWildcardCollisionType, 50);
  this->disc(S(41), 2, 60);
  this->disc(S(60), 5, 70);
  this->disc(S(61), 6, 80);
  EXPECT_THAT(this->step(),
              ElementsAre("of2.begin(10,20)", "of2.preSolve(10,20)", "of2.begin(40,30)",
                          "of2.preSolve(40,30)", "of2.begin(50,60)", "of2.preSolve(50,60)",
                          "of2.postSolve(10,20)", "of2.postSolve(40,30)", "of2.postSolve(50,60)"));
}

TYPED_TEST(HandlersTest, TheHandlerThatNamesMoreOfTheTypesIsCalled) {
  using S = TypeParam;
  this->bindDefault("all");
  this->bindWildcard("w1", 1);
  this->disc(S(0), 1, 10);
  this->disc(S(1), 2, 20);
  const auto begun = [&] {
    const std::vector<std::string> calls = this->step();
    for (const BodyId body : {this->bodyNamed(10), this->bodyNamed(20)}) this->world_.filterArbiters(body);
    return calls.front();
  };
  EXPECT_EQ(begun(), "all.begin(10,20)");
  this->bindPair("of2", kWildcardCollisionType, 2);
  EXPECT_EQ(begun(), "of2.begin(10,20)");
  this->bindPair("of1", kWildcardCollisionType, 1);
  EXPECT_EQ(begun(), "of1.begin(20,10)");
  this->bindPair("from1", 1, kWildcardCollisionType);
  EXPECT_EQ(begun(), "from1.begin(10,20)");
  this->bindPair("turned", 2, 1);
  EXPECT_EQ(begun(), "turned.begin(20,10)");
  this->bindPair("both", 1, 2);
  EXPECT_EQ(begun(), "both.begin(10,20)");
}

TYPED_TEST(HandlersTest, AHandlerForShapesWithoutATypeIsForThemAlone) {
  using S = TypeParam;
  this->bindPair("none", kWildcardCollisionType, kWildcardCollisionType);
  this->disc(S(0), kWildcardCollisionType, 10);
  this->disc(S(1), kWildcardCollisionType, 20);
  this->disc(S(20), kWildcardCollisionType, 30);
  this->disc(S(21), 5, 40);
  EXPECT_THAT(this->step(),
              ElementsAre("none.begin(10,20)", "none.preSolve(10,20)", "none.postSolve(10,20)"));
}

TYPED_TEST(HandlersTest, WhoIsToldFollowsFromTheTypesOfThatMoment) {
  using S = TypeParam;
  this->bindPair("old", 1, 2);
  this->bindPair("new", 1, 3);
  this->disc(S(0), 1, 10);
  const ShapeId b = this->disc(S(1), 2, 20);
  EXPECT_THAT(this->step(), ElementsAre("old.begin(10,20)", "old.preSolve(10,20)", "old.postSolve(10,20)"));
  this->world_.change(b, [](Shape<S>& shape) { shape.setCollisionType(3); });
  EXPECT_THAT(this->step(), ElementsAre("new.preSolve(10,20)", "new.postSolve(10,20)"));
  this->moveTo(b, S(10));
  EXPECT_THAT(this->step(), ElementsAre("new.separate(10,20)"));

  this->moveTo(b, S(1));
  EXPECT_THAT(this->step(), ElementsAre("new.begin(10,20)", "new.preSolve(10,20)", "new.postSolve(10,20)"));
  this->moveTo(b, S(10));
  this->world_.change(b, [](Shape<S>& shape) { shape.setCollisionType(2); });
  EXPECT_THAT(this->step(), ElementsAre("old.separate(10,20)"));
}

// A sensor made in contact goes on touching: nothing ends and nothing begins, but it pushes no more.
TYPED_TEST(HandlersTest, ASensorMadeOrUnmadeInContactGoesOnTouching) {
  using S = TypeParam;
  for (const SolverKind solver : {SolverKind::softStep, SolverKind::sequentialImpulses}) {
    this->world_.setSolver(solver);
    this->bindPair("h", 1, 2);
    const ShapeId a = this->disc(S(0), 1, 10);
    const ShapeId b = this->disc(S(1), 2, 20);
    const auto setSensor = [&](bool sensor) {
      this->world_.change(b, [&](Shape<S>& shape) { shape.setSensor(sensor); });
    };
    EXPECT_THAT(this->step(), ElementsAre("h.begin(10,20)", "h.preSolve(10,20)", "h.postSolve(10,20)"));
    setSensor(true);
    EXPECT_THAT(this->step(), ElementsAre("h.preSolve(10,20)"));
    setSensor(false);
    EXPECT_THAT(this->step(), ElementsAre("h.preSolve(10,20)", "h.postSolve(10,20)"));
    setSensor(true);
    this->moveTo(b, S(10));
    EXPECT_THAT(this->step(), ElementsAre("h.separate(10,20)"));
    for (const ShapeId shape : {a, b}) this->world_.removeWithShapes(bodyOf(this->world_, shape));
  }
}

// Shapes that overlap newly are told of with the next step that takes time.
TYPED_TEST(HandlersTest, AStepOfNoTimeDoesNothing) {
  using S = TypeParam;
  this->bindPair("h", 1, 2);
  this->disc(S(0), 1, 10);
  this->disc(S(1), 2, 20);
  const std::uint64_t before = this->world_.hash();
  this->world_.step(S(0));
  EXPECT_TRUE(this->log_.empty());
  EXPECT_EQ(this->world_.hash(), before);
  EXPECT_EQ(this->world_.stamp(), 0u);
  EXPECT_EQ(this->world_.currentTimeStep(), S(0));
  EXPECT_EQ(this->step().front(), "h.begin(10,20)");
  EXPECT_EQ(this->world_.currentTimeStep(), kTick<S>);
}

TYPED_TEST(HandlersTest, BindingAgainReplaces) {
  using S = TypeParam;
  this->bindPair("old", 1, 2);
  this->bindPair("new", 1, 2);
  EXPECT_EQ(this->world_.state().handlers.size(), 1u);
  this->disc(S(0), 1, 10);
  this->disc(S(1), 2, 20);
  EXPECT_THAT(this->step(), ElementsAre("new.begin(10,20)", "new.preSolve(10,20)", "new.postSolve(10,20)"));
}

// Chipmunk keeps a contact's impulses for collisionPersistence steps after it came apart.
TYPED_TEST(HandlersTest, ContactsPersistForAWhileAfterTheyCameApart) {
  using S = TypeParam;
  for (const std::uint32_t persistence : {0u, 1u, 3u, 5u}) {
    Space<S> space;
    space.setCollisionPersistence(persistence);
    const ShapeId a = addDisc<S>(space, {}, S(1), S(1));
    const ShapeId b = addDisc<S>(space, {S(1), S(0)}, S(1), S(1));
    space.step(kTick<S>);
    ASSERT_EQ(space.state().pairs.size(), 1u);
    space.body(bodyOf(space, b)).setPosition({S(20), S(0)});
    std::uint32_t kept = 0;
    while (kept < 100) {
      space.step(kTick<S>);
      if (space.state().pairs.empty()) break;
      EXPECT_EQ(space.state().pairs[0].state, ArbiterState::cached);
      ++kept;
    }
    EXPECT_EQ(kept, persistence == 0 ? 0 : persistence - 1);
    EXPECT_TRUE(space.contains(a));
  }
}

// A question asked in a callback must not change the step.
TYPED_TEST(HandlersTest, QueriesInCallbacksChangeNothing) {
  using S = TypeParam;
  std::vector<std::uint64_t> hashes[2];
  for (const bool asking : {false, true}) {
    Space<S> space;
    struct Context {
      bool asking;
      std::vector<ShapeId> found;
    } context{asking, {}};
    CollisionHandler<S> handler;
    handler.data = &context;
    handler.preSolve = [](Arbiter<S>& arbiter, Space<S>& of, void* data) {
      auto* c = static_cast<Context*>(data);
      Body<S>& moved = of.body(arbiter.bodyA());
      if (moved.isDynamic()) moved.setPosition(moved.position() + Vector<S>(S(0), ratio<S>(1, 64)));
      if (c->asking) {
        of.boxQuery({S(-100), S(-100), S(100), S(100)}, {}, c->found);
        of.boundingBox(arbiter.shapeA());
        of.eachArbiter(arbiter.bodyA(), [](Arbiter<S>&) {});
      }
      return true;
    };
    space.registerHandler(1, handler);
    space.addDefaultCollisionHandler(1);
    fillAtRandom(space, 3);
    hashes[asking] = hashesOf(space, 60);
    const BodyId walls = space.staticBody();
    space.eachArbiter(walls, [&](Arbiter<S>& arbiter) {
      EXPECT_TRUE(arbiter.bodyA() == walls || arbiter.bodyB() == walls);
    });
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TYPED_TEST(HandlersTest, ArbitersOfABodyAreThoseOfAllThatNameIt) {
  using S = TypeParam;
  Space<S> space;
  fillAtRandom(space, 4);
  for (int step = 0; step < 40; ++step) {
    space.step(kTick<S>);
    std::vector<std::pair<ShapeId, ShapeId>> all;
    space.eachArbiter([&](Arbiter<S>& arbiter) { all.push_back({arbiter.shapeA(), arbiter.shapeB()}); });
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
    space.eachBody([&](const Body<S>& body) {
      std::vector<std::pair<ShapeId, ShapeId>> expected, found;
      for (const auto& pair : all) {
        if (bodyOf(space, pair.first) == body.id() || bodyOf(space, pair.second) == body.id()) {
          expected.push_back(pair);
        }
      }
      space.eachArbiter(body.id(), [&](Arbiter<S>& arbiter) {
        found.push_back({arbiter.shapeA(), arbiter.shapeB()});
      });
      EXPECT_EQ(found, expected);
    });
  }
}

}  // namespace
}  // namespace samestep
