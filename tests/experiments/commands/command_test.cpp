// The program around its commands: how it handles a command line and every kind of failure.

#include <iterator>
#include <new>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/commands/command.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "solvers/solver_list.hpp"
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
    CHECK_THAT(help.out, Catch::Contains("\n  " + command.name + " "));
  CHECK_THAT(help.out, Catch::Contains("4  the solver was built without the library it needs"));
}

TEST_CASE("a command line that asks for nothing, or for what there isn't, is exit code 2") {
  CHECK(said({}).code == 2);
  CHECK_THAT(said({}).err, Catch::StartsWith("ballast: A subcommand is required"));
  CHECK(said({"simulate"}).code == 2);
  CHECK_THAT(said({"simulate"}).err, Catch::EndsWith(" (ballast --help)\n"));
  CHECK_THAT(said({"rn"}).err, Catch::StartsWith("ballast: no command 'rn'"));
  CHECK(said({"bench", "kernels", "--only"}).err ==
        "ballast: kernels: no option --only (ballast bench kernels --help)\n");
}

namespace {

/// The output of `path --help`; `path` is for instance "compare merge".
std::string help_of(const std::string& path) {
  std::istringstream words(path + " --help");
  const std::vector<std::string> list{std::istream_iterator<std::string>(words), {}};
  std::vector<const char*> arguments;
  for (const std::string& word : list) arguments.push_back(word.c_str());
  const Said help = said(arguments);
  CHECK((help.code == 0 && help.err.empty()));
  return help.out;
}

/// Appends the path of a command and the paths of all commands below it.
void add_paths(const std::string& path, const Command& command, std::vector<std::string>& paths) {
  paths.push_back(path);
  for (const Command& part : command.parts) add_paths(path + ' ' + part.name, part, paths);
}

}  // namespace

TEST_CASE("a command's help ends in its own text, and in no other's") {
  std::vector<std::string> paths;
  std::set<std::string> meanings;
  for (const Command& command : commands()) {
    add_paths(command.name, command, paths);
    CHECK(meanings.insert(command.meaning).second);
    CHECK_THAT(help_of(command.name), Catch::Contains("ballast " + command.name + " "));
  }
  std::vector<std::string> texts{help_text("ballast")};
  for (const std::string& path : paths) texts.push_back(help_text(path));
  for (const std::string& text : texts) {  // the solvers in the examples exist
    std::istringstream words(text);
    for (std::string word, before; words >> word; before = word)
      if ((before == "--solver" || before == "--solvers") && word != "all")
        for (const std::string& name : split(word, ',')) CHECK_NOTHROW(find_solver(name));
  }
  for (const std::string& path : paths) {
    INFO(path);
    const std::string help = help_of(path);
    for (const std::string& text : texts) {
      if (text.empty()) continue;
      INFO(text);
      CHECK((help.find(text) != std::string::npos) == (text == help_text(path)));
    }
  }
  CHECK_THAT(help_of("compare merge"), Catch::Contains("times of one machine are\ndivided"));
}
