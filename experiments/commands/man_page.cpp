// man_page of shell_words.hpp: every command with its words, and what --help says after them.

#include <sstream>

#include "experiments/commands/command.hpp"
#include "experiments/commands/shell_words.hpp"
#include "experiments/run/build_info.hpp"

namespace ballast {
namespace {

/// Text that troff takes as it is: no requests, no escapes, hyphens that can be copied.
std::string troff_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool is_first = result.empty() || result.back() == '\n';
    if (is_first && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  return result;
}

std::string entry(const std::string& name, const std::string& meaning) {
  return ".TP\n.B " + troff_text(name) + '\n' + troff_text(meaning) + '\n';
}

/// Examples and notes, line by line.
std::string notes(const std::string& path) {
  const std::string text = help_text(path);
  return text.empty() ? "" : ".PP\n.nf\n" + troff_text(text) + "\n.fi\n";
}

std::string section_of(const std::string& path, const Command& command) {
  std::string text = ".SS ballast " + troff_text(path) + '\n' + troff_text(command.meaning) + ".\n";
  if (!command.alias.empty()) text += "Also: " + troff_text(command.alias) + ".\n";
  for (const Word& word : command.words)
    text += entry(word.name, word.meaning + (word.is_required ? " (required)" : ""));
  text += notes(path);
  for (const Command& part : command.parts) text += section_of(path + ' ' + part.name, part);
  return text;
}

}  // namespace

std::string man_page() {
  std::string text = ".TH BALLAST 1 \"\" " + troff_text('"' + build_line() + '"') +
                     " \"User Commands\"\n"
                     ".SH NAME\n"
                     "ballast \\- nonsmooth contact dynamics of polyhedral grains, and a bench of "
                     "frictional\\-contact solvers\n"
                     ".SH SYNOPSIS\n.B ballast\n.I command\n[options]\n.SH DESCRIPTION\n"
                     "Every command prints its options with\n.BR \\-\\-help .\n" +
                     notes("ballast") + ".SH COMMANDS\n";
  for (const Command& command : commands()) text += section_of(command.name, command);
  return text;
}

}  // namespace ballast
