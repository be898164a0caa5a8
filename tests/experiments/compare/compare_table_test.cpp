// Profiles and means of a comparison against a table worked out by hand.

#include "experiments/compare/compare_table.hpp"

#include <cmath>
#include <limits>

#include "experiments/compare/compare_html.hpp"
#include "experiments/compare/compare_page.hpp"
#include "experiments/compare/reference_times.hpp"
#include "experiments/page/plot.hpp"
#include "experiments/run/manifest.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// Four cases, three solvers. a is fastest on 1 and 2, b on 3, nobody solves 4.
const std::vector<std::vector<double>> hand_made = {
    {1.0, 2.0, inf}, {2.0, 8.0, 6.0}, {9.0, 3.0, inf}, {inf, inf, inf}};

CompareRow row(const char* case_name, const char* solver, double seconds, Outcome outcome,
               int repeat = 0) {
  CompareRow r;
  r.case_name = case_name;
  r.family = "hand";
  r.solver = solver;
  r.law = "coulomb";
  r.tolerance = 1e-4;
  r.repeat = repeat;
  r.max_seconds = 60.0;
  r.outcome = outcome;
  r.claimed = r.judged = outcome == Outcome::solved;
  r.solve_seconds = seconds;
  r.error = outcome == Outcome::solved ? 5e-5 : 1e-2;
  r.natural_map_rms = r.error;
  r.facts.contacts = case_name[0] == 'x' ? 10 : 20;
  r.facts.mass_ratio = case_name[0] == 'x' ? 2.0 : 5.0;
  r.worst = "contact 3 <of> two";
  r.history = {{0, 0, 0.0, 1.0}, {0, 1, 0.5 * seconds, 1e-2}, {0, 2, seconds, r.error}};
  return r;
}

}  // namespace

TEST_CASE("Performance profiles of a table made by hand") {
  const std::vector<StepCurve> curves = performance_profiles(hand_made, 10.0);
  REQUIRE(curves.size() == 3);
  // a: ratios 1, 1, 3, inf
  CHECK(curves[0].x == std::vector<double>{1.0, 3.0});
  CHECK(curves[0].y == std::vector<double>{0.5, 0.75});
  // b: 2, 4, 1, inf
  CHECK(curves[1].x == std::vector<double>{1.0, 2.0, 4.0});
  CHECK(curves[1].y == std::vector<double>{0.25, 0.5, 0.75});
  // c: inf, 3, inf, inf
  CHECK(curves[2].x == std::vector<double>{1.0, 3.0});
  CHECK(curves[2].y == std::vector<double>{0.0, 0.25});
}

TEST_CASE("Data profiles of a table made by hand") {
  const std::vector<double> sizes = {1.0, 2.0, 3.0, 1.0};
  const std::vector<StepCurve> curves = data_profiles(hand_made, sizes, 0.1, 100.0);
  // a: 1, 1, 3, inf per contact
  CHECK(curves[0].x == std::vector<double>{0.1, 1.0, 3.0});
  CHECK(curves[0].y == std::vector<double>{0.0, 0.5, 0.75});
}

TEST_CASE("Shifted geometric means") {
  const std::vector<double> a = {1.0, 100.0}, b = {4.0, 25.0};
  CHECK(shifted_geometric_mean(a, 0.0) == Approx(10.0));
  CHECK(shifted_geometric_mean(a, 1.0) == Approx(std::sqrt(2.0 * 101.0) - 1.0));
  CHECK(shifted_geometric_ratio(a, b, 0.0) == Approx(1.0));
  CHECK(shifted_geometric_ratio(a, b, 5.0) == Approx(std::sqrt(6.0 / 9.0 * 105.0 / 30.0)));
}

TEST_CASE("Cells: medians over repeats, solved only when every repeat is") {
  const std::vector<CompareRow> rows = {
      row("x", "a", 3.0, Outcome::solved, 0), row("x", "a", 1.0, Outcome::solved, 1),
      row("x", "a", 2.0, Outcome::solved, 2), row("x", "b", 1.0, Outcome::solved, 0),
      row("x", "b", 60.0, Outcome::timeout, 1)};
  const std::vector<CompareTable> tables = compare_tables(rows);
  REQUIRE(tables.size() == 1);
  const CompareCell& a = tables[0].cells[0][0];
  CHECK(a.solved);
  CHECK(a.median == 2.0);
  CHECK(a.fastest == 1.0);
  CHECK(a.slowest == 3.0);
  CHECK(a.row == &rows[1]);
  CHECK_FALSE(tables[0].cells[0][1].solved);
  CHECK(std::isinf(tables[0].cells[0][1].median));
  CHECK(tables[0].fastest(0) == 2.0);
}

