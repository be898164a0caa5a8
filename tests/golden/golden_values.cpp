#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/box/packing.hpp"
#include "experiments/record/record_file.hpp"
#include "experiments/step/time_step.hpp"
#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/pose.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"
#include "tests/golden/golden_values.hpp"
#include "tests/support/temporary_folder.hpp"

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

/// Grains on a grid so narrow that neighbours overlap, above a fixed floor and in it. None turns:
/// the half step of motion before detection takes sine and cosine of zero alone, which are exact.
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

/// The backends of one table, and their numbers of iterations.
struct Kind {
  const char* table;
  Through through;
  std::array<int, 3> iterations;
  bool (*holds)(const SolverEntry& entry);
};

/// True without a foreign library, which would sum in the order that suits the processor.
bool is_own_code(const SolverEntry& entry) { return std::string(entry.package).empty(); }

/// SuiteSparse only orders the bodies, by integer arithmetic; the factors are our own.
bool factors_over_bodies(const SolverEntry& entry) {
  constexpr std::array names = {"admm",      "interior_point", "newton_ac", "newton_burst",
                                "newton_fb", "prox_newton",    "sap"};
  return entry.make && std::ranges::count(names, std::string(entry.name)) > 0;
}

constexpr std::array backend_kinds = {
    Kind{"backends", Through::arithmetic, {1, 3, 20}, is_own_code},
    // newton_burst begins with 500 sweeps.
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

/// A table of arrays, with the size and the digest of each.
Table array_table(const char* name,
                  const std::vector<std::pair<const char*, std::span<const double>>>& arrays) {
  Table table{name, Through::arithmetic, "array", {"count", "digest"}};
  for (const auto& [array, numbers] : arrays)
    table.rows.push_back({array, {std::to_string(numbers.size()), digest(numbers)}});
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
  return array_table("contacts", {{"bodies", bodies},
                                  {"features", features},
                                  {"normals", normals},
                                  {"positions", positions},
                                  {"gaps", gaps}});
}

Table problem_values(const FrictionProblem& problem, const Impulses& impulses,
                     const MotionState& after) {
  const DynamicsForm& d = problem.dynamics;
  const auto span = [](const Eigen::VectorXd& x) {
    return std::span<const double>(x.data(), static_cast<size_t>(x.size()));
  };
  Numbers velocity, spin;
  for (const Vec3& v : after.velocity) append(velocity, v);
  for (const Vec3& v : after.spin) append(spin, v);
  return array_table("problem", {{"mass", d.mass},
                                 {"h", d.h},
                                 {"v_free", span(d.v_free)},
                                 {"bias", span(d.bias)},
                                 {"friction", problem.friction},
                                 {"impulses", span(impulses)},
                                 {"velocity_after", velocity},
                                 {"spin_after", spin}});
}

/// vibrated_box_small with so few grains that all its stages together take a second.
Scene small_scene() {
  const std::vector<std::string> overrides = {
      "grains.count=12",           "box.length=0.12",          "box.width=0.12",
      "deposit.lid_time=0.02",     "deposit.settle_time=0.02", "control_volume.margin_x=0.02",
      "solver.max_iterations=200", "correction.slop=0"};
  return read_scene(find_scene("vibrated_box_small"), overrides);
}

/// A record's columns without wall clocks and the solid fraction, which the run's loop measures.
std::vector<StepColumn> physics_columns() {
  std::vector<StepColumn> columns;
  for (const StepColumn& column : step_columns())
    if (!column.phase && column.value != &StepRecord::solid_fraction) columns.push_back(column);
  return columns;
}

/// A table with the columns of the record. A cell is the digest of several steps of its column; the
/// row has the name of the last of them.
class StepTable {
 public:
  StepTable(const char* name, size_t steps_per_row) : steps_per_row_(steps_per_row) {
    table_ = {name, Through::libm, "step", {}, {}};
    for (const StepColumn& column : columns_) table_.columns.push_back(column.name);
  }

  void add(const std::string& stage, const StepRecord& step) {
    if (!steps_.empty() && (stage != stage_ || steps_.size() == steps_per_row_)) end_row();
    stage_ = stage;
    ++count_;
    steps_.push_back(step);
  }
  Table take() {
    end_row();
    return table_;
  }

 private:
  void end_row() {
    constexpr int digits = 4;  // enough: a column that differs once differs in all later rows
    std::vector<std::string> cells;
    for (const StepColumn& column : columns_)
      cells.push_back(digest(record_column(steps_, column.value), digits));
    table_.rows.emplace_back(stage_ + "_" + std::to_string(count_), cells);
    steps_.clear();
  }

  const std::vector<StepColumn> columns_ = physics_columns();
  size_t steps_per_row_, count_ = 0;
  Table table_;
  std::string stage_;
  std::vector<StepRecord> steps_;
};

Table state_values(const char* name, const MechanicalSystem& system, const MotionState& state) {
  Table table{name, Through::libm, "body", {"position", "rotation", "velocity", "spin"}};
  for (size_t b = 0; b < state.pose.size(); ++b) {
    const auto vector = [](const auto& x) { return digest({x.data(), size_t(x.size())}); };
    std::string body = system.bodies[b].name;
    std::replace(body.begin(), body.end(), ' ', '_');
    table.rows.push_back({body,
                          {vector(state.pose[b].position), vector(state.pose[b].rotation.coeffs()),
                           vector(state.velocity[b]), vector(state.spin[b])}});
  }
  return table;
}

Table packing_values(const Packing& packing) {
  const DepositState& d = packing.deposit;
  Table table{"packing", Through::libm, "what", {"exact"}};
  table.rows = {{"lid", {exact(d.lid)}},
                {"top", {exact(d.top)}},
                {"rain_time", {exact(d.rain_time)}},
                {"rest_velocity", {exact(d.rest_velocity)}},
                {"contacts", {std::to_string(packing.memory.contacts.size())}}};
  return table;
}

/// All columns of one step in readable form.
Table step_values(const char* name, const StepRecord& step) {
  Table table{name, Through::libm, "column", {"exact", "about"}};
  for (const StepColumn& column : physics_columns()) {
    const double value = step.*column.value;
    table.rows.push_back({column.name, {exact(value), printed("%.4g", value)}});
  }
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
  Scene scene = heap();
  scene.solver.name = "pgs";
  scene.solver.tolerance = 1e-3 / velocity_scale(scene);  // 1e-3 m/s
  scene.solver.max_iterations = 50;
  const MechanicalSystem system = make_system(scene, state);
  TimeStepper stepper(system, scene, -1);
  StepMemory memory;
  stepper.step(state, memory);
  const FrictionProblem& problem = stepper.problem();
  Impulses warm = stepper.impulses();
  warm *= 0.5;  // neither cold nor solved
  std::vector<Table> tables = {contact_values(memory.contacts),
                               problem_values(problem, stepper.impulses(), state)};
  for (const Kind& kind : backend_kinds)
    if (Table table = backend_values(problem, warm, kind); !table.rows.empty())
      tables.push_back(std::move(table));
  return tables;
}

std::vector<Table> box_values() {
  const Scene scene = small_scene();
  const Rain rain = make_rain(scene);
  const TemporaryFolder folder;

  StepTable deposit_steps("deposit", 100);
  const auto listen = [&](BoxStage stage, double, const StepRecord& step) {
    deposit_steps.add(name_of(stage), step);
    return true;
  };
  Packing packing;
  if (!deposit(scene, rain, folder.path() / "part", listen, packing)) return {};

  MotionState state;
  const MechanicalSystem system = drive_system(scene, rain, packing, state);
  std::vector<Table> tables = {deposit_steps.take(), packing_values(packing),
                               state_values("packing_bodies", system, state)};

  TimeStepper stepper(system, scene, system.first_driven_wall());
  StepTable drive_steps("drive", 1);
  StepRecord step;
  for (int k = 0; k < 40; ++k) {
    step = stepper.step(state, packing.memory);
    drive_steps.add("drive", step);
  }
  tables.push_back(drive_steps.take());
  tables.push_back(step_values("drive_last_step", step));
  tables.push_back(state_values("drive_bodies", system, state));
  return tables;
}

File values_today() {
  File file{bits_generation, {libm_values(), grain_values()}};
  for (const std::vector<Table>& tables : {heap_values(), box_values()})
    file.tables.insert(file.tables.end(), tables.begin(), tables.end());
  return file;
}

}  // namespace ballast::golden
