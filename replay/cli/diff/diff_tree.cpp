// SPDX-License-Identifier: MIT
#include "cli/diff/diff_tree.h"

#include <charconv>
#include <sstream>

#if (defined(__unix__) && !defined(__EMSCRIPTEN__) && !defined(__wasi__)) || defined(__APPLE__)
#define SAMESTEP_PROCESSES
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#endif

namespace samestep::program {
namespace {

/// Lines longer than any answer are none.
constexpr std::size_t kMostLine = 4096;

bool readLine(std::FILE* stream, std::string& line) {
  line.clear();
  for (int c = std::fgetc(stream); c != EOF && line.size() < kMostLine; c = std::fgetc(stream)) {
    if (c == '\n') return true;
    line += static_cast<char>(c);
  }
  return false;
}

}  // namespace

std::unique_ptr<HashTree> treeOf(std::span<const std::uint8_t> bytes, const Wirings& wirings) {
  std::unique_ptr<HashTree> tree;
  withScalarOf(recordingInfo(bytes).scalar, [&](auto scalar) {
    using S = decltype(scalar);
    if constexpr (std::is_same_v<S, Fixed> || std::is_same_v<S, double>) {
      tree = std::make_unique<RecordingTree<S>>(bytes, wiringOf<S>(wirings));
    }
    return kGood;
  });
  return tree;
}

void answerQuestions(HashTree& tree, std::FILE* questions, std::FILE* answers) {
  for (std::string line; readLine(questions, line);) {
    std::istringstream words(line);
    std::string question;
    std::uint32_t count = 0;
    words >> question;
    if (question == "first") words >> count;
    TreePath path;
    for (std::uint32_t number = 0; words >> number && path.size() < 6;) path.push_back(number);
    std::string answer;
    if (question == "children") answer = std::to_string(tree.children(path));
    if (question == "first") answer = hex(tree.hashOfFirst(path, count));
    if (question == "name") answer = tree.name(path);
    if (question == "value") answer = tree.value(path);
    std::fprintf(answers, "%s\n", answer.c_str());
    std::fflush(answers);
  }
}

#ifdef SAMESTEP_PROCESSES

AnsweredTree::AnsweredTree(const std::string& command) {
  int questions[2];
  int answers[2];
  if (::pipe(questions) != 0 || ::pipe(answers) != 0) throw Unusable("no more pipes");
  ::signal(SIGPIPE, SIG_IGN);
  std::fflush(stdout);
  const pid_t process = ::fork();
  if (process < 0) throw Unusable("no more processes");
  if (process == 0) {
    ::dup2(questions[0], STDIN_FILENO);
    ::dup2(answers[1], STDOUT_FILENO);
    for (const int end : {questions[0], questions[1], answers[0], answers[1]}) ::close(end);
    ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  ::close(questions[0]);
  ::close(answers[1]);
  process_ = process;
  questions_ = ::fdopen(questions[1], "wb");
  answers_ = ::fdopen(answers[0], "rb");
}

AnsweredTree::~AnsweredTree() {
  std::fclose(questions_);
  std::fclose(answers_);
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
}

#else

AnsweredTree::AnsweredTree(const std::string& command) {
  throw Unusable(command + ": this system has no processes");
}
AnsweredTree::~AnsweredTree() = default;

#endif

std::string AnsweredTree::ask(const std::string& question, const TreePath& path) {
  std::string line = question;
  for (const std::uint32_t number : path) line += " " + std::to_string(number);
  std::fprintf(questions_, "%s\n", line.c_str());
  std::fflush(questions_);
  std::string answer;
  if (!readLine(answers_, answer)) throw Unusable("the other side says nothing to \"" + line + "\"");
  return answer;
}

std::uint32_t AnsweredTree::children(const TreePath& path) {
  const std::string answer = ask("children", path);
  std::uint32_t count = 0;
  const auto [end, error] = std::from_chars(answer.data(), answer.data() + answer.size(), count);
  if (error != std::errc() || end == answer.data()) {
    throw Unusable("the other side answers no number: " + printable(answer));
  }
  return count;
}

std::uint64_t AnsweredTree::hashOfFirst(const TreePath& path, std::uint32_t count) {
  const std::string answer = ask("first " + std::to_string(count), path);
  std::uint64_t hash = 0;
  const auto [end, error] = std::from_chars(answer.data(), answer.data() + answer.size(), hash, 16);
  if (error != std::errc() || end == answer.data()) {
    throw Unusable("the other side answers no hash: " + printable(answer));
  }
  return hash;
}

std::string AnsweredTree::name(const TreePath& path) { return ask("name", path); }
std::string AnsweredTree::value(const TreePath& path) { return ask("value", path); }

}  // namespace samestep::program
