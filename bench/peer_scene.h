// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace samestep::bench {

/// One shape of a scene file, numbers as they are written there.
struct SceneShape {
  int body = 0;
  std::string type;  ///< Of the body: static, kinematic or dynamic.
  std::string x, y, angle, vx, vy, w;
  std::string shape;  ///< circle or polygon.
  std::string radius;
  std::vector<std::string> vertices;  ///< x and y in turn.
};

/// A scene as in bench/scenes: density 1, restitution 0, effective friction 0.6, dt 1/60.
struct PeerScene {
  std::string gravityX, gravityY;
  std::vector<SceneShape> shapes;
};

/// Reads a scene file; ends the program with a message if it cannot.
PeerScene readScene(const std::string& path);

}  // namespace samestep::bench
