// SPDX-License-Identifier: MIT
#include <samestep/film.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include <samestep/state_diff.h>

#include "base/require_ieee.h"
#include "scenes/paint.h"

namespace samestep {
namespace {

/// The larger side of a picture, in the tenths of a pixel that all its lengths are.
constexpr int kSide = 12000;
constexpr int kHeader = 400;
/// Distance that a body may be off its track where pictures of it are left out: half a pixel, half a degree.
constexpr std::int64_t kTolerance = 5;
/// So many pictures at most are left out after each other.
constexpr std::size_t kLongestLine = 64;
/// Places of bodies that are kept; beyond it every other picture is let go.
constexpr std::size_t kMostSamples = std::size_t{1} << 21;
constexpr std::uint64_t kMostLabels = 60;
/// Times of a film are counted in parts of its length.
constexpr std::uint64_t kParts = 1000000;

/// The shape of a body as it is drawn, in the body's own frame.
template <Scalar S>
struct Outline {
  ShapeType type;
  bool sensor;
  S radius;
  std::vector<Vector<S>> vertices;

  friend bool operator==(const Outline& a, const Outline& b) {
    const auto same = [](const Vector<S>& u, const Vector<S>& v) { return u.x == v.x && u.y == v.y; };
    return a.type == b.type && a.sensor == b.sensor && a.radius == b.radius &&
           std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(), same);
  }
};

/// Place of a body in one picture.
template <Scalar S>
struct Pose {
  Vector<S> at;
  std::int32_t angle = 0;  ///< Tenths of a degree, without jumps from one picture to the next.
};

/// A body while it looks the same: another one begins where its shapes change.
template <Scalar S>
struct Track {
  BodyId id;
  BodyType type = BodyType::dynamicBody;
  bool isOther = false;  ///< It is that of the second recording.
  std::uint32_t first = 0;
  std::vector<Outline<S>> outlines;
  std::vector<Pose<S>> poses;

  std::uint32_t end() const { return first + static_cast<std::uint32_t>(poses.size()); }
};

template <Scalar S>
std::int32_t tenthsOfDegree(const Vector<S>& rotation, const Pose<S>* before) {
  const auto angle = static_cast<std::int32_t>(atan2(rotation.y, rotation.x) * ratio<S>(5729578, 10000));
  if (before == nullptr) return angle;
  const std::int32_t turns = (before->angle - angle + (before->angle > angle ? 1800 : -1800)) / 3600;
  return angle + turns * 3600;
}

}  // namespace

template <Scalar S>
struct Film<S>::Impl {
  Player<S>& player;
  Player<S>* other;
  FilmOptions options;
  std::vector<Track<S>> tracks;
  std::vector<std::size_t> last;       ///< The track of each body slot in the picture before.
  std::vector<std::size_t> lastOther;  ///< Tracks of the second recording's.
  std::uint64_t stride = 1;
  std::uint32_t pictures = 0;
  std::size_t samples = 0;
  std::optional<FilmDifference> difference;
  S timeStep{};
  BB<S> frame{};

  Impl(Player<S>& playerIn, Player<S>* otherIn, const FilmOptions& optionsIn)
      : player(playerIn), other(otherIn), options(optionsIn), timeStep(player.timeStep()) {}

  void shoot();
  void look();
  void seeAll(const Space<S>& space, bool isOther, std::vector<std::size_t>& before);
  void see(const Space<S>& space, const Body<S>& body, bool isOther, std::vector<std::size_t>& before);
  void compare();
  void thin();
  void setFrame();
  const Track<S>* followed() const;

  std::uint64_t tickOf(std::uint32_t picture) const { return options.from + picture * stride; }
  /// The picture from which on a step is shown.
  std::uint32_t pictureAfter(std::uint64_t tick) const {
    return tick <= options.from ? 0 : static_cast<std::uint32_t>((tick - options.from + stride - 1) / stride);
  }

