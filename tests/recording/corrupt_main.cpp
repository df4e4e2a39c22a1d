// SPDX-License-Identifier: MIT
// Spoils recordings, as often as it is told to: corrupt_recordings [--count N] [--seed N] [--megabytes N]
// FILE... Exits with 1 where one of them is verified though it is another match, takes too long or too much
// memory; a crash names the number of the one that it came of.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include "support/corruptions.h"

namespace {

using samestep::Bytes;

std::uint64_t gNumber = 0;

/// Says at which number it ended; only what a handler may do.
extern "C" void tellNumber(int signal) {
  char text[64] = "ended at number ";
  std::size_t length = std::strlen(text);
  char digits[20];
  std::size_t count = 0;
  for (std::uint64_t left = gNumber; count == 0 || left > 0; left /= 10) {
    digits[count++] = static_cast<char>('0' + left % 10);
  }
  while (count > 0) text[length++] = digits[--count];
  text[length++] = '\n';
  if (::write(STDERR_FILENO, text, length) < 0) ::_exit(3);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

struct Options {
  std::uint64_t count = 1000000;
  std::uint64_t seed = 1;
  std::uint64_t megabytes = 512;
  std::vector<Bytes> files;
};

bool readOptions(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    std::uint64_t* number = word == "--count"       ? &options.count
                            : word == "--seed"      ? &options.seed
                            : word == "--megabytes" ? &options.megabytes
                                                    : nullptr;
    if (number != nullptr) {
      if (++i == argc) return false;
      *number = std::strtoull(argv[i], nullptr, 10);
      continue;
    }
    std::ifstream stream(word, std::ios::binary);
    if (!stream) return false;
    options.files.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return true;
}

template <class S>
std::uint64_t runAll(const Options& options, const char* name) {
  samestep::Corruptions<S> corruptions(options.seed);
  for (const Bytes& file : options.files) corruptions.addFile(file);
  std::uint64_t flaws = 0;
  // Half of them for each scalar.
  for (std::uint64_t number = 0; number < options.count / 2; ++number) {
    gNumber = number;
    // A step that hangs ends the program: five seconds are a thousand times what one takes.
    ::alarm(5);
    const std::string flaw = corruptions.run(number);
    if (flaw.empty()) continue;
    ++flaws;
    std::printf("%s, number %llu: %s\n", name, static_cast<unsigned long long>(number), flaw.c_str());
  }
  ::alarm(0);
  return flaws;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!readOptions(argc, argv, options)) {
    std::fprintf(stderr, "usage: corrupt_recordings [--count N] [--seed N] [--megabytes N] FILE...\n");
    return 2;
  }
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM})
    std::signal(signal, tellNumber);
#ifndef __SANITIZE_ADDRESS__
  rlimit limit{};
  limit.rlim_cur = limit.rlim_max = static_cast<rlim_t>(options.megabytes << 20);
  ::setrlimit(RLIMIT_AS, &limit);
#endif
  std::uint64_t flaws = runAll<samestep::Fixed>(options, "fixed");
#ifndef SAMESTEP_FIXED_ONLY
  flaws += runAll<double>(options, "double");
#endif
  std::printf("%llu spoilt recordings, seed %llu: %llu flaws\n",
              static_cast<unsigned long long>(options.count), static_cast<unsigned long long>(options.seed),
              static_cast<unsigned long long>(flaws));
  return flaws == 0 ? 0 : 1;
}
