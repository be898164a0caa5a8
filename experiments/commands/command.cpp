#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <ostream>

#include <CLI/CLI.hpp>

#include "experiments/commands/command.hpp"
#include "experiments/run/build_info.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {

std::string help_file(const std::string& name);  // of experiments/commands/help

// Each is defined in the file of its name, or of what it is about.
Command run_command(), solve_command(), compare_command(), plan_command(), paper_command(),
    bench_command(), answer_command(), solvers_command(), scenes_command(), check_command(),
    export_command(), report_command(), view_command(), version_command(), convert_command();

namespace {

/// What may stand behind the words of a command line: subcommands, options, and where there is a
/// list of them their values.
std::vector<std::string> offered(const std::vector<std::string>& line) {
  const std::vector<Command> all = commands();
  Command at{"ballast", "", {}, {}, all};
  for (const std::string& word : line)
    for (const Command& part : at.parts)
      if (part.name == word) {
        const Command below = part;
        at = below;
        break;
      }
  std::vector<std::string> names{"--help"};
  for (const Command& part : at.parts) names.push_back(part.name);
  for (const Word& word : at.words) {
    const std::string name = option_name(word);
    const bool is_option = name.starts_with("--");
    std::vector<std::string> values;
    if (name == "scene" || name == "--live")
      for (const auto& [scene, title] : list_scenes()) values.push_back(scene);
    if (name == "--solver" || name == "--solvers")
      for (const SolverEntry& entry : solver_list())
        if (entry.make) values.emplace_back(entry.name);
    if (is_option && !line.empty() && line.back() == name && !values.empty()) return values;
    if (is_option)
      names.push_back(name);
    else
      names.insert(names.end(), values.begin(), values.end());
  }
  return names;
}

/// Where no word fits, files do.
constexpr std::pair<const char*, const char*> completions[] = {
    {"bash", R"sh(_ballast() {
  local words=$(ballast completions words -- "${COMP_WORDS[@]:1:COMP_CWORD-1}")
  COMPREPLY=($(compgen -W "$words" -- "${COMP_WORDS[COMP_CWORD]}"))
}
complete -o default -F _ballast ballast
)sh"},
    {"zsh", R"sh(#compdef ballast
local -a offered
offered=(${(f)"$(ballast completions words -- ${words[2,CURRENT-1]})"})
compadd -a offered
_files
)sh"},
    {"fish",
     "complete -c ballast -a '(ballast completions words -- (commandline -opc)[2..-1])'\n"}};

Command completions_command() {
  struct Options {
    std::string what;
    std::vector<std::string> line;
  };
  const auto options = std::make_shared<Options>();
  return {"completions",
          "Prints the completion of a shell; cmake --install installs them",
          {{"what", &options->what,
            "bash, zsh, fish; words: what may stand behind those that follow", required},
           {"line", &options->line, "The words before"}},
          [options] {
            for (const auto& [shell, text] : completions)
              if (options->what == shell) std::cout << text;
            if (options->what == "words")
              for (const std::string& word : offered(options->line)) std::cout << word << '\n';
            else if (std::none_of(std::begin(completions), std::end(completions),
                                  [&](const auto& one) { return options->what == one.first; }))
              throw UsageError("completions: '" + options->what + "': expected bash, zsh or fish");
            return ExitCode::ok;
          }};
}

}  // namespace

std::vector<Command> commands() {
  return {run_command(),    solve_command(),   compare_command(),     plan_command(),
          paper_command(),  bench_command(),   answer_command(),      solvers_command(),
          scenes_command(), check_command(),   export_command(),      report_command(),
          view_command(),   convert_command(), completions_command(), version_command()};
}

std::string help_text(std::string path) {
  std::replace(path.begin(), path.end(), ' ', '_');
  std::string text = help_file(path + ".txt");
  if (!text.empty()) text.pop_back();
  return text;
}

