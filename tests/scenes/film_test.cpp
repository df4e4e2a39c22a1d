// SPDX-License-Identifier: MIT
// Films of recordings: pictures that a browser plays, the same everywhere, of a bounded size.
#include <samestep/film.h>

#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/recordings.h"
#include "support/scalars.h"

namespace samestep {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::string attributeOf(const std::string& tag, const std::string& name) {
  const std::size_t at = tag.find(" " + name + "=\"");
  if (at == std::string::npos) return {};
  const std::size_t from = at + name.size() + 3;
  return tag.substr(from, tag.find('"', from) - from);
}

/// Each tag of a text in order, without its brackets.
std::vector<std::string> tagsOf(const std::string& text) {
  std::vector<std::string> tags;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    tags.push_back(text.substr(at + 1, text.find('>', at) - at - 1));
  }
  return tags;
}

/// Each opened tag is closed by its like.
void expectWellFormed(const std::string& text) {
  std::vector<std::string> open;
  for (const std::string& tag : tagsOf(text)) {
    if (tag.back() == '/') continue;
    const std::string name = tag.substr(tag[0] == '/' ? 1 : 0, tag.find(' ') - (tag[0] == '/' ? 1 : 0));
    if (tag[0] != '/') {
      open.push_back(name);
      continue;
    }
    ASSERT_FALSE(open.empty()) << tag;
    ASSERT_EQ(open.back(), name);
    open.pop_back();
  }
  EXPECT_TRUE(open.empty());
}

/// Each animation has a time for each value, from 0 to 1 or, where values jump, to where it stays; rising.
void expectPlayable(const std::string& text) {
  for (const std::string& tag : tagsOf(text)) {
    if (!tag.starts_with("animate")) continue;
    const std::string times = attributeOf(tag, "keyTimes");
    if (times.empty()) continue;
    const std::vector<std::string> each = split(times, ';');
    EXPECT_EQ(each.size(), split(attributeOf(tag, "values"), ';').size()) << tag;
    EXPECT_EQ(each.front(), "0") << tag;
    const bool jumps = attributeOf(tag, "calcMode") == "discrete";
    EXPECT_TRUE(jumps || each.back() == "1") << tag;
    for (std::size_t i = 1; i < each.size(); ++i) {
      EXPECT_LT(std::atof(each[i - 1].c_str()), std::atof(each[i].c_str())) << tag;
    }
  }
}

template <class S>
class FilmTest : public ::testing::Test {
 protected:
  static std::string filmOf(const Bytes& bytes, const FilmOptions& options = {}) {
    Player<S> player(bytes, testWiring<S>());
    return Film<S>(player, nullptr, options).svg("a <film> & more");
  }
};
TYPED_TEST_SUITE(FilmTest, AllScalars);

TYPED_TEST(FilmTest, IsPlayableAndTheSameEachTime) {
  const Bytes bytes = recordSmallMatch<TypeParam>(60);
  const std::string film = this->filmOf(bytes);

  expectWellFormed(film);
  expectPlayable(film);
  EXPECT_THAT(film, HasSubstr("a &lt;film> &amp; more"));
  EXPECT_THAT(film, HasSubstr("<animateTransform attributeName=\"transform\" type=\"translate\""));
  EXPECT_THAT(film, HasSubstr("<animateTransform attributeName=\"transform\" type=\"rotate\""));
  EXPECT_EQ(this->filmOf(bytes), film);
  // The way to its beginning makes no difference.
  FilmOptions late;
  late.from = 33;
  EXPECT_EQ(this->filmOf(recordSmallMatch<TypeParam>(60, {4, 1u << 20}), late), this->filmOf(bytes, late));
}

TYPED_TEST(FilmTest, BodiesAreSeenWhileTheyAreThere) {
  FilmOptions each;
  each.rate = 240;
  const std::string film = this->filmOf(recordSmallMatch<TypeParam>(40), each);
  // One is spawned before step 4 and removed before step 20, of 40.
  EXPECT_THAT(film, HasSubstr("values=\"hidden;visible;hidden\" keyTimes=\"0;.1;.5\""));
}

