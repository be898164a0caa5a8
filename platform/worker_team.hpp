#pragma once
// A few threads that wait close by: for loops of some ten microseconds, thousands of times a
// second.

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "platform/team_patience.hpp"

namespace ballast {

/// Cores on which this process may run, at least 1.
int available_cores();

/// The caller is the first member; the others spin for a short while between two tasks, then sleep.
/// Each member has parts of its own; what one that comes late (another program has its core) has
/// not begun is done by the others, and where members are late again and again the caller works
/// alone for a while (TeamPatience). Which thread does a part makes no difference to it.
class WorkerTeam {
 public:
  WorkerTeam() = default;
  ~WorkerTeam();
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;

  /// `threads` >= 1, the caller among them. Only between tasks.
  void resize(int threads);
  int size() const { return members_; }

  /// task(part) for every part in [0, parts), each on one thread, and returns when all are done.
  /// `task` must not throw.
  template <typename Task>
  void run(int parts, const Task& task) {
    if (members_ == 1 || parts < 2 || patience_.works_alone()) {
      for (int part = 0; part < parts; ++part) task(part);
      return;
    }
    start(
        parts, [](const void* context, int part) { (*static_cast<const Task*>(context))(part); },
        &task);
  }

 private:
  using Call = void (*)(const void*, int);
  /// How many of a member's parts have been taken in which round: round * 2^32 + count. One number,
  /// so that whoever comes late cannot take a part of a round that is over.
  struct alignas(64) Share {
    std::atomic<std::uint64_t> taken{0};
  };

  void start(int parts, Call call, const void* context);
  bool do_parts(int member, std::uint32_t round);
  void work(int member, std::uint32_t seen);
  void stop();

  std::vector<std::thread> workers_;
  int members_ = 1;
  std::unique_ptr<Share[]> shares_;
  std::atomic<std::uint32_t> round_{0};
  std::atomic<int> left_{0};  // parts that are not done
  std::atomic<int> parts_{0};
  std::atomic<bool> ends_{false};  // one who is late for a round reads it while stop() sets it
  Call call_ = nullptr;
  const void* context_ = nullptr;
  TeamPatience patience_;
};

/// By the team, or by the caller alone where there is none.
template <typename Task>
void run_parts(WorkerTeam* team, int parts, const Task& task) {
  if (team) return team->run(parts, task);
  for (int part = 0; part < parts; ++part) task(part);
}

}  // namespace ballast
