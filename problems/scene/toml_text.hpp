#pragma once
// TOML written in one way only: sorted keys, shortest digits that read back to the same double.
// Same table, same text.

#include <toml++/toml.h>

#include <string>

namespace ballast {

/// A whole document.
std::string toml_text(const toml::table& table);

/// One value on one line; longer than `limit` characters it is cut and ends with "...".
std::string toml_value_text(const toml::node& node, size_t limit);

}  // namespace ballast
