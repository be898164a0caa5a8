#pragma once
// The commands of the ballast program as data: which words each takes, where their values go, the
// text of --help, and the action. command.cpp reads a command line by these tables, with CLI11.

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "platform/error.hpp"

namespace CLI {
class Option;
}

namespace ballast {

/// The action of a parsed command line. Throws on failure; the exception's what() is the message.
using Action = std::function<ExitCode()>;

/// The command line itself is wrong, in a way that only the command can detect: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A condition on a word besides its type. A word that breaks it gives exit code 2.
using Rule = std::function<void(CLI::Option&)>;
extern const Rule required;
Rule between(double low, double high);  ///< both included; NaN is beyond all bounds
Rule above(double low);
Rule at_least(double low);
Rule excludes(const std::string& other);  ///< `other` stands further up
Rule needs(const std::string& other);

/// A text that `use` converts before the command acts, whether given or the default. An exception
/// from `use` is reported with the word's name.
struct TextParser {
  std::string text;
  std::function<void(const std::string&)> use;
};
/// value = parser(text); `text` is the default.
template <class Value, class Parser>
TextParser into(Value& value, Parser parser, std::string text = {}) {
  return {std::move(text), [&value, parser](const std::string& given) { value = parser(given); }};
}

/// One argument or option.
struct Word {
  using Value = std::variant<std::string*, std::filesystem::path*, double*, int*, bool*,
                             std::vector<std::string>*, std::vector<int>*, TextParser>;

  template <class... Rules>
  Word(std::string name_, Value value_, std::string meaning_, const Rules&... rules_)
      : name(std::move(name_)),
        value(std::move(value_)),
        meaning(std::move(meaning_)),
        rules{rules_...} {}

  /// "scene": an argument, known by its place. "--output DIR": an option, with the name of its
  /// value in --help.
  std::string name;
  /// Keeps the value; its initial content is the default. A bool is a switch, which "--no-..."
  /// turns off. A list of texts takes all values that come, a list of numbers has commas between
  /// them.
  Value value;
  std::string meaning;
  std::vector<Rule> rules;
};

/// One command of the program.
struct Command {
  std::string name, meaning;
  std::vector<Word> words;
  /// Keeps alive the object that the values of `words` point into.
  Action act;
  /// Its subcommands, one of which must be named where there is no `act`.
  std::vector<Command> parts = {};
};

/// All commands, in the order of --help, with defaults. A new one is its function and a row there.
std::vector<Command> commands();

/// The text of --help after the options of the command `path` ("ballast", "run", "compare merge"):
/// help/run.txt, help/compare_merge.txt, without the last line end; empty where there is no file.
std::string help_text(std::string path);

/// The whole program: parses, acts, and turns every failure into one line "ballast: ..." on `err`
/// and an exit code.
int ballast_main(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

/// Carries out an action. An exception becomes its line on `err` and its exit code: UsageError 2,
/// MissingSolver 4, everything else 1.
ExitCode perform(const Action& action, std::ostream& err);

/// The command line of this process, as a shell reads it.
std::string own_command();

}  // namespace ballast
