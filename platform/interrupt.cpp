#include "platform/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace ballast {
namespace {

std::atomic<bool> interrupted{false};
// The only kind that a signal handler may touch.
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_signal(int signal) {
  interrupted = true;
  // Whoever asks twice does not want to wait for a checkpoint.
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
