// The shape of the sources: files and lines are short enough for a reader, and every module has a
// test.

#include <algorithm>
#include <regex>

#include "tests/catch.hpp"
#include "tests/house/source_tree.hpp"

using namespace ballast::house;

namespace {

constexpr size_t longest_file = 500;  // lines
constexpr size_t widest_line = 100;   // columns

std::vector<std::string> breaches(const std::string& path, const std::string& text) {
  std::vector<std::string> found;
  const std::vector<std::string> lines = lines_of(text);
  if (lines.size() > longest_file)
    found.push_back(path + ": " + std::to_string(lines.size()) + " lines, at most " +
                    std::to_string(longest_file));
  for (size_t k = 0; k < lines.size(); ++k)
    if (columns(lines[k]) > widest_line)
      found.push_back(path + ":" + std::to_string(k + 1) + ": " +
                      std::to_string(columns(lines[k])) + " columns, at most " +
                      std::to_string(widest_line));
  if (path.ends_with(".hpp") && text.find("#pragma once") == std::string::npos)
    found.push_back(path + ": no #pragma once");
  return found;
}

/// Module -> the place of its test if no test has its name, and the reason: the lines "module:
/// reason" of tests/<room>/tested_elsewhere.txt.
std::map<std::string, std::string> exceptions(const std::set<std::string>& rooms) {
  std::map<std::string, std::string> reasons;
  for (const std::string& room : rooms)
    for (const std::string& line :
         lines_of(content(root() / "tests" / room / "tested_elsewhere.txt"))) {
      if (line.empty() || line[0] == '#') continue;
      const size_t colon = line.find(": ");
      INFO(room << ": " << line);
      REQUIRE(colon != std::string::npos);
      reasons[room + "/" + line.substr(0, colon)] = line.substr(colon + 2);
    }
  return reasons;
}

bool has_test(const std::string& module) {
  return std::filesystem::is_regular_file(root() / "tests" / (module + "_test.cpp"));
}

}  // namespace

TEST_CASE("no file is too long and no line too wide") {
  for (const SourceFile& file : all_sources(true))
    for (const std::string& breach : breaches(file.path, file.text)) FAIL_CHECK(breach);
}

TEST_CASE("the scripts of pages are as short as the sources") {
  for (const char* folder :
       {"experiments/page/replay", "experiments/page/answers", "experiments/compare/answers"})
    for (const auto& entry : std::filesystem::directory_iterator(root() / folder))
      for (const std::string& breach : breaches(entry.path().filename(), content(entry.path())))
        FAIL_CHECK(breach);
}

TEST_CASE("what is too long or too wide is seen") {
  CHECK(breaches("a.cpp", std::string(longest_file, '\n')).empty());
  CHECK(breaches("a.cpp", std::string(longest_file + 1, '\n')).size() == 1);
  CHECK(breaches("a.cpp", std::string(widest_line, 'x') + "\n").empty());
  CHECK(breaches("a.cpp", std::string(widest_line + 1, 'x') + "\n").size() == 1);
  std::string accents;
  for (size_t k = 0; k < widest_line; ++k) accents += "µ";
  CHECK(breaches("a.cpp", accents).empty());  // counts columns, not bytes
  CHECK(breaches("a.hpp", "int x;\n").size() == 1);
}

TEST_CASE("what a name leads to is asked for by platform/atomic_file alone") {
  const std::regex throwing(R"(filesystem::(exists|is_regular_file|is_directory)\(|)"
                            R"(\bfs::(exists|is_regular_file|is_directory)\((?!status\)))");
  REQUIRE(std::regex_search("if (fs::exists(file)) {", throwing));
  REQUIRE_FALSE(std::regex_search("fs::exists(status)", throwing));
  for (const SourceFile& file : all_sources(false)) {
    INFO(file.path);
    if (!file.path.starts_with("platform/atomic_file"))
      CHECK_FALSE(std::regex_search(file.text, throwing));
  }
}

TEST_CASE("every source folder has tests, in the same tree") {
  std::set<std::string> rooms;
  for (const SourceFile& file : all_sources(false)) rooms.insert(room_of(file.path));
  for (const std::string& room : rooms) {
    INFO(room);
    const auto folder = root() / "tests" / room;
    REQUIRE(std::filesystem::is_directory(folder));
    const std::filesystem::directory_iterator entries(folder);
    CHECK(std::any_of(begin(entries), end(entries), [](const auto& entry) {
      return entry.path().string().ends_with("_test.cpp");
    }));
  }
}

TEST_CASE("every module has its test beside it, or a line that says where it is tested") {
  std::set<std::string> modules, rooms;
  for (const SourceFile& file : all_sources(false)) {
    rooms.insert(room_of(file.path));
    if (file.path.ends_with(".cpp")) modules.insert(module_of(file.path));
  }
  const std::map<std::string, std::string> reasons = exceptions(rooms);
  for (const std::string& module : modules) {
    INFO(module);
    CHECK((has_test(module) || reasons.contains(module)));
  }
  for (const auto& [module, reason] : reasons) {
    INFO(module << ": in tested_elsewhere.txt of its room");
    CHECK(modules.contains(module));
    CHECK_FALSE(has_test(module));
    CHECK(reason.size() > 10);
    CHECK(reason != "not yet looked at");
  }
}
