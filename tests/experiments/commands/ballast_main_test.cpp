// The program around its commands: what it does with a command line, and with every kind of
// failure.

#include <new>
#include <sstream>

#include "experiments/commands/command.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

struct Said {
  int code;
  std::string out, err;
};

Said said(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "ballast");
  std::ostringstream out, err;
  const int code = ballast_main(static_cast<int>(arguments.size()), arguments.data(), out, err);
  return {code, out.str(), err.str()};
}

}  // namespace

TEST_CASE("every kind of failure has its exit code and its line") {
  const auto outcome = [](const Action& action) {
    std::ostringstream err;
    const int code = static_cast<int>(perform(action, err));
    return std::to_string(code) + ' ' + err.str();
  };
  CHECK(outcome([] { return ExitCode::ok; }) == "0 ");
  CHECK(outcome([] { return ExitCode::time_limit; }) == "3 ");
  CHECK(outcome([]() -> ExitCode { throw UsageError("two\nlines\n"); }) ==
        "2 ballast: two lines\n");
  CHECK(outcome([]() -> ExitCode { throw Error("x"); }) == "1 ballast: x\n");
  CHECK(outcome([]() -> ExitCode { throw std::bad_alloc(); }) == "1 ballast: out of memory\n");
}

TEST_CASE("help names every command and every exit code") {
  const Said help = said({"--help"});
  CHECK(help.code == 0);
  CHECK(help.err.empty());
  for (const Command& command : commands())
    // a comma where it has an alias
    CHECK_THAT(help.out, Catch::Contains("\n  " + command.name + " ") ||
                             Catch::Contains("\n  " + command.name + ","));
  CHECK_THAT(help.out, Catch::Contains("4  the solver was built without the library it needs"));
}

TEST_CASE("a command line that asks for nothing, or for what there isn't, is exit code 2") {
  CHECK(said({}).code == 2);
  CHECK_THAT(said({}).err, Catch::StartsWith("ballast: a subcommand is required"));
  CHECK(said({"simulate"}).code == 2);
  CHECK_THAT(said({"simulate"}).err, Catch::EndsWith(" (ballast --help)\n"));
}
