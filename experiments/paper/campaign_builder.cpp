#include "experiments/paper/campaign_builder.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/box/vibrated_box.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace {

/// Says what differs from the base, so that equal runs have equal names.
std::string name_of(const RunSettings& s, int base_iterations) {
  std::string name = "nu=" + campaign_number(s.frequency);
  const auto add = [&](const char* key, const std::string& value, bool differs) {
    if (differs) name += std::string("_") + key + '=' + value;
  };
  add("t", campaign_number(s.duration), s.duration != duration_at(s.frequency));
  add("f", campaign_number(s.force), s.force != base_force);
  add("g", campaign_number(s.gravity), s.gravity != base_gravity);
  add("mw", campaign_number(s.wall_mass), s.wall_mass != base_wall_mass);
  add("solver", s.solver, s.solver != "nncg");
  add("it", std::to_string(s.iterations), s.iterations != base_iterations);
  add("h", campaign_number(s.step), s.step != base_step);
  add("mu", campaign_number(s.friction), s.friction != base_friction);
  add("size", s.size, s.size != "radius");
  add("gap", campaign_number(s.lid_raise), s.lid_raise != base_lid_raise);
  add("lid", "placed", !s.pressed);
  add("mudep", campaign_number(s.deposit_friction), s.deposit_friction != base_friction);
  add("tol", campaign_number(s.tolerance), s.tolerance > 0.0);
  if (!s.scene.empty()) name += '_' + s.scene;
  if (!s.variant.empty()) name += '_' + s.variant;
  return name + "_seed=" + std::to_string(s.seed);
}

/// Core-seconds of a drive: a step's fixed part, and an iteration of each backend, as measured with
/// 1200 grains on one machine (docs/measured), in proportion to the grains. Only for telling how
/// long the rest takes.
double estimate(const RunSettings& s, long steps, int grains) {
  constexpr double fixed = 3e-3, iteration = 0.08e-3;  // [s]
  // nesterov_pgs is given as many as a jam takes, and uses a tenth of them.
  const double factor = s.solver == "nncg" ? 1.0 : s.solver == "nesterov_pgs" ? 0.1 : 0.8;
  return static_cast<double>(steps) * grains / 1200.0 * (fixed + factor * iteration * s.iterations);
}

}  // namespace

long Campaign::steps() const {
  long sum = 0;
  for (const CampaignRun& run : runs) sum += run.steps;
  return sum;
}

double Campaign::seconds() const {
  double sum = packing_seconds;
  for (const CampaignRun& run : runs) sum += run.seconds;
  return sum;
}

std::string campaign_number(double value) { return printed("%g", value); }

/// Three periods of the load, and at least a second.
double duration_at(double frequency) { return std::max(1.0, 3.0 / frequency); }

CampaignBuilder::CampaignBuilder(const CampaignSettings& settings)
    : scene_(read_scene(find_scene(settings.scene), settings.overrides)) {
  if (!scene_.grains)
    throw SceneFileError(settings.scene + ": has no [grains], expected a vibrated box");
  campaign.settings = settings;
}

size_t CampaignBuilder::run(RunSettings s) {
  // equal names are equal runs: one run may serve many figures
  if (s.iterations == 0) s.iterations = campaign.settings.iterations;
  const std::string name = name_of(s, campaign.settings.iterations);
  for (size_t k = 0; k < campaign.runs.size(); ++k)
    if (campaign.runs[k].planned.name == name) return k;
  CampaignRun run;
  run.planned = {name, s.scene.empty() ? campaign.settings.scene : s.scene, overrides_of(s)};
  run.steps = std::lround(s.duration / s.step);
  const Scene scene = read_scene(find_scene(run.planned.scene), run.planned.overrides);
  run.seconds = estimate(s, run.steps, scene.grains->count);
  run.stage = stage;
  campaign.runs.push_back(run);
  // what the deposit depends on, and nothing else of the run
  constexpr double packing_of_grain = 0.04;  // [s] of one core
  if (packings_.insert(packing_key(scene)).second)
    campaign.packing_seconds += packing_of_grain * scene.grains->count;
  campaign.packings = static_cast<int>(packings_.size());
  return campaign.runs.size() - 1;
}

void CampaignBuilder::point(Varied varied, double value, const std::string& label,
                            RunSettings settings, int seeds, TimeWindow window) {
  for (int seed = 1; seed <= seeds; ++seed) {
    settings.seed = seed;
    campaign.points.push_back({varied, value, label, seed, run(settings), window, stage});
  }
}

std::vector<std::string> CampaignBuilder::overrides_of(const RunSettings& s) const {
  // what the user overrides is of the campaign's scene
  std::vector<std::string> set;
  if (s.scene.empty()) set = campaign.settings.overrides;
  const auto add = [&](const char* key, const std::string& value) {
    set.push_back(std::string(key) + '=' + value);
  };
  // what every run says, whether it is the base's or not
  add("grains.seed", std::to_string(s.seed));
  add("drive.frequency", campaign_number(s.frequency));
  add("scene.duration", campaign_number(s.duration));
  add("scene.step", campaign_number(s.step));
  add("drive.f_max_over_weight", campaign_number(s.force));
  add("gravity.magnitude", campaign_number(s.gravity));
  add("deposit.gravity", campaign_number(base_gravity));
  add("drive.wall_mass_over_grains", campaign_number(s.wall_mass));
  add("contact.friction", campaign_number(s.friction));
  add("box.friction_horizontal", campaign_number(s.friction));
  add("solver.name", s.solver);
  add("solver.max_iterations", std::to_string(s.iterations));
  if (s.size == "diameter") {  // the same packing at half the scale
    add("grains.size", s.size);
    add("box.length", campaign_number(0.5 * scene_.box.length));
    add("box.width", campaign_number(0.5 * scene_.box.width));
    add("control_volume.margin_x", campaign_number(0.5 * scene_.control_volume.margin_x));
  }
  // what only some runs say, so that the others keep the keys they had before these were varied
  if (s.lid_raise != base_lid_raise) add("drive.lid_raise", campaign_number(s.lid_raise));
  if (!s.pressed) add("deposit.lid_pressure_weight", "0");
  if (s.deposit_friction != base_friction)
    add("deposit.friction", campaign_number(s.deposit_friction));
  if (s.tolerance > 0.0) add("solver.tolerance", campaign_number(s.tolerance));
  set.insert(set.end(), s.set.begin(), s.set.end());
  add("record.pose_rate", campaign_number(s.states ? 100.0 : s.pose_rate));
  add("record.forces", "false");
  if (s.states) add("record.state_rate", "100");
  return set;
}

}  // namespace ballast
