#include "experiments/measure/run_data.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <nlohmann/json.hpp>

#include "experiments/record/recorder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// One line for each column that is not finite somewhere.
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

/// Calls `read` with the file's text; why it is not to be had is said.
void read_part(RunData& data, const char* name, const char* missing,
               const std::function<void(const std::string& text)>& read) {
  const fs::path file = data.folder / name;
  try {
    if (is_there(file))
      read(read_whole_file(file));
    else
      data.notices.push_back(std::string(name) + " is missing: " + missing);
  } catch (const std::exception& error) {
    data.notices.push_back(std::string(name) + " cannot be used: " + error.what());
  }
}

/// What the scene knows: loads in weights of the grains, the wall's mass in theirs.
void add_settings(const Scene& scene, RunFacts& facts) {
  facts.solver = scene.solver.name;
  facts.iterations_most = scene.solver.max_iterations;
  facts.friction = scene.friction;
  facts.step = scene.step;
  if (scene.solver.tolerance > 0.0) facts.tolerance = scene.solver.tolerance;
  facts.gravity = scene.gravity.norm();
  facts.has_packing = scene.grains.has_value();
  facts.has_wall = facts.has_packing;
  for (const WallSpec& wall : scene.walls)
    if (wall.motion == WallMotion::driven) {
      facts.has_wall = true;
      facts.frequency = wall.load.frequency;
    }
  for (const BodySpec& body : scene.bodies)
    if (body.shape)
      facts.smallest_size = std::fmin(facts.smallest_size, body.shape->circumradius());
  if (!scene.grains) return;
  facts.seed = static_cast<int>(scene.grains->seed);
  facts.grains = scene.grains->count;
  facts.frequency = scene.drive.frequency;
  facts.f_max = scene.drive.f_max_over_weight;
  facts.f_min = scene.drive.f_min_over_weight;
  facts.wall_mass = scene.drive.wall_mass_over_grains;
  facts.length = scene.box.length;
  facts.lid_raise = scene.drive.lid_raise;
  const double part = scene.grains->size_convention == SizeConvention::radius ? 1.0 : 0.5;
  for (const SizeClass& grains : scene.grains->distribution) {
    facts.largest_size = std::fmax(facts.largest_size, part * grains.size);
    facts.smallest_size = std::fmin(facts.smallest_size, part * grains.size);
  }
  facts.deposit_friction = scene.deposit.friction;
  facts.lid_pressure = scene.deposit.lid_pressure_weight;
}

bool is_any_nonzero(const std::vector<StepRecord>& steps, double StepRecord::*value) {
  return std::ranges::any_of(
      steps, [&](const StepRecord& s) { return std::isfinite(s.*value) && s.*value != 0.0; });
}

/// NaN when it isn't there or no number.
double summary_number(const RunData& data, const std::string& name) {
  const nlohmann::ordered_json::json_pointer place("/summary/" + name);
  const bool is_there = data.manifest().contains(place) && data.manifest()[place].is_number();
  return is_there ? data.manifest()[place].get<double>() : not_known;
}

/// The manifest's summary was written by the run itself: it comes first, then the scene; what both
/// lack is found in the record.
RunFacts facts_of(const RunData& data) {
  RunFacts facts;
  if (data.scene) add_settings(*data.scene, facts);
  const auto take = [&](double& value, const char* name) {
    if (const double found = summary_number(data, name); std::isfinite(found)) value = found;
  };
  take(facts.step, "step_s");
  take(facts.grain_mass, "grain_mass_kg");
  take(facts.grains, "grains");
  take(facts.height, "packing_top_m");
  take(facts.solid_fraction_initial, "solid_fraction_initial");
  if (!data.scene) facts.gravity = summary_number(data, "weight_N") / facts.grain_mass;
  // in units of the grains' weight and mass the scene alone has them
  const double weight = facts.grain_mass * facts.gravity;
  facts.f_max *= weight;
  facts.f_min *= weight;
  facts.wall_mass *= facts.grain_mass;
  take(facts.frequency, "frequency_Hz");
  take(facts.f_max, "f_max_N");
  take(facts.wall_mass, "wall_mass_kg");
  const auto fill = [](double& value, double found) {
    if (!std::isfinite(value)) value = found;
  };
  const std::vector<StepRecord>& steps = data.steps;
  if (steps.size() > 1)
    fill(facts.step,
         (steps.back().time - steps.front().time) / static_cast<double>(steps.size() - 1));
  facts.velocity_scale = facts.gravity == 0.0 ? 1.0 : facts.gravity * facts.step;
  take(facts.velocity_scale, "velocity_scale_m_s");
  if (!data.scene) {
    facts.has_wall = is_any_nonzero(steps, &StepRecord::load);
    facts.has_packing = is_any_nonzero(steps, &StepRecord::solid_fraction);
  }
  if (facts.has_wall) {
    const Statistics load = statistics(record_column(steps, &StepRecord::load));
    fill(facts.f_max, load.max);
    fill(facts.f_min, load.min);
  }
  if (facts.has_packing) fill(facts.solid_fraction_initial, steps.front().solid_fraction);
  return facts;
}

}  // namespace

const nlohmann::ordered_json& RunData::manifest() const {
  static const auto none = nlohmann::ordered_json::object();
  return stored_manifest ? *stored_manifest : none;
}

RunData read_run_data(const fs::path& folder) {
  RunData data;
  data.folder = folder;
  if (!is_folder(folder)) throw Error(folder.string() + ": no such folder");
  data.steps = read_steps(folder);
  if (data.steps.empty()) throw Error(folder.string() + ": the record holds no step");
  check_times(folder, data.steps);
  note_gaps(data.steps, data.notices);
  read_part(data, "manifest.json", "machine, commit and the run's summary are not known.",
            [&](const std::string& text) {
              data.manifest_text = text;
              auto parsed = nlohmann::ordered_json::parse(text, nullptr, false);
              if (!parsed.is_object()) throw Error(broken_json);
              data.stored_manifest =
                  std::make_shared<const nlohmann::ordered_json>(std::move(parsed));
            });
  read_part(data, "scene.toml", "parameters are those of the manifest alone.",
            [&](const std::string& text) {
              data.scene_text = text;
              data.scene = read_scene(folder / "scene.toml");
            });
  data.facts = facts_of(data);
  return data;
}

}  // namespace ballast
