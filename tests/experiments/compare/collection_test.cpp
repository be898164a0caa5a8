#include "experiments/compare/collection.hpp"

#include <algorithm>
#include <set>

#include "experiments/compare/compare_case.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("The collection has three scenes of six sizes, each once") {
  std::set<std::string> names;
  for (const CollectedRun& run : collection_runs(2400)) names.insert(run.name);
  CHECK(names.size() == 18);
  CHECK(names.contains("pressed-2400"));
  CHECK(collection_runs(80).size() == 6);
}

TEST_CASE("A collection that is made twice holds the same problems, and its manifest says so") {
  const TemporaryFolder folder;
  CollectedRun run = collection_runs(25)[1];
  // Quicker to deposit than what is collected.
  run.overrides.emplace_back("grains.count=6");
  const auto make = [&](const char* name) {
    return make_collection(folder.path() / name, std::vector{run}, [](const auto&) {});
  };
  const auto manifest_of = [&](const std::string& name) {
    return read_whole_file(folder.path() / name / "problems/manifest.csv");
  };
  REQUIRE(make("a") == ExitCode::ok);
  REQUIRE(make("b") == ExitCode::ok);
  const std::string manifest = manifest_of("a");
  CHECK(manifest_of("b") == manifest);
  CHECK(std::count(manifest.begin(), manifest.end(), '\n') == 5);
  CHECK_THAT(manifest, Catch::StartsWith("file,content,contacts,rows,step,phase\n") &&
                           Catch::Contains(",10,settling\n") && Catch::EndsWith(",285,passive\n"));
  // What a comparison calls its content.
  const auto cases = compare_cases({(folder.path() / "a/problems").string()});
  REQUIRE(cases.size() == 4);
  CHECK_THAT(manifest, Catch::Contains("pressed-25/step_0000010.hdf5," +
                                       cases[0].load().facts.content + ","));
  // The same command goes on where all is there.
  CHECK(make("a") == ExitCode::ok);
  CHECK(manifest_of("a") == manifest);
}
