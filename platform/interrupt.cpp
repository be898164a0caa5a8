#include "platform/interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <csignal>

namespace ballast {
namespace {

std::atomic<bool> interrupted{false};
// A signal handler may only touch an atomic that is lock-free.
static_assert(std::atomic<bool>::is_always_lock_free);

int guards = 0;                             // number of guards alive
void (*pipe_before)(int signal) = SIG_DFL;  // SIGPIPE's handler before the first guard

constexpr int caught[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1};

extern "C" void on_signal(int signal) {
  interrupted = true;
  // A user who asks twice does not want to wait for a checkpoint. A terminal that closes and a
  // batch system may send their signal several times without meaning that.
  if (signal == SIGINT || signal == SIGTERM) std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  if (guards++ > 0) return;
  interrupted = false;
  // A hang-up that was ignored before, as under nohup, stays ignored.
  for (const int signal : caught)
    if (std::signal(signal, on_signal) == SIG_IGN && signal == SIGHUP) std::signal(signal, SIG_IGN);
  pipe_before = std::signal(SIGPIPE, SIG_IGN);
}

InterruptGuard::~InterruptGuard() {
  if (--guards > 0) return;
  for (const int signal : caught)
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
  std::signal(SIGPIPE, pipe_before);
}

bool InterruptGuard::requested() { return interrupted; }

void prepare_standard_streams() {
  // open() takes the lowest free number: all numbers below are open by then.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1 && open("/dev/null", O_RDWR) != stream) break;
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace ballast
