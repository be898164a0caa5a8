// The decisive stages' sections on runs that follow a law: they must find it again.

#include "experiments/paper/stage_tables.hpp"

#include <cmath>

#include "tests/experiments/paper/paper_runs.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

/// The runs of some things that are varied, made by a law.
PaperData written(const TemporaryFolder& folder, const std::vector<Varied>& wanted,
                  const PaperLaw& law, int seeds = 2) {
  CampaignSettings settings;
  settings.seeds = seeds;
  const Campaign campaign = make_campaign(settings);
  for (const CampaignPoint& point : campaign.points) {
    const PlannedRun& run = campaign.runs[point.run].planned;
    const bool is_wanted = std::find(wanted.begin(), wanted.end(), point.varied) != wanted.end();
    if (is_wanted && !is_finished(folder.path(), run)) write_run(folder.path(), run, law);
  }
  return PaperData(campaign, folder.path());
}

PaperSection section_named(PaperData& data, const std::string& name) {
  return make_sections(data, name).front();
}

/// What was found, in plain words, of the finding whose first part begins so.
std::string found_of(const PaperSection& section, const std::string& what) {
  for (const BeyondRow& row : section.findings)
    if (plain_words(row.what).starts_with(what)) return plain_words(row.found);
  FAIL("no finding of " + what);
  return {};
}

PaperLaw steep_law(double excess) {
  PaperLaw law;
  law.prefactor = 0.2;  // far above the drift of a micrometre a period
  law.excess = [excess](const Scene&) { return excess; };
  return law;
}

double frequency_of(const RunObservables& run) { return run.seen.facts.frequency; }

}  // namespace

TEST_CASE("stage tables: exponents of samples and what a case changes") {
  using enum Varied;
  const TemporaryFolder folder;
  // The rough deposits' walls go out a quarter farther.
  PaperLaw law = steep_law(0.3);
  law.excess = [](const Scene& scene) { return scene.deposit.friction > 0.7 ? 0.1 : 0.3; };
  PaperData data = written(folder, {pressed_frequency, pressed_rough_frequency}, law);
  const RunGroup smooth{"smooth", data.values(pressed_frequency)},
      rough{"rough", data.values(pressed_rough_frequency)};
  REQUIRE(smooth.values.size() == 4);
  const SampleMean exponent = exponent_by_sample(data, smooth.values, frequency_of, rise_of);
  CHECK(exponent.samples == 2);
  CHECK(exponent.mean == Approx(-1.7).margin(0.01));
  CHECK(exponent.error < 1e-6);
  CHECK(exponent_by_sample(data, rough.values, frequency_of, rise_of).mean ==
        Approx(-1.9).margin(0.01));
  // ln of (L nu^2/g)^(0.05 - 0.15) at each frequency
  REQUIRE(smooth.at(10.0));
  REQUIRE(rough.at(10.0));
  CHECK(!smooth.at(11.0));
  const double length = 0.54, expected = -0.1 * std::log(length * 100.0 / 9.81);
  const Difference change = log_change(data, *smooth.at(10.0), *rough.at(10.0), rise_of);
  CHECK(change.mean == Approx(expected).margin(0.01));
  CHECK(change.degrees_of_freedom == 1);

  const PaperSection section = section_named(data, "deposits");
  CHECK(section.tables.size() == 3);
  CHECK(section.tables[0].rows.size() == 8);
  CHECK(section.tables[1].rows.size() == 6);  // over all frequencies, and between two pairs
  for (const auto& row : section.tables[1].rows) {
    const std::string exponent_words = plain_words(row[3]), minus = "−";
    REQUIRE(exponent_words.starts_with(minus));
    CHECK(std::stod(exponent_words.substr(minus.size())) ==
          Approx(plain_words(row[0]).ends_with("0.8") ? 1.9 : 1.7).margin(0.015));
  }
  CHECK(section.tables[2].rows.size() == 4);
  CHECK(section.notes.size() == 2);  // the placed lids are not driven
  CHECK(found_of(section, "exponents of ν: lid pressed, μ 0.8, 5 to 60 Hz")
            .starts_with("Δx_max −1.90"));
}

TEST_CASE("stage tables: of fewer than three values or of one sample nothing is made up") {
  using enum Varied;
  const TemporaryFolder folder;
  PaperData data = written(folder, {pressed_frequency}, steep_law(0.0), 1);
  std::vector<VariedValue> values = data.values(pressed_frequency);
  const SampleMean exponent = exponent_by_sample(data, values, frequency_of, rise_of);
  CHECK(exponent.samples == 1);
  CHECK(plain_words(words_with_interval(exponent)).ends_with("(one sample)"));
  values.resize(2);
  CHECK(exponent_by_sample(data, values, frequency_of, rise_of).samples == 0);
  CHECK(plain_words(words_of_change(Difference{})) == "–");
  CHECK(plain_words(words_with_interval({})) == "–");
  const Difference change = log_change(data, values[0], values[0], rise_of);
  CHECK(change.mean == 0.0);
  CHECK(!std::isfinite(change.half_width()));
}

