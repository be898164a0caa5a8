// The house's rules, read from the sources themselves: who may include whom (docs/design.md), and no room larger than a
// reader likes.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/catch.hpp"

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Room -> rooms that it may include.
const std::map<std::string, std::set<std::string>> arrows = {
    {"geometry", {"geometry"}},
    {"algebra", {"algebra"}},
    {"mechanics", {"mechanics", "geometry", "algebra"}},
    {"solvers", {"solvers", "algebra"}},
    {"experiments", {"experiments", "solvers", "mechanics", "geometry", "algebra"}},
    {"tests", {"tests", "experiments", "solvers", "mechanics", "geometry", "algebra"}},
};

/// problems/ has two rooms: files whose names begin like this are mechanics, all others are algebra.
const Words mechanics_files = {"scene", "toml_", "mechanical_system", "assemble", "solid_fraction"};

/// Beginning of a third-party header -> beginnings of the paths that may include it.
const std::vector<std::pair<std::string, Words>> third_party = {
    {"Eigen/", {"geometry/", "problems/", "solvers/", "experiments/", "tests/"}},
    {"libqhull_r/", {"geometry/convex_hull"}},
    {"hdf5.h", {"problems/problem_file", "problems/fclib", "problems/hdf5", "experiments/hdf5_file", "tests/"}},
    {"toml++/", {"problems/toml_", "problems/scene_"}},
    {"CLI/", {"experiments/commands/"}},
    {"benchmark/", {"experiments/bench/kernels"}},
    {"nlohmann/", {"experiments/", "tests/"}},
    {"cholmod.h", {"solvers/sparse_factor"}},
    {"umfpack.h", {"solvers/sparse_factor"}},
    {"klu.h", {"solvers/sparse_factor"}},
    {"Ip", {"solvers/ipopt"}},
    {"nlopt.h", {"solvers/nlopt", "tests/solvers/nlopt"}},
    {"siconos/", {"solvers/siconos"}},
    {"catch2/", {"tests/catch.hpp", "tests/test_main.cpp"}},
};

/// POSIX; every other header of the C or C++ library has neither a slash nor a suffix.
const Words posix = {"fcntl.h", "fnmatch.h", "glob.h", "poll.h", "signal.h", "spawn.h", "stdlib.h", "unistd.h", "sys/"};

constexpr int longest_file = 350;  // lines

bool begins_like_one_of(const std::string& text, const Words& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(), [&](const std::string& b) { return text.starts_with(b); });
}

std::string room_of(const std::string& path) {
  const std::string top = path.substr(0, path.find('/'));
  if (top != "problems") return top;
  return begins_like_one_of(path.substr(top.size() + 1), mechanics_files) ? "mechanics" : "algebra";
}

/// What is wrong with `#include <header>` in the file `path`; empty: nothing.
std::string wrong_system_include(const std::string& path, const std::string& header) {
  for (const auto& [beginning, allowed] : third_party)
    if (header.starts_with(beginning))
      return begins_like_one_of(path, allowed) ? "" : path + ": <" + header + "> belongs in another room";
  if (begins_like_one_of(header, posix)) return "";
  if (header.find_first_of("/.") == std::string::npos) return "";
  return path + ": <" + header + "> is in no table of tests/house_test.cpp";
}

std::string wrong_own_include(const fs::path& root, const std::string& path, const std::string& header) {
  if (!fs::is_regular_file(root / header)) return path + ": \"" + header + "\" is no file seen from the root";
  const std::string from = room_of(path), to = room_of(header);
  if (!arrows.contains(from)) return path + ": is in no room";
  return arrows.at(from).contains(to) ? "" : path + ": " + from + " may not include " + to + " (\"" + header + "\")";
}

