// The man page: troff that no line of ours can break.

#include <set>
#include <sstream>

#include "experiments/commands/shell_words.hpp"
#include "tests/catch.hpp"

using namespace ballast;
using Catch::Matchers::Contains;

TEST_CASE("every request in the man page is one that was meant") {
  const std::set<std::string> known{".TH", ".SH", ".SS", ".TP", ".PP",
                                    ".B",  ".BR", ".I",  ".nf", ".fi"};
  std::istringstream lines(man_page());
  int open = 0;
  for (std::string line; std::getline(lines, line);) {
    INFO(line);
    if (line.starts_with(".")) CHECK(known.contains(line.substr(0, line.find(' '))));
    CHECK_FALSE(line.starts_with("'"));
    open += line == ".nf" ? 1 : line == ".fi" ? -1 : 0;
    CHECK((open == 0 || open == 1));
  }
  CHECK(open == 0);
  CHECK_THAT(man_page(), Contains(".SS ballast bench step\n") && Contains("\nExit codes:\n"));
}
