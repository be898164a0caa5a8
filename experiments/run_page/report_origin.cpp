#include "experiments/run_page/report_origin.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "platform/atomic_file.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// "rest_velocity_m_s" is "rest velocity" in m/s.
struct NamedUnit {
  const char *suffix, *unit;
};
constexpr NamedUnit named_units[] = {{"_m_s2", "m/s²"}, {"_kg_m3", "kg/m³"}, {"_m_s", "m/s"},
                                     {"_kg", "kg"},     {"_Hz", "Hz"},       {"_MB", "MB"},
                                     {"_GB", "GB"},     {"_N", "N"},         {"_J", "J"},
                                     {"_s", "s"},       {"_m", "m"}};

/// Lists and objects on one line, without JSON's quotes and braces.
std::string readable(const nlohmann::ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_structured()) return value.dump();
  std::string text;
  for (const auto& [name, part] : value.items())
    add_to_list(text, (value.is_object() ? name + ' ' : std::string()) + readable(part));
  return text;
}

using Json = nlohmann::ordered_json;

/// What the manifest says at "/group/name", as words; empty when it says nothing.
std::string text_at(const RunData& data, const char* where) {
  const Json::json_pointer at(where);
  if (!data.manifest().contains(at) || data.manifest()[at].is_null()) return {};
  return readable(data.manifest()[at]);
}

/// The texts in a list of the manifest; empty when there is no such list.
std::vector<std::string> list_at(const RunData& data, const char* name) {
  std::vector<std::string> list;
  const auto found = data.manifest().find(name);
  if (found != data.manifest().end() && found->is_array())
    for (const Json& entry : *found) list.push_back(readable(entry));
  return list;
}

void add_scene(const Scene& scene, page::Table& table) {
  const auto row = [&](const char* what, page::Text value) {
    table.rows.push_back({page::marked(what), std::move(value)});
  };
  row("step *h*, duration",
      page::exact_quantity(scene.step, "s") + ", " + page::exact_quantity(scene.duration, "s"));
  row("gravity", page::exact_quantity(scene.gravity.norm(), "m/s²"));
  row("friction, restitution between bodies",
      page::exact(scene.friction) + ", " + page::exact(scene.restitution));
  row("solver",
      page::Text(scene.solver.name) + ", tolerance " + page::exact(scene.solver.tolerance) +
          page::marked(scene.gravity.isZero() ? " m/s" : " *gh*") + ", at most " +
          page::exact(scene.solver.max_iterations) +
          (scene.solver.warm_start ? " iterations, warm start" : " iterations, cold start"));
  row("overlap correction",
      scene.correction.enabled
          ? page::exact_quantity(100.0 * scene.correction.fraction, "%") + " of what exceeds " +
                page::exact_quantity(1e6 * scene.correction.slop, "µm") + " per step, " +
                page::exact(scene.correction.sweeps) + " sweeps"
          : page::Text("off"));
  if (!scene.grains) return;
  const DriveSpec& drive = scene.drive;
  row("drive", page::exact_quantity(drive.frequency, "Hz") + page::marked(", *f*~max~ = ") +
                   page::exact(drive.f_max_over_weight) + page::marked(" *mg*, *f*~min~ = ") +
                   page::exact(drive.f_min_over_weight) + page::marked(" *mg*, wall ") +
                   page::exact(drive.wall_mass_over_grains) + page::marked(" *m*, lid raised ") +
                   page::exact_quantity(1e3 * drive.lid_raise, "mm"));
  row("grains", page::exact(scene.grains->count, 6) + ", seed " +
                    std::to_string(scene.grains->seed) + ", " +
                    page::exact_quantity(scene.grains->density, "kg/m³"));
  row("box, length × width", page::exact_quantity(scene.box.length, "m") + " × " +
                                 page::exact_quantity(scene.box.width, "m"));
  row("friction of floor and lid, of side walls",
      page::exact(scene.box.friction_horizontal) + ", " + page::exact(scene.box.friction_vertical));
}

/// A number or text that the run noted, its unit taken from the end of its name.
void add_noted(std::string name, const Json& value, page::Table& table) {
  const char* unit = "";
  for (const NamedUnit& known : named_units) {
    if (!name.ends_with(known.suffix) || name == known.suffix) continue;
    name.resize(name.size() - std::string_view(known.suffix).size());
    unit = known.unit;
    break;
  }
  std::replace(name.begin(), name.end(), '_', ' ');
  page::Text words = value.is_null()           ? page::number(not_known)
                     : value.is_number_float() ? page::exact_quantity(value, unit, 6)
                                               : page::Text(readable(value));
  table.rows.push_back({name, std::move(words)});
}

}  // namespace

std::string name_of_run(const RunData& data) {
  if (data.scene && !data.scene->title.empty()) return data.scene->title;
  const auto scene = data.manifest().find("scene");
  if (scene != data.manifest().end() && scene->is_string()) return scene->get<std::string>();
  return data.folder.filename().string();
}

