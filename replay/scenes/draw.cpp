// SPDX-License-Identifier: MIT
#include <samestep/draw.h>

#include "base/require_ieee.h"
#include "scenes/paint.h"

namespace samestep {
namespace {

/// Writes the picture. Lengths are metres with y downwards, so that a pixel's size never matters.
template <Scalar S>
class Artist {
 public:
  explicit Artist(const Space<S>& space) : space_(space) {}

  std::string draw(const std::string& caption) {
    measure();
    begin();
    layer(BodyType::staticBody);
    layer(BodyType::kinematicBody);
    layer(BodyType::dynamicBody);
    joints();
    velocities();
    contacts();
    labels();
    write(caption);
    out_ += "</svg>\n";
    return std::move(out_);
  }

 private:
  static constexpr int kPixels = 1200;

  /// Four decimals, without the scalar's own text, which differs in length.
  static std::string number(S x) {
    const bool negative = x < S(0);
    const S size = (negative ? -x : x) + ratio<S>(1, 20000);
    const auto whole = static_cast<int>(size);
    const auto part = static_cast<int>((size - S(whole)) * S(10000));
    if (whole == 0 && part == 0) return "0";
    std::string digits = std::to_string(part);
    digits.insert(0, 4 - min<std::string::size_type>(digits.size(), 4), '0');
    while (!digits.empty() && digits.back() == '0') digits.pop_back();
    return (negative ? "-" : "") + std::to_string(whole) + (digits.empty() ? "" : "." + digits);
  }
  static std::string attribute(const char* name, S value) {
    return std::string(" ") + name + "=\"" + number(value) + "\"";
  }
  /// Writes a place: y turned over.
  static std::string place(const char* x, const char* y, const Vector<S>& at) {
    return attribute(x, at.x) + attribute(y, -at.y);
  }
  static std::string paint(const Paint& colours) {
    return std::string(" fill=\"") + colours.fill + "\" stroke=\"" + colours.line + "\"";
  }
  const Body<S>& bodyOf(const Shape<S>& shape) const { return space_.body(shape.body()); }
  BB<S> boxOf(const Shape<S>& shape) const { return boundingBox(shape, bodyOf(shape).transform()); }

  /// The frame: all that moves, or everything where nothing does; a little wider, and never tiny.
  void measure() {
    bool any = false;
    const auto take = [&](bool moving) {
      space_.eachShape([&](const Shape<S>& shape) {
        if (moving && bodyOf(shape).type() == BodyType::staticBody) return;
        frame_ = any ? merge(frame_, boxOf(shape)) : boxOf(shape);
        any = true;
      });
    };
    take(true);
    if (!any) take(false);
    const S width = frame_.right - frame_.left;
    const S height = frame_.top - frame_.bottom;
    const S margin = max(max(width, height) * ratio<S>(1, 16), ratio<S>(1, 8));
    frame_ = {frame_.left - margin, frame_.bottom - margin, frame_.right + margin, frame_.top + margin};
    width_ = frame_.right - frame_.left;
    height_ = frame_.top - frame_.bottom;
    unit_ = max(width_, height_) / S(1000);
  }

  S header() const { return unit_ * S(34); }

  void begin() {
    const S top = -frame_.top - header();
    const S total = height_ + header();
    const int pixelsHigh = static_cast<int>(total / width_ * S(kPixels));
    out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + std::to_string(kPixels) + "\" height=\"" +
           std::to_string(pixelsHigh) + "\" viewBox=\"" + number(frame_.left) + " " + number(top) + " " +
           number(width_) + " " + number(total) + "\" font-family=\"sans-serif\">\n";
    out_ +=
        "<defs><marker id=\"tip\" orient=\"auto\" markerWidth=\"5\" markerHeight=\"5\" refX=\"3\" refY=\"2\">"
        "<path d=\"M0,0 L4,2 L0,4 z\" fill=\"#27408b\"/></marker></defs>\n";
    out_ += "<rect" + place("x", "y", {frame_.left, -top}) + attribute("width", width_) +
            attribute("height", total) + " fill=\"#fcfbf8\"/>\n";
  }

  /// Last, so that nothing hides it.
  void write(const std::string& caption) {
    const S top = -frame_.top - header();
    out_ += "<rect" + place("x", "y", {frame_.left, -top}) + attribute("width", width_) +
            attribute("height", header()) + " fill=\"#fcfbf8\"/>\n";
    out_ += "<text" + attribute("x", frame_.left + unit_ * S(12)) + attribute("y", top + unit_ * S(24)) +
            attribute("font-size", unit_ * S(17)) + " fill=\"#333\">" + escapedText(caption) + "</text>\n";
  }

  void layer(BodyType type) {
    out_ +=
        "<g" + attribute("stroke-width", unit_) + " stroke-linejoin=\"round\" stroke-linecap=\"round\">\n";
    space_.eachShape([&](const Shape<S>& shape) {
      if (bodyOf(shape).type() == type) outline(shape);
    });
    out_ += "</g>\n";
  }

