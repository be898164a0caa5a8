#include "experiments/paper/campaign.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <stdexcept>

#include "problems/scene_file.hpp"

namespace ballast {
namespace {

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

/// Everything in which runs of the campaign differ.
struct Settings {
  double frequency = sweep_frequency, duration = sweep_duration;
  double force = base_force;  ///< f_max/(m g) at the run's own g
  double gravity = base_gravity, wall_mass = base_wall_mass, step = base_step, friction = base_friction;
  std::string solver = "nncg", size = "radius";
  int iterations = 0, seed = 1;
  bool states = false;
};

/// The paper's 1 s; whole periods, three at least.
double duration_at(double frequency) { return std::max(1.0, 3.0 / frequency); }

/// Says what differs from the base, so that equal runs have equal names.
std::string name_of(const Settings& s, int base_iterations) {
  std::string name = "nu=" + text_of(s.frequency);
  const auto add = [&](const char* key, const std::string& value, bool differs) {
    if (differs) name += std::string("_") + key + '=' + value;
  };
  add("t", text_of(s.duration), s.duration != duration_at(s.frequency));
  add("f", text_of(s.force), s.force != base_force);
  add("g", text_of(s.gravity), s.gravity != base_gravity);
  add("mw", text_of(s.wall_mass), s.wall_mass != base_wall_mass);
  add("solver", s.solver, s.solver != "nncg");
  add("it", std::to_string(s.iterations), s.iterations != base_iterations);
  add("h", text_of(s.step), s.step != base_step);
  add("mu", text_of(s.friction), s.friction != base_friction);
  add("size", s.size, s.size != "radius");
  return name + "_seed=" + std::to_string(s.seed);
}

/// Core-seconds of a drive of the 1200-grain box, from the first measurements (docs/results.md, docs/comparison.md): a step's fixed part, and
/// an iteration of each backend.
double estimate(const Settings& s, long steps) {
  constexpr double fixed = 8e-3, sweep = 0.18e-3;  // [s]
  const double factor = s.solver == "nncg" ? 1.0 : s.solver == "anderson_pgs" ? 1.3 : s.solver == "sap" ? 600.0 : 0.8;
  return static_cast<double>(steps) * (fixed + factor * sweep * s.iterations);
}
constexpr double packing_seconds = 85.0;

class Builder {
 public:
  explicit Builder(const CampaignSettings& settings) : scene_(read_scene(find_scene(settings.scene), settings.overrides)) {
    if (!scene_.grains) throw SceneFileError(settings.scene + ": has no [grains], expected a vibrated box");
    campaign_.settings = settings;
  }

  size_t run(Settings s) {
    if (s.iterations == 0) s.iterations = campaign_.settings.iterations;
    const std::string name = name_of(s, campaign_.settings.iterations);
    for (size_t k = 0; k < campaign_.runs.size(); ++k)
      if (campaign_.runs[k].planned.name == name) return k;
    CampaignRun run;
    run.planned = {name, campaign_.settings.scene, overrides_of(s)};
    run.steps = std::lround(s.duration / s.step);
    run.seconds = estimate(s, run.steps);
    run.stage = stage;
    campaign_.runs.push_back(run);
    packings_.insert(s.size + std::to_string(s.seed));
    campaign_.packings = static_cast<int>(packings_.size());
    return campaign_.runs.size() - 1;
  }

  /// One value of a sweep, for the first `seeds` samples.
  void point(Sweep sweep, double value, const std::string& label, Settings s, int seeds, TimeWindow window = scaling_window) {
    for (int seed = 1; seed <= seeds; ++seed) {
      s.seed = seed;
      campaign_.points.push_back({sweep, value, label, seed, run(s), window});
    }
  }

  int seeds() const { return campaign_.settings.seeds; }
  Campaign campaign_;
  std::string stage;  ///< of the runs that come next

 private:
  std::vector<std::string> overrides_of(const Settings& s) const {
    std::vector<std::string> set = campaign_.settings.overrides;
    const auto add = [&](const char* key, const std::string& value) { set.push_back(std::string(key) + '=' + value); };
    add("grains.seed", std::to_string(s.seed));
    add("drive.frequency", text_of(s.frequency));
    add("scene.duration", text_of(s.duration));
    add("scene.step", text_of(s.step));
    add("drive.f_max_over_weight", text_of(s.force));
    add("gravity.magnitude", text_of(s.gravity));
    add("deposit.gravity", text_of(base_gravity));
    add("drive.wall_mass_over_grains", text_of(s.wall_mass));
    add("contact.friction", text_of(s.friction));
    add("box.friction_horizontal", text_of(s.friction));
    add("solver.name", s.solver);
    add("solver.max_iterations", std::to_string(s.iterations));
    if (s.size == "diameter") {  // the same packing at half the scale
      add("grains.size", s.size);
      add("box.length", text_of(0.5 * scene_.box.length));
      add("box.width", text_of(0.5 * scene_.box.width));
      add("control_volume.margin_x", text_of(0.5 * scene_.control_volume.margin_x));
    }
    add("record.pose_rate", s.states ? "100" : "1");
    if (s.states) add("record.state_rate", "100");
    return set;
  }

