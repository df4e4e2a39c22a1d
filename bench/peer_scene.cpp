// SPDX-License-Identifier: MIT
#include "peer_scene.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace samestep::bench {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

PeerScene readScene(const std::string& path) {
  std::ifstream file(path);
  if (!file) {
    std::fprintf(stderr, "cannot read %s\n", path.c_str());
    std::exit(2);
  }
  PeerScene scene;
  std::string line;
  std::getline(file, line);
  const std::string numbers = line.substr(line.find("gravity ") + 8);
  const std::vector<std::string> gravity = split(numbers.substr(0, numbers.find(' ')));
  scene.gravityX = gravity.at(0);
  scene.gravityY = gravity.at(1);
  std::getline(file, line);
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = split(line);
    SceneShape shape;
    shape.body = std::atoi(cells.at(0).c_str());
    shape.type = cells.at(1);
    shape.x = cells.at(2);
    shape.y = cells.at(3);
    shape.angle = cells.at(4);
    shape.vx = cells.at(5);
    shape.vy = cells.at(6);
    shape.w = cells.at(7);
    shape.shape = cells.at(8);
    shape.radius = cells.at(9);
    const std::size_t count = 2 * static_cast<std::size_t>(std::atoi(cells.at(10).c_str()));
    for (std::size_t i = 0; i < count; ++i) shape.vertices.push_back(cells.at(11 + i));
    scene.shapes.push_back(shape);
  }
  return scene;
}

}  // namespace samestep::bench
