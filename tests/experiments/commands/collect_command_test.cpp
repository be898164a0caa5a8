// The commands `ballast compare collect` and `ballast compare ranking`, from a list to a page.
// Other programs read their files.

#include <filesystem>

#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/text.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/files/fclib_file.hpp"
#include "problems/files/problem_file.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

const char* const two_worlds =
    "[[family]]\nname = \"cube\"\nscene = \"sliding_cube\"\nset = [\"scene.duration=0.02\"]\n"
    "steps = \"every=10,steps=1\"\nvary = [[\"wall.0.friction=0.1\", \"wall.0.friction=0.9\"]]\n"
    "[[family]]\nname = \"pile\"\nmade = [\"pile:contacts=8,count=4\"]\n"
    "[[family]]\nname = \"pile\"\nmade = [\"pile:contacts=9\"]\npart = \"large\"\n";

/// Compiles a C program. Returns false if a header that it includes is missing.
bool compiled(const std::string& source, const fs::path& program) {
  const std::string words =
      "F=\"$(pkg-config --cflags hdf5) -I/usr/include/siconos -I/usr/include/siconos/numerics\"; "
      "cc -E $F \"$1\" > /dev/null 2>&1 || exit 77; L=; "
      "if grep -q fclib.h \"$1\"; then L=-lfclib; fi; "
      "cc $F \"$1\" -o \"$2\" $(pkg-config --libs hdf5) -lhdf5_hl $L -lsiconos_numerics -lm";
  const ProgramResult result = run_program(
      "/bin/sh", {"-c", words, "sh", std::string(BALLAST_SOURCE_FOLDER) + source, program.string()},
      120.0);
  if (result.status == 77) return false;
  INFO(result.errors);
  REQUIRE(result.status == 0);
  return true;
}

}  // namespace

TEST_CASE("a list becomes a collection, a comparison and a ranking") {
  const TemporaryFolder folder;
  const std::string file = folder.write("list.toml", two_worlds).string(),
                    collection = (folder.path() / "collection").string(),
                    compared = (folder.path() / "compared").string(),
                    ranking = (folder.path() / "ranking").string();
  const ProgramResult made =
      ballast_program({"compare", "collect", "--list", file, "--output", collection});
  INFO(made.errors);
  REQUIRE(made.status == 0);
  CHECK_THAT(made.output, Contains("1/3  cube-0.1") && Contains("3/3  pile-made-1") &&
                              Contains("made: " + collection + "/manifest.csv"));
  CHECK(read_whole_file(collection + "/collection.toml") == two_worlds);
  REQUIRE(ballast_program({"compare", collection + "/problems", "--solvers", "pgs,auto",
                           "--exact-seconds", "0", "--memory", "0", "--quiet", "--no-report",
                           "--output", compared})
              .status == 0);
  // Distances are measured from the references in the collection.
  CsvReader rows(compared + "/results.csv");
  REQUIRE(rows.next());
  const std::vector<std::string> head(rows.cells().begin(), rows.cells().end());
  const auto distance = std::ranges::find(head, "contact_velocity_distance") - head.begin();
  REQUIRE(distance < static_cast<long>(head.size()));
  while (rows.next())
    CHECK(rows.number(static_cast<size_t>(distance), "contact_velocity_distance") < 1e-2);
  const ProgramResult ranked =
      ballast_program({"compare", "ranking", compared, "--output", ranking});
  INFO(ranked.errors);
  REQUIRE(ranked.status == 0);
  CHECK_THAT(ranked.output, Contains(" rows: " + ranking + "/index.html"));
  CHECK_THAT(read_whole_file(ranking + "/table.csv"),
             Contains("open,cube,") && Contains(",1e-08,cold,auto,coulomb,"));
}

