// Programs as backends of `ballast compare` and `ballast solve`: each misbehaviour of a program
// becomes its row, the other programs go on, and no process is left running.

#include <fstream>
#include <map>
#include <tuple>

#include "experiments/external/external_program.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/files/problem_file.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

const std::string own = std::string("'") + BALLAST_PROGRAM + "' answer --solver pgs";

/// The number of processes whose command line holds the word.
int processes_with(const std::string& word) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "cmdline", std::ios::binary);
    const std::string words{std::istreambuf_iterator<char>(file), {}};
    count += words.find(word) != std::string::npos && words.find("ballast") == std::string::npos;
  }
  return count;
}

struct Row {
  std::string verdict, note;
  double startup = 0.0;
};

/// The rows of a comparison by solver.
std::map<std::string, Row> rows_of(const fs::path& folder) {
  std::map<std::string, Row> rows;
  CsvReader table(folder / "results.csv");
  REQUIRE(table.next());
  std::map<std::string, size_t> column;
  for (size_t k = 0; k < table.cells().size(); ++k) column[std::string(table.cells()[k])] = k;
  while (table.next())
    rows[std::string(table.cells()[column.at("solver")])] = {
        std::string(table.cells()[column.at("verdict")]),
        std::string(table.cells()[column.at("note")]),
        table.number(column.at("startup_seconds"), "startup_seconds")};
  return rows;
}

/// An answer that claims to have solved the request `id`, with a NaN impulse.
fs::path answer_of_nan(const fs::path& file, int contacts, int id) {
  ExternalRequest request;
  for (int c = 0; c < contacts; ++c) request.problem.row_begin.push_back(3 * (c + 1));
  request.problem.friction.assign(static_cast<size_t>(contacts), 0.5);
  request.id = id;
  ExternalAnswer answer;
  answer.status = static_cast<int>(StopReason::reached_tolerance);
  answer.solved.impulses = Impulses::Constant(3 * contacts, std::nan(""));
  write_answer(file, request, answer);
  return file;
}

/// `startup_seconds` is an argument, as a busy machine may take half a second to start a program.
std::vector<std::string> compare_words(const fs::path& output, const std::string& max_seconds,
                                       const std::string& startup_seconds) {
  return {"compare",       "known:contacts=10,bodies=6,frictionless=0",
          "--solvers",     "pgs",
          "--tolerances",  "1e-6",
          "--memory",      "0",
          "--no-report",   "--startup-seconds",
          startup_seconds, "--max-seconds",
          max_seconds,     "--output",
          output.string()};
}

}  // namespace

TEST_CASE("whatever a program does is its row, and nothing is left running") {
  const TemporaryFolder folder;
  const std::string sleep = "sleep 86398.25";  // the processes are recognised by this duration
  const std::string half = "; head -c 600 \"$2\" > \"$2.x\"; mv \"$2.x\" \"$2\"; : ";
  const auto script = [&](const std::string& name, const std::string& text) {
    return name + "=sh '" + folder.write(name, text).string() + "'";
  };
  const std::string answered = own + " \"$1\" \"$2\"";
  const std::string nan = answer_of_nan(folder.path() / "nan.hdf5", 10, 2).string();
  const std::string kept = (folder.path() / "kept").string();
  // Programs that never answer get little time, others much: a busy machine stalls for seconds.
  const std::pair<const char*, std::vector<std::string>> groups[] = {
      {"0.5",
       {script("hangs", sleep), script("dies", "echo no licence >&2; exit 3"),
        script("crashes", "kill -SEGV $$"), script("half", answered + half),
        script("silent", "exit 0"), script("nan", "cp " + nan + " \"$2\""),
        script("floods", "exec yes")}},
      {"20",
       {"good=" + own, script("chatty", "yes | head -c 3000000; " + answered),
        script("forks", sleep + " & (setsid " + sleep + " &); " + answered),
        script("other",
               answered + "; test -e " + kept + " && cp " + kept + " \"$2\"; cp \"$2\" " + kept)}}};
  std::map<std::string, Row> rows;  // of the second case: later rows replace earlier ones
  std::string said;
  for (const auto& [startup_seconds, programs] : groups) {
    const std::filesystem::path output = folder.path() / startup_seconds;
    std::vector<std::string> words = compare_words(output, "0.2", startup_seconds);
    // A second case, so that "other" can answer with the answer to another problem.
    words.insert(words.begin() + 1, "known:contacts=11,bodies=6,frictionless=0");
    for (const std::string& program : programs) words.insert(words.end(), {"--external", program});
    const ProgramResult result = ballast_program(words);
    said += result.output + result.errors;
    INFO(said);
    REQUIRE(result.status == 0);
    rows.merge(rows_of(output));
  }
  INFO(said);
  const std::vector<std::tuple<const char*, const char*, const char*>> expected = {
      {"pgs", "solved", ""},
      {"good", "solved", ""},
      {"hangs", "timeout", "hangs: killed: no answer within"},
      {"dies", "crashed", "exit code 3: no licence"},
      {"crashes", "crashed", "signal 11"},
      {"half", "unsolved", "truncated"},
      {"silent", "unsolved", "no such file"},
      {"nan", "unsolved", "/ballast_answer/r[0] = nan is not finite"},
      {"floods", "timeout", ""},
      {"chatty", "solved", ""},
      {"forks", "solved", ""},
      {"other", "unsolved", ""}};
  for (const auto& [name, verdict, note] : expected) {
    INFO(name);
    CHECK(rows.at(name).verdict == verdict);
    CHECK_THAT(rows.at(name).note, Contains(note));
  }
  CHECK(rows.at("good").startup > 0.0);
  CHECK_THAT(said, Contains("error       nan  dies: the program ended with exit code 3: ") &&
                       Contains(rows.at("nan").note));
  CHECK_THAT(rows.at("other").note, Contains("10 contacts") || Contains("11 contacts") ||
                                        Contains("answers another problem"));
  CHECK(processes_with("86398.25") == 0);
}