/// Every breach of the rules in one file. `path`: from the root.
Words breaches(const fs::path& root, const std::string& path, const std::string& text) {
  Words found;
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    std::istringstream words(line);
    std::string word, header;
    if (!(words >> word >> header) || word != "#include") continue;
    const char close = header[0] == '<' ? '>' : '"';
    const size_t end = header.find(close, 1);
    if (end == std::string::npos) continue;
    const std::string name = header.substr(1, end - 1);
    const std::string wrong = close == '>' ? wrong_system_include(path, name) : wrong_own_include(root, path, name);
    if (!wrong.empty()) found.push_back(wrong);
  }
  if (count > longest_file)
    found.push_back(path + ": " + std::to_string(count) + " lines, at most " + std::to_string(longest_file));
  if (path.ends_with(".hpp") && text.find("#pragma once") == std::string::npos)
    found.push_back(path + ": no #pragma once");
  return found;
}

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("every include goes along an allowed arrow, and no file is too long") {
  const fs::path root = BALLAST_SOURCE_FOLDER;
  int files = 0;
  for (const char* top : {"geometry", "problems", "solvers", "experiments", "tests"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string suffix = entry.path().extension().string();
      if (suffix != ".cpp" && suffix != ".hpp") continue;
      ++files;
      for (const std::string& breach : breaches(root, fs::relative(entry.path(), root).string(), content(entry.path())))
        FAIL_CHECK(breach);
    }
  }
  CHECK(files > 50);  // the right folder was read
}

TEST_CASE("the reader of includes sees what is forbidden") {
  const fs::path root = BALLAST_SOURCE_FOLDER;
  struct Example {
    const char *path, *text;
    bool allowed;
  };
  const std::vector<Example> examples = {
      {"geometry/a.cpp", "#include \"problems/friction_problem.hpp\"\n", false},
      {"geometry/a.cpp", "#include \"geometry/pose.hpp\"\n", true},
      {"problems/delassus.cpp", "#include \"problems/scene.hpp\"\n", false},
      {"problems/delassus.cpp", "#include \"geometry/pose.hpp\"\n", false},
      {"problems/scene_file.cpp", "#include \"geometry/pose.hpp\"\n", true},
      {"problems/scene_file.cpp", "#include \"solvers/solver.hpp\"\n", false},
      {"solvers/a.cpp", "#include \"geometry/pose.hpp\"\n", false},
      {"solvers/a.cpp", "  #include   \"problems/mechanical_system.hpp\"  // why\n", false},
      {"solvers/a.cpp", "#include \"problems/friction_cone.hpp\"\n", true},
      {"experiments/a.cpp", "#include \"tests/catch.hpp\"\n", false},
      {"experiments/a.cpp", "#include \"solvers/solver.hpp\"\n", true},
      {"tests/a.cpp", "#include \"experiments/run.hpp\"\n", true},
      {"cellar/a.cpp", "#include \"geometry/pose.hpp\"\n", false},
      {"solvers/a.cpp", "#include \"solver.hpp\"\n", false},
      {"solvers/a.cpp", "#include <toml++/toml.h>\n", false},
      {"solvers/a.cpp", "#include <cholmod.h>\n", false},
      {"solvers/sparse_factor.cpp", "#include <cholmod.h>\n", true},
      {"solvers/a.cpp", "#include <boost/any.hpp>\n", false},
      {"solvers/a.cpp", "#include <strange.h>\n", false},
      {"solvers/a.cpp", "#include <vector>\n#include <Eigen/Dense>\n", true},
      {"geometry/a.hpp", "#pragma once\n", true},
      {"geometry/a.hpp", "int x;\n", false},
  };
  for (const Example& example : examples) {
    INFO(example.path << ": " << example.text);
    CHECK(breaches(root, example.path, example.text).empty() == example.allowed);
  }
  CHECK(!breaches(root, "solvers/long.cpp", std::string(longest_file + 1, '\n')).empty());
  CHECK(breaches(root, "solvers/long.cpp", std::string(longest_file, '\n')).empty());
}

TEST_CASE("what docs/adding_a_solver.md quotes is what the files say") {
  const fs::path root = BALLAST_SOURCE_FOLDER;
  std::istringstream lines(content(root / "docs" / "adding_a_solver.md"));
  std::string file, quotation;
  bool inside = false;
  int quotations = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!inside) {  // the last file that was named before a block is the one quoted
      for (size_t at = line.find("`solvers/"); at != std::string::npos; at = line.find("`solvers/", at + 1))
        file = line.substr(at + 1, line.find('`', at + 1) - at - 1);
      inside = line == "```cpp" || line == "```cmake";
      quotation.clear();
    } else if (line == "```") {
      inside = false;
      ++quotations;
      INFO(file << ":\n" << quotation);
      CHECK(content(root / file).find(quotation) != std::string::npos);
    } else {
      quotation += line + "\n";
    }
  }
  CHECK(quotations >= 8);
}
