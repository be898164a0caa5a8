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

TEST_CASE("The summary of a collection has the fewest and the most contacts, wherever they stand") {
  const std::vector<CollectedProblem> problems{{"a", "", 70, 210, 10, "settling"},
                                               {"b", "", 9000, 27000, 95, "passive"},
                                               {"c", "", 61, 183, 190, "active"},
                                               {"d", "", 500, 1500, 285, "active"}};
  CHECK(summary_of(problems) ==
        "4 problems of 61 to 9000 contacts (2 active, 1 passive, 1 settling)");
  CHECK(summary_of({}) == "0 problems");
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
  CHECK(other_contents(first, second).empty());
  const auto file = folder.path() / "a/problems/manifest.csv";
  std::vector<CollectedProblem> read = read_collection(file);
  REQUIRE(read.size() == 4);
  CHECK(read[3].content == first[3].content);
  CHECK(read[3].phase == first[3].phase);
  read[2].content[0] = read[2].content[0] == '0' ? '1' : '0';
  CHECK(other_contents(first, read) == std::vector<std::string>{first[2].file});
  // What a comparison calls its content.
  const auto cases = compare_cases({(folder.path() / "a/problems").string()});
  REQUIRE(cases.size() == 4);
  CHECK(cases[0].load().facts.content == first[0].content);
  // The same command goes on where all is there.
  CHECK(make("a", read) == ExitCode::ok);
  CHECK(other_contents(first, read).empty());
  write_whole_file(file, "a,b\n");
  CHECK_THROWS_WITH(read_collection(file), Catch::Contains("is no manifest of a collection"));
}
