#include "experiments/measure/run_data.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "experiments/record/recorder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// One line for all columns that the record lacks, and one for each that is not finite somewhere.
void note_gaps(const std::vector<StepRecord>& steps, std::vector<std::string>& notices) {
  std::string missing;
  for (const StepColumn& column : step_columns()) {
    std::vector<size_t> rows;
    for (size_t k = 0; k < steps.size(); ++k)
      if (!std::isfinite(steps[k].*column.value)) rows.push_back(k + 1);
    if (rows.size() == steps.size())
      add_to_list(missing, column.name);
    else if (!rows.empty())
      notices.push_back(std::string(column.name) + " is not finite in " +
                        std::to_string(rows.size()) + " of " + std::to_string(steps.size()) +
                        " steps, first in row " + std::to_string(rows.front()) +
                        ": these are left out.");
  }
  if (!missing.empty())
    notices.push_back("The record has no column " + missing + ": what needs it is left out.");
}

void check_times(const fs::path& folder, const std::vector<StepRecord>& steps) {
  for (size_t k = 0; k < steps.size(); ++k)
    if (!std::isfinite(steps[k].time) || (k > 0 && steps[k].time <= steps[k - 1].time))
      throw Error(folder.string() + ": the record's time is not finite and growing in row " +
                  std::to_string(k + 1));
}

void read_manifest(RunData& data) {
  const fs::path file = data.folder / "manifest.json";
  if (!is_there(file)) {
    data.notices.push_back(
        "manifest.json is missing: machine, commit and the run's summary are not known.");
    return;
  }
  try {
    data.manifest_text = read_whole_file(file);
    auto parsed = nlohmann::ordered_json::parse(data.manifest_text, nullptr, false);
    if (!parsed.is_object()) throw Error(broken_json);
    data.stored_manifest = std::make_shared<const nlohmann::ordered_json>(std::move(parsed));
  } catch (const Error& error) {
    data.notices.push_back(std::string("manifest.json cannot be read: ") + error.what());
  }
}

void read_scene_of_run(RunData& data) {
  const fs::path file = data.folder / "scene.toml";
  if (!is_there(file)) {
    data.notices.push_back("scene.toml is missing: parameters are those of the manifest alone.");
    return;
  }
  try {
    data.scene_text = read_whole_file(file);
    data.scene = read_scene(file);
  } catch (const std::exception& error) {
    data.notices.push_back(std::string("scene.toml cannot be used: ") + error.what());
  }
}

/// What the scene alone knows of the solver, the bodies, the box and the deposit.
void add_settings(const Scene& scene, RunFacts& facts) {
  facts.solver = scene.solver.name;
  facts.iterations_most = scene.solver.max_iterations;
  facts.friction = scene.friction;
  for (const BodySpec& body : scene.bodies)
    if (body.shape)
      facts.smallest_size = std::fmin(facts.smallest_size, body.shape->circumradius());
  if (!scene.grains) return;
  facts.seed = static_cast<int>(scene.grains->seed);
  if (!std::isfinite(facts.grains)) facts.grains = scene.grains->count;
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

RunFacts facts_of(const RunData& data) {
  // the manifest's summary was written by the run itself: it comes first
  RunFacts facts;
  const auto summary = [&](const char* name) { return data.summary_number(name); };
  facts.step = summary("step_s");
  facts.velocity_scale = summary("velocity_scale_m_s");
  facts.frequency = summary("frequency_Hz");
  facts.f_max = summary("f_max_N");
  facts.f_min = summary("f_min_N");
  facts.grain_mass = summary("grain_mass_kg");
  facts.wall_mass = summary("wall_mass_kg");
  facts.solid_fraction_initial = summary("solid_fraction_initial");
  facts.gravity = summary("weight_N") / facts.grain_mass;
  facts.grains = summary("grains");
  facts.height = summary("packing_top_m");
  if (!data.scene) return facts;
  const Scene& scene = *data.scene;
  add_settings(scene, facts);
  if (!std::isfinite(facts.step)) facts.step = scene.step;
  if (scene.solver.tolerance > 0.0) facts.tolerance = scene.solver.tolerance;
  facts.gravity = scene.gravity.norm();
  facts.has_packing = scene.grains.has_value();
  bool has_driven = scene.grains.has_value();
  for (const WallSpec& wall : scene.walls)
    has_driven = has_driven || wall.motion == WallMotion::driven;
  facts.has_wall = has_driven;
  if (!scene.grains) return facts;
  // the rest follows from the scene where the mass of the grains is known
  const double weight = facts.grain_mass * facts.gravity;
  if (!std::isfinite(facts.frequency)) facts.frequency = scene.drive.frequency;
  if (!std::isfinite(facts.f_max)) facts.f_max = scene.drive.f_max_over_weight * weight;
  if (!std::isfinite(facts.f_min)) facts.f_min = scene.drive.f_min_over_weight * weight;
  if (!std::isfinite(facts.wall_mass))
    facts.wall_mass = scene.drive.wall_mass_over_grains * facts.grain_mass;
  return facts;
}

}  // namespace

const nlohmann::ordered_json& RunData::manifest() const {
  static const auto none = nlohmann::ordered_json::object();
  return stored_manifest ? *stored_manifest : none;
}

double RunData::summary_number(const std::string& name) const {
  const auto summary = manifest().find("summary");
  if (summary == manifest().end() || !summary->is_object()) return not_known;
  const auto value = summary->find(name);
  return value != summary->end() && value->is_number() ? value->get<double>() : not_known;
}

RunData read_run_data(const fs::path& folder) {
  RunData data;
  data.folder = folder;
  if (!is_folder(folder)) throw Error(folder.string() + ": no such folder");
  data.steps = read_steps(folder);
  if (data.steps.empty()) throw Error(folder.string() + ": the record holds no step");
  check_times(folder, data.steps);
  note_gaps(data.steps, data.notices);
  read_manifest(data);
  read_scene_of_run(data);
  data.facts = facts_of(data);
  return data;
}

}  // namespace ballast
