// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include <samestep/hash_tree.h>

#include "cli/program.h"

namespace samestep::program {

/// The tree of a recording of either scalar. The bytes must outlive it.
std::unique_ptr<HashTree> treeOf(std::span<const std::uint8_t> bytes, const Wirings& wirings);

/// Answers questions about a tree, a line each, until there are none: "children 7 2", "first 5 7 2" (the hash
/// of the first 5 children), "name 7 2", "value 7 2 1 3 0".
void answerQuestions(HashTree& tree, std::FILE* questions, std::FILE* answers);

/// A tree that a program answers for, which reads questions and writes answers as answerQuestions does.
class AnsweredTree : public HashTree {
 public:
  /// @param command  for the shell
  /// @throws Unusable where it cannot be started
  explicit AnsweredTree(const std::string& command);
  ~AnsweredTree() override;
  AnsweredTree(const AnsweredTree&) = delete;
  AnsweredTree& operator=(const AnsweredTree&) = delete;

  std::uint32_t children(const TreePath& path) override;
  std::uint64_t hashOfFirst(const TreePath& path, std::uint32_t count) override;
  std::string name(const TreePath& path) override;
  std::string value(const TreePath& path) override;

 private:
  std::string ask(const std::string& question, const TreePath& path);

  int process_ = 0;
  std::FILE* questions_ = nullptr;
  std::FILE* answers_ = nullptr;
};

}  // namespace samestep::program
