// Completions: what a shell offers, asked of the shell itself where it is there.

#include "experiments/commands/shell_words.hpp"

#include "experiments/commands/command.hpp"
#include "platform/program.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
using Catch::Matchers::Contains;

namespace {

/// What bash offers for the last of `words`, in lines.
std::string offered_by_bash(const std::vector<std::string>& words) {
  const TemporaryFolder folder;
  const std::string script = folder.write("ballast", completions("bash")).string();
  std::string list;
  for (const std::string& word : words) list += ' ' + shell_word(word);
  const std::string command = "bash --norc -c '. " + script + "; COMP_WORDS=(" + list +
                              "); COMP_CWORD=" + std::to_string(words.size() - 1) +
                              "; _ballast; printf \"%s\\n\" \"${COMPREPLY[@]}\"'";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe);
  std::string text = "\n";
  for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) text += static_cast<char>(c);
  CHECK(pclose(pipe) == 0);
  return text;
}

/// Every command of the table, subcommands too.
void visit(const std::vector<Command>& list, const std::function<void(const Command&)>& f) {
  for (const Command& command : list) {
    f(command);
    visit(command.parts, f);
  }
}

}  // namespace

TEST_CASE("bash offers commands, options and what can be listed") {
  const std::string all = offered_by_bash({"ballast", ""});
  for (const Command& command : commands()) CHECK_THAT(all, Contains("\n" + command.name + "\n"));
  const std::string run = offered_by_bash({"ballast", "run", "--o"});
  CHECK_THAT(run, Contains("\n--output\n") && Contains("\n--overwrite\n") && !Contains("--set"));
  CHECK_THAT(offered_by_bash({"ballast", "run", "vibrated_box_s"}),
             Contains("\nvibrated_box_small\n"));
  CHECK_THAT(offered_by_bash({"ballast", "bench", "st"}), Contains("\nstep\n"));
  CHECK_THAT(offered_by_bash({"ballast", "compare", "--solvers", "nn"}), Contains("\nnncg\n"));
}

TEST_CASE("every command and option is in every script and in the man page") {
  const std::string bash = completions("bash"), zsh = completions("zsh"),
                    fish = completions("fish"), man = man_page();
  visit(commands(), [&](const Command& command) {
    INFO(command.name);
    CHECK_THAT(fish, Contains(" -a " + command.name + " "));
    CHECK_THAT(zsh, Contains("'" + command.name + "':"));
    for (const Word& word : command.words) {
      const std::string name = option_name(word);
      if (!name.starts_with("--")) continue;
      INFO(name);
      CHECK_THAT(bash, Contains(name));
      CHECK_THAT(zsh, Contains("'" + name + "':"));
      CHECK_THAT(fish, Contains(" -l " + name.substr(2) + " "));
      std::string dashed;
      for (const char c : name) dashed += c == '-' ? std::string("\\-") : std::string(1, c);
      CHECK_THAT(man, Contains(".B " + dashed));
    }
  });
  CHECK_THROWS_AS(completions("csh"), std::invalid_argument);
}
