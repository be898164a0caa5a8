// The investigation on runs whose exponents are known: every part of it must find them again.

#include <cmath>
#include <set>

#include "experiments/paper/campaign.hpp"
#include "experiments/paper/run_groups.hpp"
#include "tests/experiments/paper/paper_runs.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

constexpr double excess = 0.2;  // Delta x_max ~ nu^-1.8; friction 0.8 mends it to -2

PaperLaw known_law() {
  PaperLaw law;
  law.prefactor = 0.2;  // far above the drift of a micrometre a period
  law.excess = [](const Scene& scene) { return scene.friction > 0.7 ? 0.0 : excess; };
  return law;
}

/// Enough of the campaign for every part of the section.
Campaign written_campaign(const std::filesystem::path& results) {
  CampaignSettings settings;
  settings.seeds = 1;
  const Campaign campaign = make_campaign(settings);
  const std::set<double> frequencies{5.0, 7.0, 10.0, 15.0, 20.0, 60.0};
  for (const CampaignPoint& point : campaign.points) {
    using enum Varied;
    const bool is_wanted =
        (point.varied == frequency && frequencies.contains(point.value)) || point.varied == force ||
        point.varied == gravity || point.varied == rough_frequency ||
        (point.varied == size && point.seed == 1) ||
        ((point.varied == iterations || point.varied == iterations_fast) && point.value <= 20.0);
    const PlannedRun& run = campaign.runs[point.run].planned;
    if (is_wanted && !is_finished(results, run)) write_run(results, run, known_law());
  }
  return campaign;
}

const RunGroup& cause_of(const std::vector<RunGroup>& causes, const std::string& name) {
  for (const RunGroup& cause : causes)
    if (cause.name == name) return cause;
  FAIL("no cause is called " + name);
  return causes.front();
}

}  // namespace

TEST_CASE(
    "the investigation finds exponents, the cause that mends them, and what similarity demands") {
  const TemporaryFolder folder;
  PaperData data(written_campaign(folder.path()), folder.path());
  const std::vector<RunGroup> causes = causes_of(data);
  const auto exponent = [&](const char* name, double Observation::*quantity) {
    const RunGroup& cause = cause_of(causes, name);
    REQUIRE(cause.at(10.0));
    REQUIRE(cause.at(60.0));
    return exponent_between(*cause.at(10.0), *cause.at(60.0), quantity).mean;
  };
  CHECK(exponent("nothing (mean over samples)", &Observation::rise) ==
        Approx(-2.0 + excess).margin(0.01));
  CHECK(exponent("nothing (mean over samples)", &Observation::speed_in) ==
        Approx(-1.0 + excess).margin(0.01));
  CHECK(exponent("friction 0.8", &Observation::rise) == Approx(-2.0).margin(0.01));
  CHECK(exponent("20 iterations a step", &Observation::rise) == Approx(-2.0 + excess).margin(0.01));
  CHECK(cause_of(causes, "friction 0.8").reference == 1);

  const std::vector<VariedValue> frequencies = data.values(Varied::frequency),
                                 sizes = data.values(Varied::size);
  REQUIRE(frequencies.size() == 6);
  for (size_t k = 1; k < frequencies.size(); ++k)
    CHECK(exponent_between(frequencies[k - 1], frequencies[k], &Observation::rise).mean ==
          Approx(-2.0 + excess).margin(0.02));
  const double full =
      interpolated(frequencies[1], frequencies[2], 10.0 * std::sqrt(0.5), &Observation::rise).mean;
  REQUIRE(sizes.size() == 3);
  for (const size_t half : {1, 2})
    CHECK(sizes[half].mean(&Observation::rise).mean == Approx(0.5 * full).epsilon(0.01));

  const std::vector<PaperSection> sections = make_sections(data, "investigation");
  REQUIRE(sections.size() == 1);
  CHECK(sections[0].figures.size() == 2);
  std::string effects;
  for (const page::Table& table : sections[0].tables)
    for (const std::vector<page::Text>& row : table.rows)
      if (row.size() == 8)
        effects += plain_words(row[0] + " " + row[1] + " " + row[2] + " " + row[3]) + '\n';
  CHECK_THAT(effects, Catch::Contains("friction 0.8 Δx_max −2.00 −1.80") &&
                          Catch::Contains("20 iterations a step Δx_max −1.80 −1.80"));
  const auto found = [&](const std::string& what) {
    for (const BeyondRow& finding : sections[0].findings)
      if (plain_words(finding.what) == what) return plain_words(finding.found);
    return std::string("nothing");
  };
  CHECK_THAT(found("exponent of g = −α/2 − β (similarity)"),
             Catch::StartsWith("−α/2 − β = 1.90") && Catch::Contains("measured: 1.90"));
  CHECK_THAT(found("compaction fastest near 10 Hz"),
             Catch::Contains("at 10 Hz in the paper’s window"));
  CHECK_THAT(found("half-scale box = full box at ν/√2 (similarity), with the lid’s 1 cm as it is"),
             Catch::Contains("Δx_max") && Catch::Contains("v_max"));
}
