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
template <class Spec>
page::Text default_of(const SceneKey<Spec>& key) {
  if (key.default_words) return key.default_words;
  if (key.presence == Presence::required) return "required";
  Spec defaults;
  const std::string value = kept_text(key.value.in(defaults));
  if (value == "\"\"") return "empty";
  return value.empty() ? page::Text() : page::Text(value, page::code);
}

template <class Spec>
std::string expected_of(const SceneKey<Spec>& key) {
  Spec defaults;
  return expected_text(key.value.in(defaults), key.value.rule);
}

template <class Spec>
void add_keys(const std::string& prefix, const SceneKeys<Spec>& keys, page::Table& table) {
  for (const SceneKey<Spec>& key : keys)
    table.rows.push_back({page::Text(prefix + key.name, page::code),
                          unit_words(key.value.rule.unit), default_of(key), expected_of(key),
                          page::marked(key.meaning)});
}

/// The keys of one `[section]` of a scene, or of several, one after the other.
template <class... Keys>
page::Table table_of(const std::pair<const char*, Keys>&... parts) {
  page::Table table{.head = {"key", "unit", "default", "expected", "meaning"}};
  (add_keys(parts.first, parts.second, table), ...);
  return table;
}

}  // namespace

std::string scene_keys_markdown() {
  using std::pair;
  page::Section both{"both", "Both kinds"}, grains{"grains", "Grains in a box"},
      bodies{"bodies", "Bodies and walls"};
  both.add(table_of(pair("scene.", head_keys), pair("gravity.", gravity_keys),
                    pair("contact.", contact_keys), pair("solver.", solver_keys),
                    pair("sleep.", sleep_keys), pair("correction.", correction_keys),
                    pair("detection.", detection_keys), pair("record.", record_keys)));
  for (const page::Text& line : parts_of(page::words("keys.grains"), "\n")) grains.add(line);
  grains.add(table_of(pair("grains.", grains_keys), pair("grains.distribution.", distribution_keys),
                      pair("grains.shape.", grain_shape_keys), pair("box.", box_keys),
                      pair("deposit.", deposit_keys), pair("drive.", drive_keys),
                      pair("control_volume.", control_volume_keys)));
  bodies.add(page::words("keys.walls"));
  bodies.add(table_of(pair("", wall_keys), pair("", prescribed_wall_keys),
                      pair("", driven_wall_keys), pair("load.", load_keys)));
  bodies.add(page::words("keys.bodies"));
  bodies.add(table_of(pair("", body_keys), pair("", shape_keys("box")),
                      pair("", shape_keys("sphere")), pair("", shape_keys("grain")),
                      pair("", shape_keys("mesh")), pair("orientation.", orientation_keys),
                      pair("force.", force_keys)));
  std::string text = markdown_of(both) + markdown_of(grains) + markdown_of(bodies);
  text.pop_back();  // the empty line after the last table
  return text;
}

}  // namespace ballast
