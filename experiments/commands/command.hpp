#pragma once
// The commands of the ballast program as data: which words each takes, where their values go, what
// --help says of them, and what is done then. command.cpp reads a command line by these tables,
// with CLI11.

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "platform/error.hpp"

namespace ballast {

/// What a parsed command line wants done. Throws on failure; the exception's what() is the message.
using Action = std::function<ExitCode()>;

/// The command line itself is wrong, in a way that only the command can see: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Word;
/// What holds of a word besides its type. What breaks a rule is exit code 2.
using Rule = std::function<void(Word&)>;

/// One argument or option.
struct Word {
  using Value = std::variant<std::string*, std::filesystem::path*, double*, int*, bool*,
                             std::vector<std::string>*>;

  template <class... Rules>
  Word(std::string name_, Value value_, std::string meaning_, const Rules&... rules)
      : name(std::move(name_)), value(value_), meaning(std::move(meaning_)) {
    for (const Rule& rule : std::initializer_list<Rule>{rules...}) rule(*this);
  }

  /// "scene": an argument, known by its place. "--output DIR": an option, and what --help calls its
  /// value. Where the value is a bool, the option is a switch, and "--no-..." switches off.
  std::string name;
  /// Keeps the value; what is there before is the default. A list takes all that come.
  Value value;
  std::string meaning;

  bool is_required = false;
  bool shows_default = false;                  ///< --help says the value that is there before
  std::optional<std::pair<int, int>> between;  ///< both included; --help says so
  std::optional<double> above, at_least;       ///< bounds of a number; NaN is beyond all
  std::vector<std::string> excludes, needs;    ///< words further up
  /// Makes something of a text, given or not. A std::invalid_argument or Error from it is said with
  /// the word's name.
  std::function<void(const std::string& text)> parse;
};

/// "--output" of "--output DIR".
std::string option_name(const Word& word);

// The rules, as they stand in the rows of a table of words.
inline const Rule required = [](Word& word) { word.is_required = true; };
inline const Rule shown = [](Word& word) { word.shows_default = true; };
inline Rule between(int low, int high) {
  return [=](Word& word) { word.between = {low, high}; };
}
inline Rule above(double low) {
  return [=](Word& word) { word.above = low; };
}
inline Rule at_least(double low) {
  return [=](Word& word) { word.at_least = low; };
}
inline Rule excludes(const std::string& other) {
  return [=](Word& word) { word.excludes.push_back(other); };
}
inline Rule needs(const std::string& other) {
  return [=](Word& word) { word.needs.push_back(other); };
}
inline Rule parsed(const std::function<void(const std::string&)>& parse) {
  return [=](Word& word) { word.parse = parse; };
}
/// value = parser(text)
template <class Value, class Parser>
Rule into(Value& value, Parser parser) {
  return parsed([&value, parser](const std::string& text) { value = parser(text); });
}

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

/// Carries out an action. An exception becomes its line on `err` and its exit code: UsageError and
/// UnknownSolver named on the command line 2, MissingSolver 4, everything else 1.
ExitCode perform(const Action& action, std::ostream& err);

/// The command line of this process, as a shell reads it.
std::string own_command();

}  // namespace ballast
