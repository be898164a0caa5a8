// From folders of finished runs to the report: records with known exponents, and partial data, which are said and never
// an error.

#include <cmath>
#include <fstream>
#include <numbers>

#include "experiments/manifest.hpp"
#include "experiments/paper/paper_report.hpp"
#include "experiments/run_folder.hpp"
#include "problems/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/synthetic_run.hpp"
#include "tests/temporary_folder.hpp"

using namespace ballast;

namespace {

constexpr double mass = 200.0;
constexpr double prefactor = 0.02;

/// A wall that goes out by C times Eq. 3 in every period and back, jammed for half of it; solid fraction with a gain
/// per period as Eq. 5 has it.
std::vector<StepRecord> scaled_record(const Scene& scene) {
  const double nu = scene.drive.frequency, g = scene.gravity.norm(), wall = scene.drive.wall_mass_over_grains,
               h = 0.2e-3;
  const double rise = prefactor / (1.0 + wall) / scene.drive.f_max_over_weight * g / (nu * nu);
  const double gain = 0.0025 * 0.52 * (nu < 10.0 ? 1.0 : 100.0 / (nu * nu));
  std::vector<StepRecord> steps;
  for (long k = 1; k <= std::lround(scene.duration / h); ++k) {
    StepRecord s;
    s.time = static_cast<double>(k) * h;
    const double turns = s.time * nu, phase = turns - std::floor(turns), inside = std::min(1.0, 2.0 * phase);
    s.load = mass * g * scene.drive.f_max_over_weight * 0.5 * (1.0 - std::sin(2.0 * std::numbers::pi * turns));
    s.wall_x = 0.5 * rise * (1.0 - std::cos(2.0 * std::numbers::pi * inside)) - 1e-6 * turns;
    s.wall_v = inside < 1.0 ? rise * 2.0 * std::numbers::pi * nu * std::sin(2.0 * std::numbers::pi * inside) : 0.0;
    s.wall_force = s.load;
    s.solid_fraction = s.time < 0.2 ? 0.50 + 0.1 * s.time : 0.52 + gain * nu * (s.time - 0.2);
    s.error_rms = 1e-6;
    s.seconds_solve = 1e-3;
    steps.push_back(s);
  }
  return steps;
}

/// As a finished run leaves its folder, as far as the report looks at it.
void write_run(const std::filesystem::path& results, const PlannedRun& run) {
  const std::filesystem::path folder = folder_of(results, run);
  std::filesystem::create_directories(folder);
  const auto file = find_scene(run.scene);
  const Scene scene = read_scene(file, run.overrides);
  std::ofstream(folder / "scene.toml") << resolved_scene_text(file, run.overrides);
  std::ofstream(folder / "record.h5") << "not read";
  write_steps_csv(folder / "steps.csv", scaled_record(scene));
  Manifest manifest(scene.name, run.overrides, run_key(run));
  const double g = scene.gravity.norm();
  manifest.summary("grains", 1200);
  manifest.summary("grain_mass_kg", mass);
  manifest.summary("weight_N", mass * g);
  manifest.summary("f_max_N", scene.drive.f_max_over_weight * mass * g);
  manifest.summary("wall_mass_kg", scene.drive.wall_mass_over_grains * mass);
  manifest.summary("frequency_Hz", scene.drive.frequency);
  manifest.summary("solid_fraction_initial", 0.50);
  manifest.summary(steps_left_entry, 0.0);
  manifest.write(folder / "manifest.json");
}

const AgreementRow& row_of(const std::vector<PaperSection>& sections, const std::string& paper) {
  for (const PaperSection& section : sections)
    for (const AgreementRow& row : section.rows)
      if (row.paper == paper) return row;
  FAIL("no row says " + paper);
  return sections.front().rows.front();
}

}  // namespace

