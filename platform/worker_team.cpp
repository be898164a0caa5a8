#include "platform/worker_team.hpp"

namespace ballast {
namespace {

/// Some hundred microseconds: longer than the gap between two loops of a solve, shorter than the
/// rest of a time step.
constexpr int spins = 10000;

inline void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

WorkerTeam::~WorkerTeam() { stop(); }

void WorkerTeam::resize(int threads) {
  threads = threads < 1 ? 1 : threads;
  if (threads == members_) return;
  stop();
  members_ = threads;
  // Taken here, not by the thread: one that starts late must not miss the first round.
  const unsigned seen = round_.load();
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
  parts_ = parts;
  call_ = call;
  context_ = context;
  busy_.store(members_ - 1, std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (int part = 0; part < parts; part += members_) call(context, part);
  // The others are about to end: spin, but let go of the core if one of them waits for it.
  for (int spin = 0; busy_.load(std::memory_order_acquire) > 0; ++spin) {
    if (spin < spins)
      pause();
    else
      std::this_thread::yield();
  }
}

void WorkerTeam::work(int member, unsigned seen) {
  while (true) {
    // Spin for a short while, in which the next task usually comes; then sleep until it does.
    unsigned now = seen;
    for (int spin = 0; spin < spins && (now = round_.load(std::memory_order_acquire)) == seen;
         ++spin)
      pause();
    if (now == seen) {
      round_.wait(seen, std::memory_order_acquire);
      continue;
    }
    seen = now;
    if (ends_) return;
    for (int part = member; part < parts_; part += members_) call_(context_, part);
    busy_.fetch_sub(1, std::memory_order_release);
  }
}

}  // namespace ballast