TYPED_TEST(FilmTest, StillPicturesShowWhatIsThere) {
  const Bytes bytes = recordSmallMatch<TypeParam>(40);
  Player<TypeParam> player(bytes, testWiring<TypeParam>());
  FilmOptions each;
  each.rate = 240;
  each.from = 2;
  each.to = 30;
  Film<TypeParam> film(player, nullptr, each);
  ASSERT_EQ(film.pictures(), 29u);
  EXPECT_EQ(film.stride(), 1u);
  EXPECT_EQ(film.tickOf(28), 30u);
  const auto circles = [&](std::uint32_t picture) {
    std::size_t count = 0;
    for (const std::string& tag : tagsOf(film.still(picture, ""))) count += tag.starts_with("circle") ? 1 : 0;
    return count;
  };
  EXPECT_EQ(circles(0), 0u);
  EXPECT_EQ(circles(2), 1u);
  EXPECT_EQ(circles(10), 2u);
  EXPECT_EQ(circles(28), 1u);
  expectWellFormed(film.still(10, "x"));
  EXPECT_THROW(film.still(29, ""), ValueOutOfRange);
}

TYPED_TEST(FilmTest, IsNoLargerThanItMayBe) {
  const Bytes bytes = recordSmallMatch<TypeParam>(300);
  FilmOptions options;
  options.bytes = 12000;
  const std::string film = this->filmOf(bytes, options);
  EXPECT_LE(film.size(), 12000u);
  expectPlayable(film);
  EXPECT_LT(film.size(), this->filmOf(bytes).size());
  options.bytes = 100;
  EXPECT_THROW(this->filmOf(bytes, options), ValueOutOfRange);
}

TYPED_TEST(FilmTest, FollowsABodyThatIsThere) {
  const Bytes bytes = recordSmallMatch<TypeParam>(60);
  FilmOptions options;
  options.follow = 3;
  const std::string film = this->filmOf(bytes, options);
  expectPlayable(film);
  EXPECT_NE(film, this->filmOf(bytes));
  options.follow = 99;
  EXPECT_THROW(this->filmOf(bytes, options), ValueOutOfRange);
  options.follow.reset();
  options.from = 61;
  EXPECT_THROW(this->filmOf(bytes, options), ValueOutOfRange);
}

TYPED_TEST(FilmTest, MarksTheFirstBodyThatDiffers) {
  const auto record = [](int push) {
    Space<TypeParam> space;
    const BodyId player = fillSmall(space);
    Bytes bytes;
    Recorder<TypeParam> recorder(space, kTick<TypeParam>, bytes, testWiring<TypeParam>());
    for (int tick = 1; tick <= 60; ++tick) {
      if (tick == 21) {
        recorder.apply(ApplyImpulse<TypeParam>{player, {TypeParam(push), TypeParam(2)}, {}});
      }
      recorder.step();
    }
    recorder.finish();
    return std::pair(bytes, player.index);
  };
  const auto [bytes, index] = record(1);
  const auto [other, same] = record(2);
  Player<TypeParam> a(bytes, testWiring<TypeParam>());
  Player<TypeParam> b(other, testWiring<TypeParam>());
  Film<TypeParam> film(a, &b, {});
  ASSERT_TRUE(film.difference().has_value());
  EXPECT_EQ(film.difference()->tick, 21u);
  EXPECT_EQ(film.difference()->body, index);
  const std::string text = film.svg("");
  expectWellFormed(text);
  expectPlayable(text);
  EXPECT_THAT(text, HasSubstr("stroke=\"#d42a2a\""));

  Player<TypeParam> again(bytes, testWiring<TypeParam>());
  Player<TypeParam> twin(bytes, testWiring<TypeParam>());
  Film<TypeParam> alike(again, &twin, {});
  EXPECT_FALSE(alike.difference().has_value());
  EXPECT_THAT(alike.svg(""), Not(HasSubstr("#d42a2a")));
}

}  // namespace
}  // namespace samestep
