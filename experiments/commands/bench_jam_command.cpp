// `ballast bench jam`.

#include <iostream>
#include <memory>

#include "experiments/bench/jam_bench.hpp"
#include "experiments/commands/command.hpp"
#include "experiments/compare/compare_options.hpp"
#include "platform/atomic_file.hpp"
#include "platform/interrupt.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

struct JamRequest {
  std::filesystem::path run, output = "results/bench";
  std::string solvers_text = "nncg", iterations_text = "20,50,80,200,500", steps_text = "2e-4";
  JamOptions jams;
};

ExitCode bench_jam(const JamRequest& request) {
  const auto rows = measure_jams(request.run, request.jams, [](const JamRow& r) {
    std::cout << printed(
                     "t %.4f s  %-8s %6d iterations  h %g s  k_art %10.3e N/m  wall %9.2e m/s  "
                     "error %8.2e m/s\n",
                     r.time, r.solver.c_str(), r.iterations, r.h, r.stiffness(), r.found.speed,
                     r.found.error)
              << std::flush;
    return !InterruptGuard::requested();
  });
  const auto measurements = jam_measurements(rows);
  create_folder(request.output);
  write_bench_result(request.output, "jam", own_command(), measure_machine(), measurements);
  write_whole_file(request.output / "jam_rows.csv", jam_csv(rows));
  std::cout << measurement_table(measurements) << "\nresults in " << request.output.string()
            << ": jam.json, jam.csv, jam_rows.csv\n";
  return ExitCode::ok;
}

}  // namespace

Command bench_jam_command() {
  const auto request = std::make_shared<JamRequest>();
  JamOptions& jams = request->jams;
  const auto counts = [](const std::string& list) {
    const std::vector<long> numbers = parse_counts(list, 1'000'000'000);
    return std::vector<int>(numbers.begin(), numbers.end());
  };
  const auto names = [](const std::string& list) {
    std::vector<std::string> found;
    for (const ComparedSolver& solver : parse_solvers(list)) found.push_back(solver.name);
    return found;
  };
  return {
      "jam",
      "How stiff a run's jams are under other solvers, iterations and steps",
      {{"run", &request->run, "A run's folder that keeps states (record.state_rate)", required},
       {"--solvers", &request->solvers_text, "Separated by commas", shown,
        into(jams.solvers, names)},
       {"--iterations", &request->iterations_text, "In every step", shown,
        into(jams.iterations, counts)},
       {"--steps", &request->steps_text, "h [s]", shown, into(jams.steps, parse_tolerances)},
       {"--states", &jams.states, "Jams that are loaded, those with the largest load", shown,
        between(1, 1'000'000)},
       {"--part", &jams.part, "By which part the load rises and falls", shown, above(0)},
       {"--settle", &jams.settle, "Simulated under the steady load before [s]", shown, above(0)},
       {"--seconds", &jams.seconds, "Simulated at each load [s]", shown, above(0)},
       {"--output DIR", &request->output, "Folder of the results", shown}},
      [request] { return bench_jam(*request); }};
}

}  // namespace ballast
