// SPDX-License-Identifier: MIT
#include "cli/verify/verdict_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "cli/program.h"
#include "cli/verify/verdict_line.h"
#include "state/state_hash.h"

namespace samestep::program {
namespace {

namespace fs = std::filesystem;

/// Key of a file and what was asked of it; a name of a file has no byte 0.
std::string keyOf(const std::string& file, const std::string& content, const std::string& asked,
                  std::uint64_t verifier) {
  return file + std::string(1, '\0') + content + asked + std::to_string(verifier);
}

/// Beside a file, those that begin with its name and end as parts do, in order.
std::vector<std::string> partsBeside(const std::string& path) {
  std::vector<std::string> parts;
  const fs::path folder = fs::path(path).parent_path();
  const std::string begin = fs::path(path).filename().string() + ".";
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? fs::path(".") : folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(begin) && name.ends_with(".part")) parts.push_back(entry.path().string());
  }
  std::stable_sort(parts.begin(), parts.end());
  return parts;
}

std::string thisProcess() {
  char name[256] = {};
  if (::gethostname(name, sizeof name - 1) != 0) name[0] = 0;
  return std::string(name[0] == 0 ? "here" : name) + "-" + std::to_string(::getpid());
}

void toDisk(const std::string& path) {
  const int open = ::open(path.c_str(), O_RDONLY);
  if (open < 0) return;
  ::fsync(open);
  ::close(open);
}

}  // namespace

VerdictFile::VerdictFile(const std::string& path)
    : path_(path), own_(path + "." + thisProcess() + ".part"), parts_(partsBeside(path)) {
  take(path_);
  for (const std::string& part : parts_) take(part);
  stream_ = std::fopen(own_.c_str(), "wb");
  if (stream_ == nullptr) throw Unusable(path + ": cannot be written");
}

VerdictFile::~VerdictFile() {
  if (stream_ != nullptr) std::fclose(stream_);
}

void VerdictFile::take(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  for (std::string line; std::getline(stream, line);) {
    const auto read = readVerdictLine(line);
    // The last line of a part may have been cut.
    if (!read || !read->settled) continue;
    lines_[keyOf(read->file, read->content, read->asked, read->verifier)] = line + "\n";
  }
}

std::string VerdictFile::found(const std::string& file, std::uint64_t content, std::uint64_t asked,
                               std::uint32_t verifier) const {
  const auto line = lines_.find(keyOf(file, hex(content), hex(asked), verifier));
  return line == lines_.end() ? std::string() : line->second;
}

void VerdictFile::add(const std::string& line) {
  const bool written =
      std::fwrite(line.data(), 1, line.size(), stream_) == line.size() && std::fflush(stream_) == 0;
  if (!written) throw Unusable(path_ + ": cannot be written");
}

void VerdictFile::finish() {
  const bool written =
      std::fflush(stream_) == 0 && ::fsync(::fileno(stream_)) == 0 && std::fclose(stream_) == 0;
  stream_ = nullptr;
  if (!written) throw Unusable(path_ + ": cannot be written");
  std::error_code error;
  fs::rename(own_, path_, error);
  // Another run of the same batch may have been quicker, and have taken this part in.
  if (error && !fs::exists(path_)) throw Unusable(path_ + ": cannot be written: " + error.message());
  for (const std::string& part : parts_) std::remove(part.c_str());
  const fs::path folder = fs::path(path_).parent_path();
  toDisk(folder.empty() ? "." : folder.string());
}

std::uint64_t contentOf(const std::string& file, std::uint64_t most) {
  constexpr std::size_t kPiece = std::size_t{1} << 16;
  std::ifstream stream(file, std::ios::binary);
  if (!stream || fs::is_directory(file)) return 0;
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  std::vector<char> piece(kPiece);
  while (stream && most > 0) {
    stream.read(piece.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(kPiece, most)));
    const auto got = static_cast<std::size_t>(stream.gcount());
    XXH3_64bits_update(&state, piece.data(), got);
    most -= got;
  }
  return XXH3_64bits_digest(&state);
}

}  // namespace samestep::program
