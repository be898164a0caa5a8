#include <array>
#include <cmath>

#include "experiments/step/time_step.hpp"
#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/pose.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"
#include "tests/golden/golden_values.hpp"

namespace ballast::golden {
namespace {

using Numbers = std::vector<double>;

void append(Numbers& numbers, const auto& more) {
  numbers.insert(numbers.end(), more.begin(), more.end());
}

std::vector<PrincipalShape> grains(int count) {
  const Scene scene = read_scene(find_scene("vibrated_box_small"));
  const GrainsSpec& spec = *scene.grains;
  return make_grains(count, spec.distribution, spec.size_convention, spec.shape, spec.seed);
}

/// Grains on a grid so narrow that neighbours overlap, above and in a fixed floor. None turns: the
/// half step of motion before detection asks the sine and cosine of zero alone, which are exact.
Scene heap() {
  constexpr int side = 3;
  constexpr double spacing = 0.05, density = 2700.0, speed = 0.5;  // [m] [kg/m^3] [m/s]
  Scene scene;
  scene.name = "heap";
  WallSpec floor;
  floor.name = "floor";
  floor.friction = 0.4;
  scene.walls.push_back(floor);
  const auto shapes = grains(side * side * side);
  Random random(7);
  for (size_t k = 0; k < shapes.size(); ++k) {
    const int at = static_cast<int>(k);
    BodySpec body;
    body.name = "grain " + std::to_string(k);
    body.shape = std::make_shared<const Polyhedron>(shapes[k].shape);
    body.mass = density * shapes[k].volume;
    body.inertia = density * shapes[k].inertia;
    body.pose.position =
        spacing * Vec3(at % side, at / side % side, 0.4 + static_cast<double>(at / side / side));
    body.pose.rotation = random_rotation(random);
    body.velocity = speed * random_direction(random);
    scene.bodies.push_back(std::move(body));
  }
  return scene;
}

/// The backends of one table.
struct Kind {
  const char* table;
  Through through;
  std::array<int, 3> iterations;
  bool (*holds)(const SolverEntry& entry);
};

/// Without a foreign library, which would sum in the order that suits the processor.
bool is_own_code(const SolverEntry& entry) { return std::string(entry.needs.package).empty(); }

/// Own code that decides by libm's last bits, or not by the problem alone.
bool is_through_libm(const SolverEntry& entry) {
  // hypot in the contact's equation; sine and cosine for the sides of the pyramid
  return std::ranges::count(std::array{"pgs_newton", "pyramid_lemke"}, std::string(entry.name)) > 0;
}

/// SuiteSparse orders the bodies, which is a matter of whole numbers; the factors are our own.
bool factors_over_bodies(const SolverEntry& entry) {
  constexpr std::array names = {"admm",      "interior_point", "newton_ac",   "newton_burst",
                                "newton_fb", "newton_nm",      "prox_newton", "sap"};
  return entry.make && std::ranges::count(names, std::string(entry.name)) > 0;
}

constexpr std::array backend_kinds = {
    Kind{"backends",
         Through::arithmetic,
         {1, 3, 20},
         [](const SolverEntry& entry) { return is_own_code(entry) && !is_through_libm(entry); }},
    Kind{"backends_libm", Through::libm, {1, 3, 20}, is_through_libm},
    // newton_burst begins with 500 sweeps
    Kind{factoring_table, Through::libm, {1, 20, 520}, factors_over_bodies}};

Table backend_values(const FrictionProblem& problem, const Impulses& warm, const Kind& kind) {
  Table table{kind.table, kind.through, "backend"};
  for (const int count : kind.iterations) {
    const std::string after = "_after_" + std::to_string(count);
    table.columns.insert(table.columns.end(), {"impulses" + after, "error" + after});
  }
  SolverRunner runner;
  for (const SolverEntry& entry : solver_list()) {
    if (!kind.holds(entry)) continue;
    std::vector<std::string> cells;
    for (const int count : kind.iterations) {
      Budget budget;
      budget.tolerance = 0.0;
      budget.max_iterations = count;
      const auto solver = entry.make();
      const SolverRun run = runner.run(*solver, problem, warm, budget);
      const Impulses& r = run.solved.impulses;
      cells.push_back(digest({r.data(), static_cast<size_t>(r.size())}));
      cells.push_back(exact(run.error.natural_map_rms));
    }
    table.rows.emplace_back(entry.name, cells);
  }
  return table;
}

Table contact_values(const std::vector<ContactPoint>& contacts) {
  Numbers bodies, features, normals, positions, gaps;
  for (const ContactPoint& c : contacts) {
    append(bodies, std::array<double, 2>{double(c.body_a), double(c.body_b)});
    features.push_back(double(c.feature >> 32));
    features.push_back(double(c.feature & 0xffffffffu));
    append(normals, c.normal);
    append(positions, c.position);
    gaps.push_back(c.gap);
  }
  Table table{"contacts", Through::arithmetic, "array", {"count", "digest"}};
  const auto add = [&](const char* name, const Numbers& numbers) {
    table.rows.push_back({name, {std::to_string(numbers.size()), digest(numbers)}});
  };
  add("bodies", bodies);
  add("features", features);
  add("normals", normals);
  add("positions", positions);
  add("gaps", gaps);
  return table;
}

Table problem_values(const FrictionProblem& problem, const Impulses& impulses,
                     const MotionState& after) {
  Table table{"problem", Through::arithmetic, "array", {"count", "digest"}};
  const auto add = [&](const char* name, std::span<const double> numbers) {
    table.rows.push_back({name, {std::to_string(numbers.size()), digest(numbers)}});
  };
  const DynamicsForm& d = problem.dynamics;
  const auto span = [](const Eigen::VectorXd& x) {
    return std::span<const double>(x.data(), static_cast<size_t>(x.size()));
  };
  add("mass", d.mass);
  add("h", d.h);
  add("v_free", span(d.v_free));
  add("bias", span(d.bias));
  add("friction", problem.friction);
  add("impulses", span(impulses));
  Numbers velocity, spin;
  for (const Vec3& v : after.velocity) append(velocity, v);
  for (const Vec3& v : after.spin) append(spin, v);
  add("velocity_after", velocity);
  add("spin_after", spin);
  return table;
}

}  // namespace

Table libm_values() {
  Numbers sine, cosine, length, power;
  Random random(1);
  for (int k = 0; k < 2000; ++k) {
    const double x = random.uniform(-1.0, 60.0), y = random.uniform(0.0, 1.0);
    append(sine, std::array{std::sin(x), std::sin(1e-3 * y)});
    append(cosine, std::array{std::cos(x), std::cos(1e-3 * y)});
    length.push_back(std::hypot(x, y));
    append(power, std::array{std::pow(y, 3), std::pow(2.0 + y, x)});
  }
  return {libm_table,
          Through::arithmetic,
          "function",
          {"digest"},
          {{"sin", {digest(sine)}},
           {"cos", {digest(cosine)}},
           {"hypot", {digest(length)}},
           {"pow", {digest(power)}}}};
}

Table grain_values() {
  Table table{"grains", Through::arithmetic, "grain", {"vertices", "faces", "mass", "inertia"}};
  const auto shapes = grains(12);
  for (size_t k = 0; k < shapes.size(); ++k) {
    const Polyhedron& shape = shapes[k].shape;
    Numbers vertices, faces, inertia;
    for (const Vec3& vertex : shape.vertices()) append(vertices, vertex);
    for (int f = 0; f < shape.face_count(); ++f)
      for (const int vertex : shape.face(f)) faces.push_back(vertex);
    append(inertia, shapes[k].inertia);
    table.rows.push_back(
        {std::to_string(k),
         {digest(vertices), digest(faces), exact(shapes[k].volume), digest(inertia)}});
  }
  return table;
}

std::vector<Table> heap_values() {
  MotionState state;
  const MechanicalSystem system = make_system(heap(), state);
  StepSettings settings;
  settings.solver.name = "pgs";
  settings.solver.max_iterations = 50;
  TimeStepper stepper(system, settings, -1);
  StepMemory memory;
  stepper.step(state, memory);
  const FrictionProblem& problem = stepper.problem();
  Impulses warm = stepper.impulses();
  warm *= 0.5;  // neither cold nor solved
  std::vector<Table> tables = {contact_values(stepper.contacts()),
                               problem_values(problem, stepper.impulses(), state)};
  for (const Kind& kind : backend_kinds)
    if (Table table = backend_values(problem, warm, kind); !table.rows.empty())
      tables.push_back(std::move(table));
  return tables;
}

}  // namespace ballast::golden
