#include "experiments/commands/command.hpp"

#include <algorithm>
#include <limits>
#include <new>
#include <ostream>
#include <set>

#include <CLI/CLI.hpp>

#include "experiments/run/run_folder.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {

std::string help_file(const std::string& name);  // of experiments/commands/help

// Each is defined in the file of its name or of its subject.
Command run_command(), solve_command(), compare_command(), plan_command(), paper_command(),
    bench_command(), answer_command(), solvers_command(), scenes_command(), check_command(),
    export_command(), report_command(), view_command(), convert_command();

std::vector<Command> commands() {
  return {run_command(),    solve_command(),  compare_command(), plan_command(),   paper_command(),
          bench_command(),  answer_command(), solvers_command(), scenes_command(), check_command(),
          export_command(), report_command(), view_command(),    convert_command()};
}

std::string help_text(std::string path) {
  std::replace(path.begin(), path.end(), ' ', '_');
  std::string text = help_file(path + ".txt");
  if (!text.empty()) text.pop_back();
  return text;
}

namespace {

constexpr double greatest = std::numeric_limits<double>::max();  // no number is infinite

Rule bounded(double low, bool is_open, double high, const std::string& expected) {
  return [=](CLI::Option& option) {
    const auto fault = [=](const std::string& text) {
      const double value = parsed_number(text).value_or(std::nan(""));
      const bool is_in = (is_open ? value > low : value >= low) && value <= high;
      return is_in ? std::string() : "'" + text + "': expected a number " + expected;
    };
    option.check(fault, expected);
  };
}

void print_failure(std::ostream& err, const std::string& what) {
  std::string line = one_line(what, ' ');
  while (line.ends_with(' ')) line.pop_back();
  err << "ballast: " << line << std::endl;
}

/// "--output" of "--output DIR".
std::string option_name(const Word& word) { return word.name.substr(0, word.name.find(' ')); }

/// The fault of "", and of the value that CLI11 takes from "--output= --quiet"; neither is a name.
std::string names_something(const std::string& text) {
  return text.empty() || text.starts_with("--") ? "'" + text + "': expected a name" : "";
}

/// Adds one word to CLI11.
void add_word(CLI::App& app, Word& word) {
  const std::string name = option_name(word);
  CLI::Option* option = nullptr;
  if (bool** flag = std::get_if<bool*>(&word.value)) {
    const auto turn = [on = *flag, to = !name.starts_with("--no-")] { *on = to; };
    option = app.add_flag_callback(name, turn, word.meaning);
  } else {
    const auto add = [&]<class Kept>(Kept& kept) {
      if constexpr (std::is_same_v<Kept, TextParser>)
        return app.add_option(name, kept.text, word.meaning);
      else
        return app.add_option(name, *kept, word.meaning);
    };
    option = std::visit(add, word.value)->capture_default_str();
    if (std::holds_alternative<std::string*>(word.value) ||
        std::holds_alternative<std::filesystem::path*>(word.value))
      option->check(names_something, "");
    // a default that is empty or without a limit is not shown
    for (const char* nothing : {"\"\"", "[]", "1e+30", "nan"})
      if (option->get_default_str() == nothing) option->default_str("");
  }
  if (name.size() < word.name.size()) option->type_name(word.name.substr(name.size() + 1));
  // a list option grows by one value each time; a list argument takes all that follow
  if (name.starts_with("--") && std::holds_alternative<std::vector<std::string>*>(word.value))
    option->take_all()->expected(1)->allow_extra_args(false);
  if (std::holds_alternative<std::vector<int>*>(word.value))
    option->delimiter(',')->allow_extra_args(false);
  for (const Rule& rule : word.rules) rule(*option);
}

/// Adds the command `path` ("compare merge") to CLI11; `chosen` is set to it when the command line
/// names it.
void add_command(CLI::App& app, const std::string& path, Command& command, Command*& chosen) {
  CLI::App* added = app.add_subcommand(command.name, command.meaning);
  added->footer(help_text(path));  // else CLI11 hands down that of the command above
  for (Word& word : command.words) add_word(*added, word);
  for (Command& part : command.parts) add_command(*added, path + ' ' + part.name, part, chosen);
  // CLI11 calls a subcommand back before the command above it, which then has nothing to do.
  if (command.act)
    added->require_subcommand(0, 1)->callback([&command, &chosen, added] {
      if (!chosen) {
        chosen = &command;
        return;
      }
      for (const CLI::Option* option : added->get_options())
        if (option->count() > 0)
          throw CLI::ValidationError(option->get_name(), "a word of '" + command.name +
                                                             "', not of '" + chosen->name + "'");
    });
  else
    added->require_subcommand(1);
}

ExitCode carry_out(const Command& command) {
  for (const Word& word : command.words) {
    const TextParser* parsed = std::get_if<TextParser>(&word.value);
    if (!parsed) continue;
    try {
      parsed->use(parsed->text);
    } catch (const MissingSolver&) {
      throw;
    } catch (const std::exception& error) {
      throw UsageError(option_name(word) + ": " + error.what());
    }
  }
  return command.act();
}

/// The first word that is no command or option there, with a suggestion; where all are known, the
/// parser's message `found`. Ends with the command whose --help says more.
std::string complaint(const CLI::App& program, int argc, const char* const* argv,
                      std::string found) {
  // a rule has already checked that it is a number
  if (const std::string cli = "Could not convert: "; found.starts_with(cli))
    found = found.substr(cli.size()) + " is no whole number that fits";
  const CLI::App* at = &program;
  std::string path = program.get_name(), unknown;
  for (int k = 1; k < argc && unknown.empty(); ++k) {
    const std::string word = argv[k];
    std::set<std::string> names;
    if (word.starts_with("--") && word.size() > 2) {
      for (const CLI::Option* option : at->get_options()) names.insert(option->get_name());
      const std::string given = word.substr(0, word.find('='));
      if (!names.contains(given)) unknown = "no option " + given + did_you_mean(given, names);
    } else {
      for (const CLI::App* below : at->get_subcommands({})) names.insert(below->get_name());
      if (names.contains(word)) {
        at = at->get_subcommand(word);
        path += ' ' + word;
      } else if (at->get_require_subcommand_min() > 0) {
        unknown = "no command '" + word + "'" + did_you_mean(word, names);
      }
    }
  }
  if (at != &program && !unknown.empty()) unknown.insert(0, at->get_name() + ": ");
  return (unknown.empty() ? found : unknown) + " (" + path + " --help)";
}

}  // namespace

