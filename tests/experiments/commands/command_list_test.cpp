#include <CLI/CLI.hpp>

#include <set>
#include <string>

#include "experiments/commands/command.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("every row of the table adds the one command of its name, with words and an example") {
  std::set<std::string> names;
  for (const Command& command : commands()) {
    INFO(command.name);
    CHECK(names.insert(command.name).second);
    CLI::App program;
    Action action;
    command.add(program, action);
    const auto added = program.get_subcommands([](const CLI::App*) { return true; });
    REQUIRE(added.size() == 1);
    CHECK(added[0]->get_name() == command.name);
    CHECK(added[0]->get_description().size() > 10);
    CHECK_FALSE(action);  // only parsing sets it
  }
}
