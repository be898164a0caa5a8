#include "experiments/measure/run_data.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "experiments/record/recorder.hpp"
#include "experiments/step/time_step.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// Adds one notice for each column that is not finite in some step.
void note_gaps(const std::vector<StepRecord>& steps, std::vector<std::string>& notices) {
  for (const StepColumn& column : step_columns()) {
    std::vector<size_t> rows;
    for (size_t k = 0; k < steps.size(); ++k)
      if (!std::isfinite(steps[k].*column.value)) rows.push_back(k + 1);
    if (!rows.empty())
      notices.push_back(
          printed("%s is not finite in %zu of %zu steps, first in row %zu: these are "
                  "left out.",
                  column.name, rows.size(), steps.size(), rows.front()));
  }
}

void check_times(const fs::path& folder, const std::vector<StepRecord>& steps) {
  for (size_t k = 0; k < steps.size(); ++k)
    if (!std::isfinite(steps[k].time) || (k > 0 && steps[k].time <= steps[k - 1].time))
      throw Error(folder.string() + ": the record's time is not finite and growing in row " +
                  std::to_string(k + 1));
}

/// Facts from the scene. For a box, loads are in weights of the grains, the wall's mass in theirs.
void add_settings(const Scene& scene, RunFacts& facts) {
  facts.solver = scene.solver.name;
  facts.iterations_most = scene.solver.max_iterations;
  facts.seconds_most = scene.solver.max_seconds;
  if (scene.correction.enabled) facts.slop = scene.correction.slop;
  facts.friction = scene.friction;
  facts.step = scene.step;
  if (scene.solver.tolerance > 0.0) facts.tolerance = scene.solver.tolerance;
  facts.gravity = scene.gravity.norm();
  facts.velocity_scale = velocity_scale(scene);
  facts.has_packing = scene.grains.has_value();
  // a step records the motion of the first driven wall
  const auto driven = std::ranges::find(scene.walls, WallMotion::driven, &WallSpec::motion);
  facts.has_wall = facts.has_packing || driven != scene.walls.end();
  if (driven != scene.walls.end()) {
    facts.frequency = driven->load.frequency;
    facts.f_max = driven->load.f_max;
    facts.f_min = driven->load.f_min;
  }
  for (const BodySpec& body : scene.bodies)
    if (body.shape)
      facts.smallest_size = std::fmin(facts.smallest_size, body.shape->circumradius());
  if (!scene.grains) return;
  facts.seed = scene.grains->seed;
  facts.grains = scene.grains->count;
  facts.frequency = scene.drive.frequency;
  facts.f_max = scene.drive.f_max_over_weight;
  facts.f_min = scene.drive.f_min_over_weight;
  facts.wall_mass = scene.drive.wall_mass_over_grains;
  facts.length = scene.box.length;
  facts.lid_raise = scene.drive.lid_raise;
  facts.volume_margin = scene.control_volume.margin_x;
  const double part = scene.grains->size_convention == SizeConvention::radius ? 1.0 : 0.5;
  for (const SizeClass& grains : scene.grains->distribution) {
    facts.largest_size = std::fmax(facts.largest_size, part * grains.size);
    facts.smallest_size = std::fmin(facts.smallest_size, part * grains.size);
  }
  facts.deposit_friction = scene.deposit.friction;
  facts.lid_pressure = scene.deposit.lid_pressure_weight;
}

/// NaN where the summary has no such number.
double summary_number(const RunData& data, const std::string& name) {
  const nlohmann::ordered_json::json_pointer place("/summary/" + name);
  const bool is_number = data.manifest().contains(place) && data.manifest()[place].is_number();
  return is_number ? data.manifest()[place].get<double>() : not_known;
}

/// Facts from the scene, and those of the packing from the manifest's summary.
RunFacts facts_of(const RunData& data) {
  RunFacts facts;
  if (data.scene) add_settings(*data.scene, facts);
  facts.grain_mass = summary_number(data, "grain_mass_kg");
  facts.height = summary_number(data, "packing_top_m");
  facts.solid_fraction_initial = summary_number(data, "solid_fraction_initial");
  if (!facts.has_packing) return facts;
  facts.f_max *= facts.weight();
  facts.f_min *= facts.weight();
  facts.wall_mass *= facts.grain_mass;
  return facts;
}

}  // namespace

const nlohmann::ordered_json& RunData::manifest() const {
  static const auto none = nlohmann::ordered_json::object();
  return stored_manifest ? *stored_manifest : none;
}

nlohmann::ordered_json json_object(const std::string& text, const fs::path& file) {
  auto parsed = nlohmann::ordered_json::parse(text, nullptr, false);
  if (!parsed.is_object()) throw Error(file.string() + ": " + broken_json);
  return parsed;
}

RunData read_run_data(const fs::path& folder) {
  RunData data;
  data.folder = folder;
  if (!is_folder(folder)) throw Error(folder.string() + ": no such folder");
  data.steps = read_steps(folder);
  if (data.steps.empty()) throw Error(folder.string() + ": the record holds no step");
  check_times(folder, data.steps);
  note_gaps(data.steps, data.notices);
  const fs::path manifest = folder / "manifest.json", scene = folder / "scene.toml";
  data.manifest_text = read_whole_file(manifest);
  data.stored_manifest =
      std::make_shared<const nlohmann::ordered_json>(json_object(data.manifest_text, manifest));
  data.scene_text = read_whole_file(scene);
  try {
    data.scene = read_scene(scene);
  } catch (const Error& error) {  // its meshes may be gone
    data.notices.push_back(std::string("The scene cannot be used: ") + error.what());
  }
  data.facts = facts_of(data);
  return data;
}

}  // namespace ballast
