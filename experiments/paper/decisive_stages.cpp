#include "experiments/paper/decisive_stages.hpp"

#include <algorithm>
#include <cmath>

#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace {

constexpr TimeWindow all_periods{};

/// Three periods at least after the transient; fast loads have them soon.
double short_duration(double frequency) { return frequency < 10.0 ? duration_at(frequency) : 0.7; }

RunSettings decisive_run(double frequency) {
  RunSettings s;
  s.frequency = frequency;
  s.duration = short_duration(frequency);
  s.iterations = decisive_iterations;
  s.pose_rate = 20.0;  // a multiple of 1, 2, 5, 10 and 20 Hz: frames at the same phase of the load
  return s;
}

std::string key_value(const char* key, double value) {
  return std::string(key) + '=' + campaign_number(value);
}

std::string count_of(double grains) {
  return "grains.count=" + std::to_string(std::lround(grains));
}

/// A side is never shorter than this [m]: small scenes have no room for every stage.
double shortest(const Scene& scene, double margin) {
  double widest = 2.2 * margin;
  for (const SizeClass& c : scene.grains->distribution) widest = std::max(widest, 2.0 * c.size);
  return widest;
}

/// The box at another size: its length and width times these factors, as many grains as make the
/// packing `height` times as high.
void resize(CampaignBuilder& build, double length, double width, double height, RunSettings& s) {
  const Scene& base = build.scene();
  const double least_length = shortest(base, base.control_volume.margin_x),
               least_width = shortest(base, base.control_volume.margin_y);
  s.set.push_back(key_value("box.length", std::max(least_length, length * base.box.length)));
  s.set.push_back(key_value("box.width", std::max(least_width, width * base.box.width)));
  s.set.push_back(count_of(length * width * height * base.grains->count));
  // higher and longer packings come to rest later
  s.set.push_back(key_value("deposit.max_time", 2.0 * base.deposit.max_time));
}

void add_box_lengths(CampaignBuilder& build) {
  for (const double frequency : {5.0, 20.0})
    for (const double shape : box_shapes) {
      RunSettings s = decisive_run(frequency);
      s.variant = "lh=" + campaign_number(shape);
      resize(build, shape / base_box_shape, 1.0, 1.0, s);
      build.point(frequency == 5.0 ? Varied::box_length : Varied::box_length_fast, shape,
                  "L/H " + campaign_number(shape), s, build.seeds(), all_periods);
    }
}

/// One sample, the start moved by less than anything that could be known: what differs is chaos.
void add_replicas(CampaignBuilder& build) {
  constexpr int replicas = 8;
  for (const double frequency : {10.0, 60.0})
    for (int k = 1; k <= replicas; ++k) {
      RunSettings s = decisive_run(frequency);
      s.variant = "replica=" + std::to_string(k);
      s.set = {"drive.start_noise=1e-12", "drive.start_noise_seed=" + std::to_string(k)};
      build.point(frequency == 10.0 ? Varied::replica : Varied::replica_fast, k,
                  "replica " + std::to_string(k), s, 1, all_periods);
    }
}

void add_frequencies(CampaignBuilder& build, Varied varied, std::vector<double> frequencies,
                     const RunSettings& settings) {
  for (const double frequency : frequencies) {
    RunSettings s = settings;
    s.frequency = frequency;
    s.duration = short_duration(frequency);
    build.point(varied, frequency, campaign_number(frequency) + " Hz", s, build.seeds(),
                all_periods);
  }
}

void add_tight(CampaignBuilder& build) {
  RunSettings s = decisive_run(10.0);
  s.tolerance = 1e-2;
  s.iterations = 1000;
  add_frequencies(build, Varied::tight_frequency, {5.0, 60.0, 20.0, 10.0, 30.0}, s);
}

/// By sweeps with momentum, which reach this error in a third of the sweeps; a tenth tighter than
/// the error that is meant, for the steps that meet none.
void add_tightest(CampaignBuilder& build) {
  RunSettings s = decisive_run(10.0);
  s.solver = "nesterov_pgs";
  s.tolerance = 9e-4;
  s.iterations = 20000;
  add_frequencies(build, Varied::tightest_frequency, {20.0, 60.0}, s);
}

void add_deposits(CampaignBuilder& build) {
  using enum Varied;
  const struct {
    Varied varied;
    bool pressed;
    double friction;
  } cases[] = {{pressed_frequency, true, 0.4},
               {placed_rough_frequency, false, 0.8},
               {placed_frequency, false, 0.4},
               {pressed_rough_frequency, true, 0.8}};
  for (const auto& [varied, pressed, friction] : cases) {
    RunSettings s = decisive_run(10.0);
    s.pressed = pressed;
    s.deposit_friction = friction;
    add_frequencies(build, varied, {10.0, 60.0, 5.0, 20.0}, s);
  }
}

void add_loads(CampaignBuilder& build) {
  using enum Varied;
  const std::vector<double> frequencies{5.0, 10.0, 2.0, 1.0};
  RunSettings s = decisive_run(10.0);
  s.wall_mass = 0.1;
  s.force = 6.0;
  add_frequencies(build, light_frequency, frequencies, s);
  s.force = 12.0;
  add_frequencies(build, light_strong_frequency, frequencies, s);
  s.force = 6.0;
  s.size = "diameter";
  add_frequencies(build, light_half_frequency, frequencies, s);
}

