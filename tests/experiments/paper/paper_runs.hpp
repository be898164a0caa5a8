#pragma once
// Folders of finished runs whose walls follow Eq. 3, or another known law, which the sections must
// find.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/paper/sections.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/hdf5_file.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/plans/small_plan.hpp"

namespace ballast {

/// Delta x_max = C m/(m + m_w) m g/f_max g/nu^2 (L nu^2/g)^(excess/2), L the box's length: a motion
/// that rigid grains may have. At constant f_max the exponents of Delta x_max are -2 + excess of nu
/// and 2 - excess/2 of g; that of v_max is -1 + excess of nu.
struct PaperLaw {
  double prefactor = 0.02;
  std::function<double(const Scene&)> excess = [](const Scene&) { return 0.0; };
  double offset = 0.0, slope = 1.0;  ///< f_g = offset [N] + slope f(t)
};

/// A wall that goes out by the law in every period and back, and is jammed for half of it. The
/// solid fraction gains per period as in Eq. 5. The grains weigh 200 kg.
inline std::vector<StepRecord> scaled_record(const Scene& scene, const PaperLaw& law) {
  const double nu = scene.drive.frequency, g = scene.gravity.norm(),
               wall = scene.drive.wall_mass_over_grains, h = scene.step, excess = law.excess(scene);
  const double rise = law.prefactor / (1.0 + wall) / scene.drive.f_max_over_weight * g / (nu * nu) *
                      std::pow(scene.box.length * nu * nu / g, 0.5 * excess);
  const double gain = 0.0025 * 0.52 * (nu < 10.0 ? 1.0 : 100.0 / (nu * nu));
  std::vector<StepRecord> steps;
  for (long k = 1; k <= std::lround(scene.duration / h); ++k) {
    StepRecord s;
    s.time = static_cast<double>(k) * h;
    const double turns = s.time * nu, phase = turns - std::floor(turns),
                 inside = std::min(1.0, 2.0 * phase);
    s.load = 200.0 * g * scene.drive.f_max_over_weight * 0.5 *
             (1.0 - std::sin(2.0 * std::numbers::pi * turns));
    s.wall_x = 0.5 * rise * (1.0 - std::cos(2.0 * std::numbers::pi * inside)) - 1e-6 * turns;
    s.wall_v = inside < 1.0
                   ? rise * 2.0 * std::numbers::pi * nu * std::sin(2.0 * std::numbers::pi * inside)
                   : 0.0;
    s.wall_force = law.offset + law.slope * s.load;
    s.solid_fraction = s.time < 0.2 ? 0.50 + 0.1 * s.time : 0.52 + gain * nu * (s.time - 0.2);
    s.error_rms = 1e-6 * (1.0 + scene.box.length);  // gives every box another record
    s.seconds_solve = 1e-3;
    steps.push_back(s);
  }
  return steps;
}

/// Writes the folder of a finished run, with all that the report reads.
inline void write_run(const std::filesystem::path& results, const PlannedRun& run,
                      const PaperLaw& law = {}) {
  const std::filesystem::path folder = run_folder(results, run);
  std::filesystem::create_directories(folder);
  const auto file = find_scene(run.scene);
  const Scene scene = read_scene(file, run.overrides);
  std::ofstream(folder / "scene.toml") << resolve_scene(file, run.overrides).text;
  std::ofstream(folder / "steps.csv") << "not read";
  const std::vector<StepRecord> steps = scaled_record(scene, law);
  Hdf5Writer record(folder / "record.h5", Hdf5Storage::plain);
  record.add_group("steps");
  for (const StepColumn& column : step_columns())
    record.add(std::string("steps/") + column.name, record_column(steps, column.value));
  record.commit();
  Manifest manifest(scene.name, run.overrides, run.key);
  manifest.summary("grain_mass_kg", 200.0);
  manifest.summary("solid_fraction_initial", 0.50);
  manifest.summary("packing_top_m", 0.46);
  manifest.summary(steps_left_entry, 0.0);
  manifest.write(folder / "manifest.json");
}

/// The runs of these stages of the built-in campaign for which `is_wanted` holds, made by a law.
inline PaperData written(
    const std::filesystem::path& results, const std::vector<std::string>& stages,
    const PaperLaw& law = {},
    const std::function<bool(const PlannedRun&, const Scene&)>& is_wanted = {}) {
  static const std::vector<PlannedRun> campaign = read_campaign({});
  for (const PlannedRun& run : campaign) {
    if (std::ranges::count(stages, stage_of(run)) == 0 || is_finished(results, run)) continue;
    const Scene scene = read_scene(find_scene(run.scene), run.overrides);
    if (!is_wanted || is_wanted(run, scene)) write_run(results, run, law);
  }
  return PaperData(campaign, results);
}

/// The verdict and the measured value of the first claim with these plain words in the paper.
inline std::string judged(const std::vector<PaperSection>& sections, const std::string& paper) {
  for (const PaperSection& section : sections)
    for (const std::vector<page::Text>& row : section.claims)
      if (plain_words(row[1]) == paper) return plain_words(row[2]) + ": " + plain_words(row[3]);
  FAIL("no row says " + paper);
  return {};
}

/// The result, in plain words, of the finding whose first part begins with `what`.
inline std::string found_of(const PaperSection& section, const std::string& what) {
  for (const std::vector<page::Text>& row : section.findings)
    if (plain_words(row[0]).starts_with(what)) return plain_words(row[1]);
  FAIL("no finding of " + what);
  return {};
}

inline bool is_of_two(const PlannedRun&, const Scene& scene) { return scene.grains->seed <= 2; }

inline PaperSection section_named(PaperData& data, const std::string& name) {
  for (PaperSection& section : make_sections(data, name))
    if (section.id == name) return section;
  FAIL("no section " + name);
  return {};
}

inline PaperLaw steep_law(double excess) {
  PaperLaw law;
  law.prefactor = 0.2;  // far above the drift of a micrometre a period
  law.excess = [excess](const Scene&) { return excess; };
  return law;
}

}  // namespace ballast
