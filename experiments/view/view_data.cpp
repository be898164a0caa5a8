#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "experiments/box/packing.hpp"
#include "experiments/record/recorder.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/view/view.hpp"
#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/mesh_file.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/files/captured_problem.hpp"
#include "solvers/seam/run_solver.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

constexpr size_t most_rows = 6000;  // of a curve: more than a screen has columns

void add_curves(const RunData& run, ViewData& view) {
  const size_t stride = (run.steps.size() + most_rows - 1) / most_rows;
  std::vector<StepRecord> rows;
  for (size_t k = 0; k < run.steps.size(); k += stride) rows.push_back(run.steps[k]);
  view.series_time = record_column(rows, &StepRecord::time);
  if (view.system.first_driven_wall() >= 0) {
    double largest = 0.0;
    for (const StepRecord& step : run.steps) largest = std::max(largest, std::abs(step.load));
    const double factor = largest >= 1000.0 ? 1e-3 : 1.0;
    const std::string unit = largest >= 1000.0 ? "kN" : "N";
    view.series = {
        {"x", "x", "mm", "blue", record_column(rows, &StepRecord::wall_x, 1e3)},
        {"fg", "f_g", unit, "grey", record_column(rows, &StepRecord::wall_force, factor)},
        {"f", "f", unit, "vermilion", record_column(rows, &StepRecord::load, factor)}};
    view.plots = {{"", {"x"}}, {"", {"fg", "f"}}, {"x", {"fg"}}};
  }
  if (run.scene && run.scene->grains) {
    view.series.push_back(
        {"rho", "ρ", "", "green", record_column(rows, &StepRecord::solid_fraction)});
    view.plots.push_back({"", {"rho"}});
  } else {
    view.series.push_back(
        {"energy", "E", "J", "purple", record_column(rows, &StepRecord::kinetic_energy)});
    view.series.push_back(
        {"contacts", "n", "", "green", record_column(rows, &StepRecord::active_contacts)});
    view.plots.insert(view.plots.end(), {{"", {"energy"}}, {"", {"contacts"}}});
  }
}

/// One body, as far as its contacts and its mass block tell.
struct KnownBody {
  std::vector<Vec3> points, normals;  ///< of its contacts; normals out of the body
  double mass = 0.0;                  ///< [kg]; 0: the body does not rotate

  bool is_plane() const {
    return mass == 0.0 && std::all_of(normals.begin(), normals.end(), [&](const Vec3& normal) {
             return normal.dot(normals.front()) > 1.0 - 1e-6;
           });
  }
};

std::map<int, KnownBody> known_bodies(const CapturedProblem& captured) {
  std::map<int, KnownBody> bodies;
  const DynamicsForm& dynamics = captured.problem.dynamics;
  for (int c = 0; c < captured.problem.contact_count(); ++c)
    for (const bool is_b : {false, true}) {
      const auto k = static_cast<size_t>(c);
      KnownBody& known = bodies[is_b ? captured.id_b[k] : captured.id_a[k]];
      // a body rotates when it has six unknowns
      const int body = is_b ? dynamics.body_b[k] : dynamics.body_a[k];
      if (dynamics.body_dofs(body) == 6) known.mass = dynamics.mass[dynamics.mass_begin[body]];
      const Vec3 normal(captured.frame.data() + 9 * k);
      known.points.emplace_back(captured.position.data() + 3 * k);
      known.normals.push_back(is_b ? Vec3(-normal) : normal);
    }
  return bodies;
}

/// The hull of a body's contact points and of a ball in their middle, which keeps it from being
/// flat.
BodySpec hull_of(const KnownBody& known, int id) {
  BodySpec body;
  body.name = printed("body %d", id);
  body.mass = known.mass;
  for (const Vec3& point : known.points)
    body.pose.position += point / static_cast<double>(known.points.size());
  double reach = 1e-6;
  std::vector<Vec3> corners;
  for (const Vec3& point : known.points) {
    corners.push_back(point - body.pose.position);
    reach = std::max(reach, corners.back().norm());
  }
  const Polyhedron ball = make_sphere(0.5 * reach, 0);
  corners.insert(corners.end(), ball.vertices().begin(), ball.vertices().end());
  body.shape = std::make_shared<const Polyhedron>(convex_hull(corners));
  return body;
}

/// The bodies of a captured problem without its run: hulls of their contact points. A body that
/// does not rotate is a wall if all its contacts have one normal. `contacts` number the bodies as
/// the problem does; in the view they have the view's numbers.
ViewData bodies_of_problem(const CapturedProblem& captured, std::vector<FrameContact> contacts) {
  const std::map<int, KnownBody> bodies = known_bodies(captured);
  ViewData view;
  view.has_shapes = false;
  MotionState state;
  std::map<int, int> place;  // in the view, of a body of the problem
  // walls come last
  for (const bool are_walls : {false, true})
    for (const auto& [id, known] : bodies) {
      if (known.is_plane() != are_walls) continue;
      place[id] = static_cast<int>(view.system.bodies.size());
      if (are_walls) {
        const Vec3& normal = known.normals.front();
        add_wall(view.system, state,
                 {printed("wall %d", id), normal, normal.dot(known.points.front())});
      } else {
        const BodySpec body = hull_of(known, id);
        const double volume = 4.0 / 3.0 * M_PI * std::pow(body.shape->circumradius(), 3);
        add_body(view.system, state, body, volume);
      }
    }
  for (FrameContact& contact : contacts) {
    contact.body_a = place.at(contact.body_a);
    contact.body_b = place.at(contact.body_b);
  }
  const std::vector<double>& friction = captured.problem.friction;
  if (!friction.empty()) view.system.friction = std::ranges::max(friction);
  state.time = captured.time;
  state.step = captured.step;
  view.frames = {state};
  view.contacts = [contacts](size_t) { return contacts; };
  return view;
}

