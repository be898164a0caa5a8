// The rules of includes between rooms (docs/house/design.md), read from the sources and from CMake.

#include <algorithm>

#include "tests/catch.hpp"
#include "tests/house/source_tree.hpp"

using namespace ballast::house;

namespace {

using Words = std::vector<std::string>;

/// The rule: beginning of a path -> beginnings of the paths that it may include. The doors between
/// rooms (CMake) restrict it further; none may contradict it.
const std::vector<std::pair<std::string, Words>> law = {
    {"platform/", {"platform/"}},
    {"geometry/", {"geometry/", "platform/"}},
    {"problems/algebra/", {"problems/algebra/", "platform/"}},
    {"problems/files/", {"problems/files/", "problems/algebra/", "platform/"}},
    {"problems/", {"problems/", "geometry/", "platform/"}},
    {"solvers/", {"solvers/", "problems/algebra/", "platform/"}},
    {"experiments/", {"experiments/", "solvers/", "problems/", "geometry/", "platform/"}},
    {"tests/", {"tests/", "experiments/", "solvers/", "problems/", "geometry/", "platform/"}},
};

/// Beginning of a third-party header -> beginnings of the paths that may include it.
const std::vector<std::pair<std::string, Words>> third_party = {
    {"Eigen/", {"geometry/", "problems/", "solvers/", "experiments/", "tests/"}},
    {"unsupported/Eigen/", {"experiments/measure/"}},
    {"libqhull_r/", {"geometry/shape/convex_hull"}},
    {"hdf5.h", {"platform/hdf5", "tests/"}},
    {"zlib.h", {"platform/deflate", "tests/"}},
    {"toml++/", {"problems/scene/"}},
    {"CLI/", {"experiments/commands/"}},
    {"nlohmann/", {"experiments/", "tests/"}},
    {"cholmod.h", {"solvers/parts/sparse_factor"}},
    {"Eigen/UmfPackSupport", {"solvers/parts/sparse_factor"}},
    {"klu.h", {"solvers/parts/sparse_factor"}},
    {"Ip", {"solvers/backends/ipopt"}},
    {"nlopt.h", {"solvers/backends/nlopt", "tests/solvers/backends/nlopt"}},
    {"siconos/", {"solvers/backends/siconos"}},
    {"immintrin.h", {"solvers/gauss_seidel/lanes"}},  // the processor's own instructions
    {"catch2/", {"tests/catch.hpp", "tests/test_main.cpp"}},
};

/// POSIX headers. Every other header of the C or C++ library has neither a slash nor a suffix.
const Words posix = {"dirent.h", "fcntl.h",  "fnmatch.h", "glob.h",  "poll.h", "signal.h",
                     "spawn.h",  "stdlib.h", "unistd.h",  "dlfcn.h", "sys/"};

bool begins_like_one_of(const std::string& text, const Words& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](const std::string& b) { return text.starts_with(b); });
}

std::string wrong_system_include(const std::string& path, const std::string& header) {
  for (const auto& [beginning, allowed] : third_party)
    if (header.starts_with(beginning))
      return begins_like_one_of(path, allowed)
                 ? ""
                 : path + ": <" + header + "> belongs in another room";
  if (begins_like_one_of(header, posix)) return "";
  if (header.find_first_of("/.") == std::string::npos) return "";
  return path + ": <" + header + "> is in no table of tests/house/include_test.cpp";
}

std::string wrong_own_include(const std::string& path, const std::string& header,
                              const Arrows& doors_of) {
  if (!std::filesystem::is_regular_file(root() / header))
    return path + ": \"" + header + "\" is no file seen from the root";
  const auto rule = std::find_if(law.begin(), law.end(),
                                 [&](const auto& r) { return path.starts_with(r.first); });
  if (rule == law.end()) return path + ": is in no room";
  if (!begins_like_one_of(header, rule->second))
    return path + ": the law forbids \"" + header + "\"";
  if (path.starts_with("tests/")) return "";
  const auto room = doors_of.find(room_of(path));
  if (room == doors_of.end()) return path + ": its folder is no ballast_room of CMake";
  if (!room->second.contains(room_of(header)))
    return path + ": its room has no door to \"" + header + "\" (DOORS of ballast_room)";
  return "";
}

Words breaches(const SourceFile& file, const Arrows& doors_of) {
  Words found;
  for (const Include& include : file.includes) {
    const std::string wrong = include.own ? wrong_own_include(file.path, include.header, doors_of)
                                          : wrong_system_include(file.path, include.header);
    if (!wrong.empty()) found.push_back(wrong);
  }
  return found;
}

