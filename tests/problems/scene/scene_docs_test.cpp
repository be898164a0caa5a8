// docs/manual/scenes.md agrees with the program about every key of a scene.

#include <fstream>
#include <map>
#include <set>

#include "platform/text.hpp"
#include "tests/problems/scene/scene_texts.hpp"
#include "tests/support/mesh_writer.hpp"

using namespace ballast;

namespace {

/// A row of the tables. `list` is "", or the prefix of its keys: "wall.0.", "body.0.part.0.".
struct Row {
  std::string list, key, unit, by_default, expected, meaning;
  /// The key in the form of an override.
  std::string path() const {
    std::string name = list + key;
    const std::string classes = "grains.distribution.";
    return name.starts_with(classes) ? name.insert(classes.size(), "0.") : name;
  }
};

std::vector<Row> rows_of_docs() {
  std::vector<Row> rows;
  std::ifstream docs(BALLAST_SOURCE_FOLDER "/docs/manual/scenes.md");
  std::string list;
  for (std::string line; std::getline(docs, line);) {
    for (const char* name : {"wall.0.", "body.0.", "crowd.0.", "body.0.part.0.", "body.0.repeat.0.",
                             "contact.pair.0."}) {
      std::string head = std::string("`[[") + name + "]]`";  // `[[body.part]]`
      for (size_t at; (at = head.find(".0")) != std::string::npos;) head.erase(at, 2);
      if (line.starts_with(head.replace(head.find(".]"), 1, ""))) list = name;
    }
    if (!line.starts_with("| `")) continue;
    for (const auto& [sign, plain] : {std::pair("²", "^2"), std::pair("³", "^3")})
      if (const size_t at = line.find(sign); at != std::string::npos) line.replace(at, 2, plain);
    std::vector<std::string> cells = split(line, '|');
    REQUIRE(cells.size() == 7);
    for (std::string& cell : cells) cell = cell.size() < 3 ? "" : cell.substr(1, cell.size() - 2);
    rows.push_back(
        {list, cells[1].substr(1, cells[1].size() - 2), cells[2], cells[3], cells[4], cells[5]});
  }
  return rows;
}

/// A scene in which the key may stand.
std::string scene_with(const Row& row) {
  const auto is_of = [&](const char* kind) { return row.meaning.starts_with(kind); };
  if (row.list.empty())
    return "[grains]\ncount = 10\n[[grains.distribution]]\nsize = 0.02\nfraction = 1.0\n"
           "[box]\nlength = 0.3\nwidth = 0.3\n";
  if (row.key == "scene.period") return one_wall;
  if (row.list == "wall.0." && row.key == "motion") return one_wall;
  if (row.list == "contact.pair.0.")
    return one_wall +
           "material = \"steel\"\n[[contact.pair]]\nmaterials = [\"steel\", \"steel\"]\n" +
           "friction = 0.1\n";
  if (row.list == "crowd.0.")
    return "[[crowd]]\ncount = 1\nradius = 0.1\ndensity = 1\nfrom = [0, 0, 0]\nto = [1, 1, "
           "1]\nshape = " +
           std::string(is_of("sphere:") ? "\"sphere\"\n" : "\"box\"\n");
  if (row.list == "wall.0.")
    return one_wall +
           (is_of("prescribed")
                ? "motion = \"prescribed\"\nvelocity = [0, 0, 0]\n"
                : "motion = \"driven\"\nmass = 1\n[wall.load]\nf_max = 1\nfrequency = 5\n");
  const char* shape = is_of("sphere:")    ? "shape = \"sphere\"\nradius = 1\n"
                      : is_of("grain:")   ? "shape = \"grain\"\nradius = 1\n"
                      : is_of("mesh:")    ? "shape = \"mesh\"\nfile = \"stone.obj\"\n"
                      : is_of("hull:")    ? "shape = \"hull\"\n"
                                            "points = [[0,0,0], [1,0,0], [0,1,0], [0,0,1]]\n"
                      : is_of("surface:") ? "shape = \"surface\"\nfile = \"stone.obj\"\n"
                                            "thickness = 0.1\nlocked = [\"x\", \"y\", \"z\", "
                                            "\"rotation\"]\n"
                                          : "shape = \"box\"\nsize = [1, 1, 1]\n";
  const char* rest = is_of("motion:") ? "[body.motion.turn]\naxis = [0, 0, 1]\n"
                     : row.list == "body.0.part.0."
                         ? "[[body.part]]\nshape = \"box\"\nsize = [1, 1, 1]\n"
                     : row.list == "body.0.repeat.0." ? "[[body.repeat]]\ncount = 2\n"
                                                      : "";
  if (row.list == "body.0.part.0.") shape = "";
  return std::string("[[body]]\n") + (row.key == "mass" ? "" : "density = 1\n") + shape + rest;
}

/// The same scene without the line of the key.
std::string scene_without(const Row& row) {
  std::string text = scene_with(row);
  const size_t at = text.find("\n" + row.key.substr(row.key.rfind('.') + 1) + " = ");
  REQUIRE(at != std::string::npos);
  return text.erase(at, text.find('\n', at + 1) - at);
}

/// Values that the key does not take; a date is always wrong. Numbers lie just outside the range,
/// or at an end that does not belong to it.
std::vector<std::string> wrong_values(const std::string& expected) {
  static const std::map<std::string, std::vector<std::string>> wrongs{
      {"a text", {"3"}},
      {"true or false", {"1", "\"true\""}},
      {"a list of texts", {"\"x\"", "[1]"}},
      {"three finite numbers", {"[0, 1]", "[0, 1, \"z\"]", "[0, nan, 1]", "[0, 1, inf]"}},
      {"a finite number", {"nan", "inf", "\"1\""}},
      {"a list of rows of 2 finite numbers", {"3", "[1, 2]", "[[1, 2], [3]]", "[[1, nan]]"}},
      {"a list of rows of 3 finite numbers", {"3", "[[1, 2]]", "[[1, 2, \"z\"]]"}},
      {"a list of rows of 4 finite numbers", {"3", "[[1, 2, 3]]", "[[1, 2, 3, inf]]"}},
      {"a number > 0", {"0", "-1", "nan", "inf", "true", "\"fast\""}},
      {"a number >= 0", {"-1e-9", "nan", "inf"}},
      {"a number > 0 and <= 1", {"0", "1.01"}},
      {"a number > 0 and <= 0.5", {"0", "0.51"}},
      {"a number from 0 to 1", {"-0.01", "1.01"}},
      {"a number from 0 to below 0.15", {"-0.01", "0.15"}},
      {"a number from 0 to 1e4", {"-0.1", "10001", "inf"}},
      {"an axis ratio > 0.1 and <= 1", {"0.1", "1.01"}},
      {"a whole number >= 0", {"-1", "2.5"}},
      {"a whole number from 0 to 5", {"-1", "6"}},
      {"a whole number from 4 to 200", {"3", "201"}},
      {"a whole number from 1 to 100000", {"0", "100001", "2.5"}},
      {"a whole number from 1 to 1000", {"0", "1001", "1.5"}},
      {"a whole number from 1 to 1000000", {"0", "1000001", "2.5"}},
      {"a whole number from 1 to 1000000000", {"0", "1000000001", "2.5"}}};
  std::vector<std::string> values{"1979-05-27"};
  if (expected.starts_with("one of \"")) {
    values.push_back("\"other\"");
  } else {
    INFO(expected);
    REQUIRE(wrongs.contains(expected));
    values.insert(values.end(), wrongs.at(expected).begin(), wrongs.at(expected).end());
  }
  return values;
}

}  // namespace

