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

/// Processes that verify files, each one at a time as it is told by a pipe, and answer by another.
class WorkerProcesses {
 public:
  /// True if this system has processes.
  static bool available();

  WorkerProcesses(const std::vector<std::string>& files, const VerifyPlan& plan, std::size_t count,
                  std::uint64_t megabytes);
  ~WorkerProcesses();
  WorkerProcesses(const WorkerProcesses&) = delete;
  WorkerProcesses& operator=(const WorkerProcesses&) = delete;

  /// Calls `tell` for each file, in their order.
  /// @throws Unusable where no process can be made
  void run(const std::function<void(const Said&)>& tell);

 private:
  struct Worker {
    int process = 0;  ///< 0 for none.
    int orders = -1;
    int answers = -1;
    std::size_t file = 0;
    std::string received;
  };

  void start(Worker& worker);
  [[noreturn]] void serve(int orders, int answers) const;
  void assign(Worker& worker);
  void receive(Worker& worker);
  void bury(Worker& worker);
  void close(Worker& worker);

  const std::vector<std::string>& files_;
  VerifyPlan plan_;
  std::uint64_t megabytes_;
  std::vector<Worker> workers_;
  std::vector<std::optional<Said>> said_;
  std::size_t next_ = 0;
};

}  // namespace samestep::program
