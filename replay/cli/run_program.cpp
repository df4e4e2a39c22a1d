// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <functional>

#include <samestep/error.h>
#include <samestep/fingerprint.h>
#include <samestep/program.h>
#include <samestep/space.h>
#include <samestep/version.h>

#include "cli/program.h"
#include "cli/suggest.h"

namespace {

/// Fingerprints that two players compare before a match.
std::string fingerprints() {
  using namespace samestep;
  std::string text = "fingerprint fixed " + program::hex(fingerprint<Fixed>());
#ifndef SAMESTEP_FIXED_ONLY
  text += "\nfingerprint double " + program::hex(fingerprint<double>());
#endif
  return text;
}

std::string versionText() {
  using namespace samestep;
  return "samestep " + std::string(version()) + "\nsimulation revision " +
         std::to_string(kSimulationRevision) + "\nscalars " + std::string(builtScalars()) + "\ncompiler " +
         std::string(compiler()) + "\n" + fingerprints();
}

}  // namespace

int samestep::runProgram(int argc, char** argv, const Wirings& wirings) {
  using namespace samestep::program;
  CLI::App app(
      "Samestep: 2D physics that gives the same bits on every machine.\n"
      "Runs scenes, records them, checks recordings and finds where two of them part.\n"
      "Exit code: 0 all good, 1 something differs, 2 unusable arguments or files.",
      "samestep");
  app.set_version_flag("--version", std::function<std::string()>(versionText));
  app.require_subcommand(1);
  app.set_help_all_flag("--help-all", "Show the help of all subcommands");
  int result = kGood;
  Wirings chosen = wirings;
  addScenes(app, result);
  addHash(app, result);
  addRecord(app, result);
  addVerify(app, chosen, result);
  addShards(app, result);
  addMerge(app, result);
  addInfo(app, result);
  addDiff(app, chosen, result);
  addAnswer(app, chosen, result);
  addDraw(app, chosen, result);
  addFilm(app, chosen, result);
  addChart(app, result);
  addEnvelope(app, result);
  addTune(app, result);
  addNetsim(app, result);
  addMatch(app, result);
  addView(app, result);
  addRelay(app, result);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    const std::string suggested =
        suggestion(app, {argv + 1, static_cast<std::size_t>(std::max(argc - 1, 0))});
    if (suggested.empty()) {
      app.exit(error);
    } else {
      std::fprintf(stderr, "samestep: %s\n", suggested.c_str());
    }
    return kUnusable;
  } catch (const std::exception& error) {
    std::fflush(stdout);
    std::fprintf(stderr, "samestep: %s\n", error.what());
    return kUnusable;
  }
  if (std::fflush(stdout) != 0) {
    std::fprintf(stderr, "samestep: cannot write the output\n");
    return kUnusable;
  }
  return result;
}
