#pragma once
// The project's sources as data: files, rooms, doors and includes, for the tests of house rules.

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace ballast::house {

/// One `#include`. `header`: the text between the quotation marks or the angle brackets.
struct Include {
  std::string header;
  bool own = false;  ///< in quotation marks: a file of this project
};

struct SourceFile {
  std::string path;  ///< from the project's root
  std::string text;
  std::vector<Include> includes;
};

/// Names -> the names that each leads to.
using Arrows = std::map<std::string, std::set<std::string>>;

/// The project's root folder.
std::filesystem::path root();
std::string content(const std::filesystem::path& file);
std::vector<std::string> lines_of(const std::string& text);
/// The first group of every match.
std::vector<std::string> matches(const std::string& text, const std::regex& pattern);

SourceFile parse_source(const std::string& path, const std::string& text);
/// Every .hpp and .cpp below the top folders, on request with the tests. Sorted by path.
std::vector<SourceFile> all_sources(bool with_tests);

/// "solvers/seam/solver" of "solvers/seam/solver.hpp": a header and its source are one module.
std::string module_of(const std::string& path);
/// "solvers/seam" of "solvers/seam/solver.hpp".
std::string room_of(const std::string& path);

/// Room -> the rooms that it may include, itself included: the transitive closure of the
/// `ballast_room` calls of all CMakeLists.txt.
Arrows doors();
/// Library -> libraries, from the text of one CMakeLists.txt that lies in `folder`. Also fills in
/// `folder_of`: library -> its folder.
Arrows read_rooms(const std::string& text, const std::string& folder,
                  std::map<std::string, std::string>& folder_of);

/// The names in rings, which lead back to themselves, and the names between two rings. Empty when
/// there is no ring.
std::set<std::string> ring(Arrows arrows);

/// The number of characters that a reader sees: UTF-8 continuation bytes do not count.
size_t columns(std::string_view line);

}  // namespace ballast::house
