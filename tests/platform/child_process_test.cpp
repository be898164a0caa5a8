#include "platform/child_process.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

/// No child is left over, running or dead.
bool no_children() { return waitpid(-1, nullptr, WNOHANG) == -1; }

int status_of(ChildProcess& child) {
  while (!child.has_ended()) usleep(1000);
  return child.status();
}

}  // namespace

TEST_CASE("an answer comes back whole, whatever its size") {
  for (const std::size_t size : {0u, 1u, 1000u, 8000000u}) {  // the last is longer than any pipe
    const auto byte = [](std::size_t i) { return static_cast<char>(i * 7 % 251); };
    const ChildResult result = run_in_child(60.0, [&] {
      std::string answer(size, '\0');
      for (std::size_t i = 0; i < size; ++i) answer[i] = byte(i);
      return answer;
    });
    REQUIRE(result.end == ChildEnd::complete);
    REQUIRE(result.answer.size() == size);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < size; ++i) wrong += result.answer[i] != byte(i);
    CHECK(wrong == 0);
    CHECK(no_children());
  }
}

TEST_CASE("a child that ends without an answer has crashed, even with exit code 0") {
  const auto end_of = [](void (*work)()) {
    const ChildResult result = run_in_child(60.0, [&] {
      work();
      return std::string("lost");
    });
    CHECK(result.answer.empty());
    CHECK(no_children());
    return result.end;
  };
  CHECK(end_of([] { _exit(0); }) == ChildEnd::crashed);
  CHECK(end_of([] { raise(SIGKILL); }) == ChildEnd::crashed);
  CHECK(end_of([] { throw std::runtime_error("lost"); }) == ChildEnd::crashed);
}

TEST_CASE("a child that takes too long is killed") {
  const Stopwatch watch;
  const auto wait_for_ever = []() -> std::string {
    for (;;) pause();
  };
  CHECK(run_in_child(0.1, wait_for_ever).end == ChildEnd::out_of_time);
  CHECK(watch.seconds() < 5.0);
  CHECK(no_children());
  CHECK(run_in_child(0.0, wait_for_ever).end == ChildEnd::out_of_time);
  CHECK(no_children());
}

TEST_CASE("what the parent has is not touched, and the child prints nowhere") {
  int here = 1;
  const ChildResult result = run_in_child(60.0, [&] {
    std::puts("child_process_test: this line must not be seen");
    std::fflush(stdout);
    return std::to_string(++here);
  });
  REQUIRE(result.end == ChildEnd::complete);
  CHECK(result.answer == "2");
  CHECK(here == 1);
}

TEST_CASE("the status of a child is its exit code, or its signal") {
  ChildProcess five([] { _exit(5); }), returns([] {}), throws([] { throw 1; }),
      killed([] { raise(SIGTERM); });
  CHECK(status_of(five) == 5);
  CHECK(status_of(returns) == 1);
  CHECK(status_of(throws) == 1);
  CHECK(status_of(killed) == 128 + SIGTERM);
  CHECK(five.has_ended());  // asked again
  CHECK(five.status() == 5);
  CHECK(no_children());
}

TEST_CASE("a child ends with its object") {
  {
    ChildProcess child([] {
      for (;;) pause();
    });
    CHECK_FALSE(child.has_ended());
  }
  CHECK(no_children());
}

TEST_CASE("signals reach a child as if nobody had caught them here") {
  signal(SIGTERM, SIG_IGN);
  ChildProcess child([] {
    for (;;) pause();
  });
  usleep(20000);
  child.send(SIGTERM);
  CHECK(status_of(child) == 128 + SIGTERM);
  signal(SIGTERM, SIG_DFL);
}

TEST_CASE("a child dies with the process that made it") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "grandchild";
  {
    ChildProcess parent([&] {
      ChildProcess grandchild([&] {
        std::ofstream(file.string() + ".new") << getpid() << '\n';
        std::filesystem::rename(file.string() + ".new", file);
        for (;;) pause();
      });
      for (;;) pause();
    });
    const Stopwatch watch;
    while (!std::filesystem::exists(file) && watch.seconds() < 30.0) usleep(1000);
    REQUIRE(std::filesystem::exists(file));
  }
  const pid_t grandchild = std::atoi(read_whole_file(file).c_str());
  REQUIRE(grandchild > 0);
  // It belongs to init now, which may take a while to wait for it.
  const auto is_alive = [&] {
    std::ifstream stat("/proc/" + std::to_string(grandchild) + "/stat");
    std::string word, state;
    stat >> word >> word >> state;
    return stat && state != "Z";
  };
  const Stopwatch watch;
  while (is_alive() && watch.seconds() < 10.0) usleep(1000);
  CHECK_FALSE(is_alive());
}

TEST_CASE("a child knows that it may be lost") {
  CHECK_FALSE(is_expendable_process());
  const ChildResult result =
      run_in_child(60.0, [] { return std::string(is_expendable_process() ? "yes" : "no"); });
  CHECK(result.answer == "yes");
  CHECK_FALSE(is_expendable_process());
}
