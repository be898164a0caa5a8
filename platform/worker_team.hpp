#pragma once
// A few threads that wait close by: for loops of some ten microseconds, thousands of times a
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
/// Each member has parts of its own that follow each other, the same in every task of as many
/// parts, so that what it writes in one task is in its core's cache in the next. What one that
/// comes late (another program has its core) has not begun is done by the caller. Which thread does
/// a part makes no difference to it.
class WorkerTeam {
 public:
  WorkerTeam() = default;
  ~WorkerTeam();
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;

  /// `threads` >= 1, the caller among them: all of them work. Only between tasks.
  void resize(int threads);
  /// Who works from now on: everybody, or the caller alone, as if there were no others. Only
  /// between tasks.
  void let_work(bool everybody) { size_ = everybody ? members_ : 1; }
  /// Of those who work.
  int size() const { return size_; }

  /// task(part) for every part in [0, parts), each on one thread, and returns when all are done.
  /// `task` must not throw.
  template <typename Task>
  void run(int parts, const Task& task) {
    if (size_ == 1 || parts < 2) {
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
  int members_ = 1, size_ = 1;
  std::unique_ptr<Share[]> shares_;
  Task task_;
  alignas(64) std::atomic<int> left_{0};  // parts that are not done
  alignas(64) std::atomic<int> asleep_{0};
  std::atomic<std::uint32_t> bell_{0};  // what they sleep on
  std::atomic<bool> ends_{false};       // one who is late for a round reads it while stop() sets it
};

/// For work that comes again and again, step by step: is it done faster by the whole team, or by
/// the caller alone? Where cores are far from each other, or are two halves of one, short work can
/// be slower in company. Both are tried for some rounds, then the faster works until they are tried
/// anew.
class TeamPace {
 public:
  /// Before the work: calls who shall do it. Null: nobody but the caller is there.
  void begin(WorkerTeam* team) const {
    if (team) team->let_work(is_whole_);
  }
  /// After it: how long it took [s], and how much of it there was, in any unit.
  void took(double seconds, double amount = 1.0);
  bool is_whole() const { return is_whole_; }

 private:
  static constexpr int trial = 4;    ///< rounds by each; in the first one caches fill: not counted
  static constexpr int apart = 120;  ///< rounds between two trials
  /// Company has to gain this much, more than the trial's noise.
  static constexpr double worth_it = 0.9;
  /// Work of so many seconds is shared without a trial: what sharing costs is a small part of it.
  static constexpr double long_work = 0.02;

  bool is_whole_ = true;
  int round_ = 2 * trial + apart - 12;  ///< in the first rounds everything is slow: no trial
  double whole_ = 0.0, alone_ = 0.0;    ///< least seconds of one unit in the trial
};

/// Of no team the caller is the only member.
inline int size_of(const WorkerTeam* team) { return team ? team->size() : 1; }

/// By the team, or by the caller alone where there is none.
template <typename Task>
void run_parts(WorkerTeam* team, int parts, const Task& task) {
  if (team) return team->run(parts, task);
  for (int part = 0; part < parts; ++part) task(part);
}

/// task(begin, end) for ranges of `together` numbers, the last one shorter, that cover [0, count).
/// They are the same whoever works. Beside them, and begun first, is done each of `others`.
template <typename Task, typename... Others>
void run_ranges(WorkerTeam* team, int count, int together, const Task& task,
                const Others&... others) {
  constexpr int first = sizeof...(others);
  const int parts = first + (count + together - 1) / together;
  run_parts(team, parts, [&](int part) {
    // The others are spread over the parts, so that each stands first among a member's.
    int range = part;
    bool is_range = true;
    [[maybe_unused]] int other = 0;
    [[maybe_unused]] const auto meet = [&](const auto& task_beside) {
      const int place = other++ * parts / first;
      range -= place < part;
      if (place != part) return;
      is_range = false;
      task_beside();
    };
    (meet(others), ...);
    const int begin = range * together;
    if (is_range) task(begin, begin + std::min(together, count - begin));
  });
}

/// task(i) for every i in [0, count), so many together: for what each i has to itself.
template <typename Task>
void run_each(WorkerTeam* team, int count, int together, const Task& task) {
  run_ranges(team, count, together, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) task(i);
  });
}

}  // namespace ballast
