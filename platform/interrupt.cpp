#include "platform/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace ballast {
namespace {

std::atomic<bool> interrupted{false};
static_assert(
    std::atomic<bool>::is_always_lock_free);  // the only kind that a signal handler may touch

extern "C" void on_signal(int signal) {
  interrupted = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  interrupted = false;
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool InterruptGuard::requested() { return interrupted; }

}  // namespace ballast
