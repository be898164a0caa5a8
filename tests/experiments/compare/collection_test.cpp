#include "experiments/compare/collection.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "experiments/compare/compare_case.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/files/captured_problem.hpp"
#include "problems/files/problem_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

const char* const small_list =
    "[[family]]\nname = \"pushed\"\nscene = \"vibrated_box\"\n"
    "set = [\"grains.count=6\", \"box.length=0.22\", \"box.width=0.22\","
    " \"control_volume.margin_x=0.03\", \"deposit.lid_pressure_weight=0\","
    " \"deposit.settle_time=0\", \"deposit.rest_velocity=0.5\", \"scene.duration=0.02\"]\n"
    "vary = [[\"grains.seed=1\", \"grains.seed=2\"]]\n"
    "steps = \"every=40,steps=1,also=10\"\n"
    "[[family]]\nname = \"pile\"\nmade = [\"pile:contacts=10,mass_ratio=100,count=8\"]\n"
    "[[family]]\nname = \"stress\"\nmade = [\"stress:all\"]\n";

std::vector<CollectedRun> runs_of(const std::string& text) {
  const TemporaryFolder folder;
  return read_collection(folder.write("list.toml", text));
}

const std::string cube = "[[family]]\nname = \"cube\"\nscene = \"sliding_cube\"\n";

/// The rows of a table, by their first column.
std::map<std::string, std::map<std::string, std::string>> table(const fs::path& file) {
  std::map<std::string, std::map<std::string, std::string>> rows;
  CsvReader reader(file);
  REQUIRE(reader.next());
  const std::vector<std::string> head(reader.cells().begin(), reader.cells().end());
  while (reader.next())
    for (size_t k = 0; k < head.size(); ++k) rows[reader.cells()[0]][head[k]] = reader.cells()[k];
  return rows;
}

ExitCode make(const CollectionOptions& options, const fs::path& list) {
  return make_collection(options, read_collection(list), [](const auto&) {});
}

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

TEST_CASE("A collection that is made twice has the same bytes, and its manifest says what it is") {
  const TemporaryFolder folder;
  const fs::path list = folder.write("list.toml", small_list), a = folder.path() / "a",
                 b = folder.path() / "b";
  REQUIRE(make({.folder = a, .reference_seconds = 5.0}, list) == ExitCode::ok);
  REQUIRE(make({.folder = b, .reference_seconds = 0.0, .threads = 2}, list) == ExitCode::ok);
  const std::string manifest = read_whole_file(a / "manifest.csv");
  CHECK(read_whole_file(b / "manifest.csv") == manifest);
  const auto rows = table(a / "manifest.csv"), references = table(a / "references.csv");
  CHECK(references.size() == rows.size());
  CHECK(table(b / "references.csv").empty());
  std::set<std::string> families;
  for (const auto& [name, row] : rows) {
    INFO(name);
    families.insert(row.at("family"));
    CHECK(read_whole_file(a / "problems" / name) == read_whole_file(b / "problems" / name));
    // The facts in the table are those that a comparison finds in the file.
    const LoadedCase loaded = compare_cases({(a / "problems" / name).string()}).at(0).load();
    CHECK(row.at("content") == loaded.facts.content);
    CHECK(row.at("contacts") == std::to_string(loaded.facts.contacts));
    CHECK(row.at("held") == (is_held(loaded.facts.content) ? "1" : "0"));
    CHECK(contact_error(loaded.problem, loaded.exact).within(1e-9 * loaded.facts.velocity_scale) ==
          (references.at(name).at("exact") == "1"));
  }
  CHECK(families == std::set<std::string>{"pile", "pushed", "stress"});
  const auto& captured = rows.at("pushed/2-step_0000010.hdf5");
  CHECK(captured.at("step") == "10");
  CHECK(captured.at("friction_max") == "0.4");
  CHECK(!captured.at("warm_error").empty());
  CHECK(rows.at("pile/pile-c10-d0.3-R1e+02-f0.3..0.3-a0.8-s1.hdf5").at("phase") == "made");
  CHECK(std::ranges::count_if(references, [](const auto& r) {
          return r.second.at("exact") == "1";
        }) > static_cast<long>(rows.size()) - 3);
  // The file has the geometry, the keys and the warm start.
  const CapturedProblem problem = read_captured(a / "problems/pushed/2-step_0000010.hdf5");
  CHECK(problem.key.size() == static_cast<size_t>(problem.problem.contact_count()));
  CHECK(problem.start.size() == problem.problem.row_count());
}

TEST_CASE("The same command goes on where all is there, and the held part moves") {
  const TemporaryFolder folder;
  const fs::path list = folder.write("list.toml", small_list), made = folder.path() / "made";
  CollectionOptions options{.folder = made, .reference_seconds = 5.0};
  REQUIRE(make(options, list) == ExitCode::ok);
  const std::string manifest = read_whole_file(made / "manifest.csv"),
                    references = read_whole_file(made / "references.csv");
  // Removes one problem, one reference and one run.
  fs::remove(made / "problems/pushed/1-step_0000040.hdf5");
  fs::remove(made / "references/pushed/1-step_0000080.exact");
  fs::remove_all(made / "runs/pushed-2");
  REQUIRE(make(options, list) == ExitCode::ok);
  CHECK(read_whole_file(made / "manifest.csv") == manifest);
  CHECK(read_whole_file(made / "references.csv") == references);
  CHECK_FALSE(fs::exists(made / "held"));
  options.keeps_held_apart = true;
  REQUIRE(make(options, list) == ExitCode::ok);
  CHECK(read_whole_file(made / "manifest.csv") == manifest);
  long held = 0;
  for (const auto& [name, row] : table(made / "manifest.csv")) {
    INFO(name);
    const bool is_held = fs::exists(made / "held" / name);
    CHECK(is_held == (row.at("held") == "1"));
    CHECK(fs::exists(made / "problems" / name) != is_held);
    CHECK(fs::exists(reference_of(made / "held" / name)));
    held += row.at("held") == "1";
  }
  CHECK(held > 2);
  CHECK(find_problems((made / "held").string()).size() == static_cast<size_t>(held));
  // Steps that were captured by other settings do not belong to this list.
  fs::remove(made / "runs/pushed-1/capture/step_0000080.hdf5");
  CHECK_THROWS_WITH(make(options, list), Catch::Contains("has 2 steps, the list asks for 3"));
}

TEST_CASE("About a fifth is held, by the key alone") {
  int held = 0;
  for (int k = 0; k < 1000; ++k) held += is_held(std::to_string(k));
  CHECK(held == 197);
  CHECK(is_held("3") == is_held("3"));
}