  // Writing, in film coordinates.
  int width() const { return length(frame.right - frame.left); }
  int height() const { return length(frame.top - frame.bottom); }
  S side() const { return max(frame.right - frame.left, frame.top - frame.bottom); }
  int length(S size) const;
  std::array<std::int64_t, 2> place(const Vector<S>& at) const {
    return {length(at.x - frame.left), length(frame.top - at.y)};
  }
  std::string begin(const std::string& caption) const;
  std::string shapes(const Track<S>& track) const;
  std::string outline(const Track<S>& track, const Outline<S>& shape) const;
  std::string moving(const Track<S>& track) const;
  std::string labels() const;
  std::string film(const std::string& caption) const;
  std::string duration() const;
  std::string during(std::uint32_t from, std::uint32_t to) const;
  std::string animated(const char* type, const std::vector<std::array<std::int64_t, 2>>& values,
                       std::uint32_t first) const;
  std::string ring(const Track<S>& track) const;
  bool isMarked(const Track<S>& track) const {
    return difference && difference->body == track.id.index && !track.isOther;
  }
  bool isSeen(const Track<S>& track, std::uint32_t picture) const {
    const bool marked = !track.isOther || (difference && picture >= pictureAfter(difference->tick));
    return marked && picture >= track.first && picture < track.end();
  }
};

// Taking pictures.

template <Scalar S>
void Film<S>::Impl::shoot() {
  require<Fault::ValueOutOfRange>(options.rate > 0 && options.bytes > 0, "A film has pictures.");
  options.to = min(options.to, player.ticks());
  if (other != nullptr) options.to = min(options.to, other->ticks());
  require<Fault::ValueOutOfRange>(options.from <= options.to, "The film begins at step ", options.from,
                                  ", after its end at ", options.to, ".");
  const S perPicture = S(1) / (timeStep * S(static_cast<int>(min(options.rate, 1000u))));
  stride = static_cast<std::uint64_t>(max(static_cast<int>(perPicture + ratio<S>(1, 2)), 1));
  bool more = player.seek(options.from) && (other == nullptr || other->seek(options.from));
  if (options.follow) {
    const auto& bodies = player.space().state().bodies;
    require<Fault::ValueOutOfRange>(*options.follow < bodies.slots() && bodies.aliveAt(*options.follow),
                                    "There is no body ", *options.follow, " at step ", options.from, ".");
  }
  while (true) {
    compare();
    if ((player.tick() - options.from) % stride == 0) look();
    more = more && player.tick() < options.to && player.seek(player.tick() + 1) &&
           (other == nullptr || other->seek(other->tick() + 1));
    if (!more) break;
  }
  setFrame();
}

template <Scalar S>
void Film<S>::Impl::compare() {
  if (other == nullptr || difference || player.space().hash() == other->space().hash()) return;
  difference = FilmDifference{player.tick(), std::nullopt};
  constexpr std::string_view kBody = "body ";
  for (const FieldDifference& field : differences(player.space().state(), other->space().state(), 1000)) {
    if (!field.object.starts_with(kBody)) continue;
    std::uint32_t index = 0;
    std::from_chars(field.object.data() + kBody.size(), field.object.data() + field.object.size(), index);
    difference->body = index;
    return;
  }
}

template <Scalar S>
void Film<S>::Impl::look() {
  seeAll(player.space(), false, last);
  if (difference && difference->body) {
    const auto& bodies = other->space().state().bodies;
    if (*difference->body < bodies.slots() && bodies.aliveAt(*difference->body)) {
      see(other->space(), bodies.valueAt(*difference->body), true, lastOther);
    }
  }
  ++pictures;
  while (samples > kMostSamples) thin();
}

template <Scalar S>
void Film<S>::Impl::seeAll(const Space<S>& space, bool isOther, std::vector<std::size_t>& before) {
  space.eachBody([&](const Body<S>& body) { see(space, body, isOther, before); });
}

template <Scalar S>
void Film<S>::Impl::see(const Space<S>& space, const Body<S>& body, bool isOther,
                        std::vector<std::size_t>& before) {
  std::vector<Outline<S>> outlines;
  space.eachShape(body.id(), [&](const Shape<S>& shape) {
    const auto vertices = shape.vertices();
    outlines.push_back({shape.type(), shape.sensor(), shape.radius(), {vertices.begin(), vertices.end()}});
  });
  const std::uint32_t slot = body.id().index;
  if (before.size() <= slot) before.resize(slot + std::size_t{1}, ~std::size_t{0});
  const std::size_t was = before[slot];
  const bool goesOn = was < tracks.size() && tracks[was].id == body.id() && tracks[was].end() == pictures &&
                      tracks[was].type == body.type() && tracks[was].outlines == outlines;
  if (!goesOn) {
    before[slot] = tracks.size();
    tracks.push_back({body.id(), body.type(), isOther, pictures, std::move(outlines), {}});
  }
  Track<S>& track = tracks[before[slot]];
  const Pose<S>* earlier = track.poses.empty() ? nullptr : &track.poses.back();
  track.poses.push_back({body.position(), tenthsOfDegree(body.rotation(), earlier)});
  ++samples;
}

