#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/commands/command.hpp"
#include "tests/catch.hpp"

using namespace ballast;

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
  CHECK_THAT(help_of("compare merge"), Catch::Contains("any web host serves; it opens"));
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
