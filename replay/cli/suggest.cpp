// SPDX-License-Identifier: MIT
#include "cli/suggest.h"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <vector>

namespace samestep::program {
namespace {

/// Number of letters that must be put in, taken out or changed to make one word of the other (Levenshtein).
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

std::string sentence(const std::string& kind, const std::string& wrong,
                     const std::vector<std::string>& known) {
  std::string nearest;
  std::size_t least = wrong.size();
  std::string all;
  for (const std::string& word : known) {
    all += (all.empty() ? "" : ", ") + word;
    const std::size_t far = distance(wrong, word);
    if (far < least) {
      least = far;
      nearest = word;
    }
  }
  const bool near = least <= std::max<std::size_t>(1, wrong.size() / 3);
  return "no " + kind + " " + wrong + (near ? "; did you mean " + nearest + "?" : "; there are " + all);
}

std::vector<std::string> optionsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> wordsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* word : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(word->get_name());
  }
  return names;
}

bool isIn(const std::vector<std::string>& all, const std::string& word) {
  return std::find(all.begin(), all.end(), word) != all.end();
}

}  // namespace

std::string suggestion(const CLI::App& app, std::span<char* const> arguments) {
  const CLI::App* at = &app;
  for (const char* text : arguments) {
    const std::string argument(text);
    if (argument == "--") break;
    if (argument.starts_with("--")) {
      const std::string name = argument.substr(0, argument.find('='));
      const std::vector<std::string> known = optionsOf(*at);
      if (!isIn(known, name)) return sentence("option", name, known);
    } else if (at == &app && !argument.starts_with("-")) {
      const std::vector<std::string> known = wordsOf(app);
      if (!isIn(known, argument)) return sentence("word", argument, known);
      at = app.get_subcommand(argument);
    }
  }
  return {};
}

}  // namespace samestep::program
