// The files and pages that the docs quote, cite and link to exist, and their prose fits an editor.

#include <algorithm>
#include <regex>

#include "tests/catch.hpp"
#include "tests/house/source_tree.hpp"

using namespace ballast::house;
namespace fs = std::filesystem;

namespace {

constexpr size_t widest_prose = 100;  // columns
constexpr int farthest_page = 3;      // links from README.md

/// One page of Markdown.
struct Page {
  fs::path path;  ///< from the project's root
  std::string text;
};

/// README, CHANGELOG and every page of docs/. Sorted by path.
std::vector<Page> pages() {
  std::vector<Page> found = {{"README.md", content(root() / "README.md")},
                             {"CHANGELOG.md", content(root() / "CHANGELOG.md")}};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root() / "docs"))
    if (entry.path().extension() == ".md")
      found.push_back({fs::relative(entry.path(), root()), content(entry.path())});
  std::sort(found.begin(), found.end(),
            [](const Page& a, const Page& b) { return a.path < b.path; });
  return found;
}

/// `ballast bench all` writes the results and names the commit that it measured.
constexpr const char *results_page = "docs/results.md", *checks_page = "docs/house/checks.md";

/// Pages with numbers and commands that a program inserts, which widen their lines.
bool is_generated(const Page& page) {
  return page.path.string().starts_with("docs/article/") || page.path == results_page;
}

/// The lines of prose: no tables, no headings, no code (fenced or indented by four).
std::vector<std::string> prose(const std::string& text) {
  std::vector<std::string> found;
  bool fenced = false;
  for (const std::string& line : lines_of(text)) {
    if (line.starts_with("```")) fenced = !fenced;
    const bool code = fenced || line.starts_with("```") || line.starts_with("    ");
    if (!code && !line.empty() && line[0] != '|' && line[0] != '#') found.push_back(line);
  }
  return found;
}

/// The targets of links to files of this project: `[words](target)` or `[words](<target>)`, without
/// `#part`.
std::vector<std::string> links(const std::string& text) {
  static const std::regex link(R"(\]\(<?(?!http|#)([^)>#]+))");
  return matches(text, link);
}

/// Texts in backticks that look like a path of the sources: `solvers/seam/solver.hpp`, a module
/// without its suffix, or a folder. Placeholders (<room>, *, foo) are not paths.
std::vector<std::string> cited_paths(const std::string& text) {
  static const std::regex path(
      R"(`((?:platform|geometry|problems|solvers|experiments|tests)/(?![^`]*foo)[^` <*{]*)`)");
  return matches(text, path);
}

/// The pages that a source names in a comment or a message, such as docs/manual/plans.md.
std::vector<std::string> cited_pages(const std::string& text) {
  static const std::regex page(R"((docs/(?!measured/\.\.)[\w/.-]*?\.md))");
  return matches(text, page);
}

bool is_in_the_tree(const std::string& path) {
  return fs::exists(root() / path) || fs::exists(root() / (path + ".hpp")) ||
         fs::exists(root() / (path + ".cpp"));
}

/// Words that look like a commit: seven or more hexadecimal digits, letters and figures mixed.
std::vector<std::string> commits(const std::string& text) {
  static const std::regex commit(
      R"((?:^|[^\w.-])((?=[0-9]*[a-f])(?=[a-f]*[0-9])[0-9a-f]{7,})(?![\w.-]))");
  return matches(text, commit);
}

/// Pages -> the least number of links from README.md to each.
std::map<std::string, int> distances_from_readme() {
  std::map<std::string, int> distance = {{"README.md", 0}};
  std::vector<std::string> queue = {"README.md"};
  for (size_t k = 0; k < queue.size(); ++k) {
    const std::string page = queue[k];
    if (!page.ends_with(".md")) continue;
    for (const std::string& link : links(content(root() / page))) {
      const std::string to = (fs::path(page).parent_path() / link).lexically_normal().string();
      if (distance.try_emplace(to, distance[page] + 1).second) queue.push_back(to);
    }
  }
  return distance;
}

}  // namespace

TEST_CASE("every link of the docs leads to a file") {
  int found = 0;
  for (const Page& page : pages())
    for (const std::string& link : links(page.text)) {
      INFO(page.path.string() << ": " << link);
      CHECK(fs::exists(root() / page.path.parent_path() / link));
      ++found;
    }
  CHECK(found > 50);
}