TEST_CASE("records that follow Eq. 3 and Eq. 5 are found to do so, from the folders to the table") {
  TemporaryFolder folder;
  CampaignSettings settings;
  settings.seeds = 1;
  const Campaign campaign = make_campaign(settings);
  for (const char* target : {"fig11", "fig13"})
    for (const size_t run : runs_for(campaign, target))
      if (!is_finished(folder.path(), campaign.runs[run].planned)) write_run(folder.path(), campaign.runs[run].planned);
  PaperData data(campaign, folder.path());
  std::vector<PaperSection> sections;
  for (const char* target : {"fig9", "fig10", "fig11", "fig13"})
    sections.push_back(make_sections(data, target).front());
  for (const PaperSection& section : sections) CHECK(section.notes.empty());
  for (const char* claim :
       {"Δx_max ~ ν^−2", "v_max ~ ν^−1", "Δx_max ~ f_max^−1", "Δx_max ~ g^2", "Δx_max ~ m/(m + m_w)",
        "one line through all sweeps", "maximum at ν_c ~ 10 Hz", "Δρ_max/ρ₀ ~ 0.0025"})
    CHECK(row_of(sections, claim).agreement == Agreement::agrees);
  CHECK_THAT(row_of(sections, "Δx_max ~ ν^−2").ballast, Catch::StartsWith("−2.0"));
  CHECK_THAT(row_of(sections, "Δx_max ~ g^2").ballast, Catch::StartsWith("2.0"));
  CHECK_THAT(row_of(sections, "C ~ 0.01").ballast, Catch::StartsWith("C = 0.0") && Catch::Contains("m all grains"));
  const auto values = data.sweep(Sweep::frequency);
  for (const SweepValue& value : values)
    CHECK(value.samples.front().rise / value.samples.front().eq3() ==
          Approx(prefactor).epsilon(0.03));  // 41 steps in the fastest stroke
}

TEST_CASE("partial data give partial figures and a loud note; no data give a report as well") {
  TemporaryFolder folder;
  const Campaign campaign = make_campaign({});
  PaperData nothing(campaign, folder.path());
  const auto empty = make_sections(nothing, "all");
  CHECK(empty.size() == 14);
  for (const PaperSection& section : empty) {
    INFO(section.id);
    CHECK_FALSE(section.notes.empty());
    CHECK(section.rows.empty());
    CHECK(section.figures.empty());
  }
  int written = 0;
  for (const CampaignPoint& point : campaign.points) {
    if (point.sweep != Sweep::frequency || point.value < 5.0 || point.value > 10.0 || point.seed > 2) continue;
    write_run(folder.path(), campaign.runs[point.run].planned);
    ++written;
  }
  REQUIRE(written == 6);
  PaperData data(campaign, folder.path());
  CHECK(data.finished() == 6);
  const PaperSection section = make_sections(data, "fig9").front();
  REQUIRE(section.notes.size() == 1);
  CHECK(section.notes.front() == "PARTIAL: 3 of 10 frequencies, 6 of 30 runs.");
  REQUIRE(section.figures.size() == 1);

  write_paper_report(data, make_sections(data, "all"), folder.path() / "report");
  const auto text = [&](const char* name) {
    std::ifstream file(folder.path() / "report" / name);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string markdown = text("README.md"), html = text("paper.html");
  CHECK_THAT(markdown, Catch::Contains("**PARTIAL: 3 of 10 frequencies, 6 of 30 runs.**") &&
                           Catch::Contains("figures/fig09.svg") &&
                           Catch::Contains("6 of " + std::to_string(campaign.runs.size()) + " runs are finished"));
  CHECK_THAT(html, Catch::Contains("PARTIAL: 3 of 10 frequencies"));
  CHECK_THAT(text("data/fig09.csv"), Catch::StartsWith("panel,y_label,curve,x_label,x,y,y_error,y_low\n"));
}

TEST_CASE("numbers are written as a person writes them") {
  CHECK(digits(-1.9342) == "−1.93");
  CHECK(digits(0.00025) == "2.50e-4");
  CHECK(digits(not_known) == "–");
  CHECK(with_error(1.23456, 0.0421) == "1.235 ± 0.042");
  CHECK(with_error(123.4, 5.6) == "123.4 ± 5.6");
  CHECK(with_error(1.5, not_known) == "1.50");
}
