#pragma once
// A few threads that wait close by: for loops of some ten microseconds, thousands of times a
// second.

#include <atomic>
#include <thread>
#include <vector>

namespace ballast {

/// The caller is the first member; the others spin for a short while between two tasks, then sleep.
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
    if (members_ == 1 || parts < 2) {
      for (int part = 0; part < parts; ++part) task(part);
      return;
    }
    start(
        parts, [](const void* context, int part) { (*static_cast<const Task*>(context))(part); },
        &task);
  }

 private:
  using Call = void (*)(const void*, int);
  void start(int parts, Call call, const void* context);
  void work(int member, unsigned seen);
  void stop();

  std::vector<std::thread> workers_;
  int members_ = 1;
  std::atomic<unsigned> round_{0};
  std::atomic<int> busy_{0};
  bool ends_ = false;
  int parts_ = 0;
  Call call_ = nullptr;
  const void* context_ = nullptr;
};

/// By the team, or by the caller alone where there is none.
template <typename Task>
void run_parts(WorkerTeam* team, int parts, const Task& task) {
  if (team) return team->run(parts, task);
  for (int part = 0; part < parts; ++part) task(part);
}

}  // namespace ballast
