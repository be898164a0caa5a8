#pragma once
// The commands of the ballast program as data: which words each takes, where their values go, what
// --help says of them, and what is done then. command.cpp reads a command line by these tables,
// with CLI11.

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

/// What a parsed command line wants done. Throws on failure; the exception's what() is the message.
using Action = std::function<ExitCode()>;

/// The command line itself is wrong, in a way that only the command can see: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What holds of a word besides its type. What breaks a rule is exit code 2.
using Rule = std::function<void(CLI::Option&)>;
extern const Rule required;
Rule between(double low, double high);  ///< both included; NaN is beyond all bounds
Rule above(double low);
Rule at_least(double low);
Rule excludes(const std::string& other);  ///< words further up
Rule needs(const std::string& other);

/// A text of which something is made before the command acts, given or not. What `use` throws is
/// said with the word's name.
struct Parsed {
  std::string text;
  std::function<void(const std::string&)> use;
};
/// value = parser(text); `text` is the default.
template <class Value, class Parser>
Parsed into(Value& value, Parser parser, std::string text = {}) {
  return {std::move(text), [&value, parser](const std::string& given) { value = parser(given); }};
}

/// One argument or option.
struct Word {
  using Value = std::variant<std::string*, std::filesystem::path*, double*, int*, bool*,
                             std::vector<std::string>*, std::vector<int>*, Parsed>;

  template <class... Rules>
  Word(std::string name_, Value value_, std::string meaning_, const Rules&... rules_)
      : name(std::move(name_)),
        value(std::move(value_)),
        meaning(std::move(meaning_)),
        rules{rules_...} {}

  /// "scene": an argument, known by its place. "--output DIR": an option, and what --help calls its
  /// value.
  std::string name;
  /// Keeps the value; what is there before is the default. A bool is a switch, and "--no-..."
  /// switches off. A list of texts takes all that come, one of numbers has commas between them.
  Value value;
  std::string meaning;
  std::vector<Rule> rules;
};

/// One command of the program.
struct Command {
  std::string name, meaning;
  std::vector<Word> words;
  /// Keeps alive what the values of `words` are in.
  Action act;
  /// Its subcommands, one of which must be named where there is no `act`.
  std::vector<Command> parts = {};
};

/// All, in the order of --help, with their defaults. A new command is its function and a row there.
std::vector<Command> commands();

/// What --help says after the options of "ballast", "run" or "compare merge": help/run.txt,
/// help/compare_merge.txt, without its last line end; empty where there is no such file.
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
