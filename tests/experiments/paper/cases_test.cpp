// Sections that are rows of the tables of laws and cases must find the law that the made-up runs
// follow.

#include "platform/text.hpp"
#include "tests/experiments/paper/paper_runs.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("exponents of samples, and what a case changes") {
  const TemporaryFolder folder;
  // The walls of the rough deposits go out a quarter farther.
  PaperLaw law;
  law.prefactor = 0.2;
  law.excess = [](const Scene& scene) { return scene.deposit.friction > 0.7 ? 0.1 : 0.3; };
  PaperData data =
      written(folder.path(), {"deposits"}, law, [](const PlannedRun& run, const Scene& scene) {
        return is_of_two(run, scene) && scene.deposit.lid_pressure_weight > 0.0;
      });
  const PaperSection section = section_named(data, "deposits");
  REQUIRE(section.tables.size() == 3);
  CHECK(section.tables[0].rows.size() == 8);
  REQUIRE(section.tables[1].rows.size() == 6);  // over all frequencies, and between two pairs
  for (const auto& row : section.tables[1].rows) {
    const std::string exponent_words = plain_words(row[3]), minus = "−";
    REQUIRE(exponent_words.starts_with(minus));
    CHECK(std::stod(exponent_words.substr(minus.size())) ==
          Approx(plain_words(row[0]).ends_with("0.8") ? 1.9 : 1.7).margin(0.015));
  }
  // The change is ln of (L nu^2/g)^(0.05 - 0.15) at 10 Hz: 1 - (0.54 x 100/9.81)^-0.1.
  REQUIRE(section.tables[2].rows.size() == 4);
  CHECK_THAT(plain_words(section.tables[2].rows[1][2]), Catch::StartsWith("−16 %"));
  CHECK(section.notes.size() == 1);  // runs with a placed lid are missing
  CHECK(found_of(section, "exponents of ν: lid pressed, μ 0.8, 5 to 60 Hz")
            .starts_with("Δx_max −1.90"));
}

TEST_CASE("of fewer than three values or of one sample nothing is made up") {
  const TemporaryFolder folder;
  PaperData data = written(folder.path(), {"deposits"}, steep_law(0.0),
                           [](const PlannedRun&, const Scene& scene) {
                             return scene.grains->seed == 1 && scene.drive.frequency < 15.0 &&
                                    scene.deposit.friction == 0.4;
                           });
  const PaperSection section = section_named(data, "deposits");
  REQUIRE(section.tables.size() == 2);  // with two frequencies there are no exponents
  CHECK(section.findings.empty());
  for (const auto& row : section.tables[1].rows) {
    CHECK(plain_words(row[2]) == "+0 %");  // the walls are the same; one sample has no interval
    CHECK(plain_words(row[3]) == "–");
  }
  CHECK(plain_words(words_of_change({})) == "–");
  CHECK(plain_words(words_with_interval({})) == "–");
  CHECK(plain_words(words_with_interval({1.0, not_known, 1})).ends_with("(one sample)"));
}

TEST_CASE("the run that all series of Eq. 3 have is one point of their common fit") {
  const TemporaryFolder folder;
  PaperData data =
      written(folder.path(), {"frequency", "force", "gravity", "mass"}, steep_law(0.5),
              [](const PlannedRun&, const Scene& scene) { return scene.grains->seed == 1; });
  const PaperSection section = section_named(data, "fig11");
  const std::vector<Curve>& curves = section.figures[0].plot.panels[0].curves;
  std::set<std::pair<double, double>> points;
  for (size_t family = 0; family < 4; ++family)
    for (size_t k = 0; k < curves[family].x.size(); ++k)
      points.emplace(curves[family].x[k], curves[family].y[k]);
  std::vector<double> x, y;
  for (const auto& [at, rise] : points) x.push_back(at), y.push_back(rise);
  CHECK(points.size() == 9 + 4 + 3 + 3);
  CHECK_THAT(judged({section}, "one line through all series"),
             Catch::Contains(plain_words(words_of(fit_power(x, y)))));
}

TEST_CASE("the box's section finds how C goes with L/H") {
  const TemporaryFolder folder;
  // (L nu^2/g)^(excess/2) with excess -2: C is proportional to L^-1, and the height H is constant.
  PaperData data = written(folder.path(), {"box"}, steep_law(-2.0), is_of_two);
  const PaperSection section = section_named(data, "box");
  REQUIRE(section.figures.size() == 2);
  CHECK(section.figures[0].plot.panels[0].curves[0].x.size() == 5);
  CHECK_THAT(found_of(section, "C and the box at 5 Hz"), Catch::Contains("−1.00 ["));
  // The record's drift of a micrometre a period is one to two per cent of the rise here.
  CHECK_THAT(found_of(section, "the box at 20 Hz"),
             Catch::StartsWith("exponents of L/H") && Catch::Contains("Δx_max −1.01"));
  CHECK(section.tables[1].rows.size() == 10);
}

TEST_CASE("the floor of chaos is the replicas' standard deviation") {
  const TemporaryFolder folder;
  PaperLaw law = steep_law(0.0);
  // (L nu^2/g)^(excess/2) makes four replicas 2 % larger and four 2 % smaller.
  law.excess = [](const Scene& scene) {
    const double base = std::log(scene.box.length * 100.0 / 9.81);
    return 2.0 * std::log(scene.drive.start_noise_seed % 2 == 0 ? 1.02 : 0.98) / base;
  };
  PaperData data =
      written(folder.path(), {"replicas"}, law,
              [](const PlannedRun&, const Scene& scene) { return scene.drive.frequency == 10.0; });
  // The standard deviation of 1 ± 0.02 with n - 1: 0.02 sqrt(8/7).
  CHECK(found_of(section_named(data, "replicas"), "floor of chaos")
            .starts_with("Δx_max scatters by 2.1 % at 10 Hz (8"));
}

