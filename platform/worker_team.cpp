#include "platform/worker_team.hpp"

#include <algorithm>

#include "platform/clock.hpp"

namespace ballast {
namespace {

/// Pauses before the core is offered to others; some microseconds.
constexpr int spins = 100;
/// Then, between two looks at the clock of whoever waits.
constexpr int looks = 16;
/// Longer than the gap between two loops of a solve, shorter than the rest of a time step [s].
constexpr double wakeful = 3e-4;

inline void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Until `is_over()`; the core goes to others early, as one of them may be the one that is waited
/// for. False when it took longer than `most` seconds.
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
  if (threads == members_) return;
  stop();
  members_ = threads;
  shares_ = std::make_unique<Share[]>(static_cast<size_t>(threads));
  patience_ = TeamPatience();
  // Taken here, not by the thread: one that starts late must not miss the first round.
  const std::uint32_t seen = round_.load();
  for (int member = 1; member < threads; ++member)
    workers_.emplace_back([this, member, seen] { work(member, seen); });
}

void WorkerTeam::stop() {
  ends_ = true;
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (std::thread& worker : workers_) worker.join();
  workers_.clear();
  ends_ = false;
  members_ = 1;
}

void WorkerTeam::start(int parts, Call call, const void* context) {
  // A share's upper half is the number of the round, its lower half how many of the member's parts
  // are taken. A thread that is still in an earlier round finds another number there, and leaves.
  const std::uint32_t round = round_.load(std::memory_order_relaxed) + 1;
  // The shares come before all else of the new round. A thread may have read an earlier round's
  // share and then stop: it can take a part by it no more, even if it now finds the new `parts_`.
  for (int member = 0; member < members_; ++member)
    shares_[static_cast<size_t>(member)].taken.store(std::uint64_t{round} << 32,
                                                     std::memory_order_relaxed);
  parts_.store(parts, std::memory_order_release);
  call_ = call;
  context_ = context;
  left_.store(parts, std::memory_order_relaxed);
  round_.store(round, std::memory_order_release);
  round_.notify_all();
  // The caller's own parts, then those that the others have not begun.
  const Stopwatch watch;
  for (int member = 0; member < members_; ++member) do_parts(member, round);
  const auto is_done = [&] { return left_.load(std::memory_order_acquire) == 0; };
  if (wait_awake(watch.seconds() + TeamPatience::late, is_done)) return patience_.note(false);
  patience_.note(true);
  wait_awake(1e30, is_done);
}

/// Those of `member`'s parts that nobody has taken yet. False when the round is over.
bool WorkerTeam::do_parts(int member, std::uint32_t round) {
  std::atomic<std::uint64_t>& taken = shares_[static_cast<size_t>(member)].taken;
  while (true) {
    std::uint64_t now = taken.load(std::memory_order_acquire);
    if (now >> 32 != round) return false;
    // The member's parts are member, member + members, member + 2 members and so on:
    // the same parts whoever does them.
    const std::int64_t part = member + static_cast<std::int64_t>(now & 0xffffffffu) * members_;
    if (part >= parts_.load(std::memory_order_acquire)) return true;
    if (!taken.compare_exchange_weak(now, now + 1, std::memory_order_acq_rel)) continue;
    // As long as this part is not done the round goes on: its task is there.
    call_(context_, static_cast<int>(part));
    left_.fetch_sub(1, std::memory_order_release);
  }
}

void WorkerTeam::work(int member, std::uint32_t seen) {
  while (true) {
    // Awake for a short while, in which the next task usually comes; then asleep until it does.
    std::uint32_t now = seen;
    const auto has_come = [&] { return (now = round_.load(std::memory_order_acquire)) != seen; };
    if (!wait_awake(wakeful, has_come)) {
      round_.wait(seen, std::memory_order_acquire);
      continue;
    }
    seen = now;
    if (ends_) return;
    do_parts(member, now);
  }
}

}  // namespace ballast