TEST_CASE("every source that the docs cite exists") {
  int found = 0;
  for (const Page& page : pages())
    for (const std::string& path : cited_paths(page.text)) {
      INFO(page.path.string() << ": " << path);
      CHECK(is_in_the_tree(path));
      ++found;
    }
  CHECK(found > 50);
}

TEST_CASE("every page that the sources cite exists") {
  int found = 0;
  for (const SourceFile& file : all_sources(true)) {
    if (file.path == "tests/house/docs_test.cpp") continue;
    for (const std::string& page : cited_pages(file.text)) {
      INFO(file.path << ": " << page);
      CHECK(fs::exists(root() / page));
      ++found;
    }
  }
  CHECK(found > 3);
}

TEST_CASE("the docs' prose is not too wide, and no commit explains anything") {
  for (const Page& page : pages()) {
    INFO(page.path.string());
    if (!is_generated(page))
      for (const std::string& line : prose(page.text)) {
        INFO(line);
        CHECK(columns(line) <= widest_prose);
      }
    if (page.path != results_page && page.path != checks_page) CHECK(commits(page.text).empty());
  }
}

TEST_CASE("every page is a few links from README.md") {
  const std::map<std::string, int> distance = distances_from_readme();
  for (const Page& page : pages()) {
    const std::string path = page.path.string();
    if (path == "CHANGELOG.md") continue;
    INFO(path);
    REQUIRE(distance.contains(path));
    CHECK(distance.at(path) <= farthest_page);
  }
}

TEST_CASE("every number in README's table of results is one of the page of results") {
  const std::string readme = content(root() / "README.md"),
                    results = content(root() / results_page);
  const size_t begin = readme.find("\n## Results\n"), end = readme.find("\n## ", begin + 1);
  REQUIRE(begin != std::string::npos);
  int rows = 0;
  for (const std::string& line : lines_of(readme.substr(begin, end - begin)))
    if (line.starts_with("| ")) {
      CHECK_THAT(results, Catch::Contains(line));
      ++rows;
    }
  CHECK(rows > 3);
}

TEST_CASE("docs/house/design.md has a row for every room") {
  const std::string design = content(root() / "docs" / "house" / "design.md");
  for (const auto& [room, ignored] : doors()) {
    INFO(room);
    CHECK(design.find("| `" + fs::path(room).filename().string() + "` |") != std::string::npos);
  }
}

TEST_CASE("the reader of docs sees what is forbidden") {
  CHECK(links("a [b](c.md#part) [d](https://e.f) ![g](h.svg)") ==
        std::vector<std::string>{"c.md", "h.svg"});
  CHECK(prose("# head\n\none\n| table |\n    code\n```\nfenced\n```\n- two\n") ==
        std::vector<std::string>{"one", "- two"});
  CHECK(commits("since cea39a7, 4.348570e-3 and 20260101 and 1e30") ==
        std::vector<std::string>{"cea39a7"});
  CHECK(cited_paths("`solvers/none.hpp`, tests/no, `tests/<room>/a.txt`, `ballast run`") ==
        std::vector<std::string>{"solvers/none.hpp"});
  CHECK(cited_pages("// see docs/a/b.md. And docs/measured/.../c.md, docs/d") ==
        std::vector<std::string>{"docs/a/b.md"});
  CHECK(is_in_the_tree("tests/house/source_tree"));
  CHECK_FALSE(is_in_the_tree("solvers/none.hpp"));
}

TEST_CASE("what docs/house/adding_a_solver.md quotes is what the files say") {
  static const std::regex named("`(solvers/[^`]*)`");
  std::string file, quotation;
  bool inside = false;
  int quotations = 0;
  for (const std::string& line : lines_of(content(root() / "docs/house/adding_a_solver.md"))) {
    if (!inside) {  // the block quotes the last file named before it
      for (const std::string& name : matches(line, named)) file = name;
      inside = line == "```cpp" || line == "```cmake";
      quotation.clear();
    } else if (line == "```") {
      inside = false;
      ++quotations;
      INFO(file << ":\n" << quotation);
      CHECK(content(root() / file).find(quotation) != std::string::npos);
    } else {
      quotation += line + "\n";
    }
  }
  CHECK(quotations >= 8);
}