  Scene scene_;
  std::set<std::string> packings_;
};

/// The 10 Hz run of the frequency sweep, cut to the duration of the other sweeps, is their base.
Settings sweep_base() {
  Settings s;
  s.duration = duration_at(sweep_frequency);
  return s;
}
constexpr TimeWindow sweep_window{0.3, sweep_duration};

Settings at_frequency(double frequency) {
  Settings s;
  s.frequency = frequency;
  s.duration = duration_at(frequency);
  s.states = frequency == motion_frequency;
  return s;
}

void add_frequencies(Builder& build) {
  Settings motion = at_frequency(motion_frequency);
  for (motion.seed = 1; motion.seed <= build.seeds(); ++motion.seed) build.campaign_.motion.push_back(build.run(motion));
  // the corners of the range first; 1 Hz needs 3 s and is as dear as all others together can bear: last
  for (const double frequency : {10.0, 5.0, 20.0, 2.0, 60.0, 30.0, 3.0, 7.0, 15.0})
    build.point(Sweep::frequency, frequency, text_of(frequency) + " Hz", at_frequency(frequency), build.seeds());
}

void add_force(Builder& build) {
  build.point(Sweep::force, base_force, text_of(base_force), sweep_base(), build.seeds(), sweep_window);
  for (const double force : {1.5, 8.0, 2.0, 5.0}) {
    Settings s;
    s.force = force;
    build.point(Sweep::force, force, text_of(force), s, build.seeds(), sweep_window);
  }
}

void add_gravity(Builder& build) {
  build.point(Sweep::gravity, base_gravity, text_of(base_gravity) + " m/s²", sweep_base(), build.seeds(), sweep_window);
  for (const double gravity : {0.25 * base_gravity, 1.5 * base_gravity, 0.5 * base_gravity}) {
    Settings s;
    s.gravity = gravity;
    s.force = base_force * base_gravity / gravity;  // f_max in newtons stays: Eq. 3 then says g^2
    build.point(Sweep::gravity, gravity, text_of(gravity) + " m/s²", s, build.seeds(), sweep_window);
  }
}

void add_wall_mass(Builder& build) {
  build.point(Sweep::wall_mass, base_wall_mass, text_of(base_wall_mass), sweep_base(), build.seeds(), sweep_window);
  for (const double mass : {2.0, 0.1, 1.0}) {
    Settings s;
    s.wall_mass = mass;
    build.point(Sweep::wall_mass, mass, text_of(mass), s, build.seeds(), sweep_window);
  }
}

void add_slowest(Builder& build) { build.point(Sweep::frequency, 1.0, "1 Hz", at_frequency(1.0), build.seeds()); }

void add_looseness(Builder& build) {
  const int base = build.campaign_.settings.iterations;
  const TimeWindow fast{0.3, fast_duration};
  build.point(Sweep::iterations, base, std::to_string(base), sweep_base(), 1, sweep_window);
  build.point(Sweep::iterations_fast, base, std::to_string(base), at_frequency(fast_frequency), 1, fast);
  for (const int iterations : {20, 200, 500, 50}) {
    Settings s;
    s.iterations = iterations;
    build.point(Sweep::iterations, iterations, std::to_string(iterations), s, 1, sweep_window);
    s.frequency = fast_frequency;
    s.duration = fast_duration;
    build.point(Sweep::iterations_fast, iterations, std::to_string(iterations), s, 1, fast);
  }
}

void add_backends(Builder& build) {
  build.point(Sweep::backend, 0, "nncg", sweep_base(), 1, sweep_window);
  double number = 0;
  for (const char* solver : {"pgs", "psor", "anderson_pgs", "jacobi"}) {
    Settings s;
    s.solver = solver;
    build.point(Sweep::backend, ++number, solver, s, 1, sweep_window);
  }
}

void add_sensitivity(Builder& build) {
  build.point(Sweep::time_step, base_step, "2e-4 s", sweep_base(), 1, sweep_window);
  for (const double step : {1e-3, 5e-4, 1e-4, 5e-5}) {
    Settings s;
    s.step = step;
    build.point(Sweep::time_step, step, text_of(step) + " s", s, 1, sweep_window);
  }
  build.point(Sweep::size, 0, "radius", sweep_base(), 2, sweep_window);
  Settings diameter;
  diameter.size = "diameter";
  build.point(Sweep::size, 1, "diameter", diameter, 2, sweep_window);
  build.point(Sweep::friction, base_friction, text_of(base_friction), sweep_base(), 1, sweep_window);
  for (const double friction : {0.2, 0.8}) {
    Settings s;
    s.friction = friction;
    build.point(Sweep::friction, friction, text_of(friction), s, 1, sweep_window);
  }
}

/// Sweeps that a target draws; empty: the 5 Hz runs alone.
struct Target {
  const char* name;
  std::vector<Sweep> sweeps;
  bool motion;
};

const std::vector<Target>& targets() {
  using enum Sweep;
  static const std::vector<Target> list = {
      {"fig3", {}, true},  {"fig4", {}, true},  {"fig5", {}, true},  {"fig6", {}, true},  {"fig7", {}, true},
      {"fig8", {frequency}, true},  // of the sweep only 5 and 10 Hz: runs_for
      {"fig9", {frequency}, false},  {"fig10", {force}, false},  {"fig11", {frequency, force, gravity, wall_mass}, false},
      {"fig12", {}, true},  {"fig13", {frequency}, false},  {"packing", {}, true},
      {"looseness", {iterations, iterations_fast, backend, force}, false},
      {"sensitivity", {time_step, size, friction, force}, false},
      {"all", {frequency, force, gravity, wall_mass, iterations, iterations_fast, backend, time_step, size, friction}, true},
  };
  return list;
}

}  // namespace

long Campaign::steps() const {
  long sum = 0;
  for (const CampaignRun& run : runs) sum += run.steps;
  return sum;
}

double Campaign::seconds() const {
  double sum = packing_seconds * packings;
  for (const CampaignRun& run : runs) sum += run.seconds;
  return sum;
}

std::vector<double> campaign_frequencies() { return {1, 2, 3, 5, 7, 10, 15, 20, 30, 60}; }

Campaign make_campaign(const CampaignSettings& settings) {
  Builder build(settings);
  const auto stage = [&](const char* name, void (*add)(Builder&)) {
    build.stage = name;
    add(build);
  };
  stage("frequency", add_frequencies);
  stage("force", add_force);
  stage("gravity-mass", add_gravity);
  stage("gravity-mass", add_wall_mass);
  stage("looseness", add_looseness);
  stage("slowest", add_slowest);
  stage("sensitivity", add_backends);
  stage("sensitivity", add_sensitivity);
  return build.campaign_;
}

std::vector<std::string> paper_targets() {
  std::vector<std::string> names;
  for (const Target& target : targets()) names.emplace_back(target.name);
  return names;
}

std::vector<size_t> runs_for(const Campaign& campaign, const std::string& name) {
  const auto found = std::find_if(targets().begin(), targets().end(), [&](const Target& target) { return target.name == name; });
  if (found == targets().end()) {
    std::string all;
    for (const std::string& target : paper_targets()) all += (all.empty() ? "" : ", ") + target;
    throw std::invalid_argument("paper: '" + name + "' is not one of " + all);
  }
  std::set<size_t> needed;
  if (found->motion) needed.insert(campaign.motion.begin(), campaign.motion.end());
  for (const CampaignPoint& point : campaign.points) {
    if (name == "fig8" && point.value != motion_frequency && point.value != 2.0 * motion_frequency) continue;
    if (std::find(found->sweeps.begin(), found->sweeps.end(), point.sweep) == found->sweeps.end()) continue;
    const bool is_spread = point.sweep == Sweep::force && (name == "looseness" || name == "sensitivity");
    if (is_spread && point.value != base_force) continue;  // what they are compared with: the samples' spread
    needed.insert(point.run);
  }
  return {needed.begin(), needed.end()};
}

std::vector<Plan> stages_of(const Campaign& campaign, const std::string& target) {
  std::vector<Plan> stages;
  for (const size_t index : runs_for(campaign, target)) {
    const CampaignRun& run = campaign.runs[index];
    const std::string name = "paper-" + run.stage;
    if (stages.empty() || stages.back().name != name) stages.push_back({name, {}});
    stages.back().runs.push_back(run.planned);
  }
  return stages;
}

}  // namespace ballast
