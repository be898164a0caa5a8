#include "experiments/run_page/report_origin.hpp"

#include "tests/catch.hpp"

namespace ballast {
namespace {

TEST_CASE("words for a shell") {
  CHECK(shell_word("drive.frequency=5") == "drive.frequency=5");
  CHECK(shell_word("a b") == "'a b'");
  CHECK(shell_word("it's $HOME") == "'it'\\''s $HOME'");
  CHECK(shell_word("") == "''");
}

}  // namespace
}  // namespace ballast
