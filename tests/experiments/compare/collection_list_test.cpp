#include "experiments/compare/collection.hpp"

#include <algorithm>
#include <set>

#include "problems/scene/scene.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

std::vector<CollectedRun> runs_of(const std::string& text) {
  const TemporaryFolder folder;
  return read_collection(folder.write("list.toml", text));
}

const std::string cube = "[[family]]\nname = \"cube\"\nscene = \"sliding_cube\"\n";

}  // namespace

TEST_CASE("The built-in list has many worlds of all sizes, and every one can be run") {
  const std::vector<CollectedRun> runs = runs_of(collection_list());
  std::set<std::string> families, names;
  int largest = 0;
  for (const CollectedRun& run : runs) {
    families.insert(run.family);
    names.insert(run.name);
    largest = std::max(largest, run.bodies);
  }
  CHECK(families.size() >= 15);
  CHECK(names.size() == runs.size());
  CHECK(largest == 24000);
  const auto found = std::ranges::find(runs, "pressed-2400", &CollectedRun::name);
  REQUIRE(found != runs.end());
  CHECK(found->is_large);
  CHECK(found->family == "pressed");
  CHECK(found->steps == 7);
  CHECK(std::ranges::count(found->overrides, "contact.friction=1") == 1);
}

TEST_CASE("A run for each combination, named by the first value of each text") {
  const auto runs = runs_of(cube +
                            "set = [\"scene.duration=0.1\"]\nsteps = \"every=10,steps=1,also=1\"\n"
                            "vary = [[\"body.0.velocity=[1,0,0]\", \"body.0.velocity=[0.5,2,0]\"],"
                            " [\"body.0.mass=1 wall.0.friction=0.2\", \"body.0.mass=9\"]]\n");
  REQUIRE(runs.size() == 4);
  CHECK(runs[0].name == "cube-1_0_0-1");
  CHECK(runs[3].name == "cube-0.5_2_0-9");
  CHECK(runs[0].overrides == std::vector<std::string>{"scene.duration=0.1",
                                                      "body.0.velocity=[1,0,0]", "body.0.mass=1",
                                                      "wall.0.friction=0.2"});
  CHECK(runs[0].steps == 11);
  CHECK(runs[0].bodies == 1);
  CHECK_FALSE(runs[0].is_large);
}

TEST_CASE("An entry like another one takes what it has not itself") {
  const auto runs = runs_of(cube + "set = [\"scene.duration=0.1\"]\nsteps = \"from=1,to=2\"\n" +
                            "[[family]]\nname = \"heavy\"\nlike = \"cube\"\npart = \"large\"\n"
                            "set = [\"body.0.mass=100\"]\n");
  REQUIRE(runs.size() == 2);
  CHECK(runs[1].scene == "sliding_cube");
  CHECK(runs[1].overrides == std::vector<std::string>{"scene.duration=0.1", "body.0.mass=100"});
  CHECK(runs[1].steps == 2);
  CHECK(runs[1].is_large);
}

TEST_CASE("What is wrong with a list is said with file, family and key") {
  const std::string steps = "steps = \"from=1,to=2\"\n";
  const auto complains = [](const std::string& text, const std::string& about) {
    INFO(text);
    CHECK_THROWS_WITH(runs_of(text), Catch::Contains("list.toml") && Catch::Contains(about));
  };
  complains("", "expected tables [[family]]");
  complains(cube, "steps");
  complains(cube + "steps = \"each=3\"\n", "'each=3': expected every=");
  complains(cube + steps + "made = [\"known:\"]\n", "either a scene or `made`");
  complains(cube + steps + "part = \"huge\"\n", "one of \"small\", \"large\"");
  complains(cube + steps + "vary = [\"a=1\"]\n", "expected lists of texts");
  complains(cube + steps + "vary = [[\"a\"]]\n", "expected lists of texts");
  complains(cube + steps + "vary = [[\"a.key = 1\"]]\n", "expected lists of texts");
  complains(cube + steps + "vary = [[\" a.key=1\"]]\n", "expected lists of texts");
  complains(cube + steps + "vary = [[\"wall.7.friction=1\"]]\n", "family cube");
  complains(cube + steps + "vary = [[\"body.0.mass=1\", \"body.0.mass=1\"]]\n", "stands twice");
  complains(cube + steps + "color = 1\n", "color");
  complains("[[family]]\nname = \"cube2\"\n", "a letter last");
  complains("[[family]]\nname = \"cube\"\nlike = \"box\"\n", "no entry further up");
  complains("[[family]]\nname = \"cube\"\nscene = \"nowhere\"\n" + steps, "nowhere");
  complains("[[family]]\nname = \"made\"\nmade = [\"known:colour=3\"]\n", "colour");
}
