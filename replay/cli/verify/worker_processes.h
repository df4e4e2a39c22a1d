// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/verify/verify_file.h"

namespace samestep::program {

/// Processes that verify files, each one at a time as it is told by a pipe, and answer by another. They can
/// do little else (confineThisProcess). One that takes far longer than it may is ended.
class WorkerProcesses {
 public:
  /// True if this system has processes.
  static bool available();

  WorkerProcesses(const std::vector<std::string>& files, const VerifyPlan& plan, std::size_t count,
                  std::uint64_t megabytes);
  ~WorkerProcesses();
  WorkerProcesses(const WorkerProcesses&) = delete;
  WorkerProcesses& operator=(const WorkerProcesses&) = delete;

  /// Calls `tell` with the place of each file in the list, in that order or as they come to an end.
  /// @throws Unusable where no process can be made
  void run(const std::function<void(std::size_t, const Said&)>& tell, bool inOrder);

 private:
  struct Worker {
    int process = 0;  ///< 0 for none.
    int orders = -1;
    int answers = -1;
    std::size_t file = 0;
    std::size_t files = 0;   ///< Number of files it was given.
    std::int64_t since = 0;  ///< Time when it was given this one, by milliseconds().
    std::string received;
  };

  void start(Worker& worker);
  [[noreturn]] void serve(int orders, int answers) const;
  void assign(Worker& worker);
  void receive(Worker& worker);
  void bury(Worker& worker);
  void close(Worker& worker);
  void endOverdue();
  void keep(std::size_t file, Said&& said);

  const std::vector<std::string>& files_;
  VerifyPlan plan_;
  std::uint64_t megabytes_;
  std::vector<Worker> workers_;
  std::vector<std::optional<Said>> said_;
  std::vector<std::size_t> ended_;  ///< Files in the order in which they came to an end.
  std::size_t next_ = 0;
};

}  // namespace samestep::program
