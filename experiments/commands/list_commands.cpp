// What there is: solvers, scenes and their keys, version.

#include <fstream>
#include <iostream>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/page/markdown.hpp"
#include "experiments/run/build_info.hpp"
#include "experiments/run/manifest.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"
#include "problems/scene/scene_keys.hpp"
#include "solvers/solver_list.hpp"

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

namespace {

void print_solvers() {
  std::cout << printed("%-18s%-19s%-7s%-10s", "name", "law", "built", "largest")
            << "what it is (largest: contacts with friction that it takes)\n";
  for (const SolverEntry& entry : solver_list()) {
    const std::string largest =
        entry.largest.none() ? "any" : std::to_string(entry.largest.with_friction);
    std::cout << printed("%-18s%-19s%-7s%-10s", entry.name, name_of(entry.law),
                         entry.make ? "yes" : "no", largest.c_str())
              << entry.description;
    if (!entry.make) std::cout << " [install " << entry.needs.package << "]";
    std::cout << '\n';
  }
}

void print_scenes() {
  std::cout << "in " << scene_folder().string() << ":\n";
  for (const auto& [name, title] : list_scenes())
    std::cout << printed("%-22s", name.c_str()) << title << '\n';
}

/// Without scene.name where it is only the file's: in a file of the user's own it would lead into
/// the results of the scene that was printed.
std::string without_name(std::string text, const std::string& name) {
  const std::string line = "\nname = \"" + name + "\"\n";
  const size_t at = text.find(line, text.find("[scene]"));
  return at == std::string::npos ? text : text.erase(at, line.size() - 1);
}

void print_scene(const std::string& name, const std::vector<std::string>& overrides,
                 bool resolved) {
  const std::filesystem::path file = find_scene(name);
  if (resolved || !overrides.empty()) {
    std::cout << without_name(resolved_scene_text(file, overrides), file.stem().string());
    return;
  }
  std::cout << std::ifstream(file).rdbuf();
}

void print_version() {
  const BuildInfo& info = build_info();
  std::cout << "ballast " << info.version << '\n'
            << "commit        " << info.commit << (info.modified ? "-dirty" : "") << '\n'
            << "compiler      " << info.compiler << '\n'
            << "build type    " << info.build_type << '\n'
            << "flags         " << info.flags << '\n';
  for (const auto& [name, version] : info.libraries)
    std::cout << printed("%-14s", name.c_str()) << version << '\n';
  std::cout << "processor     " << cpu_model() << '\n';
}

}  // namespace

Command solvers_command() {
  return {"solvers", "Lists the solvers: name, law, whether built, what it is", {}, [] {
            print_solvers();
            return ExitCode::ok;
          }};
}

Command scenes_command() {
  struct Options {
    std::string name;
    std::vector<std::string> overrides;
    bool resolved = false, keys = false;
  };
  const auto options = std::make_shared<Options>();
  return {"scenes",
          "Lists the scenes, or prints one",
          {{"name", &options->name, "The scene to print: a start for one of your own"},
           {"--resolved", &options->resolved, "With every default filled in, as runs keep it",
            needs("name")},
           {"--set KEY=VALUE", &options->overrides,
            "With this override, resolved: dotted.key=value", needs("name")},
           {"--keys", &options->keys,
            "Every key of a scene file as Markdown: unit, default, what is expected, meaning",
            excludes("name")}},
          [options] {
            if (options->keys)
              std::cout << scene_keys_markdown();
            else if (options->name.empty())
              print_scenes();
            else
              print_scene(options->name, options->overrides, options->resolved);
            return ExitCode::ok;
          }};
}

Command version_command() {
  return {"version", "Version, commit, compiler, libraries, processor", {}, [] {
            print_version();
            return ExitCode::ok;
          }};
}

}  // namespace ballast
