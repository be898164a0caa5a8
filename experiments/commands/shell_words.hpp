#pragma once
// The commands as a shell and `man` want to know them, made from the same table as --help
// (command_list.cpp): nothing of it is written twice.

#include <string>

namespace ballast {

/// A script for `shell`: "bash", "zsh" or "fish". Throws std::invalid_argument listing them.
std::string completions(const std::string& shell);

/// The man page ballast(1), in troff.
std::string man_page();

}  // namespace ballast
