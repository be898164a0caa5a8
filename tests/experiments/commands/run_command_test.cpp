// The last output of a run, through the program itself.

#include "experiments/commands/command.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

/// Boxes of 10 g to 10 kg, the heavier on the lighter: sweeps need thousands of iterations.
std::string heavy_on_light() {
  std::string text =
      "[scene]\nname = \"heavy\"\nstep = 1e-3\nduration = 0.2\n"
      "[[wall]]\nnormal = [0, 0, 1]\nfriction = 0.5\n";
  double mass = 0.01;
  for (const char* height : {"0.05", "0.15", "0.25", "0.35"}) {
    text += "[[body]]\nshape = \"box\"\nsize = [0.1, 0.1, 0.1]\nmass = " + std::to_string(mass) +
            "\nposition = [0, 0, " + height + "]\n";
    mass *= 10.0;
  }
  return text;
}

ProgramResult run_heavy(const std::vector<std::string>& more) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("heavy.toml", heavy_on_light()).string();
  std::vector<std::string> words = {"run", scene, "--output", (folder.path() / "run").string(),
                                    "--no-report"};
  words.insert(words.end(), more.begin(), more.end());
  return ballast_program(words);
}

const std::vector<std::string> hopeless = {"--set", "solver.name=pgs", "--set",
                                           "solver.max_iterations=3"};

}  // namespace

TEST_CASE("the default backend holds heavy boxes on light ones") {
  const ProgramResult run = run_heavy({"--strict", "--capture", "every=1000"});
  INFO(run.output << run.errors);
  CHECK(run.status == 0);
  CHECK_THAT(run.output,
             Catch::Contains("to be known\n  Every step reached the tolerance of 0.001 g h") &&
                 Catch::Contains("the run has no step that --capture names"));
}

TEST_CASE("a finished run says that nothing is left to capture") {
  const TemporaryFolder folder;
  const std::vector<std::string> words = {"run",         "incline",
                                          "--set",       "scene.duration=0.01",
                                          "--output",    folder.path() / "run",
                                          "--no-report", "--continue",
                                          "--capture",   "every=1000"};
  CHECK_THAT(ballast_program(words).output, !Catch::Contains("finished already"));
  CHECK_THAT(ballast_program(words).output,
             Catch::Contains("run: finished already: no step is left to capture\n"));
}

TEST_CASE("a run that missed its tolerance ends with that, and strictly with exit code 1") {
  const ProgramResult run = run_heavy(hopeless);
  CHECK(run.status == 0);
  CHECK_THAT(run.output,
             Catch::Contains(" of 200 steps did not reach the tolerance of 0.001 g h") &&
                 Catch::Contains("--set solver.name=auto"));
  std::vector<std::string> strictly = hopeless;
  strictly.push_back("--strict");
  const ProgramResult strict = run_heavy(strictly);
  CHECK(strict.status == static_cast<int>(ExitCode::failure));
  CHECK_THAT(strict.errors, Catch::Contains("heavy.toml: --strict: finished"));
}

TEST_CASE("the page of such a run begins with it") {
  const TemporaryFolder folder;
  const std::string scene = folder.write("heavy.toml", heavy_on_light()).string();
  const auto output = folder.path() / "run";
  std::vector<std::string> words = {"run", scene, "--output", output.string()};
  words.insert(words.end(), hopeless.begin(), hopeless.end());
  REQUIRE(ballast_program(words).status == 0);
  const std::string page = read_whole_file(output / "report.html");
  const size_t told = page.find("did not reach the tolerance");
  CHECK(told != std::string::npos);
  CHECK(told < page.find("The run in numbers"));
}

TEST_CASE("quiet is quiet") {
  const ProgramResult quiet = run_heavy({"--quiet"});
  CHECK(quiet.status == 0);
  CHECK(quiet.output.empty());
  CHECK(quiet.errors.empty());
}
