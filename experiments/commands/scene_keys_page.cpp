#include "experiments/commands/scene_keys_page.hpp"

#include "experiments/page/markdown.hpp"
#include "problems/scene/scene_keys.hpp"

namespace ballast {
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

/// The keys of one `[section]` of a scene, or of several, one after the other: of what has the
/// defaults.
page::Table table_of(const std::vector<std::pair<std::string, SceneKeys>>& sections) {
  page::Table table{.head = {"key", "unit", "default", "expected", "meaning"}};
  for (const auto& [prefix, keys] : sections)
    for (const SceneKey& key : keys)
      table.rows.push_back({page::Text(prefix + key.name, page::code), unit_words(key.rule.unit),
                            default_of(key), expected_text(key.place, key.rule),
                            page::marked(key.meaning)});
  return table;
}

}  // namespace

std::string scene_keys_markdown() {
  page::Section both{"both", "Both kinds"}, grains{"grains", "Grains in a box"},
      bodies{"bodies", "Bodies and walls"};
  Scene scene;
  GravityText gravity;
  both.add(table_of({{"scene.", head_keys(scene)},
                     {"gravity.", gravity_keys(gravity)},
                     {"contact.", contact_keys(scene)},
                     {"solver.", solver_keys(scene.solver)},
                     {"correction.", correction_keys(scene.correction)},
                     {"detection.", detection_keys(scene.detection)},
                     {"record.", record_keys(scene.record)}}));
  for (const page::Text& line : parts_of(page::words("keys.grains"), "\n")) grains.add(line);
  GrainsSpec crowd;
  GrainsText text_of_grains;
  SizeClass size_class;
  grains.add(table_of({{"grains.", grains_keys(crowd, text_of_grains)},
                       {"grains.distribution.", distribution_keys(size_class)},
                       {"grains.shape.", grain_shape_keys(crowd.shape)},
                       {"box.", box_keys(scene.box)},
                       {"deposit.", deposit_keys(scene.deposit)},
                       {"drive.", drive_keys(scene.drive)},
                       {"control_volume.", control_volume_keys(scene.control_volume)}}));
  WallSpec wall;
  std::string motion = "fixed";
  bodies.add(page::words("keys.walls"));
  bodies.add(table_of({{"", wall_keys(wall, motion)},
                       {"", prescribed_wall_keys(wall)},
                       {"", driven_wall_keys(wall)},
                       {"load.", load_keys(wall.load)}}));
  BodySpec body;
  ShapeText shape;
  OrientationText orientation;
  bodies.add(page::words("keys.bodies"));
  bodies.add(table_of({{"", body_keys(body, shape)},
                       {"", shape_keys("box", shape)},
                       {"", shape_keys("sphere", shape)},
                       {"", shape_keys("grain", shape)},
                       {"", shape_keys("mesh", shape)},
                       {"orientation.", orientation_keys(orientation)},
                       {"force.", force_keys(body.force)}}));
  std::string text = markdown_of(both) + markdown_of(grains) + markdown_of(bodies);
  text.pop_back();  // the empty line after the last table
  return text;
}

}  // namespace ballast
