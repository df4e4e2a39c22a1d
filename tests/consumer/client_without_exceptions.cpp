// SPDX-License-Identifier: MIT
// A game built without exceptions, against a library built with them: the failure handler is asked first, be
// what fails in the library or in code of its headers that the game compiled itself.
#include <samestep/array.h>
#include <samestep/space.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

[[noreturn]] void tell(samestep::Fault, const char* text) {
  std::printf("told: %s\n", text);
  std::fflush(stdout);
  std::_Exit(0);
}

}  // namespace

int main(int argumentCount, char** arguments) {
  samestep::setFailureHandler(tell);
  const bool inHeader = argumentCount > 1 && std::strcmp(arguments[1], "header") == 0;
  if (inHeader) {
    samestep::Array<int> items;
    std::printf("%d\n", items[3]);
  } else {
    samestep::Space<samestep::Fixed> space;
    space.step(samestep::Fixed(-1));
  }
  std::puts("nobody was told");
  return 1;
}
