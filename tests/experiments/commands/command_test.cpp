// The program around its commands: what it does with a command line, and with every kind of
// failure.

#include <filesystem>
#include <iterator>
#include <new>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/commands/command.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"
#include "tests/catch.hpp"
#include "tests/support/program.hpp"

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
    CHECK_THAT(help.out, Catch::Contains("\n  " + command.name + " "));
  CHECK_THAT(help.out, Catch::Contains("4  the solver was built without the library it needs"));
}

TEST_CASE("a command line that asks for nothing, or for what there isn't, is exit code 2") {
  CHECK(said({}).code == 2);
  CHECK_THAT(said({}).err, Catch::StartsWith("ballast: a subcommand is required"));
  CHECK(said({"simulate"}).code == 2);
  CHECK_THAT(said({"simulate"}).err, Catch::EndsWith(" (ballast --help)\n"));
}

namespace {

/// What `path --help` prints, for "compare merge" and what else is given.
std::string help_of(const std::string& path) {
  std::istringstream words("ballast " + path + " --help");
  std::vector<std::string> list{std::istream_iterator<std::string>(words), {}};
  std::vector<const char*> arguments;
  for (const std::string& word : list) arguments.push_back(word.c_str());
  std::ostringstream out, err;
  CHECK(ballast_main(static_cast<int>(arguments.size()), arguments.data(), out, err) == 0);
  CHECK(err.str().empty());
  return out.str();
}

/// The paths of a command and all below it.
void add_paths(const std::string& path, const Command& command, std::vector<std::string>& paths) {
  paths.push_back(path);
  for (const Command& part : command.parts) add_paths(path + ' ' + part.name, part, paths);
}

}  // namespace

TEST_CASE("a command's help ends in its own text, and in no other's") {
  std::vector<std::string> paths;
  for (const Command& command : commands()) add_paths(command.name, command, paths);
  std::vector<std::string> texts{help_text("ballast")};
  for (const std::string& path : paths) texts.push_back(help_text(path));
  for (const std::string& path : paths) {
    INFO(path);
    const std::string help = help_of(path);
    for (const std::string& text : texts) {
      if (text.empty()) continue;
      INFO(text);
      CHECK((help.find(text) != std::string::npos) == (text == help_text(path)));
    }
  }
  CHECK_THAT(help_of("compare merge"), Catch::Contains("Times are divided\nwithin a machine"));
}

TEST_CASE("every row of the table adds the command of its name, with words of its own") {
  std::set<std::string> names, helps;
  for (const Command& command : commands()) {
    INFO(command.name);
    CHECK(names.insert(command.name).second);
    const std::string help = help_of(command.name);
    CHECK_THAT(help, Catch::Contains("ballast " + command.name + " "));
    CHECK(helps.insert(help.substr(0, help.find('\n'))).second);
  }
}

TEST_CASE("completions: bash offers commands, options and what can be listed") {
  const auto offered = [](const std::string& words) {
    const std::string program = std::filesystem::path(BALLAST_PROGRAM).parent_path().string();
    const ProgramResult result =
        run_program("bash",
                    {"--norc", "-c",
                     "PATH='" + program +
                         "':$PATH; eval \"$(ballast completions bash)\"; COMP_WORDS=(" + words +
                         "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _ballast; printf '%s\\n' "
                         "\"${COMPREPLY[@]}\""},
                    30.0);
    CHECK(result.errors.empty());
    return '\n' + result.output;
  };
  const std::string all = offered("ballast ''");
  for (const Command& command : commands())
    CHECK_THAT(all, Catch::Contains("\n" + command.name + "\n"));
  CHECK_THAT(offered("ballast run --o"), Catch::Contains("\n--output\n") &&
                                             Catch::Contains("\n--overwrite\n") &&
                                             !Catch::Contains("--set"));
  CHECK_THAT(offered("ballast run vibrated_box_s"), Catch::Contains("\nvibrated_box_small\n"));
  CHECK_THAT(offered("ballast bench st"), Catch::Contains("\nstep\n"));
  CHECK_THAT(offered("ballast compare --solvers nn"), Catch::Contains("\nnncg\n"));
  for (const char* shell : {"zsh", "fish"})
    CHECK_THAT(ballast_program({"completions", shell}).output,
               Catch::Contains("ballast completions words"));
  check_failure(ballast_program({"completions", "csh"}), ExitCode::usage, {"csh"});
}
