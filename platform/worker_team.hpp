#pragma once
// A small team of threads that wait awake, for loops of some ten microseconds, thousands of times a
// second.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace ballast {

/// Cores on which this process may run, at least 1.
int available_cores();

/// The caller is the first member; the others spin for a short while between two tasks, then sleep.
/// Each member has a contiguous range of the parts, the same in every task with as many parts, so
/// that data written in one task are in its core's cache in the next. When a member is late
/// (another program has its core), the caller does the parts that it has not begun. A part is the
/// same whichever thread does it.
class WorkerTeam {
 public:
  WorkerTeam() = default;
  ~WorkerTeam();
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;

  /// Sets the number of members, the caller included (>= 1); all of them work. Only between tasks.
  void resize(int threads);
  /// Sets who works from the next task on: all members, or the caller alone, as if there were no
  /// others. Only between tasks.
  void let_work(bool everybody) { size_ = everybody ? members_ : 1; }
  /// The number of members that work.
  int size() const { return size_; }

  using Call = void (*)(const void* context, int part);
  /// run_parts() for a team of several members that work.
  void run(int parts, Call call, const void* context);

 private:
  /// A round and a number that belongs to it, read and written as one: round * 2^24 + number. A
  /// late thread therefore cannot take a part of a round that is over. Round numbers do not wrap
  /// around: 2^40 of them take months.
  using PackedRound = std::uint64_t;
  static constexpr int number_bits = 24;
  /// The number of a member's parts that are taken, and in which round. It has a cache line of its
  /// own: nobody else touches it while its member is in time.
  struct alignas(64) Share {
    std::atomic<PackedRound> taken{0};
  };
  /// The caller's message to the others, on one cache line: the round with its number of parts, and
  /// the task.
  struct alignas(64) Task {
    std::atomic<PackedRound> round{0};
    Call call = nullptr;
    const void* context = nullptr;
  };

  void do_parts(int member, PackedRound round);
  void work(int member, PackedRound seen);
  void stop();

  std::vector<std::thread> workers_;
  int members_ = 1, size_ = 1;
  std::unique_ptr<Share[]> shares_;
  Task task_;
  alignas(64) std::atomic<int> left_{0};  // parts that are not done
  alignas(64) std::atomic<int> asleep_{0};
  std::atomic<std::uint32_t> bell_{0};  // sleeping members wait on it
  std::atomic<bool> ends_{false};       // a late member reads it while stop() sets it
};

/// Chooses between the whole team and the caller alone for work that recurs step by step. Where
/// cores are far from each other, or are two halves of one core, short work can be slower with the
/// whole team. Both are tried for some rounds; then the faster one is used until the next trial.
class TeamPace {
 public:
  /// Called before the work: sets who does it. Null: there is nobody but the caller.
  void begin(WorkerTeam* team) const {
    if (team) team->let_work(is_whole_);
  }
  /// Called after the work: its duration [s], and its amount in any unit.
  void took(double seconds, double amount = 1.0);
  bool is_whole() const { return is_whole_; }

 private:
  static constexpr int trial = 4;    ///< rounds by each; the first fills caches and is not counted
  static constexpr int apart = 120;  ///< rounds between two trials
  /// The team must take at most this share of the caller's time: a gain above the trial's noise.
  static constexpr double worth_it = 0.9;
  /// Work longer than this [s] is shared without a trial: sharing costs a small part of it.
  static constexpr double long_work = 0.02;

  bool is_whole_ = true;
  int round_ = 2 * trial + apart - 12;  ///< no trial in the first rounds, which are slow
  double whole_ = 0.0, alone_ = 0.0;    ///< least seconds of one unit in the trial
};

/// The number of members that work; without a team, 1: the caller.
inline int size_of(const WorkerTeam* team) { return team ? team->size() : 1; }

/// Calls task(part) for every part in [0, parts), each on one thread, and returns when all are
/// done. Null: the caller does them in order. `task` must not throw.
template <typename Task>
void run_parts(WorkerTeam* team, int parts, const Task& task) {
  if (size_of(team) > 1 && parts > 1)
    return team->run(
        parts, [](const void* context, int part) { (*static_cast<const Task*>(context))(part); },
        &task);
  for (int part = 0; part < parts; ++part) task(part);
}

/// Calls task(begin, end) for ranges of `together` numbers, the last one shorter, that cover [0,
/// count). They do not depend on who works. `beside`, if given, is called beside them, begun first.
template <typename Task, typename... Beside>
void run_ranges(WorkerTeam* team, int count, int together, const Task& task,
                const Beside&... beside) {
  constexpr int first = sizeof...(beside);  // the part of the first range
  static_assert(first <= 1);
  run_parts(team, first + (count + together - 1) / together, [&](int part) {
    if (part < first) return (beside(), ...);
    const int begin = (part - first) * together;
    task(begin, begin + std::min(together, count - begin));
  });
}

/// Calls task(i) for every i in [0, count), `together` of them a part. Calls must be independent.
template <typename Task>
void run_each(WorkerTeam* team, int count, int together, const Task& task) {
  run_ranges(team, count, together, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) task(i);
  });
}

}  // namespace ballast
