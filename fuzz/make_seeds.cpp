// SPDX-License-Identifier: MIT
// Writes the first inputs of the targets that read formats: worlds and recordings of the smaller scenes after
// some ticks, in both number types, into DIR/snapshot and DIR/recording.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <samestep/named_handlers.h>
#include <samestep/recorder.h>
#include <samestep/scene.h>
#include <samestep/snapshot.h>
#include <samestep/space_codec.h>

namespace {

using namespace samestep;
using Bytes = std::vector<std::uint8_t>;

constexpr const char* kScenes[] = {"example", "cradle", "filters", "handlers",  "incline",
                                   "stack",   "bounce", "scales",  "soft-stack"};
constexpr std::uint32_t kMostBodies = 24;
/// Bytes the targets are given, at most.
constexpr std::size_t kMostBytes = 4096;

void write(const std::filesystem::path& path, const Bytes& bytes) {
  if (bytes.size() > kMostBytes) return;
  std::filesystem::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

template <Scalar S>
void writeSeeds(const std::filesystem::path& folder, const std::string& name, std::uint8_t kind, int ticks) {
  const SceneSource source = SceneSource::find(name);
  Scene<S> scene(source);
  if (scene.space().bodyCount() > kMostBodies) return;
  const std::string file = name + "-" + std::to_string(ticks) + (kind != 0 ? "-double" : "-fixed");
  for (int i = 0; i < ticks; ++i) scene.step();

  Bytes world{kind};
  encodeWorld(scene.space().state(), world);
  write(folder / "snapshot" / file, world);

  // Bit 1 says that it is a whole one.
  Bytes snapshot(1 + static_cast<std::size_t>(saveSnapshot(scene.space(), {})));
  snapshot[0] = static_cast<std::uint8_t>(kind | 2);
  saveSnapshot(scene.space(), std::span(snapshot).subspan(1));
  write(folder / "snapshot" / (file + "-whole"), snapshot);
}

/// The next steps of a scene, with a command of each kind, keyframes, claims and notes.
template <Scalar S>
void writeRecording(const std::filesystem::path& path, const std::string& name, int ticks, bool packing) {
  Scene<S> scene(SceneSource::find(name));
  if (scene.space().bodyCount() > kMostBodies) return;
  for (int i = 0; i < ticks; ++i) scene.step();
  Bytes recording;
  Recorder<S> recorder(scene.space(), scene.timeStep(), recording, namedHandlerWiring<S>());
  recorder.setPacking(packing);
  // Recordings of five steps are small enough without.
  recorder.setKeyframes({ticks == 5 ? 0u : 3u, 1u << 20});
  recorder.note("scene", name);
  for (int i = 0; i < 6; ++i) {
    while (const Command<S>* command = scene.nextCommand()) recorder.apply(*command);
    if (i == 2) {
      Spawn<S> spawn{Body<S>(S(1), S(1)), {}};
      const BodyId body = recorder.apply(spawn);
      recorder.apply(ApplyImpulse<S>{body, {S(1), S(2)}, {S(0), S(1)}});
      recorder.apply(SetVelocity<S>{body, {S(1), S(0)}});
      recorder.apply(SetAngularVelocity<S>{body, S(1)});
      recorder.apply(SetPosition<S>{body, {S(50), S(50)}});
      recorder.apply(SetAngle<S>{body, S(2)});
      recorder.apply(ApplyForce<S>{body, {S(3), S(0)}, {}});
      recorder.apply(Remove{body});
    }
    recorder.step();
    if (i == 3) recorder.claim("samestep.bodies", namedClaim(scene.space(), "samestep.bodies"));
  }
  recorder.finish();
  write(path, recording);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: samestep_fuzz_seeds DIR\n", stderr);
    return 2;
  }
  for (const char* name : kScenes) {
    for (const int ticks : {0, 5, 30}) {
      writeSeeds<Fixed>(argv[1], name, 0, ticks);
      writeSeeds<double>(argv[1], name, 1, ticks);
      const std::filesystem::path path =
          std::filesystem::path(argv[1]) / "recording" / (name + ("-" + std::to_string(ticks)));
      writeRecording<Fixed>(path.string() + "-fixed", name, ticks, false);
      writeRecording<double>(path.string() + "-double", name, ticks, false);
      if (packingAvailable()) writeRecording<Fixed>(path.string() + "-packed", name, ticks, true);
    }
  }
  return 0;
}
