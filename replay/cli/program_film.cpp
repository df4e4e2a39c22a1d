// SPDX-License-Identifier: MIT
#include <cstdio>
#include <filesystem>

#include <samestep/film.h>

#include "cli/program.h"

namespace samestep::program {
namespace {

struct Options {
  std::string recording;
  std::string other;
  std::string output;
  FilmOptions film;
  std::uint32_t follow = 0;
  std::uint64_t kilobytes = 8192;
};

/// Player whose recording names its file where it cannot be used.
template <Scalar S>
class Opened {
 public:
  Opened(const std::string& file, const Wirings& wirings, Progress& progress)
      : bytes_(readRecording(file)), player_(bytes_, wiringOf<S>(wirings), optionsFor(progress)) {}
  Player<S>& player() { return player_; }

 private:
  static PlayerOptions optionsFor(Progress& progress) {
    PlayerOptions options;
    options.data = &progress;
    options.progress = [](std::uint64_t tick, std::uint64_t target, void* data) {
      static_cast<Progress*>(data)->at(tick, target);
      return true;
    };
    return options;
  }

  std::vector<std::uint8_t> bytes_;
  Player<S> player_;
};

std::string nameOfPicture(std::uint32_t picture) {
  std::string digits = std::to_string(picture);
  digits.insert(0, 6 - std::min<std::size_t>(digits.size(), 6), '0');
  return digits + ".svg";
}

/// A page that shows the pictures of its folder one after the other.
std::string page(std::uint32_t pictures, std::int64_t milliseconds) {
  return "<!doctype html>\n<meta charset=\"utf-8\">\n<title>samestep film</title>\n"
         "<img id=\"picture\" src=\"000000.svg\" style=\"max-width:100%;max-height:90vh\"><br>\n"
         "<input id=\"at\" type=\"range\" min=\"0\" max=\"" +
         std::to_string(pictures - 1) +
         "\" value=\"0\" style=\"width:100%\">\n<script>\n"
         "const at = document.getElementById('at'), picture = document.getElementById('picture');\n"
         "const show = () => { picture.src = at.value.padStart(6, '0') + '.svg'; };\n"
         "let plays = setInterval(() => { at.value = (Number(at.value) + 1) % " +
         std::to_string(pictures) + "; show(); }, " + std::to_string(milliseconds) +
         ");\n"
         "at.oninput = () => { clearInterval(plays); show(); };\n</script>\n";
}

template <Scalar S>
void writeFolder(const Options& options, const Film<S>& film, S timeStep) {
  std::error_code error;
  std::filesystem::create_directories(options.output, error);
  for (std::uint32_t picture = 0; picture < film.pictures(); ++picture) {
    writeFile(options.output + "/" + nameOfPicture(picture), film.still(picture, options.recording));
  }
  const S each = timeStep * S(static_cast<int>(std::min<std::uint64_t>(film.stride(), 1u << 20))) * S(1000);
  writeFile(options.output + "/index.html", page(film.pictures(), std::max(static_cast<int>(each), 1)));
}

template <Scalar S>
void tell(const Options& options, const Film<S>& film, std::uint64_t bytes) {
  std::printf("%s: ticks %llu to %llu of %s, %u pictures, each %llu ticks after the last",
              options.output.c_str(), static_cast<unsigned long long>(film.tickOf(0)),
              static_cast<unsigned long long>(film.tickOf(film.pictures() - 1)), options.recording.c_str(),
              static_cast<unsigned>(film.pictures()), static_cast<unsigned long long>(film.stride()));
  if (bytes > 0) std::printf(", %llu bytes", static_cast<unsigned long long>(bytes));
  std::printf("\n");
  if (options.other.empty()) return;
  if (!film.difference()) {
    std::printf("the worlds are the same in it\n");
    return;
  }
  std::printf("the worlds differ from tick %llu on",
              static_cast<unsigned long long>(film.difference()->tick));
  if (film.difference()->body) {
    std::printf("; body %u is marked, dashed as it is in %s", static_cast<unsigned>(*film.difference()->body),
                options.other.c_str());
  }
  std::printf("\n");
}

template <Scalar S>
int run(const Options& options, const Wirings& wirings) {
  Progress progress("film", 0);
  const auto open = [&](const std::string& file) {
    try {
      return std::make_unique<Opened<S>>(file, wirings, progress);
    } catch (const FormatError& error) {
      throw Unusable(file + ": offset " + std::to_string(error.offset()) + ": " + error.what());
    }
  };
  const auto first = open(options.recording);
  const auto second = options.other.empty() ? nullptr : open(options.other);
  Film<S> film(first->player(), second ? &second->player() : nullptr, options.film);
  progress.clear();
  std::uint64_t bytes = 0;
  if (options.output.ends_with(".svg")) {
    const std::string text = film.svg(options.recording + (second ? " · " + options.other : ""));
    bytes = text.size();
    writeFile(options.output, text);
  } else {
    writeFolder(options, film, first->player().timeStep());
  }
  tell(options, film, bytes);
  return film.difference() ? kMismatch : kGood;
}

int film(const Options& options, const Wirings& wirings) {
  if (options.output.ends_with(".svg")) checkWritable(options.output);
  const ScalarKind scalar = recordingInfo(readRecording(options.recording)).scalar;
  if (!options.other.empty() && recordingInfo(readRecording(options.other)).scalar != scalar) {
    throw Unusable("one is recorded with fixed, the other with double");
  }
  return withScalarOf(scalar, [&](auto number) { return run<decltype(number)>(options, wirings); });
}

}  // namespace

void addFilm(CLI::App& app, Wirings& wirings, int& result) {
  CLI::App* word = app.add_subcommand("film", "Make a film of a recording, which a browser plays");
  auto options = std::make_shared<Options>();
  word->add_option("FILE", options->recording, "A recording")->required();
  word->add_option(
      "OTHER", options->other,
      "Another one: the first body that is not the same in both is marked, dashed as it is here");
  word->add_option("-o,--output", options->output,
                   "FILE.svg, an animated picture; or a folder for pictures and a page that plays them")
      ->required();
  word->add_option("--from", options->film.from, "The tick that it begins at");
  word->add_option("--to", options->film.to, "The tick that it ends at, if the recording does not before");
  word->add_option("--follow", options->follow, "The index of a body that the picture goes along with");
  word->add_option("--rate", options->film.rate, "Pictures for a second of the match, at most")
      ->check(CLI::Range(1u, 240u))
      ->capture_default_str();
  word->add_option("--max-kilobytes", options->kilobytes,
                   "Where the animated picture would be larger, it has fewer pictures a second")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 22))
      ->capture_default_str();
  addGameOption(*word, wirings);
  word->callback([options, word, &wirings, &result] {
    if (word->count("--follow") > 0) options->film.follow = options->follow;
    options->film.bytes = options->kilobytes << 10;
    result = film(*options, wirings);
  });
}

}  // namespace samestep::program
