#include "experiments/compare/case_views.hpp"

#include "experiments/compare/compare_options.hpp"
#include "platform/atomic_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/captured_run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

TEST_CASE("captured cases are seen in 3D with the backends that gave an answer, others are not") {
  const TemporaryFolder place;
  const fs::path file = captured_run(place.path() / "run");
  const std::string captured = file.parent_path().string();
  fs::copy_file(file, place.path() / "alone.hdf5");

  CompareOptions options;
  options.solvers = parse_solvers("pgs,apgd,nncg");
  options.tolerances = {1e-3};
  options.max_seconds = 5.0;
  options.limits.memory_MB = 0.0;  // sanitizers reserve terabytes
  options.folder = place.path() / "compare";
  const auto cases =
      compare_cases({captured, (place.path() / "alone.hdf5").string(), "known:contacts=5,count=1"});
  REQUIRE(cases.size() >= 3);
  CHECK(cases.front().has_bodies);
  // out of its run's folder too; a problem made on the spot is nowhere
  CHECK(cases[cases.size() - 2].has_bodies);
  CHECK_FALSE(cases.back().has_bodies);
  auto rows =
      run_comparison(cases, options, [](const auto&, bool, size_t, size_t) { return true; });
  for (CompareRow& row : rows)
    if (row.solver == "apgd") row.verdict = Verdict::crashed;

  const auto goes_on = [] { return true; };
  CHECK(write_case_views(rows, options, goes_on) == cases.size() - 1);
  CHECK_FALSE(fs::exists(options.folder / view_page_of(cases.back().name)));
  const fs::path page = options.folder / view_page_of(cases.front().name);
  const std::string text = read_whole_file(page);
  CHECK_THAT(text, Catch::Contains(R"("backend":"pgs")") &&
                       Catch::Contains(R"("backend":"nncg")") &&
                       !Catch::Contains(R"("backend":"apgd")"));
  // what is there stays; who is stopped writes nothing
  write_whole_file(page, "kept");
  write_case_views(rows, options, goes_on);
  CHECK(read_whole_file(page) == "kept");
  fs::remove(page);
  CHECK(write_case_views(rows, options, [] { return false; }) == 0);
  CHECK_FALSE(fs::exists(page));
}

}  // namespace
}  // namespace ballast