TEST_CASE("the box's section finds how C goes with L/H") {
  using enum Varied;
  const TemporaryFolder folder;
  // (L nu^2/g)^(excess/2) with excess -2: C goes with L^-1, the packing's height is the same.
  PaperData data = written(folder, {box_length, box_length_fast}, steep_law(-2.0));
  const PaperSection section = section_named(data, "box");
  REQUIRE(section.figures.size() == 1);
  const std::vector<Curve>& curves = section.figures[0].plot.panels[0].curves;
  REQUIRE(curves.size() == 4);  // as seen and by the theory, at two frequencies
  CHECK(curves[0].x.size() == 5);
  const PowerFit fit = fit_power(curves[0].x, curves[0].y);
  CHECK(fit.exponent == Approx(-1.0).margin(0.01));
  CHECK(found_of(section, "C and the box at 5 Hz").find("C −1.00 [") != std::string::npos);
  // C = 0.2 g/(L nu^2) is 0.01 at L = 20 g/nu^2 = 7.85 m, and H is 0.46 m.
  CHECK(section.tables[0].rows.size() == 10);
}

TEST_CASE("the floor of chaos is the replicas' standard deviation") {
  using enum Varied;
  const TemporaryFolder folder;
  PaperLaw law = steep_law(0.0);
  // (L nu^2/g)^(excess/2): four replicas by 2 % up, four as much down.
  law.excess = [](const Scene& scene) {
    const double base = std::log(scene.box.length * 100.0 / 9.81);
    return 2.0 * std::log(scene.drive.start_noise_seed % 2 == 0 ? 1.02 : 0.98) / base;
  };
  PaperData data = written(folder, {replica}, law, 1);
  const PaperSection section = section_named(data, "replicas");
  // standard deviation of 1 ± 0.02, n - 1: 0.02 sqrt(8/7)
  CHECK(found_of(section, "floor of chaos").starts_with("Δx_max scatters by 2.1 % at 10 Hz (8"));
}

TEST_CASE("sizes, laws, shapes, loads, rule and the second scene each have their rows") {
  using enum Varied;
  const TemporaryFolder folder;
  PaperData data = written(folder,
                           {size_similar, exact_law, convex_law, shape, light_frequency,
                            rule_frequency, reading_frequency, tight_frequency, frequency},
                           steep_law(0.2));
  CHECK(section_named(data, "sizes").tables[0].rows.size() == 6);  // with the campaign's own 1200
  CHECK(section_named(data, "laws").tables[0].rows.size() == 2);
  // the same packings, the same walls: a change of nothing
  CHECK(found_of(section_named(data, "laws"), "convex instead of exact: Δx_max")
            .starts_with("+0 % [0, 0]"));
  CHECK(section_named(data, "shapes").findings.size() == 3);
  CHECK(section_named(data, "loads").tables[0].rows.size() == 4);
  // two frequencies of the rule, one of 200 iterations, five of the tight solver
  CHECK(section_named(data, "rule").tables[0].rows.size() == 8);
  CHECK(found_of(section_named(data, "rule"), "exponents of ν: LMGC90’s rule, 10 and 60 Hz")
            .starts_with("Δx_max −1.8"));
  const PaperSection reading = section_named(data, "reading");
  REQUIRE(reading.tables.size() == 2);
  CHECK(plain_words(reading.tables[0].rows[0][2]).starts_with("−1.80"));
  CHECK(
      found_of(section_named(data, "tight"), "exponents of ν: error").starts_with("Δx_max −1.80"));
}

TEST_CASE("C against its theory: the force that the grains push with gives it, point by point") {
  using enum Varied;
  const TemporaryFolder folder;
  PaperLaw law = steep_law(0.0);
  law.offset = 200.0;
  law.slope = 0.4;
  PaperData data = written(folder, {frequency, wall_mass, box_length}, law);
  // F = 200 N/(1 - 0.4), M = m_w 0.4/(1 - 0.4), 200 kg of grains
  const auto theory = [](double wall) {
    const double force = 200.0 / 0.6 / (200.0 * 9.81), carried = wall * 0.4 / 0.6;
    return 9.0 / (4.0 * M_PI * M_PI) * force * force * (1.0 + wall) / (wall + carried);
  };
  const std::vector<VariedValue> walls = data.values(wall_mass);
  REQUIRE(walls.size() == 4);
  for (const VariedValue& value : walls)
    CHECK(mean_of(data, value, theory_of).mean == Approx(theory(value.value)).epsilon(0.02));
  const PaperSection section = section_named(data, "theory");
  REQUIRE(section.figures.size() == 1);
  // ten frequencies, three masses of the wall beside the one that they share, five boxes
  size_t points = 0;
  for (const std::vector<page::Text>& row : section.tables[0].rows) {
    points += std::stoul(plain_words(row[1]));
    if (plain_words(row[0]) == "L/H")
      CHECK(std::stod(plain_words(row[2])) == Approx(law.prefactor / theory(0.5)).epsilon(0.03));
  }
  CHECK(points == 18);
  const std::string found = found_of(section, "C against its theory, 18 distinct points");
  CHECK(found.starts_with("C as seen is "));
}
