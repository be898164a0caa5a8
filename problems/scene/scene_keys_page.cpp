#include "problems/scene/scene_keys_page.hpp"

#include "problems/scene/scene_keys.hpp"

namespace ballast {
namespace {

/// "kg/m^3" with a raised digit.
std::string unit_words(std::string unit) {
  if (const size_t at = unit.find("^2"); at != std::string::npos) unit.replace(at, 2, "²");
  if (const size_t at = unit.find("^3"); at != std::string::npos) unit.replace(at, 2, "³");
  return unit;
}

template <class Spec>
std::string row_of(const std::string& table, const SceneKey<Spec>& key) {
  Spec defaults;
  const ValuePlace place = key.value.in(defaults);
  std::string fallback = kept_text(place);
  if (fallback == "\"\"") fallback = "empty";
  if (key.presence == Presence::required) fallback = "required";
  if (key.default_words) fallback = key.default_words;
  return "| `" + table + key.name + "` | " + unit_words(key.value.rule.unit) + " | " + fallback +
         " | " + expected_text(place, key.value.rule) + " | " + key.meaning + " |\n";
}

template <class Spec>
std::string rows_of(const std::string& table, const SceneKeys<Spec>& keys) {
  std::string text;
  for (const SceneKey<Spec>& key : keys) text += row_of(table, key);
  return text;
}

constexpr const char* head =
    "\n| key | unit | default | expected | meaning |\n|---|---|---|---|---|\n";

}  // namespace

std::string scene_keys_markdown() {
  std::string text = std::string("## Both kinds\n") + head;
  text += rows_of("scene.", head_keys) + rows_of("gravity.", gravity_keys) +
          rows_of("contact.", contact_keys) + rows_of("solver.", solver_keys) +
          rows_of("sleep.", sleep_keys) + rows_of("correction.", correction_keys) +
          rows_of("detection.", detection_keys) + rows_of("record.", record_keys);
  text +=
      "\n## Grains in a box\n\n"
      "The grains fall into the box, a lid presses them, is raised and fixed, and the wall at\n"
      "x = length is pushed inwards by f(t) = (f_max + f_min)/2 − (f_max − f_min)/2 · sin 2πνt.\n";
  text += head + rows_of("grains.", grains_keys) +
          rows_of("grains.distribution.", distribution_keys) +
          rows_of("grains.shape.", grain_shape_keys) + rows_of("box.", box_keys) +
          rows_of("deposit.", deposit_keys) + rows_of("drive.", drive_keys) +
          rows_of("control_volume.", control_volume_keys);
  text +=
      "\n## Bodies and walls\n\n"
      "`[[wall]]`: the half-space boundary normal·x = offset, for a normal of any length.\n";
  text += head + rows_of("", wall_keys) + rows_of("", prescribed_wall_keys) +
          rows_of("", driven_wall_keys) + rows_of("load.", load_keys);
  text += std::string("\n`[[body]]`\n") + head + rows_of("", body_keys);
  for (const char* shape : {"box", "sphere", "grain", "mesh"})
    text += rows_of("", shape_keys(shape));
  return text + rows_of("orientation.", orientation_keys) + rows_of("force.", force_keys);
}

}  // namespace ballast