TEST_CASE("what is wrong with the words of a collection is said in one line") {
  const TemporaryFolder folder;
  const std::string output = (folder.path() / "out").string(),
                    bad = folder.write("bad.toml", "[[family]]\nname = \"x\"\n").string();
  check_failure(ballast_program({"compare", "collect", "--part", "huge", "--output", output}),
                ExitCode::usage, {"--part huge: expected small or all"});
  check_failure(ballast_program({"compare", "collect", "--list", bad, "--output", output}),
                ExitCode::failure, {bad, "either a scene or `made`"});
  check_failure(ballast_program({"compare", "ranking", output, "--output", output + "2"}),
                ExitCode::failure, {"no folder of a comparison"});
  const std::string alike =
      folder
          .write("alike.toml",
                 "[[family]]\nname = \"k\"\nmade = ["
                 "\"known:bodies=5,contacts=6,friction_min=0.1,friction_max=0.1\", "
                 "\"known:bodies=5,contacts=6,friction_min=0.9,friction_max=0.9\"]\n")
          .string();
  check_failure(ballast_program({"compare", "collect", "--list", alike, "--exact-seconds", "0",
                                 "--output", output}),
                ExitCode::failure, {"family k has two problems of the name k-"});
  const fs::path theirs = folder.path() / "theirs";
  create_folder(theirs / "problems");
  write_whole_file(theirs / "thesis.tex", "the user's own");
  check_failure(ballast_program({"compare", "collect", "--output", theirs.string()}),
                ExitCode::failure, {theirs.string(), "holds files"});
}

TEST_CASE("a collection that is interrupted says so, and the same command goes on") {
  const TemporaryFolder folder;
  const std::string output = (folder.path() / "out").string(),
                    file = folder.write("list.toml", two_worlds).string();
  const std::vector<std::string> words = {"compare", "collect", "--list", file, "--output", output};
  // Once the first problem is stored, the references take the rest of the time.
  const ProgramResult stopped = ballast_in_shell(
      "\"$@\" --exact-seconds 600 & pid=$!; "
      "until ls \"" +
          output +
          "\"/problems/*/*.hdf5 > /dev/null 2>&1; do sleep 0.01; done; "
          "kill -TERM $pid; wait $pid",
      words);
  if (stopped.status != 0)  // status 0: it had ended before the signal
    check_failure(stopped, ExitCode::failure, {"compare collect: stopped; the same command goes"});
  const ProgramResult again = ballast_program(words);
  INFO(again.errors);
  CHECK(again.status == 0);
  CHECK(fs::exists(output + "/manifest.csv"));
}

TEST_CASE("Debian's FCLIB reads a collection, and Siconos' own measure agrees") {
  const TemporaryFolder folder;
  const fs::path reader = folder.path() / "reader";
  if (!compiled("/tests/experiments/commands/read_by_siconos.c", reader)) {
    WARN("skipped: libfclib-dev or libsiconos-numerics-dev is not there");
    return;
  }
  const std::string collection = (folder.path() / "collection").string();
  REQUIRE(ballast_program({"compare", "collect", "--list",
                           folder.write("list.toml", two_worlds).string(), "--output", collection})
              .status == 0);
  int read = 0;
  for (const auto& entry : fs::recursive_directory_iterator(collection + "/problems")) {
    if (entry.is_directory()) continue;
    const fs::path family = entry.path().parent_path().filename();
    const fs::path reference =
        fs::path(collection) / "references" / family / (entry.path().stem().string() + ".exact");
    const ProgramResult said =
        run_program(reader.string(), {entry.path().string(), reference.string()}, 60.0);
    INFO(entry.path() << ": " << said.output << said.errors);
    CHECK(said.status == 0);
    // Compares Siconos' measure of impulses that are no solution with the judge's.
    const FrictionProblem problem = read_problem(entry.path());
    const Impulses r = 0.9 * read_solution(reference, problem);
    const std::optional<double> theirs = parsed<double>(split(said.output, '\n').at(1));
    REQUIRE(theirs);
    CHECK(contact_error(problem, r).fclib == Approx(*theirs).epsilon(1e-6));
    ++read;
  }
  CHECK(read == 8);
}

TEST_CASE("the example in C solves with Siconos, and the judge agrees") {
  const TemporaryFolder folder;
  const fs::path program = folder.path() / "siconos_nsgs";
  if (!compiled("/examples/external/siconos_nsgs.c", program)) {
    WARN("skipped: libsiconos-numerics-dev is not there");
    return;
  }
  const ProgramResult result = ballast_program(
      {"compare", "known:contacts=10,bodies=6", "--solvers", "none", "--tolerances", "1e-4",
       "--measure", "fclib", "--memory", "0", "--no-report", "--output",
       (folder.path() / "out").string(), "--external", "c_nsgs=" + program.string()});
  INFO(result.output << result.errors);
  CHECK(result.status == 0);
  CHECK_THAT(result.output, Contains("c_nsgs") && Contains(" solved "));
}
