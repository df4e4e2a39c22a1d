// SPDX-License-Identifier: MIT
#include "cli/program.h"

#ifdef SAMESTEP_TRANSPORT

#include <memory>

#include "loopback/relay_process.h"

namespace samestep::program {

void addRelay(CLI::App& app, int& result) {
  CLI::App* word =
      app.add_subcommand("relay", "Pass the packets of a match on between its players, over UDP");
  auto options = std::make_shared<loopback::RelayOptions>();
  word->add_option("--port", options->port, "Where it listens; 0: any that is free")->capture_default_str();
  word->add_option("--word", options->word, "The secret of the players and this relay")
      ->required()
      ->check(CLI::Validator([](std::string& text) { return text.empty() ? "It is empty." : ""; }, "TEXT"));
  word->add_option("--seconds", options->seconds, "End after so long; 0: never")->capture_default_str();
  word->add_option("--tell-every", options->tellEvery,
                   "Seconds between two lines about what it does; 0: none")
      ->capture_default_str();
  word->callback([options, &result] {
    loopback::runRelay(*options);
    result = kGood;
  });
}

}  // namespace samestep::program

#else

namespace samestep::program {

void addRelay(CLI::App&, int&) {}

}  // namespace samestep::program

#endif