const Rule required = [](CLI::Option& option) { option.required(); };
Rule between(double low, double high) {
  return bounded(low, false, high, printed("from %.10g to %.10g", low, high));
}
Rule above(double low) { return bounded(low, true, greatest, printed("> %g", low)); }
Rule at_least(double low) { return bounded(low, false, greatest, printed(">= %g", low)); }
Rule excludes(const std::string& other) {
  return [=](CLI::Option& option) { option.excludes(other); };
}
Rule needs(const std::string& other) {
  return [=](CLI::Option& option) { option.needs(other); };
}

std::string own_command() {
  std::vector<std::string> words = process_arguments();
  words[0] = "ballast";
  return shell_line(words);
}

ExitCode perform(const Action& action, std::ostream& err) {
  try {
    return action();
  } catch (const UsageError& error) {
    print_failure(err, error.what());
    return ExitCode::usage;
  } catch (const MissingSolver& error) {
    print_failure(err, error.what());
    return ExitCode::backend_missing;
  } catch (const std::bad_alloc&) {
    print_failure(err, "out of memory");
  } catch (const std::filesystem::filesystem_error& error) {
    print_failure(err, error.path1().string() + ": " + error.code().message());
  } catch (const std::exception& error) {
    print_failure(err, error.what());
  }
  return ExitCode::failure;
}

int ballast_main(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  CLI::App program(
      "Nonsmooth contact dynamics of polyhedral grains, and a bench of frictional-contact solvers",
      "ballast");
  program.footer(help_text("ballast"));
  program.set_version_flag("--version", build_line());
  program.require_subcommand(1);
  std::vector<Command> all = commands();
  Command* chosen = nullptr;
  for (Command& command : all) add_command(program, command.name, command, chosen);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      print_failure(err, complaint(program, argc, argv, error.what()));
      return static_cast<int>(ExitCode::usage);
    }
    chosen = nullptr;
    program.exit(error, out, err);  // --help
  }
  ExitCode code = chosen ? perform([&] { return carry_out(*chosen); }, err) : ExitCode::ok;
  // a full disk may show only when the last of the output is written
  out.flush();
  if (!out && code == ExitCode::ok) {
    print_failure(err, "standard output: cannot be written");
    code = ExitCode::failure;
  }
  return static_cast<int>(code);
}

}  // namespace ballast
