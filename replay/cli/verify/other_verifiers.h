// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "cli/verify/verify_file.h"

namespace samestep::program {

/// Programs of other simulation revisions, which judge the recordings of theirs: DIR/samestep-REVISION each.
class OtherVerifiers {
 public:
  /// @param folder   empty for none
  /// @param options  words that those programs are given, too
  OtherVerifiers(std::string folder, std::vector<std::string> options)
      : folder_(std::move(folder)), options_(std::move(options)) {}

  /// Revision of a recording that is another's, if there is a program for it; else 0.
  std::uint32_t revisionFor(const std::string& file) const;
  /// Has the program of a revision verify files, and calls `tell` with the place of each in the list. Of
  /// those that it says nothing about, the verdict is unusable, and not settled.
  /// @throws Unusable where it cannot be run
  void verify(std::uint32_t revision, const std::vector<std::string>& files, const VerifyPlan& plan,
              const std::function<void(std::size_t, const Said&)>& tell) const;

 private:
  std::string programFor(std::uint32_t revision) const;

  std::string folder_;
  std::vector<std::string> options_;
};

}  // namespace samestep::program
