#include "experiments/page/page.hpp"

#include <algorithm>

namespace ballast::page {
namespace {

struct Emptiness {
  bool operator()(const Text& text) const { return text.empty(); }
  bool operator()(const Subheading&) const { return true; }  // says nothing by itself
  bool operator()(const List& list) const { return list.items.empty(); }
  bool operator()(const Table& table) const { return table.rows.empty(); }
  bool operator()(const Picture& picture) const { return picture.plot.panels.empty(); }
  bool operator()(const Notices& notices) const { return notices.items.empty(); }
  bool operator()(const Listing& listing) const { return listing.text.empty(); }
  bool operator()(const Folded& folded) const { return folded.text.empty(); }
  bool operator()(const Replay& replay) const { return replay.head.empty(); }
};

}  // namespace

bool is_empty(const Block& block) { return std::visit(Emptiness{}, block); }

void Section::add(const std::vector<Picture>& pictures) {
  blocks.insert(blocks.end(), pictures.begin(), pictures.end());
}

bool Section::is_empty() const { return std::all_of(blocks.begin(), blocks.end(), page::is_empty); }

Table facts_table() {
  Table table;
  table.is_facts = true;
  return table;
}

Table words_table(const std::string& name, const Values& values) {
  const std::vector<Text> lines = parts_of(words(name, values), "\n");
  Table table{.caption = lines.front(), .head = parts_of(lines.at(lines.size() > 1), "||")};
  for (size_t k = 2; k < lines.size(); ++k) table.rows.push_back(parts_of(lines[k], "||"));
  return table;
}

}  // namespace ballast::page
