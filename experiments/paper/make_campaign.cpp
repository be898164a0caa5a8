#include "experiments/paper/make_campaign.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "experiments/paper/campaign_builder.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// The 10 Hz run of the frequency sweep, cut to the duration of the other sweeps, is their base.
RunSettings sweep_base() {
  RunSettings s;
  s.duration = duration_at(sweep_frequency);
  return s;
}
constexpr TimeWindow sweep_window{0.3, sweep_duration};

RunSettings at_frequency(double frequency) {
  RunSettings s;
  s.frequency = frequency;
  s.duration = duration_at(frequency);
  s.states = frequency == motion_frequency;
  return s;
}

void add_frequencies(CampaignBuilder& build) {
  RunSettings motion = at_frequency(motion_frequency);
  for (motion.seed = 1; motion.seed <= build.seeds(); ++motion.seed)
    build.campaign.motion.push_back(build.run(motion));
  // the corners of the range first; 1 Hz needs 3 s and is as dear as all others together can bear:
  // last
  for (const double frequency : {10.0, 5.0, 20.0, 2.0, 60.0, 30.0, 3.0, 7.0, 15.0})
    build.point(Sweep::frequency, frequency, campaign_number(frequency) + " Hz",
                at_frequency(frequency), build.seeds());
}

void add_force(CampaignBuilder& build) {
  build.point(Sweep::force, base_force, campaign_number(base_force), sweep_base(), build.seeds(),
              sweep_window);
  for (const double force : {1.5, 8.0, 2.0, 5.0}) {
    RunSettings s;
    s.force = force;
    build.point(Sweep::force, force, campaign_number(force), s, build.seeds(), sweep_window);
  }
}

void add_gravity(CampaignBuilder& build) {
  build.point(Sweep::gravity, base_gravity, campaign_number(base_gravity) + " m/s²", sweep_base(),
              build.seeds(), sweep_window);
  for (const double gravity : {0.25 * base_gravity, 1.5 * base_gravity, 0.5 * base_gravity}) {
    RunSettings s;
    s.gravity = gravity;
    s.force = base_force * base_gravity / gravity;  // f_max in newtons stays: Eq. 3 then says g^2
    build.point(Sweep::gravity, gravity, campaign_number(gravity) + " m/s²", s, build.seeds(),
                sweep_window);
  }
}

void add_wall_mass(CampaignBuilder& build) {
  build.point(Sweep::wall_mass, base_wall_mass, campaign_number(base_wall_mass), sweep_base(),
              build.seeds(), sweep_window);
  for (const double mass : {2.0, 0.1, 1.0}) {
    RunSettings s;
    s.wall_mass = mass;
    build.point(Sweep::wall_mass, mass, campaign_number(mass), s, build.seeds(), sweep_window);
  }
}

void add_slowest(CampaignBuilder& build) {
  build.point(Sweep::frequency, 1.0, "1 Hz", at_frequency(1.0), build.seeds());
}

void add_looseness(CampaignBuilder& build) {
  const int base = build.campaign.settings.iterations;
  const TimeWindow fast{0.3, fast_duration};
  build.point(Sweep::iterations, base, std::to_string(base), sweep_base(), 1, sweep_window);
  build.point(Sweep::iterations_fast, base, std::to_string(base), at_frequency(fast_frequency), 1,
              fast);
  for (const int iterations : {20, 200, 500, 50}) {
    if (iterations == base) continue;
    RunSettings s;
    s.iterations = iterations;
    build.point(Sweep::iterations, iterations, std::to_string(iterations), s, 1, sweep_window);
    s.frequency = fast_frequency;
    s.duration = fast_duration;
    build.point(Sweep::iterations_fast, iterations, std::to_string(iterations), s, 1, fast);
  }
}

void add_backends(CampaignBuilder& build) {
  build.point(Sweep::backend, 0, "nncg", sweep_base(), 1, sweep_window);
  double number = 0;
  for (const char* solver : {"pgs", "psor", "anderson_pgs", "jacobi"}) {
    RunSettings s;
    s.solver = solver;
    build.point(Sweep::backend, ++number, solver, s, 1, sweep_window);
  }
}

void add_sensitivity(CampaignBuilder& build) {
  build.point(Sweep::time_step, base_step, campaign_number(base_step) + " s", sweep_base(), 1,
              sweep_window);
  for (const double step : {1e-3, 5e-4, 1e-4, fine_step}) {
    RunSettings s;
    s.step = step;
    build.point(Sweep::time_step, step, campaign_number(step) + " s", s, 1, sweep_window);
  }
  build.point(Sweep::size, 0, "radius", sweep_base(), 2, sweep_window);
  RunSettings diameter;
  diameter.size = "diameter";
  build.point(Sweep::size, half_scale_case, "diameter", diameter, 2, sweep_window);
  build.point(Sweep::friction, base_friction, campaign_number(base_friction), sweep_base(), 1,
              sweep_window);
  for (const double friction : {0.2, 0.8}) {
    RunSettings s = sweep_base();
    s.friction = friction;
    build.point(Sweep::friction, friction, campaign_number(friction), s, 1, sweep_window);
  }
}