Arrows module_arrows(const std::vector<SourceFile>& files) {
  Arrows arrows;
  for (const SourceFile& file : files)
    for (const Include& include : file.includes)
      if (include.own && module_of(include.header) != module_of(file.path))
        arrows[module_of(file.path)].insert(module_of(include.header));
  return arrows;
}

}  // namespace

TEST_CASE("every include goes through a door, and downward") {
  const Arrows doors_of = doors();
  const std::vector<SourceFile> files = all_sources(true);
  CHECK(files.size() > 400);  // it has read the right folder
  CHECK(doors_of.size() > 20);
  for (const SourceFile& file : files)
    for (const std::string& breach : breaches(file, doors_of)) FAIL_CHECK(breach);
}

TEST_CASE("no modules include each other in a ring, and no rooms") {
  const Arrows modules = module_arrows(all_sources(false));
  CHECK(ring(modules) == std::set<std::string>{});
  Arrows rooms;
  for (const auto& [from, all] : modules)
    for (const std::string& to : all)
      if (room_of(from) != room_of(to)) rooms[room_of(from)].insert(room_of(to));
  CHECK(ring(rooms) == std::set<std::string>{});
}

TEST_CASE("rings are found") {
  CHECK(ring({{"a", {"b"}}, {"b", {"c"}}, {"c", {}}}).empty());
  CHECK(ring({{"a", {"b"}}, {"b", {"c", "d"}}, {"c", {"a"}}, {"d", {"b", "e"}}, {"x", {"a"}}}) ==
        std::set<std::string>{"a", "b", "c", "d"});
}

TEST_CASE("rooms and doors are read from CMake") {
  std::map<std::string, std::string> folder_of;
  const Arrows found = read_rooms(
      "ballast_room(upper attic DOORS lower LIBRARIES x::y EXCEPT a.cpp)\n"
      "ballast_room(lower .)\n",
      "house", folder_of);
  CHECK(found == Arrows{{"upper", {"lower"}}, {"lower", {}}});
  CHECK(folder_of["upper"] == "house/attic");
  CHECK(folder_of["lower"] == "house");
}

TEST_CASE("the reader of includes sees what is forbidden") {
  const std::vector<std::pair<const char*, const char*>> allowed = {
      {"geometry/contact/a.cpp", "#include \"geometry/shape/pose.hpp\"\n"},
      {"problems/scene/a.cpp", "#include \"geometry/shape/pose.hpp\"\n"},
      {"solvers/parts/a.cpp", "#include \"problems/algebra/friction_cone.hpp\"\n"},
      {"experiments/run/a.cpp", "#include \"experiments/step/time_step.hpp\"\n"},
      {"tests/a.cpp", "#include \"experiments/run/run.hpp\"\n"},
      {"solvers/parts/sparse_factor.cpp", "#include <cholmod.h>\n"},
      {"solvers/seam/a.cpp", "#include <vector>\n#include <Eigen/Dense>\n"}};
  const std::vector<std::pair<const char*, const char*>> forbidden = {
      {"geometry/shape/a.cpp", "#include \"problems/algebra/friction_problem.hpp\"\n"},
      {"geometry/shape/a.cpp", "#include \"geometry/contact/contact_normal.hpp\"\n"},
      {"problems/algebra/a.cpp", "#include \"geometry/shape/pose.hpp\"\n"},
      {"problems/scene/a.cpp", "#include \"solvers/seam/solver.hpp\"\n"},
      {"solvers/parts/a.cpp", "  #include   \"problems/mechanics/assemble.hpp\"  // why\n"},
      {"experiments/step/a.cpp", "#include \"tests/catch.hpp\"\n"},
      {"experiments/step/a.cpp", "#include \"experiments/run/run.hpp\"\n"},
      {"cellar/a.cpp", "#include \"geometry/shape/pose.hpp\"\n"},
      {"solvers/seam/a.cpp", "#include \"solver.hpp\"\n"},
      {"solvers/seam/a.cpp", "#include <cholmod.h>\n"},
      {"solvers/seam/a.cpp", "#include <boost/any.hpp>\n"},
      {"solvers/seam/a.cpp", "#include <strange.h>\n"}};
  const Arrows doors_of = doors();
  for (const auto& [path, text] : allowed)
    CHECK(breaches(parse_source(path, text), doors_of) == Words{});
  for (const auto& [path, text] : forbidden) {
    INFO(path << ": " << text);
    CHECK(breaches(parse_source(path, text), doors_of).size() == 1);
  }
}
