// SPDX-License-Identifier: MIT
// A game whose check of claims tries what a verification has no need of. The claim "prying" holds where all
// of it is refused; "done" names, in its place, what was not.
#include <fcntl.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include <samestep/program.h>

namespace {

bool canConnect() {
  const int made = ::socket(AF_UNIX, SOCK_STREAM, 0);
  if (made >= 0) ::close(made);
  return made >= 0;
}

bool canWrite(const std::string& path) {
  const int open = ::open(path.c_str(), O_WRONLY | O_CREAT, 0600);
  if (open >= 0) ::close(open);
  return open >= 0 || ::mkdir((path + ".folder").c_str(), 0700) == 0;
}

bool canRemove(const std::string& path) { return ::unlink(path.c_str()) == 0; }

bool canFork() {
  const pid_t process = ::fork();
  if (process == 0) ::_exit(0);
  return process > 0;
}

bool canSignal() { return ::kill(::getppid(), 0) == 0; }

samestep::ClaimCheck checkClaim(const samestep::Space<samestep::Fixed>&, std::string_view key,
                                std::span<const std::uint8_t> value, void*) {
  if (key == "crash") ::abort();
  if (key == "hang") {
    while (true) ::pause();
  }
  if (key != "prying") return samestep::ClaimCheck::unknown;
  const std::string path(value.begin(), value.end());
  std::string done;
  if (canConnect()) done += " socket";
  if (canWrite(path + ".new")) done += " write";
  if (canRemove(path)) done += " remove";
  if (canFork()) done += " fork";
  if (canSignal()) done += " signal";
  if (done.empty()) return samestep::ClaimCheck::holds;
  std::fprintf(stderr, "prying:%s\n", done.c_str());
  return samestep::ClaimCheck::isFalse;
}

}  // namespace

int main(int argc, char** argv) {
  samestep::Wirings game;
  game.fixed.checkClaim = checkClaim;
  return samestep::runProgram(argc, argv, game);
}
