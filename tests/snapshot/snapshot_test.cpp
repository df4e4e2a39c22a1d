// SPDX-License-Identifier: MIT
#include <samestep/snapshot.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <type_traits>

#include <gtest/gtest.h>

#include <samestep/version.h>
#include "support/allocation_count.h"
#include "support/fields.h"
#include "support/scalars.h"
#include "support/snapshots.h"
#include "support/world.h"

namespace samestep {
namespace {

constexpr std::size_t kVersionAt = 8;
constexpr std::size_t kRevisionAt = 12;
constexpr std::size_t kScalarAt = 16;
constexpr std::size_t kSizeAt = 20;
constexpr std::size_t kWorldAt = 28;

template <Scalar S>
class SnapshotTest : public ::testing::Test {
 protected:
  /// Fills a world with many kinds of things, in the middle of it all: holes among bodies and shapes,
  /// contacts, a handler.
  static void fill(Space<S>& space, std::uint64_t seed) {
    registerNamedHandlers(space);
    space.addWildcardHandler(1, handlerNumber("slippery"));
    space.addCollisionHandler(2, 0, handlerNumber("count"));
    fillAtRandom(space, seed);
    space.setSolver(seed % 2 == 1 ? SolverKind::softStep : SolverKind::sequentialImpulses);
    if (seed % 4 == 1) space.setPrecision(ContactPrecision::fast);
    std::vector<ShapeId> discs;
    for (int i = 0; i < 4; ++i) discs.push_back(addDisc<S>(space, {S(2 * i - 3), S(7)}, S(1), S(1)));
    for (const std::size_t gone : {2u, 0u}) space.removeWithShapes(bodyOf(space, discs[gone]));
  }
  static Bytes snapshotAfter(std::uint64_t seed, int steps) {
    Space<S> space;
    fill(space, seed);
    hashesOf(space, steps);
    return snapshotOf(space);
  }
  /// The offset at which it is refused, by a Space that is as it was afterwards; -1 where it is not refused,
  /// 0 where it needs a function that the Space lacks.
  static std::int64_t offsetOfComplaint(const Bytes& bytes, std::string* reason = nullptr) {
    Space<S> space;
    registerNamedHandlers(space);
    addDisc<S>(space, {}, S(1), S(1));
    const std::uint64_t before = space.hash();
    try {
      loadSnapshot(space, bytes);
      return -1;
    } catch (const FormatError& error) {
      EXPECT_EQ(space.hash(), before);
      if (reason != nullptr) *reason = error.what();
      return static_cast<std::int64_t>(error.offset());
    } catch (const MissingCallback&) {
      EXPECT_EQ(space.hash(), before);
      return 0;
    }
  }
  /// Refuses the snapshot of a world after a change of its state, for that reason.
  template <class Change>
  static void expectRefused(const char* reason, Change&& change) {
    Space<S> space;
    fill(space, 4);
    hashesOf(space, 60);
    WorldState<S> world = space.state();
    ASSERT_GE(world.pairs.size(), 3u);
    ASSERT_EQ(offsetOfComplaint(snapshotOf(world)), -1);
    change(world);
    std::string said;
    const std::int64_t offset = offsetOfComplaint(snapshotOf(world), &said);
    EXPECT_GE(offset, static_cast<std::int64_t>(kWorldAt));
    EXPECT_EQ(said, reason);
  }
};
TYPED_TEST_SUITE(SnapshotTest, AllScalarsAndChecked);

TYPED_TEST(SnapshotTest, SaysWhatItIsInItsFirstBytes) {
  const Bytes bytes = this->snapshotAfter(1, 10);

  const SnapshotInfo info = snapshotInfo(bytes);

  EXPECT_EQ(info.version, kSnapshotVersion);
  EXPECT_EQ(info.revision, kSimulationRevision);
  EXPECT_EQ(info.scalar, ScalarTraits<TypeParam>::kKind);
  EXPECT_EQ(info.size, bytes.size());
}

TYPED_TEST(SnapshotTest, LoadedItContinuesAsTheOriginal) {
  using S = TypeParam;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Space<S> original;
    this->fill(original, seed);
    Space<S> other;
    registerNamedHandlers(other);
    fillAtRandom(other, seed + 50);  // The world that was there is gone afterwards.
    hashesOf(other, 5);
    for (int part = 0; part < 4; ++part) {
      const Bytes bytes = snapshotOf(original);
      loadSnapshot(other, bytes);
      ASSERT_EQ(other.hash(), original.hash());
      ASSERT_EQ(snapshotOf(other), bytes);
      ASSERT_EQ(other.add(Body<S>(S(1), S(1))), original.add(Body<S>(S(1), S(1))));
      ASSERT_EQ(hashesOf(other, 20), hashesOf(original, 20)) << "seed " << seed << ", part " << part;
    }
  }
}

TYPED_TEST(SnapshotTest, CallbacksThatRemoveObjectsAreFollowed) {
  using S = TypeParam;
  Space<S> space, copy;
  registerNamedHandlers(copy);
  this->fill(space, 3);
  loadSnapshot(copy, snapshotOf(space));

  for (int i = 0; i < 3; ++i) {
    const BodyId body = space.add(Body<S>(S(1), S(1)));
    const BodyId twin = copy.add(Body<S>(S(1), S(1)));
    ASSERT_EQ(twin, body);
    ASSERT_EQ(hashesOf(copy, 3), hashesOf(space, 3));
    space.remove(body);
    copy.remove(twin);
    ASSERT_EQ(hashesOf(copy, 3), hashesOf(space, 3));
  }
}

TYPED_TEST(SnapshotTest, AsksForRoomAndWritesNothingBeyondIt) {
  Space<TypeParam> space;
  this->fill(space, 2);
  hashesOf(space, 30);
  const Bytes whole = snapshotOf(space);

  for (std::size_t room = 0; room < whole.size() + 200; room += room + 80 < whole.size() ? 17 : 1) {
    Bytes bytes(room + 100, 0xee);
    ASSERT_EQ(saveSnapshot(space, std::span(bytes).first(room)), whole.size());
    for (std::size_t i = room < whole.size() ? room : whole.size(); i < bytes.size(); ++i) {
      ASSERT_EQ(bytes[i], 0xee) << room;
    }
    if (room >= whole.size()) {
      bytes.resize(whole.size());
      ASSERT_EQ(bytes, whole);
    }
  }
}

TYPED_TEST(SnapshotTest, SavingAllocatesNothing) {
  Space<TypeParam> space;
  this->fill(space, 2);
  hashesOf(space, 30);
  Bytes bytes = snapshotOf(space);
  const std::uint64_t before = allocationCount;

  const std::uint64_t size = saveSnapshot(space, {});
  saveSnapshot(space, bytes);

  EXPECT_EQ(allocationCount, before);
  EXPECT_EQ(size, bytes.size());
}

TYPED_TEST(SnapshotTest, IsRefusedWhereverItIsCutShort) {
  const Bytes bytes = this->snapshotAfter(4, 40);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    const std::int64_t offset = this->offsetOfComplaint(cut);
    ASSERT_GE(offset, 0) << length;
    ASSERT_LE(offset, static_cast<std::int64_t>(length));
  }
}

