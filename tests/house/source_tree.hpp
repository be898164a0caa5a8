#pragma once
// The project's sources as data: files, rooms, doors and includes, for the tests of the house.

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace ballast::house {

/// One `#include`. `header`: between the quotation marks or the angle brackets.
struct Include {
  std::string header;
  bool own = false;  ///< in quotation marks: a file of this project
};

struct SourceFile {
  std::string path;  ///< from the project's root
  std::string text;
  std::vector<Include> includes;
};

/// Names -> names that they lead to.
using Arrows = std::map<std::string, std::set<std::string>>;

/// The folder of the project.
std::filesystem::path root();
std::string content(const std::filesystem::path& file);
std::vector<std::string> lines_of(const std::string& text);
/// The first group of every match.
std::vector<std::string> matches(const std::string& text, const std::regex& pattern);

SourceFile parse_source(const std::string& path, const std::string& text);
/// Every .hpp and .cpp below the top folders, tests included when asked for. Sorted by path.
std::vector<SourceFile> all_sources(bool with_tests);

/// "solvers/seam/solver" of "solvers/seam/solver.hpp": a header and its source are one module.
std::string module_of(const std::string& path);
/// "solvers/seam" of "solvers/seam/solver.hpp".
std::string room_of(const std::string& path);

/// Room -> rooms that it may include, itself included: what the `ballast_room` calls of all
/// CMakeLists.txt say, followed through.
Arrows doors();
/// The same from the text of one CMakeLists.txt that lies in `folder`: library -> libraries, and in
/// `folder_of` library -> its folder.
Arrows read_rooms(const std::string& text, const std::string& folder,
                  std::map<std::string, std::string>& folder_of);

/// Names that lead to themselves in a ring, and what lies between two rings; empty when there is
/// none.
std::set<std::string> ring(Arrows arrows);

/// Characters that a reader sees, not bytes: UTF-8 continuation bytes are not counted.
size_t columns(std::string_view line);

}  // namespace ballast::house
