// Files, links, pipes and logs of the user stay as they are. The command that a run prints can be
// pasted.

#include <sys/stat.h>

#include "platform/atomic_file.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// One box that rests on a floor, for `steps` steps of some ten microseconds.
std::string resting_box(int steps) {
  return "[scene]\nstep = 1e-3\nduration = " + std::to_string(1e-3 * steps) +
         "\n[[wall]]\nnormal = [0, 0, 1]\n[[body]]\nshape = \"box\"\nsize = [1, 1, 1]\nmass = 1\n"
         "position = [0, 0, 0.5]\n";
}

/// Runs the program in a folder. `words` are a shell's, in which "$@" calls it with `arguments`.
ProgramResult in_folder(const fs::path& folder, const std::string& words,
                        const std::vector<std::string>& arguments) {
  return ballast_in_shell("cd '" + folder.string() + "' || exit; " + words, arguments);
}

}  // namespace

TEST_CASE("a run with --overwrite leaves a folder alone that no run of ours made") {
  const TemporaryFolder folder;
  const fs::path theirs = folder.path() / "theirs";
  fs::create_directories(theirs / "figures");
  write_whole_file(theirs / "scene.toml", "the user's own");
  write_whole_file(theirs / "figures" / "mine.svg", "the user's own");
  for (const char* option : {"--overwrite", "--no-report"})
    check_failure(ballast_program({"run", "incline", "--output", theirs.string(), option}),
                  ExitCode::failure, {theirs.string(), "no run's"});
  CHECK(read_whole_file(theirs / "scene.toml") == "the user's own");
  CHECK(read_whole_file(theirs / "figures" / "mine.svg") == "the user's own");
  CHECK_FALSE(fs::exists(theirs / "manifest.json"));
}

TEST_CASE("no command writes over files of somebody's, and each may be repeated") {
  const TemporaryFolder folder;
  const std::string source = BALLAST_SOURCE_FOLDER "/docs/measured/", theirs = folder.path() / "t",
                    ours = folder.path() / "ours/";
  const fs::path plan = folder.write("p.toml", "scene = \"incline\"\n[[run]]\nname = \"a\"\n"),
                 rows = folder.write("rows.csv", "");
  ballast_in_shell("head -n 3 " + source + "campaign_runs.csv > " + rows.string(), {});
  const std::vector<std::pair<const char*, std::vector<std::string>>> commands = {
      {"README.md", {"paper", "report", "--rows", rows, "--output"}},
      {"article.md", {"paper", "article", "--rows", rows, "--output"}},
      {"index.csv", {"plan", plan, "--output"}},
      {"step.json", {"bench", "step", "vibrated_box_small", "--output"}},
      {"results.md", {"bench", "all", "--rows", source + "numbers.csv", "--output"}},
  };
  for (auto [file, words] : commands) {
    INFO(words[1]);
    fs::remove_all(theirs);
    create_folder(theirs);
    write_whole_file(fs::path(theirs) / file, "{}");
    words.push_back(theirs);
    check_failure(ballast_program(words), ExitCode::failure, {theirs});
    CHECK(read_whole_file(fs::path(theirs) / file) == "{}");
    CHECK(std::distance(fs::directory_iterator(theirs), {}) == 1);
    if (words[1] == "article" || words[1] == "step") continue;  // need all rows or a packing
    words.back() = ours + file;
    REQUIRE(ballast_program(words).status == 0);
    const ProgramResult again = ballast_program(words);
    CHECK(again.status == 0);
    if (words[1] == "report") CHECK_THAT(again.output, Catch::Contains(" runs, 1 known by rows;"));
  }
}

TEST_CASE("a comparison and a list keep what another command put there") {
  const TemporaryFolder folder;
  const std::string output = folder.path() / "compared";
  REQUIRE(ballast_program({"compare", "known:bodies=3,contacts=4", "--solvers", "pgs",
                           "--exact-seconds", "0", "--no-report", "--quiet", "--output", output})
              .status == 0);
  const std::string rows = read_whole_file(output + "/results.csv");
  check_failure(ballast_program({"compare", "--live", "incline", "--from", "0.001", "--duration",
                                 "0.001", "--solvers", "pgs", "--output", output}),
                ExitCode::failure, {output, "holds files"});
  CHECK(read_whole_file(output + "/results.csv") == rows);
  for (const char* option : {"--repeats=2", "--starts=warm", "--no-report", "--memory=1"})
    check_failure(ballast_program({"compare", "--live", "incline", option}), ExitCode::usage,
                  {"--live"});

  const std::string collection = folder.path() / "collection",
                    list = "[[family]]\nname = \"pile\"\nmade = [\"pile:contacts=9\"]\n";
  create_folder(collection);
  write_whole_file(collection + "/collection.toml", list);
  check_failure(ballast_program({"compare", "collect", "--output", collection}), ExitCode::failure,
                {"collection.toml: is another list", "--list"});
  CHECK(read_whole_file(collection + "/collection.toml") == list);
}

TEST_CASE("a scene of one's own made from a printed one has results of its own") {
  const TemporaryFolder folder;
  for (const char* how : {"", "--resolved"}) {
    const ProgramResult result = ballast_in_shell(
        "cd '" + folder.path().string() + "' && '" BALLAST_PROGRAM "' scenes incline " + how +
            " > mine.toml && \"$@\"",
        {"run", "mine.toml", "--no-report", "--overwrite"});
    INFO(result.errors);
    CHECK(result.status == 0);
  }
  CHECK(fs::exists(folder.path() / "results" / "mine" / "record.h5"));
  CHECK_FALSE(fs::exists(folder.path() / "results" / "incline"));
}