// The size in the header is made to fit as well: every reader finds the end by itself.
TYPED_TEST(SnapshotTest, IsRefusedWhereverItIsCutShortAndMended) {
  const Bytes bytes = this->snapshotAfter(4, 40);
  for (std::size_t length = kWorldAt + 8; length < bytes.size(); ++length) {
    Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    for (unsigned i = 0; i < 8; ++i) cut[kSizeAt + i] = static_cast<std::uint8_t>(length >> (8 * i));
    mendSnapshot(cut);
    const std::int64_t offset = this->offsetOfComplaint(cut);
    ASSERT_GE(offset, static_cast<std::int64_t>(kWorldAt)) << length;
    ASSERT_LE(offset, static_cast<std::int64_t>(length));
  }
}

TYPED_TEST(SnapshotTest, NothingMayFollowItsEnd) {
  Bytes bytes = this->snapshotAfter(1, 10);
  const auto size = static_cast<std::int64_t>(bytes.size());
  bytes.push_back(0);
  EXPECT_EQ(this->offsetOfComplaint(bytes), size);
  bytes[kSizeAt] = static_cast<std::uint8_t>(bytes.size());
  bytes[kSizeAt + 1] = static_cast<std::uint8_t>(bytes.size() >> 8);
  mendSnapshot(bytes);
  EXPECT_EQ(this->offsetOfComplaint(bytes), size - 8);
}

TYPED_TEST(SnapshotTest, ASingleAlteredByteIsFound) {
  const Bytes bytes = this->snapshotAfter(4, 20);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes altered = bytes;
    altered[i] ^= 0x10;
    ASSERT_GE(this->offsetOfComplaint(altered), 0) << i;
  }
}

