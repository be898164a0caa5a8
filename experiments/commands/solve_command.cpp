// The commands solve (stored problems by one solver, with every measure of the judge) and answer
// (Ballast as a solver behind the protocol that it offers to others, docs/manual/external.md).

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "experiments/commands/command.hpp"
#include "experiments/compare/comparison.hpp"
#include "experiments/external/external_program.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/hdf5_file.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "problems/files/problem_file.hpp"
#include "solvers/seam/run_solver.hpp"

namespace ballast {
namespace {

struct SolveOptions {
  std::vector<std::string> files;
  ComparedSolver solver;
  double tolerance = 1e-8;
  bool absolute = false;
  int max_iterations = 10000;
  double max_seconds = 1e30;
  bool json = false;
  /// Where answers are written, and read to start from: a file, or a folder with one per problem.
  std::filesystem::path output, start;
};

struct SolvedFile {
  std::string file;
  int contacts = 0, rows = 0;
  double tolerance = 0.0;  ///< [m/s]
  SolverRun run = {};
  /// The fault: "unreadable", "no_start", "unsupported"; of a program also "out_of_time",
  /// "crashed"; "not_kept" where the answer could not be written. Empty where there is none.
  std::string refused = {};
  std::string words = {};  ///< the outcome (explained()), or what is wrong
};

/// One number of the table: its heading (the command's help says what it means), its JSON name.
struct ShownMeasure {
  const char* heading;
  const char* name;
  double value;
};

std::vector<ShownMeasure> measures_of(const SolverRun& run) {
  const ContactError& error = run.error;
  return {{"rms", "natural_map_rms", error.natural_map_rms},
          {"max", "natural_map_max", error.natural_map_max},
          {"scale", "velocity_scale", error.velocity_scale},
          {"fclib", "fclib", error.fclib},
          {"sink_rms", "approach_rms", error.approach_rms},
          {"cone_rms", "cone_rms", error.cone_rms},
          {"compl_rms", "complementarity_rms", error.complementarity_rms},
          {"cone", "cone_violation", error.cone_violation},
          {"min_uN", "min_normal_velocity", error.min_normal_velocity},
          {"compl", "complementarity", error.complementarity},
          {"power", "power", error.power},
          {"own", "own_residual", run.solved.own_residual},
          {"prepare_s", "prepare_seconds", run.prepare_seconds},
          {"solve_s", "solve_seconds", run.solve_seconds},
          {"startup_s", "startup_seconds", run.startup_seconds}};
}

/// The file of the answer to a problem: `where` itself if that is an HDF5 file, which holds one.
std::filesystem::path answer_of(const std::string& file, const std::filesystem::path& where) {
  const std::string extension = where.extension().string();
  if (extension == ".hdf5" || extension == ".h5") return where;
  return where / std::filesystem::path(file).filename().replace_extension(".hdf5");
}

/// Throws Error where a file is there that is no answer.
void require_answer_place(const std::filesystem::path& target) {
  if (is_file(target) && !Hdf5Reader(target).has("/ballast_answer"))
    throw Error(target.string() + ": is no answer of Ballast: it would be written over");
}

/// Checks before any solve that every answer has a file of its own, new or an earlier answer.
void require_place(const SolveOptions& options) {
  std::map<std::filesystem::path, std::string> answered;
  for (const std::string& file : options.files) {
    const std::filesystem::path target = answer_of(file, options.output);
    const auto [before, is_new] = answered.try_emplace(target, file);
    if (!is_new)
      throw Error(target.string() + ": holds the answer to " + before->second + " already");
    require_answer_place(target);
    if (target.has_parent_path()) create_folder(target.parent_path());
  }
}

void keep_answer(const FrictionProblem& problem, const SolvedFile& solved,
                 const SolveOptions& options) {
  StoredSolution stored{
      .r = solved.run.solved.impulses,
      .numbers = {{"tolerance", solved.tolerance}, {"iterations", solved.run.solved.iterations}},
      .texts = {{"problem", solved.file},
                {"solver", options.solver.name},
                {"reason", name_of(solved.run.solved.reason)},
                {"verdict", name_of(solved.run.verdict)}}};
  for (const ShownMeasure& m : measures_of(solved.run))
    stored.numbers.emplace_back(m.name, m.value);
  write_solution(answer_of(solved.file, options.output), problem, stored);
}

/// `fault`: the name of the failure when this throws.
SolvedFile solve_file(const std::string& file, const SolveOptions& options, SolverRunner& runner,
                      const char*& fault) {
  fault = "unreadable";
  const FrictionProblem problem = read_problem(file);
  SolvedFile solved{.file = file,
                    .contacts = problem.contact_count(),
                    .rows = problem.row_count(),
                    .tolerance = options.tolerance};
  // a tolerance is relative to the problem's own velocities unless it is in m/s
  if (!options.absolute) {
    problem.validate();
    const double scale = contact_error(problem, Impulses::Zero(problem.row_count())).velocity_scale;
    solved.tolerance *= scale;
  }
  const auto solver = options.solver.make();  // a new one for each: nothing is carried over
  fault = "no_start";
  const Impulses start =
      options.start.empty() ? Impulses() : read_solution(answer_of(file, options.start), problem);
  solved.run = runner.run(*solver, problem, start,
                          {solved.tolerance, options.max_iterations, options.max_seconds, false});
  solved.words = explained(problem, solved.run, solved.tolerance, options.max_seconds);
  fault = "not_kept";
  if (!options.output.empty()) keep_answer(problem, solved, options);
  return solved;
}

/// Solves a file. One that cannot be read or taken is a row with its reason; the others go on.
SolvedFile solved_or_refused(const std::string& file, const SolveOptions& options,
                             SolverRunner& runner) {
  const auto refused = [&](const char* how, std::string why) {
    if (why.find(file) == std::string::npos) why = file + ": " + why;
    return SolvedFile{.file = file, .refused = how, .words = std::move(why)};
  };
  const char* fault = nullptr;
  try {
    return solve_file(file, options, runner, fault);
  } catch (const UnsupportedProblem& error) {
    return refused("unsupported", error.what());
  } catch (const LostProcess& error) {
    return refused(error.is_out_of_time ? "out_of_time" : "crashed", error.what());
  } catch (const std::exception& error) {
    return refused(fault, error.what());
  }
}

void print_row(const SolvedFile& s, int width) {
  const std::string name = std::filesystem::path(s.file).filename();
  if (!s.refused.empty()) {
    std::cout << printed("%-*s%19s%s: ", width, name.c_str(), "", s.refused.c_str()) << s.words
              << std::endl;
    return;
  }
  std::string line =
      printed("%-*s%9d%8d  %-18s%8d%13s", width, name.c_str(), s.contacts, s.rows,
              name_of(s.run.solved.reason), s.run.solved.iterations, name_of(s.run.verdict));
  for (const ShownMeasure& m : measures_of(s.run)) line += printed("%10.2e", m.value);
  std::cout << line << printed("%8d", s.run.error.worst_contact)
            << (s.run.failure.empty() ? "" : "  " + s.run.failure) << std::endl;
}

nlohmann::ordered_json as_json(const SolvedFile& s, const SolveOptions& options) {
  if (!s.refused.empty())
    return {{"file", s.file},
            {"solver", options.solver.name},
            {"reason", s.refused},
            {"success", false},
            {"message", s.words}};
  nlohmann::ordered_json row{{"file", s.file},
                             {"solver", options.solver.name},
                             {"contacts", s.contacts},
                             {"rows", s.rows},
                             {"tolerance", s.tolerance},
                             {"reason", name_of(s.run.solved.reason)},
                             {"success", s.run.is_solved()},
                             {"verdict", name_of(s.run.verdict)},
                             {"words", s.words},
                             {"iterations", s.run.solved.iterations},
                             {"worst_contact", s.run.error.worst_contact},
                             {"finite", s.run.error.finite}};
  for (const ShownMeasure& m : measures_of(s.run)) row[m.name] = m.value;
  return row;
}

/// Returns ok when every file is solved. Otherwise prints one line, and returns time_limit where
/// time limits are the only reason, else failure.
ExitCode verdict(const std::vector<SolvedFile>& solved) {
  std::vector<std::string> failures;
  bool only_time = true;
  for (const SolvedFile& s : solved) {
    if (s.run.is_solved()) continue;
    only_time = only_time && (s.refused == "out_of_time" ||
                              (s.refused.empty() && s.run.solved.reason == StopReason::time_limit));
    failures.push_back(s.refused.empty() ? s.file + " (" + s.words + ")"
                                         : s.words + " (" + s.refused + ")");
  }
  if (failures.empty()) return ExitCode::ok;
  std::cerr << "ballast: " << failures.size() << " of " << solved.size()
            << " problems are not solved: " << joined(failures) << '\n';
  return only_time ? ExitCode::time_limit : ExitCode::failure;
}

/// The only solver of the list. Throws std::invalid_argument unless there is exactly one.
ComparedSolver one_of(const std::vector<ComparedSolver>& solvers) {
  if (solvers.size() != 1)
    throw std::invalid_argument("expected one, there are " + std::to_string(solvers.size()));
  return solvers.front();
}

ComparedSolver backend_of(const std::string& name) { return one_of(parse_solvers(name)); }

/// Uses a program instead of a backend; does nothing where `word` is empty.
void use_program(SolveOptions& options, const std::string& word) {
  if (!word.empty()) options.solver = one_of(external_solvers({word}, {.memory_MB = 0.0}));
}

ExitCode solve(const SolveOptions& options) {
  restart_with_one_algebra_thread();
  for (const std::filesystem::path& where : {options.output, options.start})
    if (options.files.size() > 1 && answer_of("", where) == where && !where.empty())
      throw UsageError("solve: " + where.string() +
                       ": is one file; several problems need a folder for their answers");
  if (!options.output.empty()) require_place(options);
  int width = 7;
  for (const std::string& file : options.files)
    width =
        std::max(width, static_cast<int>(std::filesystem::path(file).filename().string().size()));
  SolverRunner runner;
  std::vector<SolvedFile> solved;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::string heading = printed("%-*s%9s%8s  %-18s%8s%13s", width, "problem", "contacts", "rows",
                                "stopped", "iter", "verdict");
  for (const ShownMeasure& m : measures_of({})) heading += printed("%10s", m.heading);
  if (!options.json) std::cout << heading << printed("%8s\n", "worst");
  for (const std::string& file : options.files) {
    solved.push_back(solved_or_refused(file, options, runner));
    if (options.json)
      rows.push_back(as_json(solved.back(), options));
    else
      print_row(solved.back(), width);
  }
  if (options.json)
    std::cout << rows.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
  return verdict(solved);
}

struct AnswerOptions {
  std::filesystem::path problem, answer;
  ComparedSolver solver;
  bool serves = false;
};

/// Answers the request by one solver; the answer's clock runs while that works.
ExternalAnswer answer_to(const ExternalRequest& request, const MakeSolver& make) {
  Budget budget{request.tolerance, request.max_iterations, request.max_seconds, true};
  std::optional<FclibStop> fclib;
  if (request.fclib_tolerance > 0.0)
    budget.fclib = &fclib.emplace(request.problem, request.fclib_tolerance);
  ExternalAnswer answer;
  const auto solver = make();
  try {
    SolverRun run = SolverRunner().run(*solver, request.problem, request.start, budget);
    answer.status = static_cast<int>(run.solved.reason);
    answer.solved = std::move(run.solved);
    answer.seconds = run.prepare_seconds + run.solve_seconds;
  } catch (const UnsupportedProblem& error) {
    std::cerr << error.what() << '\n';
    answer.status = ExternalAnswer::unsupported;
  }
  return answer;
}

void answer_file(const std::filesystem::path& problem, const std::filesystem::path& answer,
                 const MakeSolver& make) {
  const ExternalRequest request = read_request(problem);
  if (path_exists(answer) && std::filesystem::equivalent(problem, answer))
    throw Error(answer.string() + ": is the request itself: the answer needs another file");
  require_answer_place(answer);
  write_answer(answer, request, answer_to(request, make));
}

/// Answers requests until standard input ends.
ExitCode serve(const AnswerOptions& options) {
  std::cout << "ready" << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
    try {
      const std::vector<std::string> files = split(line, '\t');
      if (files.size() != 2) throw std::invalid_argument("expected PROBLEM<tab>ANSWER");
      answer_file(files[0], files[1], options.solver.make);
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
  answer_file(options.problem, options.answer, options.solver.make);
  return ExitCode::ok;
}

}  // namespace

Command solve_command() {
  const auto options = std::make_shared<SolveOptions>();
  return {"solve",
          "Solves stored problems and prints every measure of their errors",
          {{"files", &options->files, "Problem files: FCLIB .hdf5, .h5; Siconos .dat", required},
           {"--solver", into(options->solver, backend_of, "pgs"), "A name from ballast solvers"},
           {"--external NAME=COMMAND",
            TextParser{"", [options](const std::string& word) { use_program(*options, word); }},
            "Solves with your own program (docs/manual/external.md)", excludes("--solver")},
           {"--tolerance", &options->tolerance, "Bound on the error / velocity scale", at_least(0)},
           {"--absolute", &options->absolute, "The tolerance is in m/s"},
           {"--max-iterations", &options->max_iterations, "Sweeps, Newton steps, ...", at_least(1)},
           {"--max-seconds", &options->max_seconds, "Wall clock limit per problem [s]", above(0)},
           {"--output PATH", &options->output,
            "Writes impulses, velocities and measures: a .hdf5 file, or a folder with one each"},
           {"--start PATH", &options->start, "Starts from the impulses in such a file or folder"},
           {"--json", &options->json, "Prints the rows as JSON instead of a table"}},
          [options] { return solve(*options); }};
}

Command answer_command() {
  const auto options = std::make_shared<AnswerOptions>();
  return {"answer",
          "Answers requests of ballast compare --external, as an external solver does",
          {{"problem", &options->problem, "The request file to read"},
           {"answer", &options->answer, "The answer file to write"},
           {"--serve", &options->serves, "Reads lines PROBLEM<tab>ANSWER from standard input"},
           {"--solver", into(options->solver, backend_of, "auto"), "A name from ballast solvers"}},
          [options] { return answer(*options); }};
}

}  // namespace ballast
