#include "platform/child_process.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// No child is left over, running or dead.
bool no_children() { return waitpid(-1, nullptr, WNOHANG) == -1; }

}  // namespace

TEST_CASE("an answer comes back whole, whatever its size") {
  for (const std::size_t size : {0u, 1u, 1000u, 1000000u}) {  // the last is longer than any pipe
    std::string expected;
    for (std::size_t i = 0; i < size; ++i) expected += static_cast<char>(i * i % 256);
    const ChildResult result = run_in_child(60.0, [&] { return expected; });
    REQUIRE(result.end == ChildEnd::complete);
    REQUIRE(result.answer == expected);
    CHECK(no_children());
  }
}

TEST_CASE("a child that ends without an answer has crashed, even with exit code 0") {
  const auto end_of = [](void (*work)()) {
    const ChildResult result = run_in_child(60.0, [&] {
      work();
      return std::string("never sent");
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
  const auto begin = std::chrono::steady_clock::now();
  const auto sleep_on = []() -> std::string {
    for (;;) pause();
  };
  const ChildResult result = run_in_child(0.1, sleep_on);
  CHECK(result.end == ChildEnd::out_of_time);
  CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() < 5.0);
  CHECK(no_children());
  CHECK(run_in_child(0.0, sleep_on).end == ChildEnd::out_of_time);
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