// A snapshot that is taken although it was altered is one that a world could have been saved as: it comes out
// again byte for byte, and the world can be stepped.
TYPED_TEST(SnapshotTest, AlteredWithTheChecksumMendedItIsRefusedOrAnotherWorlds) {
  using S = TypeParam;
  const Bytes bytes = this->snapshotAfter(4, 40);
  int taken = 0, refused = 0;
  for (std::size_t i = 0; i + 8 < bytes.size(); ++i) {
    for (const unsigned flip : {0x01u, 0x02u, 0x80u, 0xffu}) {
      Bytes altered = bytes;
      altered[i] = static_cast<std::uint8_t>(altered[i] ^ flip);
      mendSnapshot(altered);
      if (this->offsetOfComplaint(altered) >= 0) {
        ++refused;
        continue;
      }
      ++taken;
      Space<S> space;
      registerNamedHandlers(space);
      loadSnapshot(space, altered);
      ASSERT_EQ(snapshotOf(space), altered) << i;
      ASSERT_EQ(flawOf(space.state()), nullptr) << i;
      if (taken % 16 == 0) {
        try {
          hashesOf(space, 2);
        } catch (const IllegalBody&) {
          // A body without mass may be saved, and not stepped.
        }
      }
    }
  }
  EXPECT_GT(taken, 100);
  EXPECT_GT(refused, 100);
}

TYPED_TEST(SnapshotTest, CountsOfBillionsAreRefusedBeforeMemoryIsTaken) {
  using S = TypeParam;
  const Bytes bytes = this->snapshotAfter(4, 40);
  const auto memoryTaken = [&](const Bytes& from) {
    const std::uint64_t before = allocatedBytes;
    this->offsetOfComplaint(from);
    return allocatedBytes - before;
  };
  const std::uint64_t usual = memoryTaken(bytes);
  for (std::size_t i = kWorldAt; i + 12 < bytes.size(); ++i) {
    Bytes altered = bytes;
    for (std::size_t j = 0; j < 4; ++j) altered[i + j] = 0xff;
    mendSnapshot(altered);
    // The records are as many as the bytes could hold, at the most.
    ASSERT_LE(memoryTaken(altered), usual + bytes.size() / 2 * sizeof(Shape<S>)) << i;
  }
}

TYPED_TEST(SnapshotTest, OtherVersionsAndScalarsAreRefusedAtTheirPlace) {
  const Bytes bytes = this->snapshotAfter(1, 5);
  const auto expectRefusedAt = [&](std::size_t at, std::uint8_t value, const char* reason) {
    Bytes altered = bytes;
    altered[at] = value;
    mendSnapshot(altered);
    std::string said;
    EXPECT_EQ(this->offsetOfComplaint(altered, &said), static_cast<std::int64_t>(at));
    EXPECT_EQ(said, reason);
  };
  const bool isFixed = ScalarTraits<TypeParam>::kKind == ScalarKind::fixed;
  const auto other = static_cast<std::uint8_t>(isFixed ? ScalarKind::float64 : ScalarKind::fixed);
  expectRefusedAt(0, 0x88, "not a snapshot");
  expectRefusedAt(kVersionAt, kSnapshotVersion + 1, "a snapshot of a later format version");
  expectRefusedAt(kVersionAt, 0, "a snapshot of a trial format");
  expectRefusedAt(kScalarAt, other, "a snapshot of another scalar");
  expectRefusedAt(kScalarAt, 77, "unknown scalar");
  expectRefusedAt(kScalarAt + 2, 1, "a byte that must be zero is not");
  EXPECT_THROW(snapshotInfo(recordSmallMatch<TypeParam>(1)), FormatError);
}

TYPED_TEST(SnapshotTest, AnotherRevisionIsTakenOnlyIfAskedForByName) {
  using S = TypeParam;
  Bytes bytes = this->snapshotAfter(3, 30);
  bytes[kRevisionAt] = kSimulationRevision + 41;
  mendSnapshot(bytes);
  Space<S> space;
  registerNamedHandlers(space);
  const std::uint64_t before = space.hash();

  try {
    loadSnapshot(space, bytes);
    ADD_FAILURE() << "another revision was taken";
  } catch (const RevisionError& error) {
    EXPECT_EQ(error.offset(), kRevisionAt);
    EXPECT_EQ(error.found(), kSimulationRevision + 41);
    EXPECT_EQ(error.own(), kSimulationRevision);
    EXPECT_NE(std::string(error.what()).find(std::to_string(kSimulationRevision + 41)), std::string::npos);
  }
  EXPECT_EQ(space.hash(), before);
  loadSnapshot(space, bytes, OtherRevision::takeStateOnly);

  Space<S> original;
  this->fill(original, 3);
  hashesOf(original, 30);
  EXPECT_EQ(space.hash(), original.hash());
}

