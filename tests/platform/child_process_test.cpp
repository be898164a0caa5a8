#include "platform/child_process.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// No child is left over, running or dead.
bool no_children() { return waitpid(-1, nullptr, WNOHANG) == -1; }

}  // namespace

TEST_CASE("a record comes back whole, whatever its size") {
  for (const std::size_t size : {0u, 1u, 1000u, 1000000u}) {  // the last is longer than any pipe
    const ChildResult result = run_in_child(60.0, [&](std::vector<double>& record) {
      record.resize(size);
      for (std::size_t i = 0; i < size; ++i) record[i] = 0.1 * static_cast<double>(i);
    });
    REQUIRE(result.end == ChildEnd::complete);
    REQUIRE(result.record.size() == size);
    for (std::size_t i = 0; i < size; ++i)
      REQUIRE(result.record[i] == 0.1 * static_cast<double>(i));
    CHECK(no_children());
  }
}

TEST_CASE("a child that ends without a record has crashed, even with exit code 0") {
  const auto end_of = [](void (*work)()) {
    const ChildResult result = run_in_child(60.0, [&](std::vector<double>& record) {
      record.push_back(1.0);
      work();
    });
    CHECK(result.record.empty());
    CHECK(no_children());
    return result.end;
  };
  CHECK(end_of([] { _exit(0); }) == ChildEnd::crashed);
  CHECK(end_of([] { raise(SIGKILL); }) == ChildEnd::crashed);
  CHECK(end_of([] { throw std::runtime_error("lost"); }) == ChildEnd::crashed);
}

TEST_CASE("a child that takes too long is killed") {
  const auto begin = std::chrono::steady_clock::now();
  const ChildResult result = run_in_child(0.1, [](std::vector<double>&) {
    for (;;) pause();
  });
  CHECK(result.end == ChildEnd::out_of_time);
  CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() < 5.0);
  CHECK(no_children());
  CHECK(run_in_child(0.0, [](std::vector<double>&) { pause(); }).end == ChildEnd::out_of_time);
}

TEST_CASE("what the parent has is not touched, and the child prints nowhere") {
  int here = 1;
  const ChildResult result = run_in_child(60.0, [&](std::vector<double>& record) {
    std::puts("child_process_test: this line must not be seen");
    std::fflush(stdout);
    record.push_back(++here);
  });
  REQUIRE(result.end == ChildEnd::complete);
  CHECK(result.record[0] == 2.0);
  CHECK(here == 1);
}
