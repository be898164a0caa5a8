#include "experiments/compare/collection.hpp"

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
  std::vector<CollectedProblem> first, second;
  const auto make = [&](const char* name, std::vector<CollectedProblem>& problems) {
    return make_collection(
        folder.path() / name, std::vector{run}, [](const auto&) {}, problems);
  };
  REQUIRE(make("a", first) == ExitCode::ok);
  REQUIRE(make("b", second) == ExitCode::ok);
  REQUIRE(first.size() == 4);
  CHECK(first[0].file == "pressed-25/step_0000010.hdf5");
  CHECK(first[0].phase == "settling");
  CHECK(first[3].file == "pressed-25/step_0000285.hdf5");
  CHECK(first[3].phase == "passive");
  CHECK(first[0].contacts > 0);
  const std::string manifest = read_whole_file(folder.path() / "a/problems/manifest.csv");
  CHECK(read_whole_file(folder.path() / "b/problems/manifest.csv") == manifest);
  CHECK_THAT(manifest, Catch::StartsWith("file,content,contacts,rows,step,phase\n") &&
                           Catch::Contains(first[3].file + "," + first[3].content + ","));
  // What a comparison calls its content.
  const auto cases = compare_cases({(folder.path() / "a/problems").string()});
  REQUIRE(cases.size() == 4);
  CHECK(cases[0].load().facts.content == first[0].content);
  // The same command goes on where all is there.
  CHECK(make("a", second) == ExitCode::ok);
  CHECK(second.size() == 4);
}
