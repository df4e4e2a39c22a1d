// SPDX-License-Identifier: MIT
// Bodies from a CSV file: one row per shape, as other engines' scenes are exchanged.
#include <samestep/circle_shape.h>
#include <samestep/poly_shape.h>

#include <array>

#include "base/require_ieee.h"
#include "dynamics/body_access.h"
#include "scenes/scene_builder.h"

namespace samestep {
namespace {

constexpr std::uint32_t kMaxVertices = 8;
constexpr std::uint32_t kFixedColumns = 11;
constexpr std::uint32_t kColumns = kFixedColumns + 2 * kMaxVertices;
constexpr std::string_view kHeader =
    "body,type,x,y,angle,vx,vy,w,shape,radius,n,v0x,v0y,v1x,v1y,v2x,v2y,v3x,v3y,v4x,v4y,v5x,v5y,v6x,v6y,v7x,"
    "v7y";

/// One row, cut into its columns.
class Row {
 public:
  Row(const std::string& file, std::uint32_t line, std::string_view content) : file_(file), line_(line) {
    std::uint32_t count = 0;
    for (; count < kColumns; ++count) {
      const std::string_view::size_type comma = content.find(',');
      fields_[count] = content.substr(0, comma);
      if (comma == std::string_view::npos) break;
      content.remove_prefix(comma + 1);
    }
    if (count != kColumns - 1) fail("", std::to_string(kColumns) + " columns are wanted");
  }

  [[noreturn]] void fail(const std::string& column, const std::string& reason) const {
    throw SceneError(file_, line_, column.empty() ? column : "/" + column, reason);
  }
  std::string_view body() const { return fields_[0]; }
  std::string_view type() const { return fields_[1]; }
  std::string_view shape() const { return fields_[8]; }
  template <Scalar S>
  S number(std::uint32_t column) const {
    S value{};
    const char* reason = reasonOf(parseDecimal(fields_[column], value));
    if (reason != nullptr) fail("column " + std::to_string(column + 1), reason);
    return value;
  }
  template <Scalar S>
  Vector<S> vector(std::uint32_t column) const {
    return {number<S>(column), number<S>(column + 1)};
  }
  std::uint32_t vertices() const {
    const std::string_view text = fields_[10];
    if (text.size() != 1 || text[0] < '0' || text[0] > '8') fail("n", "a number from 0 to 8 is wanted");
    return static_cast<std::uint32_t>(text[0] - '0');
  }
  template <class Action>
  auto guard(Action&& action) const {
    try {
      const FailuresAreCaught caught;
      return action();
    } catch (const Error& error) {
      fail("", error.what());
    }
  }

 private:
  const std::string& file_;
  std::uint32_t line_;
  std::array<std::string_view, kColumns> fields_;
};

[[noreturn]] void refuseHeader(const std::string& file, std::uint32_t line) {
  throw SceneError(file, line, "", "the first line must be: " + std::string(kHeader));
}

template <Scalar S>
Body<S> bodyOf(const Row& row) {
  Body<S> body;
  if (row.type() == "static") {
    body = Body<S>::fixedInPlace();
  } else if (row.type() == "kinematic") {
    body = Body<S>::kinematic();
  } else if (row.type() != "dynamic") {
    row.fail("type", "dynamic, kinematic or static is wanted");
  }
  body.setPosition(row.vector<S>(2));
  body.setAngle(row.number<S>(4));
  body.setVelocity(row.vector<S>(5));
  body.setAngularVelocity(row.number<S>(7));
  return body;
}

template <Scalar S>
Shape<S> shapeOf(const Row& row) {
  if (row.shape() == "circle") return circleShape<S>({}, row.number<S>(9));
  if (row.shape() != "polygon") row.fail("shape", "circle or polygon is wanted");
  std::vector<Vector<S>> vertices;
  for (std::uint32_t i = 0; i < row.vertices(); ++i) vertices.push_back(row.vector<S>(kFixedColumns + 2 * i));
  return polyShapeRaw<S>({}, vertices, row.number<S>(9));
}

}  // namespace

template <Scalar S>
void SceneBuilder<S>::readCsvBodies(const Cursor& at) {
  at.allow({"csv", "density", "friction", "elasticity"});
  CsvSurface<S> surface;
  if (at.has("density")) surface.density = at.at("density").template number<S>();
  if (at.has("friction")) surface.friction = at.at("friction").template number<S>();
  if (at.has("elasticity")) surface.elasticity = at.at("elasticity").template number<S>();
  const std::string file = document_.folder + at.at("csv").text();
  const std::string text = document_.read(file);

  Space<S>& space = scene_.space_;
  BodyId body;
  std::string_view last;
  bool header = true;
  eachLine(text, [&](std::uint32_t line, std::string_view content) {
    if (header) {
      if (content != kHeader) refuseHeader(file, line);
      header = false;
      return;
    }
    const Row row(file, line, content);
    if (space.bodyCount() >= kMaxSceneBodies) row.fail("", tooMany("bodies", kMaxSceneBodies));
    if (space.shapeCount() >= kMaxSceneShapes) row.fail("", tooMany("shapes", kMaxSceneShapes));
    row.guard([&] {
      const bool first = row.body() != last;
      if (first) body = space.add(bodyOf<S>(row));
      last = row.body();
      Shape<S> shape = shapeOf<S>(row);
      shape.setBody(body);
      shape.setFriction(surface.friction);
      shape.setElasticity(surface.elasticity);
      // Mass and moment come from a body's first shape.
      if (first && space.body(body).isDynamic()) shape.setDensity(surface.density);
      space.add(shape);
      // The velocity is that of the centre of mass, which the shape has moved.
      if (first && space.body(body).type() != BodyType::staticBody)
        space.body(body).setVelocity(row.vector<S>(5));
      const char* reason = BodyAccess<S>::cannotStep(space.body(body));
      if (reason != nullptr && !scene_.unsteppable_) scene_.unsteppable_ = SceneError(file, line, "", reason);
    });
  });
  if (header) refuseHeader(file, 1);
}

#define SAMESTEP_EACH_SCALAR template class SceneBuilder<S>;
#include <samestep/each_scalar.h>

}  // namespace samestep
