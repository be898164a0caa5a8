#include "platform/worker_team.hpp"

#include "platform/clock.hpp"

namespace ballast {
namespace {

/// The number of pauses before the core is offered to others; they take some microseconds.
constexpr int spins = 200;
/// The number of yields after that between two looks at the clock.
constexpr int looks = 16;
/// The time that a thread waits awake [s]: longer than the work of one thread between two phases of
/// a time step, because waking up takes longer than a short phase.
constexpr double wakeful = 2e-3;

inline void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Waits until `is_over()`. The core goes to others early, as the thread that is waited for may
/// need it. False when it took longer than `most` seconds.
template <class Over>
bool wait_awake(double most, const Over& is_over) {
  for (int spin = 0; spin < spins; ++spin) {
    if (is_over()) return true;
    pause();
  }
  const Stopwatch watch;
  for (long look = 1; !is_over(); ++look) {
    std::this_thread::yield();
    if (look % looks == 0 && watch.seconds() > most) return is_over();
  }
  return true;
}

}  // namespace

int available_cores() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

WorkerTeam::~WorkerTeam() { stop(); }

void WorkerTeam::resize(int threads) {
  threads = threads < 1 ? 1 : threads;
  size_ = threads;
  if (threads == members_) return;
  stop();
  members_ = size_ = threads;
  shares_ = std::make_unique<Share[]>(static_cast<size_t>(threads));
  // The round is read here, not by the thread: one that starts late must not miss the first round.
  const PackedRound seen = task_.round.load();
  for (int member = 1; member < threads; ++member)
    workers_.emplace_back([this, member, seen] { work(member, seen); });
}

void WorkerTeam::stop() {
  ends_ = true;
  const PackedRound round = task_.round.load(std::memory_order_relaxed) >> number_bits;
  task_.round.store((round + 1) << number_bits, std::memory_order_release);  // no parts
  bell_.fetch_add(1, std::memory_order_release);
  bell_.notify_all();
  for (std::thread& worker : workers_) worker.join();
  workers_.clear();
  ends_ = false;
  members_ = size_ = 1;
}

void WorkerTeam::run(int parts, Call call, const void* context) {
  const PackedRound number = (task_.round.load(std::memory_order_relaxed) >> number_bits) + 1;
  const PackedRound round = (number << number_bits) + static_cast<PackedRound>(parts);
  task_.call = call;
  task_.context = context;
  left_.store(parts, std::memory_order_relaxed);
  task_.round.store(round, std::memory_order_release);
  // A member that falls asleep at this moment may be missed: the caller does its parts.
  if (asleep_.load(std::memory_order_relaxed) > 0) {
    bell_.fetch_add(1, std::memory_order_release);
    bell_.notify_all();
  }
  // The caller does its own parts, then those that the others have not begun.
  for (int member = 0; member < members_; ++member) do_parts(member, round);
  wait_awake(1e30, [&] { return left_.load(std::memory_order_acquire) == 0; });
}

/// Does those of `member`'s parts that nobody has taken yet; they are the same whoever does them.
void WorkerTeam::do_parts(int member, PackedRound round) {
  const PackedRound number = round >> number_bits, parts = round % (PackedRound{1} << number_bits);
  const PackedRound members = static_cast<PackedRound>(members_),
                    begin = static_cast<PackedRound>(member) * parts / members,
                    end = (static_cast<PackedRound>(member) + 1) * parts / members;
  std::atomic<PackedRound>& taken = shares_[static_cast<size_t>(member)].taken;
  // The count is published once, at the end: the other cores may be far away.
  int done = 0;
  while (true) {
    PackedRound now = taken.load(std::memory_order_acquire);
    const PackedRound marked = now >> number_bits;
    if (marked > number) break;  // this round is over
    // A share that was last touched in an earlier round has all its parts left.
    const PackedRound count = marked == number ? now % (PackedRound{1} << number_bits) : 0;
    const PackedRound part = begin + count;
    if (part >= end) break;
    // The round goes on until this part is taken and done: the thread that takes it does so in this
    // round, and finds its task.
    if (!taken.compare_exchange_weak(now, (number << number_bits) + count + 1,
                                     std::memory_order_acq_rel))
      continue;
    task_.call(task_.context, static_cast<int>(part));
    ++done;
  }
  if (done > 0) left_.fetch_sub(done, std::memory_order_release);
}

void WorkerTeam::work(int member, PackedRound seen) {
  while (true) {
    // Waits awake for a short while, in which the next task usually comes; then sleeps.
    PackedRound now = seen;
    const auto has_come = [&] {
      return (now = task_.round.load(std::memory_order_acquire)) != seen;
    };
    if (!wait_awake(wakeful, has_come)) {
      const std::uint32_t rung = bell_.load(std::memory_order_acquire);
      asleep_.fetch_add(1);
      if (!has_come()) bell_.wait(rung, std::memory_order_acquire);
      asleep_.fetch_sub(1);
      continue;
    }
    seen = now;
    if (ends_) return;
    do_parts(member, now);
  }
}

void TeamPace::took(double seconds, double amount) {
  if (seconds > long_work) {
    // As after a trial won by the whole team: shorter rounds between long ones begin no trial.
    is_whole_ = true;
    whole_ = 0.0;
    round_ = 2 * trial;
    return;
  }
  const double unit = seconds / amount;
  const int place = round_ % trial;
  if (round_ < 2 * trial && place > 0) {
    double& least = is_whole_ ? whole_ : alone_;
    least = place == 1 ? unit : std::min(least, unit);
  }
  round_ = round_ + 1 < 2 * trial + apart ? round_ + 1 : 0;
  is_whole_ = round_ < trial || (round_ >= 2 * trial && whole_ <= worth_it * alone_);
}

}  // namespace ballast
