// What there is: solvers, scenes, keys.

#include "experiments/page/markdown.hpp"
#include "platform/atomic_file.hpp"
#include "problems/scene/scene_file.hpp"
#include "problems/scene/scene_keys.hpp"
#include "solvers/solver_list.hpp"
#include "tests/support/program.hpp"

using namespace ballast;

TEST_CASE("solvers are listed with what they are, as a table") {
  const ProgramResult table = ballast_program({"solvers"});
  CHECK(table.status == 0);
  for (const SolverEntry& entry : solver_list())
    CHECK_THAT(table.output, Catch::Contains("\n" + std::string(entry.name) + " "));
}

TEST_CASE("scenes are listed, printed, resolved") {
  const ProgramResult list = ballast_program({"scenes"});
  for (const auto& [name, title] : list_scenes())
    CHECK_THAT(list.output, Catch::Contains(name) && Catch::Contains(title));
  CHECK_THAT(ballast_program({"scenes", "incline"}).output, Catch::Contains("[[body]]"));
  // all but the name, which is to be the file's that it is printed into
  std::string resolved = resolved_scene_text(find_scene("incline"));
  const std::string name = "name = \"incline\"\n";
  resolved.erase(resolved.find(name, resolved.find("[scene]")), name.size());
  CHECK(ballast_program({"scenes", "incline", "--resolved"}).output == resolved);
  const ProgramResult changed = ballast_program({"scenes", "incline", "--set", "scene.step=1e-5"});
  CHECK_THAT(changed.output, Catch::Contains("step = 1e-05"));
  check_failure(ballast_program({"scenes", "none"}), ExitCode::failure, {"none", "vibrated_box"});
}

namespace {

/// "kg/m^3" with a raised digit.
std::string unit_words(std::string unit) {
  if (const size_t at = unit.find("^2"); at != std::string::npos) unit.replace(at, 2, "²");
  if (const size_t at = unit.find("^3"); at != std::string::npos) unit.replace(at, 2, "³");
  return unit;
}

/// A value as TOML has it, or words that say what stands for it.
page::Text default_of(const SceneKey& key) {
  if (key.default_words) return key.default_words;
  if (key.presence == Presence::required) return "required";
  const std::string value = kept_text(key.place);
  if (value == "\"\"") return "empty";
  return value.empty() ? page::Text() : page::Text(value, page::code);
}

/// The keys of tables of a scene, one after the other, as the manual has them: of what has the
/// defaults.
std::string table_of(const std::vector<std::pair<std::string, SceneKeys>>& sections) {
  page::Table table{.head = {"key", "unit", "default", "expected", "meaning"}};
  for (const auto& [prefix, keys] : sections)
    for (const SceneKey& key : keys)
      table.rows.push_back({page::Text(prefix + key.name, page::code), unit_words(key.rule.unit),
                            default_of(key), expected_text(key.place, key.rule),
                            page::marked(key.meaning)});
  return markdown_of(page::Block(table));
}

}  // namespace

TEST_CASE("docs/manual/scenes.md has the tables by which scenes are read, to the letter") {
  const std::string docs = read_whole_file(BALLAST_SOURCE_FOLDER "/docs/manual/scenes.md");
  Scene scene;
  GravityText gravity;
  GrainsSpec crowd;
  GrainsText text_of_grains;
  SizeClass size_class;
  WallSpec wall;
  std::string motion = "fixed";
  BodySpec body;
  ShapeText shape;
  OrientationText orientation;
  // what fails here prints the table that belongs there
  for (const std::string& table :
       {table_of({{"scene.", head_keys(scene)},
                  {"gravity.", gravity_keys(gravity)},
                  {"contact.", contact_keys(scene)},
                  {"solver.", solver_keys(scene.solver)},
                  {"correction.", correction_keys(scene.correction)},
                  {"detection.", detection_keys(scene.detection)},
                  {"record.", record_keys(scene.record)}}),
        table_of({{"grains.", grains_keys(crowd, text_of_grains)},
                  {"grains.distribution.", distribution_keys(size_class)},
                  {"grains.shape.", grain_shape_keys(crowd.shape)},
                  {"box.", box_keys(scene.box)},
                  {"deposit.", deposit_keys(scene.deposit)},
                  {"drive.", drive_keys(scene.drive)},
                  {"control_volume.", control_volume_keys(scene.control_volume)}}),
        table_of({{"", wall_keys(wall, motion)},
                  {"", prescribed_wall_keys(wall)},
                  {"", driven_wall_keys(wall)},
                  {"load.", load_keys(wall.load)}}),
        table_of({{"", body_keys(body, shape)},
                  {"", shape_keys("box", shape)},
                  {"", shape_keys("sphere", shape)},
                  {"", shape_keys("grain", shape)},
                  {"", shape_keys("mesh", shape)},
                  {"orientation.", orientation_keys(orientation)},
                  {"force.", force_keys(body.force)}})})
    CHECK_THAT(docs + '\n', Catch::Contains(table));
}
