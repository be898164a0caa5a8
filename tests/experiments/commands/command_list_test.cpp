#include <set>
#include <sstream>
#include <string>

#include "experiments/commands/command.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("every row of the table adds the command of its name, with words of its own") {
  std::set<std::string> names, helps;
  for (const Command& command : commands()) {
    INFO(command.name);
    CHECK(names.insert(command.name).second);
    const char* arguments[] = {"ballast", command.name.c_str(), "--help"};
    std::ostringstream out, err;
    CHECK(ballast_main(3, arguments, out, err) == 0);
    CHECK(err.str().empty());
    CHECK_THAT(out.str(), Catch::Contains("ballast " + command.name + " "));
    CHECK(helps.insert(out.str().substr(0, out.str().find('\n'))).second);
  }
}
