#pragma once
// What a page says, in plain words: the model that every page of the program is written in. It
// knows no HTML and no Markdown; html.hpp and markdown.hpp write it.
//
//   page::Page page{.title = name_of_run, .lede = {page::exact(steps) + " steps"}};
//   page::Table table{.head = {"phase", page::marked("error / *gh*")}, .is_number = {false, true}};
//   table.rows.push_back({"detection", page::number(error)});
//   page.add({"numbers", "The run in numbers", {page::marked("Mean over *all* steps."), table}});
//   page::Picture wall{plot, {page::words("wall.caption", {{"x", page::quantity(x, "mm")}})}};
//   page.add({"wall", "The wall", {wall}});
//   page::draw_pictures(page, folder, {.command = "ballast report RUN"});
//   page::write_html_file(folder / "report.html", page);
//   write_whole_file(folder / "README.md", page::markdown_of(page));

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "experiments/page/plot.hpp"
#include "experiments/page/text.hpp"

namespace ballast::page {

struct Subheading {
  Text words;
  bool empty() const { return words.empty(); }
};

struct List {
  std::vector<Text> items;
  bool empty() const { return items.empty(); }
};

struct Table {
  Text caption = {};            ///< stands above, as a paragraph; empty: none
  std::vector<Text> head = {};  ///< empty: none
  std::vector<std::vector<Text>> rows = {};
  std::vector<bool> is_number = {};  ///< columns that are set right-aligned; empty: none
  bool is_facts = false;             ///< rows are {what, value}: the first is narrow and soft
  bool empty() const { return rows.empty(); }
};

/// A plot and what is said about it.
struct Picture {
  Figure plot = {};
  std::vector<Text> caption = {};  ///< one line each
  Text files = {};       ///< links to its files, for pages that don't hold the picture themselves
  std::string svg = {};  ///< filled by draw_pictures
  bool empty() const { return plot.panels.empty(); }
};

/// What is missing or wrong, loudly.
struct Notices {
  Text heading = {};
  std::vector<Text> items = {};
  bool empty() const { return items.empty(); }
};

/// Text as it stands in a file or for a shell, in a box; under a heading it is closed until the
/// reader opens it.
struct Listing {
  std::string text;
  Text heading = {};
  bool empty() const { return text.empty(); }
};

/// Bodies in 3D that move: what experiments/page/replay draws in the reader's browser.
/// view_page.cpp says what the head and each part hold.
struct Replay {
  std::string head = {};                                        ///< JSON; empty: no replay
  std::vector<std::pair<std::string, std::string>> parts = {};  ///< name and raw bytes
  std::string still = {};  ///< PNG: shown where the browser cannot draw, and in print
  Text caption = {};
  bool empty() const { return head.empty(); }
};

/// A paragraph is Text.
using Block = std::variant<Text, Subheading, List, Table, Picture, Notices, Listing, Replay>;

/// Says nothing: a table without rows, text without words. Writers leave it out.
bool is_empty(const Block& block);

struct Section {
  std::string id;  ///< "fig9"; an anchor of the page
  Text heading;
  std::vector<Block> blocks = {};

  void add(Block block) { blocks.push_back(std::move(block)); }
  void add(const std::vector<Picture>& pictures);
  bool is_empty() const;
};

/// What a page's script is given, so that its tables sort and its figures tell their values
/// (experiments/page/answers). Only HTML has a script.
struct Answers {
  bool are_given = false;
  bool with_curves = false;  ///< charts stand in for the figures, whose curves are in the page
  std::string data = {};     ///< a JSON object for the page's own modules; empty: none
  std::vector<std::string> modules = {};  ///< JavaScript of the page's room, run after the common
};

struct Page {
  std::string title = {};
  std::vector<Text> lede = {};  ///< lines under the title
  Notices notices = {};         ///< stand before everything else
  std::vector<Section> sections = {};
  Answers answers = {};

  void add(Section section) { sections.push_back(std::move(section)); }
};

/// A table. Its words are lines: the caption, the cells of the head with "||" between them, and
/// the rows that it has already.
Table words_table(const std::string& name, const Values& values = {});

/// Where figures stand, beside the page's file.
inline constexpr const char* picture_folder = "figures";

/// What is left beside the page for each figure; the SVG always is.
struct Drawing {
  bool is_file_shown = false;  ///< by the page: the file has a white ground; gnuplot's script,
                               ///< which holds the data, is left only where this is false
  std::string command = {};    ///< that draws them later, named where gnuplot is missing
};

/// Draws every picture of `page` into folder/figures and fills its svg. Pictures without panels are
/// dropped silently; what gnuplot cannot draw is dropped and becomes one of the page's notices, and
/// without gnuplot one notice stands for all. Throws Error when `folder` cannot be written.
void draw_pictures(Page& page, const std::filesystem::path& folder, const Drawing& drawing = {});

}  // namespace ballast::page
