#include "platform/kept_memory.hpp"

#include <vector>

#include "tests/catch.hpp"
#include "tests/support/peak_memory.hpp"

using namespace ballast;

TEST_CASE("what was freed between what stays goes back to the system") {
  const long kilobytes = peak_memory([] {
    for (int round = 0; round < 2; ++round) {
      std::vector<std::vector<char>> blocks;
      for (int k = 0; k < 2000; ++k) blocks.emplace_back(10000, 'x');
      const std::vector<char> last(100, 'y');  // behind them all
      blocks.clear();
      give_memory_back();
      // it is not there for blocks that could never stand in its place
      const std::vector<char> large(15'000'000, 'z');
    }
  });
  CHECK(kilobytes < 25000);
}

TEST_CASE("what of the program only its start needed goes back, and comes again") {
  const long before = memory_entry("RssFile:");
  give_memory_back();
  CHECK(memory_entry("RssFile:") < before - 500);
  CHECK(memory_entry("VmRSS:") > 0);
}