/// The contacts of the captured step, with the forces of the run's own answer.
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
  for (int power = 1; power < question.most_iterations; power *= 10)
    for (const int budget : {power, 3 * power})
      if (budget < question.most_iterations) errors.iterations.push_back(budget);
  errors.iterations.push_back(question.most_iterations);
  const auto solver = make_solver(backend);
  SolverRunner runner;
  for (const int iterations : errors.iterations) {
    // a tolerance that no backend reaches: the budget alone ends a solve
    const Budget budget{.tolerance = 1e-14 * captured.velocity_scale(),
                        .max_iterations = iterations};
    const SolverRun run = runner.run(*solver, captured.problem,
                                     question.is_warm ? captured.start : Impulses(), budget);
    std::vector<double> error = errors_by_contact(captured.problem, run.solved.impulses);
    for (double& value : error) value /= captured.velocity_scale();
    errors.error.push_back(std::move(error));
    errors.rms.push_back(run.error.natural_map_rms / captured.velocity_scale());
  }
  return errors;
}

/// The bodies of the run in `folder`, at the frame nearest to a problem's time; nothing where the
/// problem is not from a run there.
std::optional<ViewData> view_in_run(const fs::path& folder, const CapturedProblem& captured) {
  if (!path_exists(folder / "record.h5")) return std::nullopt;
  ViewData view;
  MotionState state;
  view.system = recorded_system(folder, state);
  const std::vector<MotionState> frames = read_poses(folder);
  for (const std::vector<int>* ids : {&captured.id_a, &captured.id_b})
    for (const int id : *ids)
      if (id < 0 || static_cast<size_t>(id) >= view.system.bodies.size()) return std::nullopt;
  if (frames.empty()) return std::nullopt;
  if (const auto scene = read_run_data(folder).scene) view.system.period = scene->period;
  view.frames = {frames[nearest_frame(frames, captured.time)]};
  view.contacts = [contacts = contacts_of(captured)](size_t) { return contacts; };
  return view;
}

}  // namespace

size_t nearest_frame(const std::vector<MotionState>& frames, double time) {
  const auto away = [time](const MotionState& frame) { return std::abs(frame.time - time); };
  return static_cast<size_t>(std::ranges::min_element(frames, {}, away) - frames.begin());
}

std::optional<ViewData> view_of_run(const RunData& run) {
  const fs::path record = run.folder / "record.h5";
  if (!path_exists(record) && !path_exists(run.folder / "log" / "poses.bin")) return std::nullopt;
  ViewData view;
  view.frames = read_poses(run.folder);
  if (view.frames.empty()) return std::nullopt;
  MotionState state;
  view.system = recorded_system(run.folder, state);
  if (view.frames.front().pose.size() != view.system.bodies.size()) return std::nullopt;
  view.has_forces_later = !path_exists(record) && path_exists(run.folder / "log" / "forces.bin");
  if (path_exists(record)) {
    const auto forces = std::make_shared<RecordForces>(record);
    if (forces->frame_count() > 0)
      view.contacts = [forces](size_t frame) { return forces->of_frame(frame); };
  }
  if (run.scene) {
    view.title = run.scene->title;
    view.system.period = run.scene->period;
  }
  add_curves(run, view);
  return view;
}

ViewData view_of_scene(const Scene& scene, const fs::path& packing_cache) {
  ViewData view;
  MotionState state;
  view.title = scene.title.empty() ? scene.name : scene.title;
  if (!scene.grains) {
    view.system = make_system(scene, state);
  } else {
    const Rain rain = make_rain(scene);
    const std::string key = packing_key(scene);
    Packing packing;
    const bool is_packed = read_packing(packing_file(packing_cache, key), key, packing);
    view.system = is_packed ? drive_system(scene, rain, packing, state)
                            : box_system(scene, rain, BoxStage::rain, rain.height, &state);
    view.title += is_packed ? ": the packing" : ": the rain before the deposit";
  }
  view.frames = {state};
  return view;
}

ViewData view_of_mesh(const fs::path& file) {
  constexpr double stone = 2700.0;  // density of a mesh, whose file has none [kg/m^3]
  const PrincipalShape grain = to_principal_frame(read_mesh(file));
  BodySpec body;
  body.name = file.stem().string();
  body.shape = std::make_shared<const Polyhedron>(grain.shape);
  body.mass = stone * grain.volume;
  body.inertia = stone * grain.inertia;
  Scene scene;
  scene.title = file.filename().string();
  scene.bodies = {body};
  return view_of_scene(scene, {});
}

ViewData view_of_problem(const fs::path& file, const ErrorQuestion& question) {
  const CapturedProblem captured = read_captured(file);
  const fs::path capture = fs::absolute(file).parent_path();
  std::optional<ViewData> in_run = view_in_run(capture.parent_path(), captured);
  ViewData view = in_run ? std::move(*in_run) : bodies_of_problem(captured, contacts_of(captured));
  view.title = printed("Where answers are wrong: step %d, %d contact points", captured.step,
                       captured.problem.contact_count());
  for (const std::string& backend : question.backends)
    view.errors.push_back(errors_of(captured, backend, question));
  return view;
}

}  // namespace ballast
