// The command `ballast compare`: its output, its files, and that it resumes.

#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// A small comparison, with `more` appended. Sanitizers reserve terabytes: it has no memory limit.
std::vector<std::string> comparison(const fs::path& output, const std::string& solvers,
                                    const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"compare",      "known:contacts=6,bodies=4",
                                    "--solvers",    solvers,
                                    "--tolerances", "1e-2",
                                    "--memory",     "0",
                                    "--output",     output.string()};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("a comparison leaves its table and its page, and the same command goes on") {
  const TemporaryFolder folder;
  const std::filesystem::path output = folder.path() / "compared";
  const ProgramResult first = ballast_program(comparison(output, "pgs,nncg"));
  INFO(first.errors);
  REQUIRE(first.status == 0);
  CHECK_THAT(first.output, Catch::Contains("  1/2  known-b4-c6x1-R1-s1") &&
                               Catch::Contains("Tolerance 0.01, cold start, 1 cases") &&
                               Catch::Contains("results in " + output.string()));
  CHECK_THAT(first.output, !Catch::Contains("was there"));
  const std::string csv = read_whole_file(output / "results.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 3);
  CHECK(std::filesystem::exists(output / "compare.html"));
  // The manifest has the command line in the form that a shell reads.
  CHECK_THAT(read_whole_file(output / "manifest.json"),
             Catch::Contains("ballast compare known:contacts=6,bodies=4"));
  std::filesystem::remove(output / "compare.html");
  const ProgramResult second = ballast_program(comparison(output, "pgs,nncg", {"--no-report"}));
  CHECK(second.status == 0);
  CHECK_THAT(second.output, Catch::Contains("(was there)") && !Catch::Contains("compare.html"));
  CHECK_FALSE(std::filesystem::exists(output / "compare.html"));
}

TEST_CASE("jobs of a comparison are merged, and a quiet one says nothing") {
  const TemporaryFolder folder;
  std::vector<std::string> merge = {"compare", "merge"};
  for (const char* solver : {"pgs", "nncg"}) {
    merge.push_back((folder.path() / solver).string());
    const ProgramResult quiet =
        ballast_program(comparison(merge.back(), solver, {"--quiet", "--no-report"}));
    CHECK(quiet.status == 0);
    CHECK(quiet.output.empty());
  }
  const fs::path all = folder.path() / "all";
  merge.insert(merge.end(), {"--output", all.string()});
  for (const char* command : {"merge", "ranking", "merge"}) {  // all into the same folder
    merge[1] = command;
    const ProgramResult merged = ballast_program(merge);
    CHECK(merged.status == 0);
    CHECK_THAT(merged.output, Catch::Contains("2 rows: " + all.string()));
  }
  CHECK(fs::exists(all / "compare.html"));
  merge.back() = merge[2];
  check_failure(ballast_program(merge), ExitCode::failure, {merge[2], "holds files"});
  merge[3] = "nowhere";  // this error comes before that of the output folder
  check_failure(ballast_program(merge), ExitCode::failure, {"nowhere: no folder of a comparison"});
}

TEST_CASE("what became of a comparison is told, with an exit code") {
  const TemporaryFolder folder;
  const auto compared = [&](const char* name, const char* iterations) {
    const fs::path output = folder.path() / name;
    const ProgramResult result = ballast_program(
        {"compare", "pile:contacts=12,seed=123", "--solvers", "pgs,apgd", "--tolerances",
         iterations, "--memory", "0", "--no-report", "--output", output.string()});
    INFO(result.errors);
    REQUIRE(result.status == 0);
    return output.string();
  };
  const std::string before = compared("before", "1e-2"), other = compared("other", "1e-3");
  const ProgramResult same = ballast_program({"compare", "diff", before, before, "--all"});
  CHECK(same.status == 0);
  CHECK_THAT(same.output, Catch::Contains("-a0.8-s123 ") && Catch::Contains(": 2 same"));
  // Makes one solve of the copy a lost one.
  const fs::path after = folder.path() / "after";
  fs::copy(before, after, fs::copy_options::recursive);
  for (const auto& entry : fs::directory_iterator(after / "rows")) {
    auto json = nlohmann::json::parse(read_whole_file(entry.path()));
    if (json["solver"] == "pgs") json["verdict"] = "timeout";
    write_whole_file(entry.path(), json.dump());
  }
  const std::vector<std::string> words = {"compare", "diff", before, after.string()};
  check_failure(ballast_program(words), ExitCode::failure,
                {"compare diff: 1 solves are lost and 0 slower"});
  CHECK_THAT(ballast_program(words).output, Catch::Contains("lost\n"));
  check_failure(ballast_program({"compare", "diff", before, other}), ExitCode::failure,
                {"no solve in common"});
  check_failure(ballast_program({"compare", "diff", before, folder.path().string()}),
                ExitCode::failure, {"no folder of a comparison"});
  check_failure(ballast_program({"compare", "known:colour=3"}), ExitCode::failure,
                {"known:colour=3: colour: no such setting"});
}

TEST_CASE("programs are compared alone where no backend is wanted") {
  const TemporaryFolder folder;
  std::vector<std::string> words = comparison(folder.path() / "out", "none", {"--no-report"});
  check_failure(ballast_program(words), ExitCode::usage, {"--solvers none: expected a program"});
  words.insert(words.end(),
               {"--external", std::string("own=") + BALLAST_PROGRAM + " answer --solver pgs"});
  const ProgramResult alone = ballast_program(words);
  INFO(alone.errors);
  CHECK(alone.status == 0);
  CHECK_THAT(alone.output, Catch::Contains("1/1") && Catch::Contains(" own "));
}

TEST_CASE("a damaged row is made again, and a folder of somebody's is left alone") {
  const TemporaryFolder folder;
  const std::filesystem::path output = folder.path() / "compared";
  const std::vector<std::string> words = comparison(output, "pgs");
  REQUIRE(ballast_program(words).status == 0);
  const auto row = std::filesystem::directory_iterator(output / "rows")->path();
  const std::string whole = read_whole_file(row);
  for (const std::string& damaged :
       {whole.substr(0, whole.size() / 2), std::string(), std::string("[1]")}) {
    write_whole_file(row, damaged);
    const ProgramResult again = ballast_program(words);
    CHECK(again.status == 0);
    CHECK_THAT(again.output, !Catch::Contains("was there"));
    CHECK_THAT(ballast_program(words).output, Catch::Contains("was there"));
  }
  {
    const FileLock lock(output / "compare.lock", briefly);
    check_failure(ballast_program(words), ExitCode::failure, {output.string(), "is working there"});
  }
  const std::filesystem::path theirs = folder.path() / "theirs";
  create_folder(theirs / "rows");
  write_whole_file(theirs / "results.csv", "the user's own");
  check_failure(ballast_program(comparison(theirs, "pgs")), ExitCode::failure,
                {theirs.string(), "holds files"});
  CHECK(read_whole_file(theirs / "results.csv") == "the user's own");
  // A run of a scene with the name "compare".
  const RunFolder run(folder.path() / "run");
  run.begin("scene", Manifest("compare", {}, "key"), false);
  check_failure(ballast_program(comparison(run.path(), "pgs")), ExitCode::failure,
                {run.path().string(), "holds a run"});
  CHECK(Manifest::read(run.manifest()).key() == "key");
}
