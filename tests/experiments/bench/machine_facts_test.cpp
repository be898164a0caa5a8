// What this machine can do: orders of magnitude that any machine has.

#include "experiments/bench/machine_facts.hpp"

#include <chrono>
#include <thread>

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("A machine reads, writes and multiplies at some rate") {
  const MachineFacts facts = measure_machine();
  // from a tenth of a slow laptop under load to ten times a fast server's core
  CHECK(facts.read_GB_s > 0.1);
  CHECK(facts.read_GB_s < 1e3);
  CHECK(facts.triad_GB_s > 0.1);
  CHECK(facts.triad_GB_s < 1e3);
  CHECK(facts.gflops > 0.1);
  CHECK(facts.gflops < 1e3);
  for (size_t k = 1; k < facts.caches.size(); ++k)
    CHECK(facts.caches[k].kilobytes >= facts.caches[k - 1].kilobytes);
  CHECK(read_bandwidth(1) > 0.1);  // never less than a few lines
}

TEST_CASE("The clock of CPU seconds runs while something is computed, and only then") {
  const double before = cpu_seconds();
  while (cpu_seconds() < before + 0.01) {
  }
  const double worked = cpu_seconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK(worked > before);
  CHECK(cpu_seconds() - worked < 0.04);
}