TEST_CASE("export writes what a link points to, and into a pipe") {
  const TemporaryFolder folder;
  const std::string run = (folder.path() / "run").string();
  REQUIRE(ballast_program({"run", "incline", "--output", run, "--no-report"}).status == 0);
  const fs::path real = folder.write("real.obj", "old"), link = folder.path() / "link.obj",
                 pipe = folder.path() / "pipe.obj";
  fs::create_symlink("real.obj", link);
  CHECK(ballast_program({"export", run, "--output", link.string()}).status == 0);
  CHECK(fs::is_symlink(link));
  const std::string text = read_whole_file(real);
  CHECK_THAT(text, Catch::Contains("o block"));
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const ProgramResult piped = in_folder(folder.path(), "cat pipe.obj > got & \"$@\"; wait",
                                        {"export", run, "--output", pipe.string()});
  CHECK(piped.errors.empty());
  CHECK(fs::is_fifo(pipe));
  CHECK(read_whole_file(folder.path() / "got") == text);
}

TEST_CASE("with standard output and error closed, a run's files hold nothing but its own") {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run", other = folder.path() / "other";
  const ProgramResult closed = ballast_in_shell(
      "\"$@\" >&- 2>&-", {"run", "incline", "--output", run.string(), "--no-report"});
  CHECK(closed.status == 0);
  REQUIRE(ballast_program({"run", "incline", "--output", other.string(), "--no-report"}).status ==
          0);
  for (const char* file : {"log/poses.bin", "scene.toml", "checkpoint.bin"})
    CHECK((read_whole_file(run / file) == read_whole_file(other / file)));
  CHECK(fs::file_size(run / "log" / "steps.bin") == fs::file_size(other / "log" / "steps.bin"));
}

TEST_CASE("the command that a stopped run prints can be pasted: blanks, any folder, all options") {
  const TemporaryFolder folder;
  const fs::path there = folder.path() / "a folder it's in";
  create_folder(there);
  write_whole_file(there / "my scene.toml", resting_box(20000));
  const auto cd = "cd '" + folder.path().string() + "/a folder it'\\''s in' && \"$@\"";
  ProgramResult result =
      ballast_in_shell(cd, {"run", "my scene.toml", "--output", "the run", "--no-report",
                            "--overwrite", "--max-seconds", "0.0001", "--set", "solver.name=nncg"});
  int times = 0;
  while (result.status == static_cast<int>(ExitCode::time_limit)) {
    REQUIRE(++times < 4);
    const size_t at = result.output.find("Continue with:\n  ");
    REQUIRE(at != std::string::npos);
    std::string command = result.output.substr(at + 17);
    command.resize(command.find('\n'));
    INFO(command);
    CHECK_THAT(command, Catch::Contains("--no-report") && Catch::Contains("solver.name=nncg") &&
                            Catch::Contains("--max-seconds 0.0001") &&
                            !Catch::Contains("--overwrite"));
    // No machine finishes in so short a time.
    const size_t limit = command.find("--max-seconds 0.0001");
    if (times == 3) command.replace(limit, 20, "--max-seconds 500");
    result = run_program("/bin/sh", {"-c", command}, 500.0);
  }
  INFO(result.errors);
  CHECK(result.status == 0);
  CHECK(times > 0);
  CHECK(fs::exists(there / "the run" / "record.h5"));
  CHECK_FALSE(fs::exists(there / "the run" / "report.html"));
}

TEST_CASE("a page that could not be written is made by --continue, and by report") {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "the run", page = run / "report.html";
  const std::vector<std::string> command{"run", "incline", "--output", run.string(), "--continue"};
  // Has the effect of a full disk at that moment: the page cannot be opened for writing.
  REQUIRE(ballast_program({"run", "incline", "--output", run.string(), "--no-report"}).status == 0);
  create_folder(run / "report.html.tmp");
  check_failure(ballast_program(command), ExitCode::failure, {page.string()});
  fs::remove(run / "report.html.tmp");
  CHECK(ballast_program(command).status == 0);
  REQUIRE(fs::exists(page));
  fs::remove(page);
  CHECK(ballast_program({"report", run.string()}).status == 0);
  CHECK(fs::exists(page));
  check_failure(ballast_program({"report", folder.path().string()}), ExitCode::failure,
                {"no run here"});
}

TEST_CASE("every signal that means an end leaves a checkpoint, and --continue ends with its bits") {
  const TemporaryFolder folder;
  write_whole_file(folder.path() / "box.toml", resting_box(30000));
  const auto run_in = [](const std::string& name) {
    return std::vector<std::string>{"run", "box.toml",    "--output",
                                    name,  "--no-report", "--continue"};
  };
  REQUIRE(in_folder(folder.path(), "\"$@\"", run_in("whole")).status == 0);
  for (const char* signal : {"HUP", "TERM", "USR1"}) {
    INFO(signal);
    const std::string words = std::string("\"$@\" & until [ -s ") + signal +
                              "/log/poses.bin ]; do sleep 0.01; done; kill -" + signal +
                              " $!; wait $!";
    const ProgramResult stopped = in_folder(folder.path(), words, run_in(signal));
    CHECK(stopped.status == 1);
    CHECK_THAT(stopped.output, Catch::Contains("nothing is lost. Continue with:"));
    CHECK(fs::exists(folder.path() / signal / "checkpoint.bin"));
    CHECK(in_folder(folder.path(), "\"$@\"", run_in(signal)).status == 0);
    CHECK((read_whole_file(folder.path() / signal / "checkpoint.bin") ==
           read_whole_file(folder.path() / "whole" / "checkpoint.bin")));
  }
}