/// Lets every other picture go.
template <Scalar S>
void Film<S>::Impl::thin() {
  samples = 0;
  for (Track<S>& track : tracks) {
    std::size_t kept = 0;
    for (std::uint32_t i = track.first % 2; i < track.poses.size(); i += 2)
      track.poses[kept++] = track.poses[i];
    track.poses.resize(kept);
    track.first = (track.first + 1) / 2;
    samples += kept;
  }
  pictures = (pictures + 1) / 2;
  stride *= 2;
}

/// The first one shown of the body to follow.
template <Scalar S>
const Track<S>* Film<S>::Impl::followed() const {
  for (const Track<S>& track : tracks) {
    if (options.follow && track.id.index == *options.follow && !track.isOther && !track.poses.empty()) {
      return &track;
    }
  }
  return nullptr;
}

/// Where the picture is: around the body it follows, else all that moves, but for what leaves for far away.
template <Scalar S>
void Film<S>::Impl::setFrame() {
  bool any = false;
  BB<S> home{};
  const auto reach = [](const Track<S>& track) {
    S most = S(0);
    for (const Outline<S>& shape : track.outlines) {
      for (const Vector<S>& vertex : shape.vertices) {
        most = max(most, max(abs(vertex.x), abs(vertex.y)) + shape.radius);
      }
    }
    return most;
  };
  const auto take = [&](const Track<S>& track, const Pose<S>& pose) {
    const S r = reach(track);
    const BB<S> box{pose.at.x - r, pose.at.y - r, pose.at.x + r, pose.at.y + r};
    frame = any ? merge(frame, box) : box;
    any = true;
  };
  if (const Track<S>* track = followed()) {
    const S half = max(reach(*track) * S(12), ratio<S>(1, 8));
    const Vector<S> at = track->poses.front().at;
    frame = {at.x - half, at.y - half, at.x + half, at.y + half};
    return;
  }
  const auto isShown = [](const Track<S>& track, bool moving) {
    return !track.poses.empty() && !track.outlines.empty() && (!moving || track.type != BodyType::staticBody);
  };
  for (const bool moving : {true, false}) {
    for (const Track<S>& track : tracks) {
      if (!any || track.first == 0) {
        if (isShown(track, moving)) take(track, track.poses.front());
      }
    }
    if (any) break;
  }
  home = frame;
  const S more = max(max(home.right - home.left, home.top - home.bottom), S(4));
  home = {home.left - more, home.bottom - more, home.right + more, home.top + more};
  for (const Track<S>& track : tracks) {
    if (!isShown(track, true)) continue;
    for (const Pose<S>& pose : track.poses) {
      const bool near =
          pose.at.x > home.left && pose.at.x < home.right && pose.at.y > home.bottom && pose.at.y < home.top;
      if (near) take(track, pose);
    }
  }
  const S margin = max(side() * ratio<S>(1, 32), ratio<S>(1, 8));
  frame = {frame.left - margin, frame.bottom - margin, frame.right + margin, frame.top + margin};
}

// Writing.

/// In tenths of a pixel; what is far outside the picture stays outside.
template <Scalar S>
int Film<S>::Impl::length(S size) const {
  const S whole = side();
  const S most = whole < S(16384) ? whole * S(65536) : S(1 << 30);
  return static_cast<int>(min(max(size, -most), most) / whole * S(kSide));
}

namespace {

std::string number(std::int64_t value) { return std::to_string(value); }
/// Tenths as they stand in attributes.
std::string tenths(std::int64_t value) {
  const std::int64_t size = value < 0 ? -value : value;
  std::string text = (value < 0 ? "-" : "") + number(size / 10);
  return size % 10 == 0 ? text : text + "." + number(size % 10);
}
/// A part of the film's length, as keyTimes has it.
std::string part(std::uint32_t picture, std::uint32_t pictures) {
  if (picture == 0) return "0";
  if (picture + 1 >= pictures) return "1";
  std::string digits = std::to_string(std::uint64_t{picture} * kParts / (pictures - 1));
  digits.insert(0, 6 - min<std::string::size_type>(digits.size(), 6), '0');
  while (digits.size() > 1 && digits.back() == '0') digits.pop_back();
  return "." + digits;
}

/// True if the values between two stand on the line between them, within the tolerance.
bool isLine(const std::vector<std::array<std::int64_t, 2>>& values, std::size_t a, std::size_t b) {
  const auto steps = static_cast<std::int64_t>(b - a);
  for (std::size_t i = a + 1; i < b; ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const std::int64_t off = (values[i][k] - values[a][k]) * steps -
                               (values[b][k] - values[a][k]) * static_cast<std::int64_t>(i - a);
      if (off > kTolerance * steps || off < -kTolerance * steps) return false;
    }
  }
  return true;
}

