#include "experiments/page/prose.hpp"

#include <sstream>
#include <stdexcept>

namespace ballast::page {

Prose::Prose(std::initializer_list<std::string_view> files) {
  for (const std::string_view file : files) {
    std::istringstream lines{std::string(file)};
    std::string* entry = nullptr;
    bool is_after_gap = false;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("# ")) {
        const auto [place, is_new] = entries_.try_emplace(line.substr(2));
        if (!is_new) throw std::logic_error("page texts: \"" + place->first + "\" stands twice");
        entry = &place->second;
        is_after_gap = false;
      } else if (line.empty()) {
        is_after_gap = true;
      } else if (!entry) {
        throw std::logic_error("page texts: no headline before \"" + line + "\"");
      } else {
        if (!entry->empty()) *entry += is_after_gap ? '\n' : ' ';
        *entry += line;
        is_after_gap = false;
      }
    }
  }
}

Text Prose::operator()(const std::string& name, const Values& values) const {
  const auto entry = entries_.find(name);
  if (entry == entries_.end()) throw std::logic_error("page texts: there is no \"" + name + "\"");
  // the texts of one figure share their values: what this one does not name is not for it
  Values named;
  for (const auto& [value, words] : values)
    if (entry->second.find('{' + value + '}') != std::string::npos) named.emplace(value, words);
  return marked(entry->second, named);
}

}  // namespace ballast::page
