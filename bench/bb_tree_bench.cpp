// SPDX-License-Identifier: MIT
// One step of the broad phase: every box told, then the pairs brought up to date.
#include <benchmark/benchmark.h>
#include <samestep/bb_tree.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace samestep {
namespace {

struct Mover {
  double x, y, vx, vy, half;
};

double unit(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/// 10 000 boxes 10 m apart, each with 5 m/s in its own direction.
std::vector<Mover> sparse() {
  std::uint64_t seed = 1;
  std::vector<Mover> movers;
  for (int i = 0; i < 10000; ++i) {
    const double angle = 6.28318530717958648 * unit(seed);
    movers.push_back({10.0 * (i % 100), 10.0 * (i / 100), 5 * std::cos(angle), 5 * std::sin(angle), 0.5});
  }
  return movers;
}

/// The pyramid of base 100, shaking a little.
std::vector<Mover> pile() {
  std::uint64_t seed = 2;
  std::vector<Mover> movers;
  for (int row = 0; row < 100; ++row) {
    for (int i = row; i < 100; ++i) {
      movers.push_back({i - 0.5 * row, row + 0.5, 0.02 * (unit(seed) - 0.5), 0.02 * (unit(seed) - 0.5), 0.5});
    }
  }
  return movers;
}

/// 1000 boxes of 0.4 m turning together, as in a drum.
std::vector<Mover> drum() {
  std::vector<Mover> movers;
  for (int i = 0; i < 1000; ++i) {
    const double x = 0.42 * (i % 32 - 16);
    const double y = 0.42 * (i / 32 - 16);
    movers.push_back({x, y, -2 * y, 2 * x, 0.2});
  }
  return movers;
}

template <class S>
struct Frame {
  std::vector<BB<S>> boxes;
  std::vector<Vector<S>> velocities;
};

/// Sixty steps out and sixty back, so that no scene ever ends.
template <class S>
std::vector<Frame<S>> filmOf(const std::vector<Mover>& movers) {
  std::vector<Frame<S>> film(120);
  for (int step = 0; step < 120; ++step) {
    const double sign = step < 60 ? 1 : -1;
    const double t = (step < 60 ? step : 120 - step) / 60.0;
    for (const Mover& m : movers) {
      const double x = m.x + m.vx * t;
      const double y = m.y + m.vy * t;
      film[step].boxes.push_back({S(x - m.half), S(y - m.half), S(x + m.half), S(y + m.half)});
      film[step].velocities.push_back({S(sign * m.vx), S(sign * m.vy)});
    }
  }
  return film;
}

template <class S>
void step(benchmark::State& state, const std::vector<Mover>& movers) {
  const std::vector<Frame<S>> film = filmOf<S>(movers);
  BBTree<S> resting;
  BBTree<S> tree(nullptr, nullptr, &resting);
  resting.update(static_cast<IndexKey>(movers.size()), {S(-200), S(-1), S(200), S(0)});
  std::size_t at = 0;
  std::size_t placed = 0;
  std::size_t pairs = 0;
  const auto one = [&] {
    const Frame<S>& frame = film[at];
    for (IndexKey key = 0; key < frame.boxes.size(); ++key) {
      placed += tree.update(key, frame.boxes[key], frame.velocities[key]) ? 1 : 0;
    }
    tree.updatePairs();
    pairs += tree.pairs().size();
    at = (at + 1) % film.size();
  };
  for (int i = 0; i < 120; ++i) one();
  placed = pairs = 0;
  for (auto _ : state) one();
  const auto perStep = [](std::size_t n) {
    return benchmark::Counter(static_cast<double>(n), benchmark::Counter::kAvgIterations);
  };
  state.counters["placed"] = perStep(placed);
  state.counters["pairs"] = perStep(pairs);
  state.counters["height"] = tree.boxes().height();
}

template <class S>
void queries(benchmark::State& state) {
  const std::vector<Frame<S>> film = filmOf<S>(sparse());
  BBTree<S> tree;
  for (IndexKey key = 0; key < 10000; ++key) tree.update(key, film[0].boxes[key]);
  std::uint64_t seed = 3;
  std::vector<IndexKey> keys;
  const double length = static_cast<double>(state.range(0));
  for (auto _ : state) {
    const Vector<S> a(S(1000 * unit(seed)), S(1000 * unit(seed)));
    const double angle = 6.28318530717958648 * unit(seed);
    const Vector<S> b(a.x + S(length * std::cos(angle)), a.y + S(length * std::sin(angle)));
    if (length == 0) {
      tree.collectAt(a, keys);
    } else {
      tree.collectAlong(a, b, S(0), keys);
    }
    benchmark::DoNotOptimize(keys.data());
  }
}

template <class S>
void stepSparse(benchmark::State& state) {
  step<S>(state, sparse());
}
template <class S>
void stepPile(benchmark::State& state) {
  step<S>(state, pile());
}
template <class S>
void stepDrum(benchmark::State& state) {
  step<S>(state, drum());
}

template <class S>
void build(benchmark::State& state) {
  const std::vector<Frame<S>> film = filmOf<S>(sparse());
  for (auto _ : state) {
    BBTree<S> tree;
    for (IndexKey key = 0; key < 10000; ++key) tree.update(key, film[0].boxes[key]);
    benchmark::DoNotOptimize(tree.count());
  }
}

template <class S>
void rebuild(benchmark::State& state) {
  const std::vector<Frame<S>> film = filmOf<S>(sparse());
  BBTree<S> tree;
  for (IndexKey key = 0; key < 10000; ++key) tree.update(key, film[0].boxes[key]);
  for (auto _ : state) tree.rebuild();
}

BENCHMARK(stepSparse<double>)->Unit(benchmark::kMicrosecond);
BENCHMARK(stepSparse<Fixed>)->Unit(benchmark::kMicrosecond);
BENCHMARK(stepPile<double>)->Unit(benchmark::kMicrosecond);
BENCHMARK(stepPile<Fixed>)->Unit(benchmark::kMicrosecond);
BENCHMARK(stepDrum<double>)->Unit(benchmark::kMicrosecond);
BENCHMARK(stepDrum<Fixed>)->Unit(benchmark::kMicrosecond);
BENCHMARK(build<Fixed>)->Unit(benchmark::kMicrosecond);
BENCHMARK(rebuild<Fixed>)->Unit(benchmark::kMicrosecond);
BENCHMARK(queries<Fixed>)->Arg(0)->Arg(20)->Arg(200);

}  // namespace
}  // namespace samestep

BENCHMARK_MAIN();
