#include "platform/kept_memory.hpp"

#include <vector>

#include "tests/catch.hpp"
#include "tests/support/peak_memory.hpp"

using namespace ballast;

TEST_CASE("what was freed between what stays goes back to the system") {
  const long kilobytes = peak_memory([] {
    std::vector<std::vector<char>> blocks;
    for (int k = 0; k < 2000; ++k) blocks.emplace_back(10000, 'x');
    for (size_t k = 0; k < blocks.size(); ++k)
      if (k % 50 != 0) blocks[k] = std::vector<char>();
    give_memory_back();
    // larger than every hole
    const std::vector<char> large(15'000'000, 'z');
  });
  CHECK(kilobytes < 28000);
}

TEST_CASE("what of the program only its start needed goes back, and comes again") {
  const long before = memory_entry("RssFile:");
  give_memory_back();
  CHECK(memory_entry("RssFile:") < before - 500);
  CHECK(memory_entry("VmRSS:") > 0);
}