/// Those values that a line through them leaves no other far from.
std::vector<std::size_t> cornersOf(const std::vector<std::array<std::int64_t, 2>>& values) {
  std::vector<std::size_t> corners{0};
  for (std::size_t i = 2; i < values.size(); ++i) {
    if (i - corners.back() > kLongestLine || !isLine(values, corners.back(), i)) corners.push_back(i - 1);
  }
  if (values.size() > 1) corners.push_back(values.size() - 1);
  return corners;
}

}  // namespace

template <Scalar S>
std::string Film<S>::Impl::duration() const {
  const S seconds = timeStep * S(static_cast<int>(min<std::uint64_t>((pictures - 1) * stride, 1u << 30)));
  const auto milliseconds = static_cast<std::int64_t>(static_cast<int>(min(seconds, S(2000000)))) * 1000 +
                            static_cast<int>((seconds - S(static_cast<int>(seconds))) * S(1000));
  return " dur=\"" + number(max<std::int64_t>(milliseconds, 1)) + "ms\" repeatCount=\"indefinite\"";
}

/// An animation that shows what it is in from one picture to before another; empty for all the time.
template <Scalar S>
std::string Film<S>::Impl::during(std::uint32_t from, std::uint32_t to) const {
  if (from == 0 && to >= pictures) return {};
  std::string values = from == 0 ? "visible" : "hidden;visible";
  std::string times = from == 0 ? "0" : "0;" + part(from, pictures);
  if (to < pictures) {
    values += ";hidden";
    times += ";" + part(to, pictures);
  }
  return "<animate attributeName=\"visibility\" calcMode=\"discrete\" values=\"" + values + "\" keyTimes=\"" +
         times + "\"" + duration() + "/>";
}

/// The attribute transform, with its animation where anything of it changes.
template <Scalar S>
std::string Film<S>::Impl::animated(const char* type, const std::vector<std::array<std::int64_t, 2>>& values,
                                    std::uint32_t first) const {
  const bool turns = type[0] == 'r';
  const auto text = [&](std::size_t i) {
    return turns ? tenths(values[i][0]) : number(values[i][0]) + "," + number(values[i][1]);
  };
  const std::string start = std::string("<g transform=\"") + type + "(" + text(0) + ")\">";
  const std::vector<std::size_t> corners = cornersOf(values);
  const bool stands = corners.size() <= 2 && values.front() == values.back();
  if (stands || pictures < 2) return start;
  std::string all = first > 0 ? text(0) : "";
  std::string times = first > 0 ? "0" : "";
  for (const std::size_t corner : corners) {
    all += (all.empty() ? "" : ";") + text(corner);
    times += (times.empty() ? "" : ";") + part(first + static_cast<std::uint32_t>(corner), pictures);
  }
  if (first + values.size() < pictures) {
    all += ";" + text(values.size() - 1);
    times += ";1";
  }
  return start + "<animateTransform attributeName=\"transform\" type=\"" + type + "\" values=\"" + all +
         "\" keyTimes=\"" + times + "\"" + duration() + "/>";
}