TEST_CASE("each key's unit, default and range are those of the manual, other values are refused") {
  const TemporaryFolder folder;
  write_mesh(folder.path() / "stone.obj", make_box(Vec3(1, 2, 3)));
  const std::vector<Row> rows = rows_of_docs();
  REQUIRE(rows.size() > 90);
  for (const Row& row : rows) {
    const std::string unit = row.unit.empty() ? "" : " [" + row.unit + "]";
    const std::string expected = ", expected " + row.expected + unit;
    const auto file = folder.write("scene.toml", scene_with(row));
    const std::string start = file.string() + " (--set): " + row.path() + " = ";
    for (const std::string& value : wrong_values(row.expected)) {
      INFO(row.path() << "=" << value);
      const std::vector<std::string> set{row.path() + "=" + value};
      CHECK_THROWS_WITH(read_scene(file, set),
                        Catch::StartsWith(start) && Catch::EndsWith(expected));
    }
    INFO(row.path());
    if (row.by_default == "required")
      CHECK_THROWS_WITH(read_scene(folder.write("without.toml", scene_without(row))),
                        Catch::EndsWith(row.path() + " is missing" + expected));
    if (!row.by_default.starts_with('`')) continue;
    const std::string value = row.by_default.substr(1, row.by_default.size() - 2);
    const std::vector<std::string> set{row.path() + "=" + value};
    CHECK(resolve_scene(file, set).text == resolve_scene(file).text);
  }
}

TEST_CASE("the manual has every key that a scene can have") {
  const TemporaryFolder folder;
  write_mesh(folder.path() / "stone.obj", make_box(Vec3(1, 2, 3)));
  const std::vector<Row> rows = rows_of_docs();
  std::set<std::string> paths, asked;
  for (const Row& row : rows) paths.insert(row.path());
  for (const Row& row : rows) {
    if (row.key == "mass" && row.list == "body.0.") continue;  // its scene is that of density
    const std::string table = row.path().substr(0, row.path().rfind('.') + 1);
    if (!asked.insert(table + scene_with(row)).second) continue;
    const std::string message = error_of(folder, scene_with(row), {table + "zzzzzzzzzzzzzzzz=1"});
    INFO(message);
    const std::string before = "unknown key, expected one of";
    REQUIRE(message.find(before) != std::string::npos);
    for (const std::string& key :
         split(message.substr(message.find(before) + before.size()), ',')) {
      if (table == "body.0.part.0." && (key == " size" || key == " part")) continue;  // its shape's
      const auto next = paths.lower_bound(table + key.substr(1));
      CHECK((next != paths.end() && next->starts_with(table + key.substr(1))));
    }
  }
  CHECK(asked.size() > 20);
}