TEST_CASE("Errors of histories fall, and their means are taken at equal times") {
  CompareRow r = row("x", "a", 1.0, Outcome::solved);
  r.prepare_seconds = 0.25;
  r.history = {{0, 0, 0.0, 1.0}, {0, 1, 1.0, 1e-2}, {0, 2, 2.0, 1e-1}, {0, 3, 3.0, 1e-4}};
  const StepCurve best = best_so_far(r);
  CHECK(best.x == std::vector<double>{0.25, 1.25, 3.25});
  CHECK(best.y == std::vector<double>{1.0, 1e-2, 1e-4});
  const std::vector<StepCurve> curves = {best, {{0.0, 2.0}, {1.0, 1e-4}}};
  const std::vector<double> times = {0.1, 1.5, 2.0, 4.0};
  const std::vector<double> mean = mean_error_at(curves, times);
  CHECK(mean[0] == Approx(1.0));
  CHECK(mean[1] == Approx(1e-1));
  CHECK(mean[2] == Approx(1e-3));
  CHECK(mean[3] == Approx(1e-4));
}

TEST_CASE("Reference times: names that differ by their suffixes, and ratios") {
  const TemporaryFolder folder;
  const auto file = folder.write(
      "ref.csv", "problem,ms_1e-4,solver_1e-4\nx-condensed.dat,500,NSGS\ny.dat,,\nz.dat,7,ADMM\n");
  const std::vector<ReferenceTimes> reference = read_reference_times(file);
  REQUIRE(reference.size() == 1);
  CHECK(reference[0].tolerance == 1e-4);
  CHECK(reference[0].entries.at("x").seconds == Approx(0.5));
  const std::vector<CompareRow> rows = {
      row("x.hdf5", "a", 2.0, Outcome::solved), row("x.hdf5", "auto", 1.0, Outcome::solved),
      row("y.dat", "a", 3.0, Outcome::solved), row("y.dat", "auto", 4.0, Outcome::stopped),
      row("x.hdf5", "siconos_nsgs", 0.1, Outcome::solved)};
  const std::vector<CompareTable> tables = compare_tables(rows);
  const std::vector<ReferenceComparison> compared = compare_with_reference(tables, reference);
  REQUIRE(compared.size() == 1);
  REQUIRE(compared[0].lines.size() == 1);
  CHECK(compared[0].lines[0].our_solver == "auto");
  CHECK(compared[0].only_ours == std::vector<std::string>{"y.dat"});
  CHECK(compared[0].missing.empty());
  CHECK(compared[0].ratio(0.0, 60.0, false) == Approx(2.0));
  CHECK(compared[0].ratio(0.5, 60.0, true) == Approx(1.5));
  for (const char* bad :
       {"problem,ms\n", "problem,ms_1e-4,solver\nx,fast,me\n", "problem,ms_1e-4,solver\nx,1\n", ""})
    CHECK_THROWS_AS(read_reference_times(folder.write("bad.csv", bad)), Error);
}

TEST_CASE("The page of a comparison is well-formed and has what it promises") {
  const TemporaryFolder folder;
  std::vector<CompareRow> rows;
  for (const char* name : {"x&<1", "y2"}) {
    rows.push_back(row(name, "a", 0.1, Outcome::solved));
    rows.push_back(row(name, "b", 0.3, Outcome::solved));
    rows.push_back(row(name, "c", 60.0, Outcome::timeout));
  }
  rows.push_back(row("z", "a", 0.2, Outcome::stopped));
  rows.back().claimed = true;
  Manifest("compare", {"ballast compare <x>"}, "key").write(folder.path() / "manifest.json");
  write_compare_page(folder.path(), rows, {});
  const std::string page = read_whole_file(folder.path() / "compare.html");
  check_page(page);
  CHECK(page.find("x&amp;&lt;1") != std::string::npos);
  CHECK(page.find("the judge denies it") != std::string::npos);
  if (!gnuplot_version().empty())
    for (const char* name : {"performance_cold_1e-04", "data_cold_1e-04",
                             "cost_contacts_cold_1e-04", "case_y2_cold", "family_hand_cold"}) {
      INFO(name);
      CHECK(page.find(std::string("<figure id=\"") + name) != std::string::npos);
      CHECK(std::filesystem::file_size(folder.path() / "figures" / (std::string(name) + ".pdf")) >
            1000);
    }
  CHECK(compare_summary(rows, {}).find("CLAIMS DENIED") != std::string::npos);
}
