// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace samestep::bench {

/// One shape of a scene file, numbers as they are written there.
struct SceneShape {
  int body = 0;      ///< Body of the shape, counted from 0 without gaps, in rising order.
  std::string type;  ///< Type of the body: static, kinematic or dynamic.
  std::string x, y, angle, vx, vy, w;
  std::string shape;  ///< circle or polygon.
  std::string radius;
  std::vector<std::string> vertices;  ///< x and y in turn.

  bool isDynamic() const { return type == "dynamic"; }
  bool isCircle() const { return shape == "circle"; }
};

/// A scene as in examples/scenes/peers: density 1 (mass and moment of a body from its first shape),
/// restitution 0, effective friction 0.6, dt 1/60.
struct PeerScene {
  std::string name;
  std::string gravityX, gravityY;
  std::vector<SceneShape> shapes;
};

/// A scene by name: a file of the folder without its `.csv`, `sparse-falling` (sparse with gravity), or
/// `pyramidN` for any base N. Ends the program with a message if there is none.
PeerScene readScene(const std::string& folder, const std::string& name);

/// A number of a scene in double.
double number(const std::string& text);

}  // namespace samestep::bench
