#pragma once
// The content of a page in plain words: the model of every page of the program. It knows neither
// HTML nor Markdown; html.cpp and markdown.cpp write it.
//
//   page::Page page{.title = name_of_run, .lede = {page::exact(steps) + " steps"}};
//   page::Table table{.head = {"phase", page::marked("error / *gh*")}, .is_number = {false, true}};
//   table.rows.push_back({"detection", page::number(error)});
//   page.add({"numbers", "The run in numbers", {page::marked("Mean over *all* steps."), table}});
//   page::Picture wall{plot, {page::words("wall.caption", {{"x", page::quantity(x, "mm")}})}};
//   page.add({"wall", "The wall", {wall}});
//   page::draw_pictures(page, folder, {.command = "ballast report RUN"});
//   write_whole_file(folder / "report.html", page::html_of(page));
//   write_whole_file(folder / "README.md", page::markdown_of(page));

#include <filesystem>
#include <string>
#include <string_view>
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
  Text caption = {};            ///< a paragraph above the table; empty: none
  std::vector<Text> head = {};  ///< empty: none
  std::vector<std::vector<Text>> rows = {};
  std::vector<bool> is_number = {};  ///< columns that are set right-aligned; empty: none
  bool is_facts = false;  ///< rows are {name, value}: the first column is narrow and soft
  bool empty() const { return rows.empty(); }
};

/// A plot and its caption.
struct Picture {
  Figure plot = {};
  std::vector<Text> caption = {};  ///< one line each
  Text files = {};       ///< links to its files, for pages that don't hold the picture themselves
  std::string svg = {};  ///< filled by draw_pictures
  bool empty() const { return plot.panels.empty(); }
};

/// Prominent notices of what is missing or wrong.
struct Notices {
  Text heading = {};
  std::vector<Text> items = {};
  bool empty() const { return items.empty(); }
};

/// Text of a file or for a shell, shown verbatim in a box. With a heading the box is closed until
/// the reader opens it.
struct Listing {
  std::string text;
  Text heading = {};
  bool empty() const { return text.empty(); }
};

/// Moving bodies in 3D, which experiments/page/replay draws in the reader's browser. view_page.cpp
/// says what the head and each part hold.
struct Replay {
  std::string head = {};                                        ///< JSON; empty: no replay
  std::vector<std::pair<std::string, std::string>> parts = {};  ///< name and raw bytes
  std::string still = {};  ///< PNG: shown where the browser cannot draw, and in print
  Text caption = {};
  bool empty() const { return head.empty(); }
};

/// An element of a page. A paragraph is Text.
using Block = std::variant<Text, Subheading, List, Table, Picture, Notices, Listing, Replay>;

/// True for a table without rows, text without words and the like, which writers leave out.
bool is_empty(const Block& block);

struct Section {
  std::string id;  ///< "fig9"; an anchor of the page
  Text heading;
  std::vector<Block> blocks = {};

  void add(Block block) { blocks.push_back(std::move(block)); }
  void add(const std::vector<Picture>& pictures);
  bool is_empty() const;
};

/// The input of a page's script, which makes tables sort and figures tell their values
/// (experiments/page/answers). Only HTML has a script.
struct Answers {
  bool is_enabled = false;
  bool has_charts = false;  ///< charts replace the figures, whose curves are in the page
  std::string data = {};    ///< a JSON object for the page's own modules; empty: none
  std::vector<std::string> modules = {};  ///< the page's own JavaScript, run after the common one
};

struct Page {
  std::string title = {};
  std::vector<Text> lede = {};  ///< lines under the title
  Notices notices = {};         ///< shown before everything else
  std::vector<Section> sections = {};
  Answers answers = {};

  void add(Section section) { sections.push_back(std::move(section)); }
};

/// The table that words(name) describe. Their lines are the caption, the head with "||" between its
/// cells, and rows of the same form.
Table words_table(const std::string& name, const Values& values = {});

/// The folder of the figures, beside the page's file.
inline constexpr const char* picture_folder = "figures";

/// Options of draw_pictures. The SVG of each figure always stays beside the page.
struct Drawing {
  bool is_file_shown = false;  ///< the page shows the SVG file, which gets a white ground; only
                               ///< where this is false gnuplot's script, with the data, stays
  std::string command = {};    ///< draws the figures later; named where gnuplot is missing
};

/// Draws every picture of `page` into folder/figures and fills its svg. Pictures without panels are
/// dropped silently. A picture that cannot be drawn or written is dropped and gets a notice on the
/// page; without gnuplot one notice stands for all.
void draw_pictures(Page& page, const std::filesystem::path& folder, const Drawing& drawing = {});

// HTML: one file that opens offline, with its figures inlined. Nothing is loaded from elsewhere;
// only replays and the ends of pages with answers have scripts.

std::string html_of(const Page& page);
std::string html_of(const Text& text);
/// A replay includes its data and the script that draws it.
std::string html_of(const Block& block);

/// Replaces & < > " ' by entities, and everything that clean_utf8 refuses by U+FFFD.
std::string escaped_html(std::string_view text);

/// A figure's SVG for inlining: without XML declaration, doctype and comments, with `name` before
/// every id, so that ids differ between figures, and with `title` for screen readers.
std::string inline_svg(std::string_view svg, const std::string& name, const std::string& title);

/// Returns whether the library that draws charts (Chart.js) is built in.
bool has_chart_library();

// Markdown (GitHub's), with figures as files beside it. Such a page cannot have headings within
// sections, listings or replays: they throw std::logic_error.

std::string markdown_of(const Page& page);
/// Characters that Markdown would take for marks are escaped.
std::string markdown_of(const Text& text);
std::string markdown_of(const Block& block);

}  // namespace ballast::page