  void outline(const Shape<S>& shape) {
    const Transform<S> pose = bodyOf(shape).transform();
    Paint colours = paintOf(bodyOf(shape).type(), bodyOf(shape).id().index);
    std::string style;
    if (shape.sensor()) {
      style = " fill-opacity=\"0.25\" stroke-dasharray=\"" + number(unit_ * S(5)) + "\"";
      colours = kSensor;
    }
    switch (shape.type()) {
      case ShapeType::circle:
        circle(shape, pose, colours, style);
        break;
      case ShapeType::segment:
        segment(shape, pose, colours);
        break;
      case ShapeType::poly:
        polygon(shape, pose, colours, style);
        break;
    }
  }

  void circle(const Shape<S>& shape, const Transform<S>& pose, const Paint& colours,
              const std::string& style) {
    const Vector<S> center = transformPoint(pose, shape.vertices()[0]);
    const Vector<S> rim = center + transformVect(pose, Vector<S>(shape.radius(), S(0)));
    out_ += "<circle" + place("cx", "cy", center) + attribute("r", shape.radius()) + paint(colours) + style +
            "/>";
    out_ +=
        "<line" + place("x1", "y1", center) + place("x2", "y2", rim) + " stroke=\"" + colours.line + "\"/>\n";
  }

  void segment(const Shape<S>& shape, const Transform<S>& pose, const Paint& colours) {
    const S thickness = max(shape.radius() * S(2), unit_ * S(2));
    out_ += "<line" + place("x1", "y1", transformPoint(pose, shape.vertices()[0])) +
            place("x2", "y2", transformPoint(pose, shape.vertices()[1])) + " stroke=\"" + colours.fill +
            "\"" + attribute("stroke-width", thickness) + "/>\n";
  }

  void polygon(const Shape<S>& shape, const Transform<S>& pose, const Paint& colours,
               const std::string& style) {
    std::string points;
    for (const Vector<S>& vertex : shape.vertices()) {
      const Vector<S> at = transformPoint(pose, vertex);
      points += (points.empty() ? "" : " ") + number(at.x) + "," + number(-at.y);
    }
    const auto filled = [&](const char* fill, const char* line, S thickness, const std::string& more) {
      out_ += std::string("<polygon points=\"") + points + "\" fill=\"" + fill + "\" stroke=\"" + line +
              "\"" + attribute("stroke-width", thickness) + more + "/>";
    };
    // The rounding is a thick line; a thicker one beneath it is its edge.
    if (shape.radius() > S(0)) {
      filled(colours.line, colours.line, shape.radius() * S(2) + unit_, "");
      filled(colours.fill, colours.fill, max(shape.radius() * S(2) - unit_, S(0)), style);
    } else {
      filled(colours.fill, colours.line, unit_, style);
    }
    out_ += "\n";
  }

  void stroke(const Vector<S>& from, const Vector<S>& to, const char* more = "") {
    out_ += "<line" + place("x1", "y1", from) + place("x2", "y2", to) + more + "/>";
  }
  void dot(const Vector<S>& at, const char* fill) {
    out_ += "<circle" + place("cx", "cy", at) + attribute("r", unit_ * S(4)) + " fill=\"" + fill + "\"/>";
  }
  /// A line to and fro.
  void coil(const Vector<S>& from, const Vector<S>& to) {
    constexpr int kTurns = 10;
    const Vector<S> part = (to - from) * ratio<S>(1, kTurns);
    const Vector<S> aside = perp(normalize(part)) * (unit_ * S(6));
    Vector<S> last = from;
    for (int i = 1; i < kTurns; ++i) {
      const Vector<S> next = from + part * (S(i) - ratio<S>(1, 2)) + (i % 2 == 0 ? aside : -aside);
      stroke(last, next);
      last = next;
    }
    stroke(last, to);
  }
  /// The part of A's axis along which B may slide, or some of it where nothing ends it.
  void rail(const Joint<S>& joint, const Body<S>& a, const Vector<S>& at) {
    const Vector<S> axis = rotate(joint.axis, a.rotation());
    const S reach = unit_ * S(60);
    const auto end = [&](S limit) { return clamp(limit, -(width_ + height_), width_ + height_); };
    stroke(at + axis * (joint.limited != 0 ? end(joint.lower) : -reach),
           at + axis * (joint.limited != 0 ? end(joint.upper) : reach));
  }
  /// Draws the turning of B: a circle about its centre with a spoke.
  void dial(const Body<S>& b) {
    const Vector<S> center = b.worldCenter();
    out_ += "<circle" + place("cx", "cy", center) + attribute("r", unit_ * S(16)) + " fill=\"none\"/>";
    stroke(center, center + b.rotation() * (unit_ * S(16)));
  }