TYPED_TEST(SnapshotTest, StatesThatNoSpaceCanHaveAreRefused) {
  using S = TypeParam;
  using World = WorldState<S>;
  const auto expect = [this](const char* reason, auto&& change) { this->expectRefused(reason, change); };
  expect("a list is not in order", [](World& w) { std::swap(w.pairs[0], w.pairs[1]); });
  expect("a list is not in order", [](World& w) { w.pairs[1] = w.pairs[0]; });
  expect("a list is not in order", [](World& w) { std::swap(w.handlers[0], w.handlers[1]); });
  expect("a pair names a shape that does not exist", [](World& w) { w.pairs[0].b.index = 4000; });
  expect("a pair is of one body", [](World& w) { w.pairs[0].b = w.pairs[0].a; });
  expect("a pair is malformed", [](World& w) { w.pairs[0].count = kMaxContactsPerPair + 1; });
  expect("a pair is malformed", [](World& w) { w.pairs[0].manifold = static_cast<Manifold>(9); });
  expect("a pair is out of range", [](World& w) { w.pairs[0].localNormal.x = S(7); });
  expect("a contact is out of range", [](World& w) { w.pairs[0].contacts[1].anchorB.y = S(1 << 24); });
  expect("a handler is malformed", [](World& w) { w.handlers[0].number = 0; });
  expect("there is no static body", [](World& w) { w.staticBody.generation += 2; });
  expect("the time step is out of range", [](World& w) { w.timeStep = S(2); });
  expect("a setting is out of range", [](World& w) { w.settings.iterations = 0; });
  expect("a setting is out of range", [](World& w) { w.settings.sleepTimeThreshold = S(-1); });
  expect("a setting is out of range", [](World& w) { w.settings.idleSpeedThreshold = S(1 << 11); });
  expect("a shape is on a body that does not exist", [](World& w) {
    w.shapes.valueAt(0).setBody(BodyId{4000, 1});
  });
}

#ifndef SAMESTEP_FIXED_ONLY
/// Sets the number with a given place in a record to a value.
struct Spoiler {
  int target;
  double value;
  int count = 0;
  bool done = false;

  template <class T>
  void operator()(const char* name, T& field) {
    if constexpr (std::is_same_v<T, double>) {
      if (count++ != target) return;
      field = value;
      done = true;
    } else if constexpr (requires { T::fields(field, *this); }) {
      T::fields(field, *this);
    } else if constexpr (requires { field.x, field.y; }) {
      (*this)(name, field.x);
      (*this)(name, field.y);
    }
  }
};

TEST(SnapshotOfDoubleTest, NoNumberMayBeNaN) {
  Space<double> space;
  registerNamedHandlers(space);
  fillAtRandom(space, 4);
  hashesOf(space, 60);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int spoilt = 0;
  // Each number of a record; false past the last one.
  const auto spoil = [&](auto&& recordOf, int target) {
    WorldState<double> world = space.state();
    auto& record = recordOf(world);
    Spoiler spoiler{target, nan};
    std::remove_reference_t<decltype(record)>::fields(record, spoiler);
    if (!spoiler.done) return false;
    Space<double> into;
    registerNamedHandlers(into);
    EXPECT_THROW(loadSnapshot(into, snapshotOf(world)), FormatError) << target;
    ++spoilt;
    return true;
  };
  const auto spoilAll = [&](auto&& recordOf) {
    for (int target = 0; spoil(recordOf, target); ++target) {
    }
  };
  spoilAll([](WorldState<double> & w) -> auto& { return w.settings; });
  spoilAll([](WorldState<double> & w) -> auto& { return w.bodies.valueAt(1); });
  spoilAll([](WorldState<double> & w) -> auto& { return w.shapes.valueAt(3); });
  spoilAll([](WorldState<double> & w) -> auto& { return w.pairs[0]; });
  EXPECT_GT(spoilt, 50);
}
#endif

