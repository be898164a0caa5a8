#include <stdexcept>

#include "experiments/external/external_program.hpp"
#include "problems/scene/scene.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
using Catch::Contains;

TEST_CASE("Programs are named on the command line and in lists") {
  const TemporaryFolder folder;
  const auto list = folder.write("list.toml",
                                 "[[external]]\nname = \"a\"\ncommand = \"a.py --fast=1\"\n"
                                 "[[external]]\nname = \"b\"\ncommand = \"b\"\nserve = true\n");
  const auto commands = external_commands({"c=python3 'x y.py' k=v", list.string()});
  REQUIRE(commands.size() == 3);
  CHECK(commands[0].name == "c");
  CHECK(commands[0].command == "python3 'x y.py' k=v");
  CHECK(commands[0].folder.empty());
  CHECK(commands[1].command == "a.py --fast=1");
  CHECK_FALSE(commands[1].is_served);
  CHECK(commands[1].folder == folder.path());
  CHECK(commands[2].is_served);
}

TEST_CASE("What is wrong with the words is said") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(external_commands({"solver"}), Contains("expected name=command"));
  CHECK_THROWS_WITH(external_commands({"x= "}), Contains("x: expected a command"));
  CHECK_THROWS_WITH(external_commands({"a/b=x"}), Contains("a name has letters"));
  CHECK_THROWS_WITH(external_commands({"a=x", "a=y"}), Contains("a: this name is there twice"));
  const auto empty = folder.write("empty.toml", "");
  CHECK_THROWS_WITH(external_commands({empty}), Contains("has no [[external]]"));
  const auto typo =
      folder.write("typo.toml", "[[external]]\nname = \"a\"\ncommand = \"b\"\nserved = true\n");
  CHECK_THROWS_AS(external_commands({typo}), SceneFileError);
}

TEST_CASE("An edited script has another key") {
  const TemporaryFolder folder;
  const auto script = folder.write("solver.py", "1");
  const ExternalCommand command{"a", "python3 '" + script.string() + "'", false, ""};
  const std::string before = key_of(command);
  CHECK(key_of(command) == before);
  folder.write("solver.py", "2");
  CHECK(key_of(command) != before);
}
