// Ballast as a solver behind the protocol that it offers to others (docs/manual/external.md).

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "experiments/commands/command.hpp"
#include "experiments/external/external_files.hpp"
#include "platform/text.hpp"
#include "solvers/seam/run_solver.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

struct AnswerOptions {
  std::filesystem::path problem, answer;
  std::string solver = "auto";
  bool serves = false;
};

/// What the request asks for, by one solver; the answer's clock runs while that works.
ExternalAnswer answer_to(const ExternalRequest& request, const std::string& name) {
  Budget budget{request.tolerance, request.max_iterations, request.max_seconds, true};
  std::optional<FclibStop> fclib;
  if (request.fclib_tolerance > 0.0)
    budget.fclib = &fclib.emplace(request.problem, request.fclib_tolerance);
  ExternalAnswer answer;
  const auto solver = make_solver(name);
  try {
    SolverRun run = SolverRunner().run(*solver, request.problem, request.start, budget);
    answer.reason = run.solved.reason;
    answer.impulses = std::move(run.solved.impulses);
    answer.iterations = run.solved.iterations;
    answer.own_residual = run.solved.own_residual;
    answer.seconds = run.prepare_seconds + run.solve_seconds;
    answer.history = std::move(run.solved.history);
  } catch (const UnsupportedProblem& error) {
    std::cerr << error.what() << '\n';
    answer.verdict = Verdict::unsupported;
  }
  return answer;
}

void answer_file(const std::filesystem::path& problem, const std::filesystem::path& answer,
                 const std::string& solver) {
  const ExternalRequest request = read_request(problem);
  write_answer(answer, request, answer_to(request, solver));
}

/// Until standard input ends.
ExitCode serve(const AnswerOptions& options) {
  std::cout << "ready bodies" << std::endl;  // these alone are read where they are known
  for (std::string line; std::getline(std::cin, line);) {
    try {
      const std::vector<std::string> files = split(line, '\t');
      if (files.size() != 2) throw std::invalid_argument("expected PROBLEM<tab>ANSWER");
      answer_file(files[0], files[1], options.solver);
      std::cout << "done" << std::endl;
    } catch (const std::exception& error) {
      std::cout << "failed: " << error.what() << std::endl;
    }
  }
  return ExitCode::ok;
}

ExitCode answer(const AnswerOptions& options) {
  if (options.serves != options.problem.empty() || options.serves != options.answer.empty())
    throw UsageError("answer: expected PROBLEM and ANSWER, or --serve");
  if (options.serves) return serve(options);
  answer_file(options.problem, options.answer, options.solver);
  return ExitCode::ok;
}

}  // namespace

Command answer_command() {
  const auto options = std::make_shared<AnswerOptions>();
  return {"answer",
          "Solves one request of ballast compare --external, as other programs do",
          {{"problem", &options->problem, "The request's file"},
           {"answer", &options->answer, "The file to be written"},
           {"--serve", &options->serves, "Requests as lines PROBLEM<tab>ANSWER on standard input"},
           {"--solver", &options->solver, "As listed by ballast solvers", shown,
            parsed([](const std::string& name) { make_solver(name); })}},
          [options] { return answer(*options); }};
}

}  // namespace ballast