void add_variant(CampaignBuilder& build, Sweep sweep, RunSettings s) {
  for (const double frequency : {10.0, 60.0, 5.0, 20.0}) {  // the ends of the exponent first
    s.frequency = frequency;
    s.duration = duration_at(frequency);
    build.point(sweep, frequency, campaign_number(frequency) + " Hz", s, 1);
  }
}

/// Where the paper's exponents, constant and compaction differ from ours, the deposit is the first
/// suspect (looser ones are driven), then friction, the load (Eq. 3 supposes f_max >> m g), at the
/// shortest periods the step, and the gap under the lid: the one length that the half-scale box
/// keeps.
void add_investigation(CampaignBuilder& build) {
  RunSettings placed = sweep_base(), loose = sweep_base();
  placed.pressed = loose.pressed = false;
  loose.deposit_friction = 0.8;
  build.point(Sweep::deposit, 0, "pressed, μ 0.4", sweep_base(), 1, sweep_window);
  build.point(Sweep::deposit, 1, "not pressed, μ 0.4", placed, 1, sweep_window);
  build.point(Sweep::deposit, 2, "not pressed, μ 0.8", loose, 1, sweep_window);
  add_variant(build, Sweep::loose_frequency, loose);
  RunSettings rough, strong;
  rough.friction = 0.8;
  strong.force = 8.0;
  add_variant(build, Sweep::rough_frequency, rough);
  add_variant(build, Sweep::strong_frequency, strong);
  const TimeWindow fast{0.3, fast_duration};
  build.point(Sweep::time_step_fast, base_step, campaign_number(base_step) + " s",
              at_frequency(fast_frequency), 1, fast);
  RunSettings fine;
  fine.step = fine_step;
  fine.frequency = fast_frequency;
  fine.duration = fast_duration;
  build.point(Sweep::time_step_fast, fine.step, campaign_number(fine.step) + " s", fine, 1, fast);
  RunSettings similar;
  similar.size = "diameter";
  similar.lid_raise = 0.5 * base_lid_raise;
  build.point(Sweep::size, similar_case, "diameter, gap 5 mm", similar, 2, sweep_window);
  build.point(Sweep::lid, base_lid_raise, "10 mm", sweep_base(), 1, sweep_window);
  for (const double gap : {0.001, 0.005, 0.02}) {
    RunSettings s;
    s.lid_raise = gap;
    build.point(Sweep::lid, gap, campaign_number(1e3 * gap) + " mm", s, 1, sweep_window);
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
      {"fig3", {}, true},
      {"fig4", {}, true},
      {"fig5", {}, true},
      {"fig6", {}, true},
      {"fig7", {}, true},
      {"fig8", {frequency}, true},  // of the sweep only 5 and 10 Hz: runs_for
      {"fig9", {frequency}, false},
      {"fig10", {force}, false},
      {"fig11", {frequency, force, gravity, wall_mass}, false},
      {"fig12", {}, true},
      {"fig13", {frequency}, false},
      {"packing", {}, true},
      {"looseness", {iterations, iterations_fast, backend, force}, false},
      {"sensitivity", {time_step, size, friction, deposit, lid}, false},
      {"investigation",
       {frequency, force, gravity, size, iterations, iterations_fast, time_step, time_step_fast,
        loose_frequency, rough_frequency, strong_frequency, lid},
       false},
      {"all",
       {frequency, force, gravity, wall_mass, iterations, iterations_fast, backend, time_step, size,
        friction, deposit, loose_frequency, rough_frequency, strong_frequency, time_step_fast, lid},
       true},
  };
  return list;
}

}  // namespace

Campaign make_campaign(const CampaignSettings& settings) {
  CampaignBuilder build(settings);
  const auto stage = [&](const char* name, void (*add)(CampaignBuilder&)) {
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
  stage("investigation", add_investigation);
  return build.campaign;
}

std::vector<std::string> paper_targets() {
  std::vector<std::string> names;
  for (const Target& target : targets()) names.emplace_back(target.name);
  return names;
}

std::vector<size_t> runs_for(const Campaign& campaign, const std::string& name) {
  const auto found = std::find_if(targets().begin(), targets().end(),
                                  [&](const Target& target) { return target.name == name; });
  if (found == targets().end()) {
    throw std::invalid_argument("paper: '" + name + "' is not one of " + joined(paper_targets()));
  }
  std::set<size_t> needed;
  if (found->motion) needed.insert(campaign.motion.begin(), campaign.motion.end());
  for (const CampaignPoint& point : campaign.points) {
    if (name == "fig8" && point.value != motion_frequency && point.value != 2.0 * motion_frequency)
      continue;
    if (std::find(found->sweeps.begin(), found->sweeps.end(), point.sweep) == found->sweeps.end())
      continue;
    const bool is_spread = point.sweep == Sweep::force && name == "looseness";
    if (is_spread && point.value != base_force)
      continue;  // what they are compared with: the samples' spread
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