TEST_CASE("a program of a list is served, and its rows are kept until its script changes") {
  const TemporaryFolder folder;
  folder.write("solver.sh", "exec " + own + " \"$@\"");
  const auto list = folder.write("list.toml",
                                 "[[external]]\nname = \"served\"\ncommand = \"sh solver.sh\"\n"
                                 "serve = true\n");
  std::vector<std::string> words = compare_words(folder.path() / "out", "20", "20");
  words.insert(words.end(), {"--external", list.string()});
  const ProgramResult first = ballast_program(words);
  INFO(first.output << first.errors);
  REQUIRE(first.status == 0);
  CHECK(rows_of(folder.path() / "out").at("served").verdict == "solved");
  const auto was_stored = [&] {
    const std::string output = ballast_program(words).output;
    const size_t row = output.find("served");
    return output.substr(row, output.find('\n', row) - row).find("was there") != std::string::npos;
  };
  CHECK(was_stored());
  folder.write("solver.sh", "# edited\nexec " + own + " \"$@\"");
  CHECK_FALSE(was_stored());
}

TEST_CASE("solve asks a program, and says what is wrong with the words") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "problem.hdf5";
  write_problem(file, make_known_solution({.bodies = 4, .contacts = 8}).problem);
  const ProgramResult solved =
      ballast_program({"solve", file.string(), "--external", "own=" + own, "--json"});
  INFO(solved.errors);
  CHECK(solved.status == 0);
  CHECK_THAT(solved.output, Contains("\"solver\": \"own\"") && Contains("\"verdict\": \"solved\""));
  check_failure(ballast_program({"solve", file.string(), "--external", "bad=exit 3 #"}),
                ExitCode::failure, {"the program ended with exit code 3", "(crashed)"});
  const ProgramResult silent =
      ballast_program({"solve", file.string(), "--external", "silent=true"});
  for (const std::string& said : {silent.output, silent.errors})
    CHECK_THAT(said, Contains("silent: ") && Contains("no such file"));
  check_failure(ballast_program({"solve", file.string(), "--external",
                                 "slow=sleep 40; :", "--max-seconds", "0.1"}),
                ExitCode::time_limit, {"(out_of_time)"});
  check_failure(ballast_program({"solve", file.string(), "--external", "nothing"}), ExitCode::usage,
                {"--external", "expected name=command"});
  check_failure(ballast_program({"compare", "known:", "--external", "pgs=true"}), ExitCode::usage,
                {"pgs: is the name of one of Ballast's solvers"});
  check_failure(ballast_program({"answer", file.string()}), ExitCode::usage,
                {"expected PROBLEM and ANSWER, or --serve"});
  check_failure(ballast_program({"answer", file.string(), file.string()}), ExitCode::failure,
                {"is no request"});
  // An answer takes no place that holds something else.
  const fs::path request = folder.path() / "request.hdf5",
                 notes = folder.write("notes.txt", "mine");
  const FrictionProblem problem = read_problem(file);
  write_request(request, {.problem = problem, .start = Impulses::Zero(problem.row_count())});
  for (const fs::path& place : {notes, file})
    check_failure(ballast_program({"answer", request.string(), place.string()}), ExitCode::failure,
                  {place.filename().string()});
  CHECK(read_whole_file(notes) == "mine");
  CHECK(read_problem(file).contact_count() == 8);
}

TEST_CASE("the example in Python solves") {
  const std::string python = BALLAST_PYTHON;
  if (!run_program(python, {"-c", "import numpy, scipy, h5py"}, 60.0).succeeded()) {
    WARN("skipped: python3-numpy, python3-scipy or python3-h5py is not there");
    return;
  }
  const TemporaryFolder folder;
  const std::string examples = std::string(BALLAST_SOURCE_FOLDER) + "/examples/external/";
  const ProgramResult result = ballast_program(
      {"compare", "known:contacts=10,bodies=6", "--solvers", "pgs", "--tolerances", "1e-4",
       "--memory", "0", "--no-report", "--output", (folder.path() / "out").string(), "--external",
       "numpy_gs=" + python + " -B '" + examples + "gauss_seidel.py'"});
  INFO(result.output << result.errors);
  REQUIRE(result.status == 0);
  const Row row = rows_of(folder.path() / "out").at("numpy_gs");
  INFO(row.note);
  CHECK(row.verdict == "solved");
  CHECK(row.startup > 0.0);
}
