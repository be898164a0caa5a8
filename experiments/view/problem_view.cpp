#include "experiments/view/problem_view.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/record/recorder.hpp"
#include "experiments/run/prepared_run.hpp"
#include "experiments/view/problem_bodies.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/files/captured_problem.hpp"
#include "solvers/seam/run_solver.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// Above its capture/.
fs::path run_folder_of(const fs::path& file) {
  return fs::absolute(file).parent_path().parent_path();
}

/// The contacts as they were, with the forces of the run's own answer.
std::vector<FrameContact> contacts_of(const CapturedProblem& captured) {
  std::vector<FrameContact> contacts;
  for (int c = 0; c < captured.problem.contact_count(); ++c) {
    const auto k = static_cast<size_t>(c);
    const double* frame = captured.frame.data() + 9 * k;
    Vec3 force = Vec3::Zero();
    for (int row = 0; row < captured.problem.contact_rows(c); ++row)
      force += captured.solution[captured.problem.row_begin[k] + row] / captured.h *
               Vec3(frame + 3 * row);
    contacts.push_back({captured.id_a[k], captured.id_b[k],
                        Vec3(captured.position.data() + 3 * k).cast<float>(),
                        Vec3(frame).cast<float>(), force.cast<float>()});
  }
  return contacts;
}

ViewErrors errors_of(const CapturedProblem& captured, const std::string& backend,
                     const ErrorQuestion& question) {
  ViewErrors errors;
  errors.backend = backend;
  errors.iterations = question.iterations;
  const auto solver = make_solver(backend);
  SolverRunner runner;
  for (const int iterations : question.iterations) {
    // a tolerance that nobody reaches: the budget alone ends a solve
    const Budget budget{.tolerance = 1e-14 * captured.velocity_scale(),
                        .max_iterations = iterations,
                        .max_seconds = question.max_seconds};
    const SolverRun run = runner.run(*solver, captured.problem,
                                     question.is_warm ? captured.start : Impulses(), budget);
    std::vector<double> error = errors_by_contact(captured.problem, run.solved.impulses);
    for (double& value : error) value /= captured.velocity_scale();
    errors.error.push_back(std::move(error));
    errors.rms.push_back(run.error.natural_map_rms / captured.velocity_scale());
    if (run.solved.reason == StopReason::time_limit) break;
  }
  // whose time is over does not get further
  errors.error.resize(question.iterations.size(), errors.error.back());
  errors.rms.resize(question.iterations.size(), errors.rms.back());
  return errors;
}

/// The bodies of the run in `folder`, at the frame nearest to a problem's time; nothing where that
/// is not the run that the problem is from.
std::optional<ViewData> view_in_run(const fs::path& folder, const CapturedProblem& captured) {
  if (!is_there(folder / "record.h5")) return std::nullopt;
  ViewData view;
  MotionState state;
  view.system = recorded_system(folder, state);
  view.friction = view.system.friction;
  const std::vector<PoseFrame> frames = read_poses(folder);
  for (const std::vector<int>* ids : {&captured.id_a, &captured.id_b})
    for (const int id : *ids)
      if (id < 0 || static_cast<size_t>(id) >= view.system.bodies.size()) return std::nullopt;
  if (frames.empty()) return std::nullopt;
  view.frames = {
      *std::min_element(frames.begin(), frames.end(), [&](const PoseFrame& a, const PoseFrame& b) {
        return std::abs(a.time - captured.time) < std::abs(b.time - captured.time);
      })};
  view.contacts = [contacts = contacts_of(captured)](size_t) { return contacts; };
  return view;
}

}  // namespace

ViewData view_of_problem(const fs::path& file, const ErrorQuestion& question) {
  const CapturedProblem captured = read_captured(file);
  std::optional<ViewData> in_run = view_in_run(run_folder_of(file), captured);
  ViewData view = in_run ? std::move(*in_run) : bodies_of_problem(captured, contacts_of(captured));
  view.title = printed("Where answers are wrong: step %d, %d contact points", captured.step,
                       captured.problem.contact_count());
  for (const std::string& backend : question.backends)
    view.errors.push_back(errors_of(captured, backend, question));
  return view;
}

}  // namespace ballast
