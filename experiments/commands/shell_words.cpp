// Completions of shells. Each script walks the words before the cursor to the command that they
// name ("bench/step"), and offers its subcommands and options, and the values that can be listed.

#include "experiments/commands/shell_words.hpp"

#include <functional>

#include "experiments/commands/command.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

using Names = std::vector<std::string>;

/// Calls f(path, command, subcommands) for the program itself, whose path is empty, and every
/// command: "run", "bench/step".
using Visit = std::function<void(const std::string&, const Command&, const std::vector<Command>&)>;
void for_commands(const std::string& path, const Command& command,
                  const std::vector<Command>& below, const Visit& f) {
  f(path, command, below);
  for (const Command& part : below)
    for_commands(path.empty() ? part.name : path + '/' + part.name, part, part.parts, f);
}
void for_commands(const Visit& f) {
  Command program;
  program.name = "ballast";
  for_commands("", program, commands(), f);
}

/// What may stand for a word, where there is a list of it.
Names values_of(const Word& word) {
  const std::string name = option_name(word);
  Names names;
  if (name == "scene" || name == "--live")
    for (const auto& scene : list_scenes()) names.push_back(scene.first);
  if (name == "--solver" || name == "--solvers")
    for (const SolverEntry& entry : solver_list())
      if (entry.make) names.emplace_back(entry.name);
  return names;
}

bool is_option(const Word& word) { return word.name.starts_with("--"); }

std::string spaced(const Names& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

/// One line of text between single quotes of a shell; what stands in `escaped` gets a backslash.
std::string shell_text(const std::string& text, const std::string& escaped = {}) {
  std::string quoted = "'";
  for (const char c : text) {
    if (escaped.find(c) != std::string::npos) quoted += '\\';
    quoted += c == '\'' ? std::string("’") : c == '\n' ? std::string(" ") : std::string(1, c);
  }
  return quoted + "'";
}

/// Lines of a case statement that go from a command and a word to the command below.
std::string walk() {
  std::string text;
  for_commands([&](const std::string& path, const Command&, const std::vector<Command>& below) {
    for (const Command& part : below) {
      const std::string to = path.empty() ? part.name : path + '/' + part.name;
      text += "      '" + path + ' ' + part.name + "'";
      if (!part.alias.empty()) text += " | '" + path + ' ' + part.alias + "'";
      text += ") at=" + to + " ;;\n";
    }
  });
  return text;
}

std::string bash() {
  std::string text = R"(# Completion of ballast for bash: made by `ballast completions bash`.
_ballast() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} at= word words=
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    case "$at $word" in
)" + walk() + "    esac\n  done\n  case \"$at $before\" in\n";
  std::string options;
  for_commands([&](const std::string& path, const Command& command,
                   const std::vector<Command>& below) {
    Names names;
    for (const Command& part : below) names.push_back(part.name);
    for (const Word& word : command.words) {
      const Names values = values_of(word);
      if (is_option(word)) names.push_back(option_name(word));
      if (is_option(word) && !values.empty())
        text += "    '" + path + ' ' + option_name(word) + "') words='" + spaced(values) + "' ;;\n";
      if (!is_option(word)) names.insert(names.end(), values.begin(), values.end());
    }
    names.emplace_back("--help");
    options += "      '" + path + "') words='" + spaced(names) + "' ;;\n";
  });
  return text + "    *) case \"$at\" in\n" + options +
         "    esac ;;\n  esac\n  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n}\n"
         "# where no word fits, files do\n"
         "complete -o default -F _ballast ballast\n";
}

std::string zsh() {
  std::string text = R"(#compdef ballast
# Completion of ballast for zsh: made by `ballast completions zsh`.
local at= word
local -a entries values
for word in ${words[2,CURRENT-1]}; do
    case "$at $word" in
)" + walk() + "    esac\ndone\ncase \"$at ${words[CURRENT-1]}\" in\n";
  std::string options;
  for_commands([&](const std::string& path, const Command& command,
                   const std::vector<Command>& below) {
    std::string entries;
    const auto add = [&](const std::string& name, const std::string& meaning) {
      entries += "    " + shell_text(name, ":") + ":" + shell_text(meaning) + "\n";
    };
    for (const Command& part : below) add(part.name, part.meaning);
    for (const Word& word : command.words) {
      const Names values = values_of(word);
      if (is_option(word)) add(option_name(word), word.meaning);
      if (is_option(word) && !values.empty())
        text += "  ('" + path + ' ' + option_name(word) + "') values=(" + spaced(values) + ") ;;\n";
      for (const std::string& value : is_option(word) ? Names{} : values) add(value, word.meaning);
    }
    options += "  ('" + path + "') entries=(\n" + entries + "  ) ;;\n";
  });
  return text +
         "esac\nif (( $#values )); then\n  compadd -a values\n  return\nfi\ncase \"$at\" in\n" +
         options + "esac\n_describe -t commands ballast entries\n_files\n";
}

std::string fish() {
  std::string text = "# Completion of ballast for fish: made by `ballast completions fish`.\n";
  for_commands([&](const std::string& path, const Command& command,
                   const std::vector<Command>& below) {
    // all words of the path are there, and none of the commands below
    std::string when = path.empty() ? "__fish_use_subcommand" : "";
    for (const std::string& name : path.empty() ? Names{} : split(path, '/'))
      when += (when.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + name);
    Names names;
    for (const Command& part : below) names.push_back(part.name);
    const std::string above = path.empty() || below.empty()
                                  ? when
                                  : when + "; and not __fish_seen_subcommand_from " + spaced(names);
    const std::string start = "complete -c ballast -n " + shell_text(above);
    for (const Command& part : below)
      text += start + " -f -a " + part.name + " -d " + shell_text(part.meaning) + '\n';
    for (const Word& word : command.words) {
      const Names values = values_of(word);
      const std::string offered = values.empty() ? "" : " -a '" + spaced(values) + "'";
      const bool takes_value = !std::holds_alternative<bool*>(word.value);
      if (is_option(word))
        text += start + " -l " + option_name(word).substr(2) + (takes_value ? " -r" : "") +
                offered + " -d " + shell_text(word.meaning) + '\n';
      else if (!values.empty())
        text += start + offered + " -d " + shell_text(word.meaning) + '\n';
    }
  });
  return text;
}

}  // namespace

std::string completions(const std::string& shell) {
  if (shell == "bash") return bash();
  if (shell == "zsh") return zsh();
  if (shell == "fish") return fish();
  throw std::invalid_argument("'" + shell + "': expected bash, zsh or fish");
}

}  // namespace ballast
