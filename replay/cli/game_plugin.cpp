// SPDX-License-Identifier: MIT
#include <samestep/game_plugin.h>

#if __has_include(<dlfcn.h>) && !defined(__EMSCRIPTEN__) && !defined(__wasi__)
#define SAMESTEP_PLUGINS
#include <dlfcn.h>
#endif

#include "cli/program.h"

namespace samestep::program {

#ifdef SAMESTEP_PLUGINS
namespace {

const char* sentence(int answer) {
  switch (static_cast<GameAnswer>(answer)) {
    case GameAnswer::ready:
      return "";
    case GameAnswer::otherInterface:
      return "it speaks another plug-in interface than this program";
    case GameAnswer::otherRevision:
      return "it was built for another simulation revision than this program's";
    case GameAnswer::otherBuild:
      return "it was compiled otherwise than this program: by other headers, compiler or scalars";
  }
  return "it refuses this program";
}

}  // namespace

void loadGame(const std::string& path, Wirings& wirings) {
  // A name alone would be looked for in the system's folders.
  const std::string place = path.find('/') == std::string::npos ? "./" + path : path;
  void* library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* reason = ::dlerror();
    throw Unusable("--game " + path + ": cannot be loaded: " + (reason == nullptr ? "" : reason));
  }
  const auto entry = reinterpret_cast<int (*)(GamePlugin*)>(::dlsym(library, "samestep_game"));
  if (entry == nullptr) throw Unusable("--game " + path + ": has no function samestep_game");
  GamePlugin question;
  question.interface = kGamePluginInterface;
  question.revision = kSimulationRevision;
  question.build = gamePluginBuild();
  question.wirings = &wirings;
  const int answer = entry(&question);
  // It stays loaded: the wirings are its functions.
  if (answer != 0) throw Unusable("--game " + path + ": " + sentence(answer));
}

#else

void loadGame(const std::string& path, Wirings&) {
  throw Unusable("--game " + path + ": this system has no plug-ins");
}

#endif

void addGameOption(CLI::App& word, Wirings& wirings) {
  word.add_option_function<std::string>(
      "--game", [&wirings](const std::string& path) { loadGame(path, wirings); },
      "A game's library with its callbacks, inputs and claims, whose code is run; see "
      "samestep/game_plugin.h");
}

}  // namespace samestep::program