  /// Each as what it is: a pin, a rail, a rod, a rope, a coil; from the centres of the bodies to where it
  /// holds them.
  void joints() {
    if (space_.jointCount() == 0) return;
    out_ +=
        "<g stroke=\"#3b3b3b\" stroke-linecap=\"round\"" + attribute("stroke-width", unit_ * S(2)) + ">\n";
    space_.eachJoint([&](JointId, const Joint<S>& joint) { drawJoint(joint); });
    out_ += "</g>\n";
  }
  void drawJoint(const Joint<S>& joint) {
    const Body<S>&a = space_.body(joint.bodyA), &b = space_.body(joint.bodyB);
    const Vector<S> atA = a.toWorld(joint.anchorA), atB = b.toWorld(joint.anchorB);
    const char* thin = " stroke-opacity=\"0.45\"";
    switch (joint.kind) {
      case JointKind::gear:
      case JointKind::ratchet:
        stroke(a.worldCenter(), b.worldCenter(), " stroke-dasharray=\"0.05\" stroke-opacity=\"0.45\"");
        return dial(b);
      case JointKind::distance:
      case JointKind::target:
        if (joint.hertz != S(0)) {
          coil(atA, atB);
        } else {
          stroke(atA, atB, joint.limited != 0 ? " stroke-dasharray=\"0.05\"" : "");
        }
        break;
      case JointKind::prismatic:
      case JointKind::wheel:
        rail(joint, a, atA);
        if (joint.spring != 0) coil(atA, atB);
        break;
      case JointKind::revolute:
      case JointKind::weld:
        if (a.type() != BodyType::staticBody) stroke(a.worldCenter(), atA, thin);
        stroke(b.worldCenter(), atB, thin);
        break;
    }
    dot(atA, joint.kind == JointKind::weld ? "#3b3b3b" : "#ffffff");
    dot(atB, joint.kind == JointKind::weld ? "#3b3b3b" : "#ffd34d");
    out_ += "\n";
  }

  void velocities() {
    out_ += "<g stroke=\"#27408b\" stroke-opacity=\"0.8\"" +
            attribute("stroke-width", unit_ * ratio<S>(3, 2)) + " marker-end=\"url(#tip)\">\n";
    space_.eachBody([&](const Body<S>& body) {
      const Vector<S> reach = body.velocity() * ratio<S>(1, 10);
      // Shorter than its own tip, an arrow says nothing.
      if (max(abs(reach.x), abs(reach.y)) < unit_ * S(4)) return;
      out_ += "<line" + place("x1", "y1", body.worldCenter()) +
              place("x2", "y2", body.worldCenter() + reach) + "/>\n";
    });
    out_ += "</g>\n";
  }

  void contacts() {
    out_ += "<g fill=\"#d42a2a\" stroke=\"#d42a2a\"" + attribute("stroke-width", unit_) + ">\n";
    const WorldState<S>& world = space_.state();
    const auto bodyOf = [&](ShapeId id) -> const Body<S>& {
      return space_.body(world.shapes.valueAt(id.index).body());
    };
    const auto draw = [&](const Pair<S>& pair) {
      const bool touches =
          pair.age == 0 && (pair.state == ArbiterState::firstCollision || pair.state == ArbiterState::normal);
      for (int i = 0; touches && i < pair.count; ++i) {
        const Body<S>& a = bodyOf(pair.a);
        const Vector<S> at =
            (a.toWorld(pair.contacts[i].anchorA) + bodyOf(pair.b).toWorld(pair.contacts[i].anchorB)) *
            ratio<S>(1, 2);
        out_ += "<circle" + place("cx", "cy", at) + attribute("r", unit_ * S(2)) + "/><line" +
                place("x1", "y1", at) +
                place("x2", "y2", at + rotate(pair.localNormal, a.rotation()) * (unit_ * S(7))) + "/>\n";
      }
    };
    for (const auto* pairs : {&world.pairs, &world.restingPairs}) {
      for (const Pair<S>& pair : *pairs) draw(pair);
    }
    out_ += "</g>\n";
  }

  /// The number of each body, as large as its shapes have room for.
  void labels() {
    out_ += "<g fill=\"#222\" fill-opacity=\"0.75\" text-anchor=\"middle\">\n";
    space_.eachBody([&](const Body<S>& body) {
      S room = S(0);
      Vector<S> at = body.worldCenter();
      space_.eachShape(body.id(), [&](const Shape<S>& shape) {
        const BB<S> box = boxOf(shape);
        const S size = min(box.right - box.left, box.top - box.bottom);
        if (size <= room) return;
        room = size;
        at = center(box);
      });
      const S size = min(room * ratio<S>(2, 5), unit_ * S(14));
      if (size < unit_ * S(3)) return;
      out_ += "<text" + place("x", "y", at - Vector<S>(S(0), size * ratio<S>(1, 3))) +
              attribute("font-size", size) + ">" + std::to_string(body.id().index) + "</text>\n";
    });
    out_ += "</g>\n";
  }

  const Space<S>& space_;
  BB<S> frame_{};
  S width_{};
  S height_{};
  S unit_{};
  std::string out_;
};

}  // namespace

template <Scalar S>
std::string drawSvg(const Space<S>& space, const std::string& caption) {
  return Artist<S>(space).draw(caption);
}

#define SAMESTEP_EACH_SCALAR template std::string drawSvg<S>(const Space<S>&, const std::string&);
#include <samestep/each_scalar.h>

}  // namespace samestep
