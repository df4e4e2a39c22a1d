// SPDX-License-Identifier: MIT
#include "peer_scene.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace samestep::bench {
namespace {

constexpr int kGreatestBase = 400;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

SceneShape shapeOf(const std::vector<std::string>& cells) {
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
  return shape;
}

PeerScene parse(std::istream& file) {
  PeerScene scene;
  std::string line;
  std::getline(file, line);
  const std::string numbers = line.substr(line.find("gravity ") + 8);
  const std::vector<std::string> gravity = split(numbers.substr(0, numbers.find(' ')));
  scene.gravityX = gravity.at(0);
  scene.gravityY = gravity.at(1);
  std::getline(file, line);
  while (std::getline(file, line)) scene.shapes.push_back(shapeOf(split(line)));
  return scene;
}

std::string halves(int count) { return std::to_string(count / 2) + (count % 2 == 0 ? "" : ".5"); }

std::string signedHalves(int count) { return count < 0 ? "-" + halves(-count) : halves(count); }

SceneShape boxAt(int body, const char* type, const std::string& x, const std::string& y,
                 const std::string& halfWidth, const std::string& halfHeight) {
  const std::string &w = halfWidth, &h = halfHeight;
  return {
      body, type, x, y, "0", "0", "0", "0", "polygon", "0", {"-" + w, "-" + h, w, "-" + h, w, h, "-" + w, h}};
}

/// Rows of unit boxes on a wide floor, by the formula of the scenes' page.
PeerScene pyramid(int base) {
  PeerScene scene{.name = "", .gravityX = "0", .gravityY = "-10", .shapes = {}};
  scene.shapes.push_back(boxAt(0, "static", "0", "-1", std::to_string(base + 20), "1"));
  int body = 0;
  for (int row = 0; row < base; ++row) {
    for (int box = row; box < base; ++box) {
      const int twiceX = row + 1 + 2 * (box - row) - base;
      scene.shapes.push_back(
          boxAt(++body, "dynamic", signedHalves(twiceX), halves(2 * row + 1), "0.5", "0.5"));
    }
  }
  return scene;
}

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "%s\n", what.c_str());
  std::exit(2);
}

}  // namespace

PeerScene readScene(const std::string& folder, const std::string& name) {
  const bool falling = name == "sparse-falling";
  const std::string path = folder + "/" + (falling ? "sparse" : name) + ".csv";
  PeerScene scene;
  if (std::ifstream file(path); file) {
    scene = parse(file);
  } else if (const int base = name.starts_with("pyramid") ? std::atoi(name.c_str() + 7) : 0;
             base > 0 && base <= kGreatestBase && name == "pyramid" + std::to_string(base)) {
    scene = pyramid(base);
  } else {
    fail("no scene '" + name + "': cannot read " + path);
  }
  scene.name = name;
  if (falling) scene.gravityY = "-10";
  return scene;
}

double number(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

}  // namespace samestep::bench
