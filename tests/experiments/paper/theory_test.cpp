// The dependence of C in theory, on rows and runs that follow a law, which must be found.

#include "experiments/paper/laws.hpp"
#include "platform/text.hpp"
#include "tests/experiments/paper/paper_runs.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

/// The row of a run of which only some measures are known.
RunRow row_of(const std::string& stage, const std::string& setting, int seed) {
  RunRow row;
  row.stage = stage;
  row.name = stage + "-" + setting + "-grains.seed=" + std::to_string(seed);
  row.key = row.name;
  row["seed"] = seed;
  return row;
}

}  // namespace

TEST_CASE("C against its theory: the force that the grains push with gives it, point by point") {
  const TemporaryFolder folder;
  PaperLaw law = steep_law(0.0);
  law.offset = 200.0;
  law.slope = 0.4;
  PaperData data = written(folder.path(), {"frequency", "slowest", "mass", "box"}, law, is_of_two);
  // F = 200 N/(1 - 0.4), M = m_w 0.4/(1 - 0.4), 200 kg of grains.
  const auto theory = [](double wall) {
    const double force = 200.0 / 0.6 / (200.0 * 9.81), carried = wall * 0.4 / 0.6;
    return 9.0 / (4.0 * M_PI * M_PI) * force * force * (1.0 + wall) / (wall + carried);
  };
  for (const RunRow* row : data.rows("mass"))
    CHECK((*row)["prefactor_theory"] ==
          Approx(theory((*row)["wall_mass_over_grains"])).epsilon(0.02));
  const PaperSection section = section_named(data, "theory");
  REQUIRE(section.figures.size() == 1);
  // Ten frequencies, three wall masses beside the one that they share, five boxes twice.
  size_t points = 0;
  for (const std::vector<page::Text>& row : section.tables[0].rows) {
    points += std::stoul(plain_words(row[2]));
    if (plain_words(row[1]) == "L/H")
      CHECK(std::stod(plain_words(row[5])) == Approx(law.prefactor / theory(0.5)).epsilon(0.03));
  }
  CHECK(points == 23);
  CHECK_THAT(found_of(section, "C against its theory, 23 distinct points"),
             Catch::StartsWith("C as seen is "));
}

TEST_CASE("what C goes with: the exponents that rows were made with are found again") {
  std::vector<RunRow> rows;
  for (int setting = 0; setting < 8; ++setting)
    for (const int seed : {1, 2}) {
      RunRow& row = rows.emplace_back();
      row.stage = "frequency";
      row.name = printed("frequency-%d-grains.seed=%d", setting, seed);
      row.key = printed("%d-%d", setting, seed);
      // Force, mass and X vary independently; seeds scatter by one per cent.
      const double force = 0.1 * (1 + setting % 4), mass = 1.0 + 0.5 * (setting / 4);
      row["seed"] = seed;
      row["push_over_weight"] = force;
      row["prefactor_theory"] = 0.228 * force * force * mass;
      row["eq3"] = 1e-3 * std::pow(10.0, setting % 3);
      row["prefactor"] = 0.3 * std::pow(force, 1.7) * std::pow(mass, 0.9) * (0.995 + 0.01 * seed);
    }
  PaperData data({}, "nowhere", rows);
  const std::string found = found_of(section_named(data, "theory"), "what C goes with");
  CHECK_THAT(found, Catch::StartsWith("8 settings: F/(m g) to the power 1.70 "));
  CHECK_THAT(found, Catch::Contains("(m + m_w)/(m_w + M) to 0.900 "));
}

TEST_CASE("C with the shape of the box beside X: the exponent that rows were made with") {
  std::vector<RunRow> rows;
  for (const double mm : {1.0, 10.0, 100.0})
    for (const double aspect : {0.5, 1.0, 2.0})
      for (const int seed : {1, 2}) {
        RunRow& row = rows.emplace_back(row_of("box", printed("%g-%g", mm, aspect), seed));
        row["eq3"] = 1e-3 * mm;
        row["aspect"] = aspect;
        const double u = std::log(mm);
        row["prefactor"] = 0.04 * std::exp(-0.1 * u - 0.01 * u * u) * std::pow(aspect, -0.9) *
                           (0.995 + 0.01 * (seed - 1));
      }
  PaperData data({}, "nowhere", rows);
  PaperSection section;
  report_box(data, section);
  REQUIRE(section.findings.size() == 1);
  const std::string found = plain_words(section.findings[0][1]);
  CHECK_THAT(found, Catch::StartsWith("9 settings: C ~ (L/H) to the power −0.900 "));
}

TEST_CASE("by how much C is more than the theory's is said frequency by frequency") {
  std::vector<RunRow> rows;
  for (const double frequency : {5.0, 60.0})
    for (const double deposit : {1.0, 2.0, 3.0})
      for (const int seed : {1, 2}) {
        RunRow& row =
            rows.emplace_back(row_of("preparation", printed("%g-%g", frequency, deposit), seed));
        row["frequency"] = frequency;
        row["prefactor_theory"] = 0.01 * deposit;
        row["prefactor"] =
            0.01 * deposit * (frequency < 10.0 ? 1.5 : 1.0) * std::exp(0.01 * (deposit - 2.0));
        row["yield_over_weight"] = 0.3 + 0.1 * deposit;
      }
  PaperData data({}, "nowhere", rows);
  const PaperSection section = section_named(data, "theory");
  CHECK(found_of(section, "C over the theory’s at 5.00 Hz, 3 deposits")
            .starts_with("1.50, one deposit scatters by 1.0 %"));
  CHECK_THAT(found_of(section, "C over the theory’s at 60.0 Hz"),
             Catch::StartsWith("1.00") && Catch::Contains("0.40 to 0.60 m g"));
}
