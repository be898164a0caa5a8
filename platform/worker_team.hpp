#pragma once
// A few threads that wait close by: for loops of some ten microseconds, thousands of times a
// second.

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace ballast {

/// Cores on which this process may run, at least 1.
int available_cores();

/// The caller is the first member; the others spin for a short while between two tasks, then sleep.
/// Each member has parts of its own; what one that comes late (another program has its core) has
/// not begun is done by the others. Which thread does a part makes no difference to it.
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
  /// A round and a number that belongs to it, read and written as one: round * 2^24 + number. So
  /// whoever comes late cannot take a part of a round that is over. Rounds never begin anew: 2^40
  /// of them take months.
  using Marked = std::uint64_t;
  static constexpr int number_bits = 24;
  /// How many of a member's parts are taken, and in which round. On a line of its own: nobody else
  /// touches it while its member is in time.
  struct alignas(64) Share {
    std::atomic<Marked> taken{0};
  };
  /// What the caller tells the others, on one line: the round with its number of parts, and the
  /// task.
  struct alignas(64) Task {
    std::atomic<Marked> round{0};
    Call call = nullptr;
    const void* context = nullptr;
  };

  void start(int parts, Call call, const void* context);
  void do_parts(int member, Marked round);
  void work(int member, Marked seen);
  void stop();

  std::vector<std::thread> workers_;
  int members_ = 1;
  std::unique_ptr<Share[]> shares_;
  Task task_;
  alignas(64) std::atomic<int> left_{0};  // parts that are not done
  alignas(64) std::atomic<int> asleep_{0};
  std::atomic<std::uint32_t> bell_{0};  // what they sleep on
  std::atomic<bool> ends_{false};       // one who is late for a round reads it while stop() sets it
};

/// Of no team the caller is the only member.
inline int size_of(const WorkerTeam* team) { return team ? team->size() : 1; }

/// By the team, or by the caller alone where there is none.
template <typename Task>
void run_parts(WorkerTeam* team, int parts, const Task& task) {
  if (team) return team->run(parts, task);
  for (int part = 0; part < parts; ++part) task(part);
}

}  // namespace ballast
