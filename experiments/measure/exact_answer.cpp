#include "experiments/measure/exact_answer.hpp"

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/pack.hpp"
#include "platform/program.hpp"
#include "problems/algebra/contact_error.hpp"
#include "solvers/seam/run_solver.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

/// `impulses` with the judge's error, if that is a solution's.
std::optional<ExactAnswer> judged(const FrictionProblem& problem, Impulses impulses,
                                  const ExactSearch& search) {
  if (impulses.size() != problem.row_count() || !impulses.allFinite()) return std::nullopt;
  const ContactError error = contact_error(problem, impulses);
  const double tolerance = ExactAnswer::tolerance * search.velocity_scale;
  if (!error.within(tolerance)) return std::nullopt;
  return ExactAnswer{std::move(impulses), error.natural_map_rms / search.velocity_scale};
}

std::string packed(const Impulses& impulses) {
  Packer packer;
  packer.list(impulses);
  return packer.bytes();
}

/// Empty where the bytes are damaged.
Impulses unpacked(const std::string& bytes) {
  Impulses impulses;
  try {
    Unpacker unpacker(bytes, "an exact answer");
    unpacker.list(impulses);
    unpacker.finish();
  } catch (const Error&) {
    return {};
  }
  return impulses;
}

/// What `solver` comes to within `seconds`; empty where it cannot.
Impulses attempt(const char* solver, const FrictionProblem& problem, const Impulses& start,
                 const ExactSearch& search, double seconds) {
  const Budget budget{.tolerance = ExactAnswer::tolerance * search.velocity_scale,
                      .max_iterations = 1 << 30,
                      .max_seconds = seconds};
  const ChildResult child = run_in_child(1.25 * seconds + 2.0, [&] {
    return packed(SolverRunner().run(*make_solver(solver), problem, start, budget).solved.impulses);
  });
  return child.end == ChildEnd::complete ? unpacked(child.answer) : Impulses();
}

}  // namespace

std::optional<ExactAnswer> find_exact_answer(const FrictionProblem& problem, const Impulses& start,
                                             const ExactSearch& search) {
  if (!(search.max_seconds > 0.0)) return std::nullopt;
  const auto file = search.folder / (search.key + ".exact");
  // An answer that is there is judged anew: a damaged or foreign file is no answer.
  const bool keeps = !search.folder.empty();
  if (keeps && is_there(file))
    if (auto found = judged(problem, unpacked(read_whole_file(file)), search)) return found;
  for (const char* solver : {"newton_burst", "auto"}) {
    auto found =
        judged(problem, attempt(solver, problem, start, search, 0.5 * search.max_seconds), search);
    if (!found) continue;
    if (keeps) {
      create_folder(search.folder);
      write_whole_file(file, packed(found->impulses));
    }
    return found;
  }
  return std::nullopt;
}

}  // namespace ballast