template <Scalar S>
std::string Film<S>::Impl::outline(const Track<S>& track, const Outline<S>& shape) const {
  Paint paint = paintOf(track.type, track.id.index);
  std::string style;
  if (shape.sensor) {
    paint = kSensor;
    style = " fill-opacity=\".25\" stroke-dasharray=\"50\"";
  }
  if (track.isOther) {
    paint = {"none", "#d42a2a"};
    style = " stroke-dasharray=\"60\"";
  }
  const int radius = length(shape.radius);
  const auto at = [&](const Vector<S>& v) { return number(length(v.x)) + "," + number(length(-v.y)); };
  const auto stroke = [&](int thickness) { return " stroke-width=\"" + number(thickness) + "\""; };
  const std::string colours =
      std::string(" fill=\"") + paint.fill + "\" stroke=\"" + paint.line + "\"" + style;
  if (shape.type == ShapeType::circle) {
    const Vector<S>& centre = shape.vertices[0];
    return "<circle cx=\"" + number(length(centre.x)) + "\" cy=\"" + number(length(-centre.y)) + "\" r=\"" +
           number(radius) + "\"" + colours + "/><path d=\"M" + at(centre) + "h" + number(radius) +
           "\" stroke=\"" + paint.line + "\"/>";
  }
  std::string path;
  for (const Vector<S>& vertex : shape.vertices) path += (path.empty() ? "M" : "L") + at(vertex);
  if (shape.type == ShapeType::segment) {
    return "<path d=\"" + path + "\" stroke=\"" + (track.isOther ? paint.line : paint.fill) + "\"" +
           stroke(max(2 * radius, 20)) + style + "/>";
  }
  path = "<path d=\"" + path + "z\"";
  if (radius == 0 || track.isOther) return path + colours + "/>";
  // The rounding is a thick line; a thicker one beneath it is its edge.
  return path + " fill=\"" + paint.line + "\" stroke=\"" + paint.line + "\"" + stroke(2 * radius + 10) +
         "/>" + path + " fill=\"" + paint.fill + "\" stroke=\"" + paint.fill + "\"" +
         stroke(max(2 * radius - 10, 0)) + style + "/>";
}

template <Scalar S>
std::string Film<S>::Impl::shapes(const Track<S>& track) const {
  std::string all;
  for (const Outline<S>& shape : track.outlines) all += outline(track, shape);
  return all;
}

/// Ring that says: this is the first one that is not the same.
template <Scalar S>
std::string Film<S>::Impl::ring(const Track<S>& track) const {
  if (!isMarked(track)) return {};
  S reach = S(0);
  for (const Outline<S>& shape : track.outlines) {
    for (const Vector<S>& vertex : shape.vertices) {
      reach = max(reach, max(abs(vertex.x), abs(vertex.y)) + shape.radius);
    }
  }
  return "<circle r=\"" + number(length(reach * ratio<S>(3, 2)) + 60) +
         "\" fill=\"none\" stroke=\"#d42a2a\" stroke-width=\"40\">";
}

template <Scalar S>
std::string Film<S>::Impl::moving(const Track<S>& track) const {
  if (track.poses.empty() || track.outlines.empty()) return {};
  std::uint32_t first = track.first;
  if (track.isOther && difference) first = max(first, pictureAfter(difference->tick));
  const std::string shown = during(first, track.end());
  std::vector<std::array<std::int64_t, 2>> places, angles;
  for (const Pose<S>& pose : track.poses) {
    places.push_back(place(pose.at));
    angles.push_back({-pose.angle, 0});
  }
  std::string mark = ring(track);
  if (!mark.empty()) mark += during(pictureAfter(difference->tick), pictures) + "</circle>";
  const std::string name = track.isOther ? std::string()
                                         : " id=\"b" + number(track.id.index) + "g" +
                                               number(track.id.generation) + "t" + number(track.first) + "\"";
  return "<g" + name + (first == 0 ? ">" : " visibility=\"hidden\">") + shown +
         animated("translate", places, track.first) + animated("rotate", angles, track.first) +
         shapes(track) + "</g>" + mark + "</g></g>\n";
}

template <Scalar S>
std::string Film<S>::Impl::begin(const std::string& caption) const {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(width() / 10) + "\" height=\"" +
         number((height() + kHeader) / 10) + "\" viewBox=\"0 " + number(-kHeader) + " " + number(width()) +
         " " + number(height() + kHeader) +
         "\" font-family=\"sans-serif\" stroke-width=\"10\" stroke-linejoin=\"round\" "
         "stroke-linecap=\"round\">\n<rect y=\"" +
         number(-kHeader) +
         "\" width=\"100%\" height=\"100%\" fill=\"#fcfbf8\"/>\n<text x=\"150\" y=\"-130\" "
         "font-size=\"200\" fill=\"#333\">" +
         escapedText(caption) + "</text>\n";
}

/// Numbers of steps, each while it is shown, and a line that grows with time.
template <Scalar S>
std::string Film<S>::Impl::labels() const {
  const auto each = static_cast<std::uint32_t>((pictures + kMostLabels - 1) / kMostLabels);
  std::string all;
  for (std::uint32_t picture = 0; picture < pictures; picture += each) {
    all += "<text x=\"" + number(width() - 150) +
           "\" y=\"-130\" text-anchor=\"end\" font-size=\"200\" fill=\"#333\"" +
           (picture == 0 ? ">" : " visibility=\"hidden\">") + "tick " + std::to_string(tickOf(picture)) +
           during(picture, picture + each) + "</text>\n";
  }
  return all + "<rect y=\"-40\" height=\"40\" fill=\"#8d949f\"><animate attributeName=\"width\" values=\"0;" +
         number(width()) + "\"" + duration() + "/></rect>\n";
}

