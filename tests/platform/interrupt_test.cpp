#include "platform/interrupt.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include "platform/program.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("a signal is kept for whoever asks, and a new guard begins without one") {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) {
    const InterruptGuard guard;
    CHECK_FALSE(InterruptGuard::requested());
    raise(number);
    CHECK(InterruptGuard::requested());
  }
  const InterruptGuard guard;
  CHECK_FALSE(InterruptGuard::requested());
}

TEST_CASE("a guard within another's life leaves it what it was asked for") {
  const InterruptGuard outer;
  raise(SIGTERM);
  {
    const InterruptGuard inner;
    CHECK(InterruptGuard::requested());
  }
  CHECK(InterruptGuard::requested());
  raise(SIGHUP);  // the signal is still caught
}

namespace {

/// The end of a process that does `work`: 128 + signal, or its exit code.
template <typename Work>
int end_of(const Work& work) {
  ChildProcess child([&] {
    work();
    _exit(0);
  });
  child.ends_within(60.0);
  return child.status();
}

}  // namespace

TEST_CASE("the second signal of a kind ends the program, and so does one without a guard") {
  CHECK(end_of([] {
          const InterruptGuard guard;
          raise(SIGINT);
          raise(SIGTERM);
        }) == 0);
  CHECK(end_of([] {
          const InterruptGuard guard;
          raise(SIGINT);
          raise(SIGINT);
        }) == 128 + SIGINT);
  CHECK(end_of([] {
          { const InterruptGuard guard; }
          raise(SIGTERM);
        }) == 128 + SIGTERM);
}

TEST_CASE("a warning may come twice, nohup is respected, and who stops reading ends nothing") {
  CHECK(end_of([] {
          const InterruptGuard guard;
          for (const int number : {SIGUSR1, SIGUSR1, SIGHUP, SIGHUP, SIGPIPE}) raise(number);
          _exit(InterruptGuard::requested() ? 3 : 4);
        }) == 3);
  CHECK(end_of([] {
          signal(SIGHUP, SIG_IGN);
          {
            const InterruptGuard guard;
            raise(SIGHUP);
            if (InterruptGuard::requested()) _exit(4);
          }
          raise(SIGHUP);
        }) == 0);
  CHECK(end_of([] {
          signal(SIGPIPE, SIG_IGN);
          { const InterruptGuard guard; }
          raise(SIGPIPE);
        }) == 0);
}

TEST_CASE("with closed standard streams, no file gets their number") {
  const auto first_number = [](std::initializer_list<int> closed) {
    return end_of([&] {
      for (const int stream : closed) close(stream);
      prepare_standard_streams();
      const int opened = open("/dev/null", O_RDONLY);
      // Output is dropped without an error.
      _exit(write(STDOUT_FILENO, "x", 1) == 1 && write(STDERR_FILENO, "x", 1) == 1 ? opened : 99);
    });
  };
  CHECK(first_number({1}) > 2);
  CHECK(first_number({2}) > 2);
  CHECK(first_number({0, 1, 2}) > 2);
  CHECK(first_number({0, 2}) > 2);
}

TEST_CASE("a file over the limit is an error, not a death") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "file").string();
  CHECK(end_of([&] {
          prepare_standard_streams();
          const rlimit small{4, 4};
          setrlimit(RLIMIT_FSIZE, &small);
          const int opened = open(file.c_str(), O_WRONLY | O_CREAT, 0600);
          if (write(opened, "12345678", 8) != 4) _exit(2);  // writes as much as fits
          _exit(write(opened, "5678", 4) < 0 && errno == EFBIG ? 0 : 1);
        }) == 0);
}
