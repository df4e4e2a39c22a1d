// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace samestep::program {

/// Verdicts of a batch, a line each, in a file that is whole or not there. Until it is whole they stand in a
/// part beside it, PATH.MACHINE-PROCESS.part, from which another run of the batch goes on.
class VerdictFile {
 public:
  /// Takes the lines that earlier runs left, in the file and its parts.
  /// @throws Unusable where it cannot be written
  explicit VerdictFile(const std::string& path);
  ~VerdictFile();
  VerdictFile(const VerdictFile&) = delete;
  VerdictFile& operator=(const VerdictFile&) = delete;

  /// True if earlier runs left nothing.
  bool isEmpty() const { return lines_.empty(); }
  /// The line that an earlier run left for a file with these bytes under these options; empty for none. One
  /// that came of too little time or memory is none.
  std::string found(const std::string& file, std::uint64_t content, std::uint64_t asked,
                    std::uint32_t verifier) const;
  /// Adds a line, which has an end, so that it is there whatever becomes of this process.
  /// @throws Unusable
  void add(const std::string& line);
  /// Puts the file into place, on the disk, and removes parts that were taken in.
  /// @throws Unusable
  void finish();

 private:
  void take(const std::string& path);

  std::string path_;
  std::string own_;
  std::vector<std::string> parts_;
  std::map<std::string, std::string> lines_;  ///< By file and what was asked of it.
  std::FILE* stream_ = nullptr;
};

/// The XXH3-64 of a file's bytes, at most so many of them; 0 where it cannot be read.
std::uint64_t contentOf(const std::string& file, std::uint64_t most);

}  // namespace samestep::program
