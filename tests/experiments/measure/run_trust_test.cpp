#include "experiments/measure/run_summary.hpp"

#include <cmath>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Ten steps of a cube of 0.1 m under gravity, all solved.
struct CubeRun {
  std::vector<StepRecord> steps;
  RunFacts facts;
  RunSummary summary() const { return summarise(steps, facts); }
};

CubeRun clean_run() {
  CubeRun run;
  run.facts.solver = "pgs";
  run.facts.tolerance = 1e-3;
  run.facts.iterations_most = 200;
  run.facts.smallest_size = 0.05 * std::sqrt(3.0);
  run.facts.velocity_scale = 9.81e-3;
  for (int k = 0; k < 10; ++k) {
    StepRecord step;
    step.time = 1e-3 * (k + 1);
    step.solved = 1.0;
    step.error_rms = 1e-4 * 9.81e-3;
    step.penetration_max = 2e-6;
    step.work_gravity = 1.0;
    step.kinetic_energy = 5.0;
    run.steps.push_back(step);
  }
  return run;
}

}  // namespace

TEST_CASE("a run of which nothing has to be said says that") {
  const RunSummary trust = clean_run().summary();
  CHECK(has_no_findings(trust));
  CHECK(run_findings(trust) ==
        std::vector<std::string>{
            "Every step reached the tolerance of 0.001 g h; the deepest overlap is 2 µm."});
}

TEST_CASE("steps that missed their tolerance are counted, and more iterations named") {
  CubeRun data = clean_run();
  for (int k = 0; k < 3; ++k) {
    data.steps[k].solved = 0.0;
    data.steps[k].error_rms = 0.02 * 9.81e-3;
  }
  const RunSummary trust = data.summary();
  CHECK(trust.missed == 3);
  CHECK_FALSE(has_no_findings(trust));
  CHECK(trust.error_max_relative == Approx(0.02));
  CHECK(trust.error_mean_relative == Approx(0.3 * 0.02 + 0.7e-4));
  CHECK(run_findings(trust) ==
        std::vector<std::string>{
            "3 of 10 steps did not reach the tolerance of 0.001 g h: their error is 0.0061 g h in "
            "the mean of all steps, 0.02 in the worst. More accurate and slower: --set "
            "solver.max_iterations=1000, or --set solver.name=auto."});
  data.facts.iterations_most = 1e9;
  CHECK_THAT(run_findings(data.summary()).at(0), Catch::Contains("max_iterations=1000000000,"));
  data.facts.seconds_most = 0.1;
  CHECK_THAT(run_findings(data.summary()).at(0), Catch::Contains("--set solver.max_seconds=0.5,"));
  data.facts.solver = "sap";
  CHECK_THAT(run_findings(data.summary()).at(0),
             Catch::Contains("sap solves another law") && !Catch::Contains("--set"));
  data.facts.tolerance = not_known;  // the run had no tolerance
  CHECK(data.summary().missed == 0);
  CHECK(
      run_findings(data.summary()) ==
      std::vector<std::string>{"No step was asked for a tolerance; the deepest overlap is 2 µm."});
}

TEST_CASE("a step whose error is not known is missed, and left out of the mean") {
  CubeRun data = clean_run();
  data.steps[4].error_rms = data.steps[4].solved = std::nan("");
  const RunSummary trust = data.summary();
  CHECK(trust.missed == 1);
  CHECK(trust.error_mean_relative == Approx(1e-4));
  CHECK(trust.error_max_relative == Approx(1e-4));
}

TEST_CASE("overlaps that can be seen are said with their time and size") {
  CubeRun data = clean_run();
  data.steps[4].penetration_max = 0.031;
  const RunSummary trust = data.summary();
  CHECK(run_findings(trust).at(0) ==
        "The deepest overlap is 31 mm at t = 0.005 s, 36 % of the smallest body's radius. A "
        "smaller scene.step mends it.");
  data.facts.slop = 0.03;
  CHECK_THAT(run_findings(data.summary()).at(0),
             Catch::EndsWith("correction.slop leaves that much alone: a smaller one mends it."));
  data.facts.step = 5e-3;  // the overlap is then in the first step
  CHECK_THAT(
      run_findings(data.summary()).at(0),
      Catch::EndsWith("radius. Bodies begin inside one another: the scene is to be mended."));
  data.steps[4].penetration_max = 0.8e-3;  // below 1 % of 87 mm
  CHECK(has_no_findings(data.summary()));
}

TEST_CASE("energy that contacts gave is said, and how much that is") {
  CubeRun data = clean_run();
  data.steps[7].energy_gained = 15.0;
  const RunSummary trust = data.summary();
  CHECK(trust.energy.gained == 15.0);
  CHECK(trust.energy.moved == 15.0);  // 10 J of work and 5 J of kinetic energy
  CHECK(run_findings(trust).at(0) ==
        "Energy +15 J: contacts gave it to the bodies, which no law of contact does (1e+02 % of "
        "the energy that moved). --set solver.name=auto mends it, or more iterations.");
  data.steps[7].energy_gained = 0.1;
  CHECK(has_no_findings(data.summary()));
}