TYPED_TEST(SnapshotTest, AGenerationThatNoSlotReachesIsRefused) {
  using S = TypeParam;
  Space<S> space;
  const std::uint32_t last = SlotMap<Body<S>, BodyId>::kRetired - 1;
  space.add(Body<S>(S(1), S(1)), {1, last});
  space.remove(BodyId{1, last});
  Bytes bytes = snapshotOf(space);
  const Bytes retired = {0xfe, 0xff, 0xff, 0xff};
  const auto place = std::search(bytes.begin(), bytes.end(), retired.begin(), retired.end());
  ASSERT_NE(place, bytes.end());
  EXPECT_EQ(this->offsetOfComplaint(bytes), -1);

  *place = 0xff;
  mendSnapshot(bytes);

  EXPECT_GE(this->offsetOfComplaint(bytes), static_cast<std::int64_t>(kWorldAt));
}

TYPED_TEST(SnapshotTest, LimitsOfTheCallerHold) {
  using S = TypeParam;
  Space<S> space;
  this->fill(space, 4);
  hashesOf(space, 40);
  const Bytes bytes = snapshotOf(space);
  const WorldState<S>& world = space.state();
  WorldLimits exact;
  exact.bodies = world.bodies.slots();
  exact.shapes = world.shapes.slots();
  exact.pairs = static_cast<std::uint32_t>(world.pairs.size());
  exact.restingPairs = exact.joints = 0;
  exact.handlers = static_cast<std::uint32_t>(world.handlers.size());
  exact.iterations = static_cast<std::uint32_t>(world.settings.iterations);
  exact.substeps = static_cast<std::uint32_t>(world.settings.substeps);
  Space<S> into;
  registerNamedHandlers(into);
  const auto less = [&](std::uint32_t WorldLimits::*which) {
    WorldLimits limits = exact;
    --(limits.*which);
    EXPECT_THROW(loadSnapshot(into, bytes, OtherRevision::refuse, limits), FormatError);
  };

  less(&WorldLimits::bodies);
  less(&WorldLimits::shapes);
  less(&WorldLimits::pairs);
  less(&WorldLimits::handlers);
  less(&WorldLimits::iterations);
  less(&WorldLimits::substeps);
  EXPECT_NO_THROW(loadSnapshot(into, bytes, OtherRevision::refuse, exact));
}

TYPED_TEST(SnapshotTest, NeedsTheFunctionsThatTheWorldUses) {
  using S = TypeParam;
  const Bytes bytes = this->snapshotAfter(4, 10);
  Space<S> bare;
  addDisc<S>(bare, {}, S(1), S(1));

  samestep::expectRefused<MissingCallback>(bare, [&] { loadSnapshot(bare, bytes); });
}

TYPED_TEST(SnapshotTest, ALockedSpaceIsNeitherSavedNorReplaced) {
  using S = TypeParam;
  const Bytes bytes = this->snapshotAfter(4, 10);
  Space<S> space;
  space.lock();

  EXPECT_THROW(saveSnapshot(space, {}), SpaceLocked);
  EXPECT_THROW(loadSnapshot(space, bytes), SpaceLocked);

  space.unlock(true);
}

// Files named VERSION.SCENE.SCALAR, with the hash of the world beside them in VERSION.SCENE.SCALAR.hash.
TYPED_TEST(SnapshotTest, EveryVersionFromOneOnIsRead) {
  std::vector<int> files(kSnapshotVersion + 1, 0);
  const std::string suffix = ScalarTraits<TypeParam>::kKind == ScalarKind::fixed ? ".fixed" : ".double";
  for (const auto& entry : std::filesystem::directory_iterator(SAMESTEP_SNAPSHOTS)) {
    const std::string name = entry.path().filename().string();
    if (name == "README.md" || entry.path().extension() == ".hash") continue;
    const std::size_t version = std::stoul(name);
    ASSERT_GE(version, 1u) << name << ": version 0 is not kept";
    ASSERT_LE(version, kSnapshotVersion) << name;
    if (entry.path().extension() != suffix) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    const Bytes bytes((std::istreambuf_iterator<char>(file)), {});
    std::uint64_t hash = 0;
    std::ifstream(entry.path().string() + ".hash") >> std::hex >> hash;
    Space<TypeParam> space;
    registerNamedHandlers(space);
    loadSnapshot(space, bytes, OtherRevision::takeStateOnly);
    EXPECT_EQ(space.hash(), hash) << name;
    ++files[version];
  }
  for (std::size_t version = 1; version <= kSnapshotVersion; ++version)
    EXPECT_GT(files[version], 0) << version;
}

}  // namespace
}  // namespace samestep