TEST_CASE("every other table of cases has its rows") {
  const TemporaryFolder folder;
  PaperData data = written(folder.path(),
                           {"sizes", "laws", "shapes", "loads", "rule", "reading", "tightest",
                            "frequency", "sensitivity"},
                           steep_law(0.2), is_of_two);
  CHECK(section_named(data, "sizes").tables[0].rows.size() == 12);
  CHECK_THAT(found_of(section_named(data, "sizes"), "length ℓ: similar"),
             Catch::Contains("Δx_max 0.1"));
  CHECK(section_named(data, "laws").tables[0].rows.size() == 2);
  // Both laws have the same packings and the same walls: the change is zero.
  CHECK(found_of(section_named(data, "laws"), "convex instead of exact")
            .starts_with("C +0 % [0, 0]"));
  CHECK(section_named(data, "shapes").findings.size() == 6);
  CHECK(section_named(data, "loads").tables[0].rows.size() == 12);
  CHECK(section_named(data, "sensitivity").tables.size() == 3);
  // Two frequencies with the rule, five with the tight solver, nine of the campaign.
  const PaperSection tight = section_named(data, "tight");
  CHECK(tight.tables[0].rows.size() == 16);
  CHECK(found_of(tight, "exponents of ν: LMGC90’s rule, 10 and 60 Hz").starts_with("Δx_max −1.8"));
  CHECK(found_of(tight, "exponents of ν: error").starts_with("Δx_max −1.80"));
  const PaperSection reading = section_named(data, "reading");
  REQUIRE(reading.tables.size() == 2);
  CHECK(plain_words(reading.tables[0].rows[1][1]).starts_with("−1.80"));
}

TEST_CASE("each preparation stands beside the paper's numbers, each window of compaction alone") {
  const TemporaryFolder folder;
  PaperData data = written(folder.path(), {"preparation", "compaction"}, steep_law(0.2),
                           [](const PlannedRun& run, const Scene& scene) {
                             const bool is_long = stage_of(run) == "compaction";
                             const auto seed = scene.grains->seed;
                             return seed <= (is_long ? 3 : 2) &&
                                    !(is_long && seed == 1 && scene.drive.frequency == 20.0);
                           });
  const PaperSection preparation = section_named(data, "preparation");
  // The paper's, then three pressures times two frictions, and the shorter fall.
  REQUIRE(preparation.tables[0].rows.size() == 8);
  CHECK(plain_words(preparation.tables[0].rows[7][1]).starts_with("−1.80"));
  CHECK(found_of(preparation, "a shorter fall, lid placed, μ 0.4").starts_with("of 6 numbers"));
  const PaperSection compaction = section_named(data, "compaction");
  REQUIRE(compaction.figures.size() == 1);
  CHECK(compaction.figures[0].plot.panels[0].curves.size() == 3);
  const std::string rate = found_of(compaction, "compaction rate, 0.5–1.5 s");
  CHECK(rate.starts_with("largest at "));
  // One packing is missing at 20 Hz: the others are compared.
  CHECK(rate.find("p –") == std::string::npos);
}

TEST_CASE("C against the solid fraction of deposits: the exponent that rows were made with") {
  std::vector<RunRow> rows;
  for (const double friction : {0.4, 0.8})
    for (const double pressure : {1.0, 0.2, 0.0})
      for (const int seed : {1, 2, 3}) {
        RunRow& row = rows.emplace_back();
        row.stage = "preparation";
        row.name = printed("preparation.lid-%g-%g-grains.seed=%d", friction, pressure, seed);
        row.key = row.name;
        row["seed"] = seed;
        row["frequency"] = 5.0;
        row["lid_pressure"] = pressure;
        row["deposit_friction"] = friction;
        // denser packings have a larger C as well: that is no part of the exponent
        const double density =
            (0.5 + 0.05 * pressure - 0.03 * (friction - 0.4)) * (0.9 + 0.05 * seed);
        row["density_before"] = density;
        row["aspect"] = std::pow(density, 2.0);
        row["prefactor"] = 0.02 * std::pow(density / 0.5, -3.0) * std::pow(seed, 2.0);
      }
  PaperData data({}, "nowhere", rows);
  const PaperSection section = section_named(data, "preparation");
  REQUIRE(section.figures.size() == 1);
  const std::vector<Curve>& curves = section.figures[0].plot.panels[0].curves;
  REQUIRE(curves.size() == 3);  // one for each friction, and the paper
  for (const size_t friction : {0, 1}) CHECK(curves[friction].x.size() == 3);
  CHECK(curves[2].x == std::vector{0.5});
  CHECK(curves[2].y == std::vector{0.01});
  CHECK(plain_words(section.numbers.at("preparation.exponent")) == "−3.00 [−3.00, −3.00]");
  CHECK(plain_words(section.numbers.at("preparation.aspect")) == "2.00 [2.00, 2.00]");
  // Of the means, with seed^2 and the packings' densities averaged by hand.
  CHECK(plain_words(section.numbers.at("preparation.at_paper")) == "0.0863");
}