template <Scalar S>
std::string Film<S>::Impl::film(const std::string& caption) const {
  std::string text = begin(caption);
  std::string camera = "<g>";
  if (const Track<S>* track = followed()) {
    std::vector<std::array<std::int64_t, 2>> away;
    const auto from = place(track->poses.front().at);
    for (const Pose<S>& pose : track->poses) {
      const auto at = place(pose.at);
      away.push_back({from[0] - at[0], from[1] - at[1]});
    }
    camera = animated("translate", away, track->first);
  }
  text += "<svg width=\"" + number(width()) + "\" height=\"" + number(height()) + "\">" + camera + "\n";
  for (const BodyType type : {BodyType::staticBody, BodyType::kinematicBody, BodyType::dynamicBody}) {
    for (const Track<S>& track : tracks) {
      if (track.type == type && !track.isOther) text += moving(track);
    }
  }
  for (const Track<S>& track : tracks) {
    if (track.isOther) text += moving(track);
  }
  return text + "</g></svg>\n" + labels() + "</svg>\n";
}

template <Scalar S>
Film<S>::Film(Player<S>& player, Player<S>* other, const FilmOptions& options)
    : impl_(new Impl(player, other, options)) {
  struct Guard {
    Impl* impl;
    ~Guard() { delete impl; }
  } guard{impl_};
  impl_->shoot();
  guard.impl = nullptr;
}

template <Scalar S>
Film<S>::~Film() {
  delete impl_;
}

template <Scalar S>
std::string Film<S>::svg(const std::string& caption) {
  while (true) {
    std::string text = impl_->film(caption);
    if (text.size() <= impl_->options.bytes) return text;
    require<Fault::ValueOutOfRange>(impl_->pictures > 2, "Two pictures of the film take ", text.size(),
                                    " bytes, allowed are ", impl_->options.bytes, ".");
    impl_->thin();
  }
}

template <Scalar S>
std::uint32_t Film<S>::pictures() const {
  return impl_->pictures;
}
template <Scalar S>
std::uint64_t Film<S>::stride() const {
  return impl_->stride;
}
template <Scalar S>
std::uint64_t Film<S>::tickOf(std::uint32_t picture) const {
  return impl_->tickOf(picture);
}
template <Scalar S>
const std::optional<FilmDifference>& Film<S>::difference() const {
  return impl_->difference;
}

template <Scalar S>
std::string Film<S>::still(std::uint32_t picture, const std::string& caption) const {
  require<Fault::ValueOutOfRange>(picture < impl_->pictures, "The film has ", impl_->pictures, " pictures.");
  std::string text = impl_->begin(caption + " · tick " + std::to_string(tickOf(picture)));
  std::array<std::int64_t, 2> away{0, 0};
  if (const Track<S>* track = impl_->followed()) {
    const auto from = impl_->place(track->poses.front().at);
    const std::size_t last = min<std::size_t>(picture - min(picture, track->first), track->poses.size() - 1);
    const auto at = impl_->place(track->poses[last].at);
    away = {from[0] - at[0], from[1] - at[1]};
  }
  text += "<svg width=\"" + number(impl_->width()) + "\" height=\"" + number(impl_->height()) +
          "\"><g transform=\"translate(" + number(away[0]) + "," + number(away[1]) + ")\">\n";
  for (const bool isOther : {false, true}) {
    for (const BodyType type : {BodyType::staticBody, BodyType::kinematicBody, BodyType::dynamicBody}) {
      for (const Track<S>& track : impl_->tracks) {
        if (track.type != type || track.isOther != isOther || !impl_->isSeen(track, picture)) continue;
        const Pose<S>& pose = track.poses[picture - track.first];
        const auto at = impl_->place(pose.at);
        const bool marked = impl_->isMarked(track) && picture >= impl_->pictureAfter(impl_->difference->tick);
        text += "<g transform=\"translate(" + number(at[0]) + "," + number(at[1]) +
                ")\"><g transform=\"rotate(" + tenths(-pose.angle) + ")\">" + impl_->shapes(track) + "</g>" +
                (marked ? impl_->ring(track) + "</circle>" : "") + "</g>\n";
      }
    }
  }
  return text + "</g></svg>\n</svg>\n";
}

#define SAMESTEP_EACH_SCALAR template class Film<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
