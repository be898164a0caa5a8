// Completions of shells and the man page, for who installs the program.

#include <iostream>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/commands/shell_words.hpp"

namespace ballast {

Command completions_command() {
  const auto what = std::make_shared<std::string>();
  const auto text = std::make_shared<std::string>();
  return {"completions",
          "Prints the completion of a shell, or the man page; cmake --install installs them",
          {{"what", what.get(), "bash, zsh, fish or man", required,
            into(*text,
                 [](const std::string& name) {
                   return name == "man" ? man_page() : completions(name);
                 })}},
          [what, text] {
            std::cout << *text;
            return ExitCode::ok;
          }};
}

}  // namespace ballast