page::Table parameters_table(const RunData& data) {
  page::Table table = page::facts_table();
  if (data.scene) add_scene(*data.scene, table);
  std::string list;
  for (const std::string& set : list_at(data, "overrides"))
    list += (list.empty() ? "" : "\n") + set;
  if (!list.empty())
    table.rows.push_back({"settings other than the scene’s (--set)", page::Text(list, page::code)});
  const auto summary = data.manifest().find("summary");
  if (summary != data.manifest().end() && summary->is_object())
    for (const auto& [name, value] : summary->items()) add_noted(name, value, table);
  return table;
}

page::Table provenance_table(const RunData& data) {
  constexpr std::pair<const char*, const char*> facts[] = {
      {"ballast", "/ballast/version"},
      {"commit", "/ballast/commit"},
      {"compiler", "/ballast/compiler"},
      {"build", "/ballast/build_type"},
      {"flags", "/ballast/flags"},
      {"libraries", "/ballast/libraries"},
      {"processor", "/machine/cpu"},
      {"cores", "/machine/cores"},
      {"memory (GB)", "/machine/memory_GB"},
      {"load average at the start (1, 5, 15 min)", "/machine/load_average"},
      {"environment", "/machine/environment"},
      {"started", "/started"},
      {"key", "/key"}};
  page::Table table = page::facts_table();
  for (const auto& [what, where] : facts) {
    std::string value = text_at(data, where);
    if (value.empty()) continue;
    const bool is_commit = std::string_view(what) == "commit";
    if (is_commit && text_at(data, "/ballast/modified") == "true")
      value += ", with changes that are not committed";
    table.rows.push_back({what, value});
  }
  for (const std::string& resumed : list_at(data, "resumed"))
    table.rows.push_back({"resumed", resumed});
  return table;
}

page::Table files_table(const RunData& data) {
  constexpr std::pair<const char*, const char*> files[] = {
      {"steps.csv", "every step’s scalars, one column each"},
      {"record.h5", "the same and the poses, with units and descriptions (HDF5)"},
      {"manifest.json", "program, machine, parameters, summary"},
      {"scene.toml", "the resolved scene: runs again as it is"},
      {"figures", "each figure as SVG, and as a gnuplot script that holds its data"},
      {"checkpoint.bin", "state to resume from"},
      {"paraview", "poses and contacts for ParaView"}};
  page::Table table = page::facts_table();
  for (const auto& [name, what] : files)
    if (is_there(data.folder / name))
      table.rows.push_back({page::Text(name, page::code, name), what});
  return table;
}

std::string made_by(const RunData& data) {
  std::string text;
  const auto add = [&](const std::string& before, const std::string& part) {
    if (!part.empty()) add_to_list(text, before + part);
  };
  add("ballast ", text_at(data, "/ballast/version"));
  add("commit ", text_at(data, "/ballast/commit").substr(0, 12));
  add("", text_at(data, "/machine/cpu"));
  add("started ", text_at(data, "/started"));
  return text;
}

std::string reproduce_commands(const RunData& data) {
  std::string text;
  const std::string commit = text_at(data, "/ballast/commit");
  if (!commit.empty() && commit != "unknown")
    text += "# the program of commit " + commit + " made it\n";
  if (data.scene_text.empty()) return text;
  // The resolved scene says everything; its name and the --set of the command line do not.
  const std::filesystem::path folder =
      std::filesystem::absolute(data.folder / "scene.toml").lexically_normal().parent_path();
  return text +
         shell_line({own_program().string(), "run", (folder / "scene.toml").string(), "--output",
                     folder.string() + "-again"}) +
         '\n';
}

std::string next_commands(bool has_grains) {
  const std::string program = shell_word(own_program().string()) + ' ';
  std::string text;
  if (has_grains)
    text += "# another frequency, other grains; every key of a scene: docs/manual/scenes.md\n" +
            program +
            "run vibrated_box --set drive.frequency=10 --set grains.seed=2 --output results/10Hz\n"
            "# one figure of the paper with all its runs (each made once); what they cost: paper "
            "plan\n" +
            program + "paper fig12 --jobs 2\n";
  text +=
      "# a plan: every combination of the values, several runs at a time\n"
      "test -e my_plan.toml || printf '[[grid]]\\nname = \"nu\"\\nscene = "
      "\"vibrated_box_small\"\\nvary.\"drive.frequency\" = [5, 10, 20]\\n' > "
      "my_plan.toml\n" +
      program +
      "plan my_plan.toml --jobs 2\n"
      "# solvers beside each other in the same closed loop\n" +
      program +
      "compare --live vibrated_box_small --duration 0.02 --solvers pgs,nncg --tolerances "
      "1e-2,1e-4\n";
  return text;
}

}  // namespace ballast