void add_shapes(CampaignBuilder& build) {
  for (const double frequency : {5.0, 20.0})
    for (size_t k = 0; k < grain_kinds().size(); ++k) {
      const GrainKind& kind = grain_kinds()[k];
      RunSettings s = decisive_run(frequency);
      if (!kind.set.empty()) s.variant = std::string("grains=") + kind.word;
      s.set = kind.set;
      build.point(frequency == 5.0 ? Varied::shape : Varied::shape_fast, static_cast<double>(k),
                  kind.name, s, build.seeds(), all_periods);
    }
}

/// The scene in which the silent choices are those that the paper's own numbers ask for.
void add_reading(CampaignBuilder& build) {
  // beside the paper's box alone: a campaign of another one is for trying out
  if (build.campaign.settings.scene != CampaignSettings{}.scene) return;
  const Scene scene = read_scene(find_scene(reading_scene));
  RunSettings s = decisive_run(10.0);
  s.scene = reading_scene;
  s.force = scene.drive.f_max_over_weight;
  s.wall_mass = scene.drive.wall_mass_over_grains;
  s.iterations = scene.solver.max_iterations;
  add_frequencies(build, Varied::reading_frequency, {5.0, 10.0, 20.0, 60.0, 2.0, 1.0}, s);
}

/// Is the length in Delta x = l Phi(X/l) the grains' or the packing's? Similar boxes (H/L fixed)
/// grow in both, wider ones (H/d fixed) in neither.
void add_sizes(CampaignBuilder& build) {
  for (const int grains : {300, 600, 2400, 4800, 9600}) {
    const double factor = grains / static_cast<double>(build.scene().grains->count);
    const double side = std::cbrt(factor);
    RunSettings similar = decisive_run(5.0), wide = similar;
    similar.variant = "similar=" + std::to_string(grains);
    resize(build, side, side, side, similar);
    wide.variant = "wide=" + std::to_string(grains);
    resize(build, 1.0, factor, 1.0, wide);
    build.point(Varied::size_wide, grains, std::to_string(grains), wide, build.seeds(),
                all_periods);
    build.point(Varied::size_similar, grains, std::to_string(grains), similar, build.seeds(),
                all_periods);
  }
}

/// Coulomb's law beside its convex relaxation, paired by packing: as many grains as sap carries.
void add_laws(CampaignBuilder& build) {
  constexpr int grains = 300, samples = 10;
  const double side = std::cbrt(grains / static_cast<double>(build.scene().grains->count));
  RunSettings s = decisive_run(10.0);
  s.iterations = 500;
  s.variant = "similar=" + std::to_string(grains);
  resize(build, side, side, side, s);
  const int seeds = std::max(samples, build.seeds());
  build.point(Varied::exact_law, 10.0, "exact law", s, seeds, all_periods);
  s.solver = "sap";
  build.point(Varied::convex_law, 10.0, "convex law", s, seeds, all_periods);
}

/// What papers of 2000 to 2010 had: plain sweeps until LMGC90's rule is met.
void add_rule(CampaignBuilder& build) {
  RunSettings s = decisive_run(10.0);
  s.solver = "pgs";
  s.iterations = 25000;
  s.variant = "rule=lmgc90";
  s.set = {"solver.change_tolerance=1.666e-4", "solver.change_every=500"};
  add_frequencies(build, Varied::rule_frequency, {10.0, 60.0}, s);
}

}  // namespace

const std::vector<GrainKind>& grain_kinds() {
  static const std::vector<GrainKind> kinds{
      {"as the campaign's", "", {}},
      {"angular and platy",
       "platy",
       {"grains.shape.max_vertices=12", "grains.shape.elongation_min=0.55",
        "grains.shape.flatness_min=0.3", "grains.shape.flatness_max=0.55",
        "grains.shape.roughness=0.12"}},
      {"spheres of 162 vertices",
       "spheres",
       {"grains.shape.min_vertices=162", "grains.shape.max_vertices=162",
        "grains.shape.elongation_min=1.0", "grains.shape.elongation_max=1.0",
        "grains.shape.flatness_min=1.0", "grains.shape.flatness_max=1.0",
        "grains.shape.roughness=0.0"}},
      // 50, 34 and 16 % of the mass: n ~ fraction / size^3, and as many as weigh the same together
      {"fractions by mass",
       "by-mass",
       {"grains.distribution=[{size=0.025,fraction=0.8055},{size=0.0375,fraction=0.1623},"
        "{size=0.05,fraction=0.0322}]",
        "grains.count=2181"}}};
  return kinds;
}

std::span<const DecisiveStage> decisive_stages() {
  static constexpr DecisiveStage stages[] = {
      {"box", add_box_lengths}, {"reading", add_reading},   {"replicas", add_replicas},
      {"tight", add_tight},     {"deposits", add_deposits}, {"loads", add_loads},
      {"shapes", add_shapes},   {"sizes", add_sizes},       {"laws", add_laws},
      {"rule", add_rule},       {"tightest", add_tightest}};
  return stages;
}

void add_decisive_stages(CampaignBuilder& build) {
  for (const DecisiveStage& stage : decisive_stages()) {
    build.stage = stage.name;
    stage.add(build);
  }
}

}  // namespace ballast