namespace {

void print_failure(std::ostream& err, const std::string& what) {
  std::string line = one_line(what, ' ');
  while (line.ends_with(' ')) line.pop_back();
  err << "ballast: " << line << std::endl;
}

/// Tells CLI11 of one word.
void add_word(CLI::App& app, const Word& word) {
  const std::string name = option_name(word);
  CLI::Option* option = std::visit(
      [&](auto* value) {
        if constexpr (std::is_same_v<decltype(value), bool*>) {
          const bool on = !name.starts_with("--no-");
          return app.add_flag_callback(
              name, [value, on] { *value = on; }, word.meaning);
        } else {
          return app.add_option(name, *value, word.meaning);
        }
      },
      word.value);
  if (name.size() < word.name.size()) option->type_name(word.name.substr(name.size() + 1));
  // a list behind an option grows by one value each time; an argument takes all that follow
  if (name.starts_with("--") && std::holds_alternative<std::vector<std::string>*>(word.value))
    option->take_all()->expected(1);
  if (word.is_required) option->required();
  if (word.shows_default) option->capture_default_str();
  if (word.between) option->check(CLI::Range(word.between->first, word.between->second));
  for (const std::string& other : word.excludes) option->excludes(app.get_option(other));
  for (const std::string& other : word.needs) option->needs(app.get_option(other));
}

/// Tells CLI11 of the command `path`, "compare merge"; when it is the one that is named, `chosen`
/// is set.
void add_command(CLI::App& app, const std::string& path, const Command& command,
                 const Command*& chosen) {
  CLI::App* added = app.add_subcommand(command.name, command.meaning);
  added->footer(help_text(path));  // else CLI11 hands down that of the command above
  for (const Word& word : command.words) add_word(*added, word);
  for (const Command& part : command.parts)
    add_command(*added, path + ' ' + part.name, part, chosen);
  // A subcommand is called back before the command above it, which then has nothing to do.
  if (command.act)
    added->require_subcommand(0, 1)->callback([&command, &chosen] {
      if (!chosen) chosen = &command;
    });
  else
    added->require_subcommand(1);
}

/// The rules that CLI11 does not see to. Throws UsageError "<command>: <word>: ...".
void check_word(const std::string& command, const Word& word) {
  const auto refuse = [&](const std::string& what) {
    throw UsageError(command + ": " + option_name(word) + ": " + what);
  };
  double number = std::nan("");
  if (const auto* value = std::get_if<double*>(&word.value)) number = **value;
  if (const auto* value = std::get_if<int*>(&word.value)) number = **value;
  if (word.above && !(number > *word.above)) refuse(printed("expected a number > %g", *word.above));
  if (word.at_least && !(number >= *word.at_least))
    refuse(printed("expected a number >= %g", *word.at_least));
  if (!word.parse) return;
  try {
    word.parse(*std::get<std::string*>(word.value));
  } catch (const UnknownSolver& error) {
    throw UsageError(error.what());
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  } catch (const Error& error) {
    refuse(error.what());
  }
}

/// The first word that is no command or option there, and what was probably meant; empty when all
/// are known.
std::string unknown_word(const std::vector<Command>& all, int argc, const char* const* argv) {
  const Command* at = nullptr;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k], in = at ? at->name : "ballast";
    std::vector<std::string> names;
    if (word.starts_with("--") && word.size() > 2) {
      names = {"--help", "--version"};
      for (const Word& known : at ? at->words : std::vector<Word>{})
        names.push_back(option_name(known));
      const std::string given = word.substr(0, word.find('='));
      if (std::find(names.begin(), names.end(), given) == names.end())
        return in + ": no option " + given + did_you_mean(given, names);
    } else if (const auto& below = at ? at->parts : all; !below.empty()) {
      const auto found = std::find_if(below.begin(), below.end(),
                                      [&](const Command& command) { return command.name == word; });
      for (const Command& command : below) names.push_back(command.name);
      if (found == below.end() && at && at->act) continue;  // its own argument
      if (found == below.end())
        return in + ": no command '" + word + "'" + did_you_mean(word, names);
      at = &*found;
    }
  }
  return {};
}

}  // namespace

std::string option_name(const Word& word) { return word.name.substr(0, word.name.find(' ')); }

std::string own_command() {
  std::vector<std::string> words = own_words();
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
  const std::vector<Command> all = commands();
  const Command* chosen = nullptr;
  for (const Command& command : all) add_command(program, command.name, command, chosen);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error, out, err);  // --help
    const std::string unknown = unknown_word(all, argc, argv);
    print_failure(err, (unknown.empty() ? error.what() : unknown) + " (ballast --help)");
    return static_cast<int>(ExitCode::usage);
  }
  const auto act = [&] {
    if (!chosen) throw UsageError("a subcommand is required (ballast --help)");
    const std::string name = program.get_subcommands().front()->get_name();
    for (const Word& word : chosen->words) check_word(name, word);
    return chosen->act();
  };
  // a full disk may show only when the last of the output is written
  ExitCode code = perform(act, err);
  out.flush();
  if (!out && code == ExitCode::ok) {
    print_failure(err, "standard output: cannot be written");
    code = ExitCode::failure;
  }
  return static_cast<int>(code);
}

}  // namespace ballast
