#include "experiments/run_page/report_origin.hpp"

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

page::Text summary_row_value(const nlohmann::ordered_json& value, const char* unit) {
  if (value.is_number_integer()) return value.dump();
  if (value.is_number()) return page::exact_quantity(value.get<double>(), unit, 6);
  if (value.is_null()) return page::number(not_known);
  return readable(value);
}

std::string text_at(const nlohmann::ordered_json& json, const char* group, const char* name) {
  const auto part = json.find(group);
  if (part == json.end() || !part->is_object()) return {};
  const auto value = part->find(name);
  if (value == part->end() || value->is_null()) return {};
  return readable(*value);
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
  if (scene.sleep.enabled)
    row("islands at rest fall asleep", "after " + page::exact(scene.sleep.steps) + " steps below " +
                                           page::exact(scene.sleep.velocity) +
                                           page::marked(" *gh*"));
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

}  // namespace

page::Table parameters_table(const RunData& data) {
  page::Table table = page::facts_table();
  if (data.scene) add_scene(*data.scene, table);
  const auto overrides = data.manifest.find("overrides");
  if (overrides != data.manifest.end() && overrides->is_array() && !overrides->empty()) {
    std::string list;
    for (const auto& entry : *overrides)
      list += (list.empty() ? "" : "\n") +
              (entry.is_string() ? entry.get<std::string>() : entry.dump());
    table.rows.push_back({"settings other than the scene’s (--set)", page::Text(list, page::code)});
  }
  const auto summary = data.manifest.find("summary");
  if (summary != data.manifest.end() && summary->is_object())
    for (const auto& [name, value] : summary->items()) {
      std::string label = name;
      const char* unit = "";
      for (const NamedUnit& known : named_units) {
        const std::string suffix = known.suffix;
        if (label.size() <= suffix.size() ||
            label.compare(label.size() - suffix.size(), suffix.size(), suffix) != 0)
          continue;
        label.resize(label.size() - suffix.size());
        unit = known.unit;
        break;
      }
      for (char& c : label)
        if (c == '_') c = ' ';
      table.rows.push_back({label, summary_row_value(value, unit)});
    }
  return table;
}

page::Table provenance_table(const RunData& data) {
  page::Table table = page::facts_table();
  const auto row = [&](const char* what, const std::string& value) {
    if (!value.empty()) table.rows.push_back({what, value});
  };
  const auto& manifest = data.manifest;
  row("ballast", text_at(manifest, "ballast", "version"));
  std::string commit = text_at(manifest, "ballast", "commit");
  if (!commit.empty() && text_at(manifest, "ballast", "modified") == "true")
    commit += ", with changes that are not committed";
  row("commit", commit);
  row("compiler", text_at(manifest, "ballast", "compiler"));
  row("build", text_at(manifest, "ballast", "build_type"));
  row("flags", text_at(manifest, "ballast", "flags"));
  row("libraries", text_at(manifest, "ballast", "libraries"));
  row("processor", text_at(manifest, "machine", "cpu"));
  row("cores", text_at(manifest, "machine", "cores"));
  row("memory (GB)", text_at(manifest, "machine", "memory_GB"));
  row("load average at the start (1, 5, 15 min)", text_at(manifest, "machine", "load_average"));
  row("environment", text_at(manifest, "machine", "environment"));
  for (const char* name : {"started", "key"})
    if (const auto value = manifest.find(name); value != manifest.end() && value->is_string())
      row(name, value->get<std::string>());
  if (const auto resumed = manifest.find("resumed");
      resumed != manifest.end() && resumed->is_array())
    for (const auto& entry : *resumed) row("resumed", readable(entry));
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
    if (std::filesystem::exists(data.folder / name))
      table.rows.push_back({page::Text(name, page::code, name), what});
  return table;
}

std::string made_by(const RunData& data) {
  std::string text;
  const auto add = [&](const std::string& before, const std::string& part) {
    if (!part.empty()) add_to_list(text, before + part);
  };
  add("ballast ", text_at(data.manifest, "ballast", "version"));
  add("commit ", text_at(data.manifest, "ballast", "commit").substr(0, 12));
  add("", text_at(data.manifest, "machine", "cpu"));
  if (const auto started = data.manifest.find("started");
      started != data.manifest.end() && started->is_string())
    add("started ", started->get<std::string>());
  return text;
}

std::string reproduce_commands(const RunData& data) {
  std::string text;
  const std::string commit = text_at(data.manifest, "ballast", "commit");
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
