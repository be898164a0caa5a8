// Problems, their solution and their judge for Python; what users see is ballast/__init__.py.

#include "problems/algebra/contact_error.hpp"
#include "problems/files/problem_file.hpp"
#include "python/binding.hpp"
#include "solvers/seam/run_solver.hpp"
#include "solvers/solver_list.hpp"

namespace ballast::python {
namespace {

/// SciPy's compressed form: by rows, or by columns for what is its transpose.
struct Compressed {
  const Doubles& data;
  const Ints& indices;
  const Ints& pointers;
};

/// Triplets of `lines` rows (or columns) of `length`. Throws std::invalid_argument.
std::vector<Eigen::Triplet<double>> triplets(const Compressed& m, int lines, int length,
                                             bool by_rows, const std::string& name) {
  const auto fail = [&](const std::string& what) {
    throw std::invalid_argument(name + ": " + what);
  };
  if (m.pointers.size() != lines + 1)
    fail("has " + std::to_string(m.pointers.size() - 1) + " rows or columns, must have " +
         std::to_string(lines));
  const int* begin = m.pointers.data();
  const int entries = begin[lines];
  if (begin[0] != 0 || entries > m.data.size() || entries > m.indices.size())
    fail("its pointers do not fit its entries");
  std::vector<Eigen::Triplet<double>> list;
  list.reserve(static_cast<size_t>(std::max(entries, 0)));
  for (int line = 0; line < lines; ++line) {
    if (begin[line + 1] < begin[line] || begin[line + 1] > entries) fail("its pointers decrease");
    for (int k = begin[line]; k < begin[line + 1]; ++k) {
      const int index = m.indices.data()[k];
      if (index < 0 || index >= length)
        fail("index " + std::to_string(index) + " is outside 0 to " + std::to_string(length - 1));
      list.emplace_back(by_rows ? line : index, by_rows ? index : line, m.data.data()[k]);
    }
  }
  return list;
}

std::vector<double> frictions(const Doubles& mu) { return {mu.data(), mu.data() + mu.size()}; }

FrictionProblem checked(FrictionProblem problem) {
  problem.validate();
  return problem;
}

FrictionProblem from_delassus(const Doubles& data, const Ints& indices, const Ints& pointers,
                              const Doubles& q, const Doubles& mu) {
  const int rows = 3 * static_cast<int>(mu.size());
  LocalProblem local;
  local.q = vector_of(q, rows, "q");
  local.mu = frictions(mu);
  const auto entries = triplets({data, indices, pointers}, rows, rows, true, "W");
  local.w.resize(rows, rows);
  local.w.setFromTriplets(entries.begin(), entries.end());
  return checked(to_friction_problem(std::move(local)));
}

FrictionProblem from_bodies(const py::tuple& m, const py::tuple& h, const Doubles& f,
                            const Doubles& w, const Doubles& mu) {
  const int unknowns = static_cast<int>(f.size()), rows = 3 * static_cast<int>(mu.size());
  GlobalProblem global;
  global.f = vector_of(f, unknowns, "f");
  global.w = vector_of(w, rows, "w");
  global.mu = frictions(mu);
  const auto matrix = [](const py::tuple& parts, int height, int width, const char* name,
                         Eigen::SparseMatrix<double>& sparse) {
    const auto data = parts[0].cast<Doubles>();
    const auto indices = parts[1].cast<Ints>(), pointers = parts[2].cast<Ints>();
    const auto entries = triplets({data, indices, pointers}, width, height, false, name);
    sparse.resize(height, width);
    sparse.setFromTriplets(entries.begin(), entries.end());
  };
  matrix(m, unknowns, unknowns, "M", global.m);
  matrix(h, unknowns, rows, "H", global.h);
  return checked(to_friction_problem(global));
}

/// W by rows: the problem's own memory where W is stored with three rows per contact, else built.
py::tuple delassus(const py::object& self) {
  const auto& problem = self.cast<const FrictionProblem&>();
  const bool is_stored = problem.has_delassus && problem.row_count() == 3 * problem.contact_count();
  if (!is_stored) return owned_parts(condensed(problem).w);
  const py::tuple parts = parts_of(problem.delassus.w, self);
  for (const py::handle& part : parts) part.attr("setflags")(py::arg("write") = false);
  return parts;
}

/// M and H' by columns, and f.
py::tuple bodies(const FrictionProblem& problem) {
  if (!problem.has_dynamics) throw std::invalid_argument("only W is known: there are no bodies");
  GlobalProblem global = to_global_problem(problem);
  const py::ssize_t unknowns = global.f.size();
  return py::make_tuple(owned_parts(std::move(global.m)), owned_parts(std::move(global.h)),
                        owned(std::move(global.f), {unknowns}));
}

py::dict measures(const ContactError& error) {
  py::dict d;
  d["natural_map_rms"] = error.natural_map_rms;
  d["natural_map_max"] = error.natural_map_max;
  d["worst_contact"] = error.worst_contact;
  d["velocity_scale"] = error.velocity_scale;
  d["fclib"] = error.fclib;
  d["approach_rms"] = error.approach_rms;
  d["cone_rms"] = error.cone_rms;
  d["complementarity_rms"] = error.complementarity_rms;
  d["cone_violation"] = error.cone_violation;
  d["min_normal_velocity"] = error.min_normal_velocity;
  d["complementarity"] = error.complementarity;
  d["power"] = error.power;
  d["momentum_residual"] = error.momentum_residual;
  d["finite"] = error.finite;
  return d;
}

py::dict judge(const FrictionProblem& problem, const Doubles& r) {
  return measures(contact_error(problem, impulses_of(problem, r)));
}

py::array velocities(const FrictionProblem& problem, const Doubles& r) {
  Eigen::VectorXd u;
  contact_velocity(problem, impulses_of(problem, r), u);
  return in_threes(three_rows(problem, u));
}

py::array body_velocities(const FrictionProblem& problem, const Doubles& r) {
  Eigen::VectorXd v;
  if (problem.has_dynamics)
    body_velocity(problem.dynamics, problem.row_begin, impulses_of(problem, r), v);
  const py::ssize_t unknowns = v.size();
  return owned(std::move(v), {unknowns});
}

double scale_of(const FrictionProblem& problem) {
  return contact_error(problem, Impulses::Zero(problem.row_count())).velocity_scale;
}

py::dict solve(const FrictionProblem& problem, const std::string& name, double tolerance,
               bool is_absolute, const std::optional<Doubles>& start, int max_iterations,
               double max_seconds) {
  // NaN is refused by the same comparisons
  if (!(tolerance >= 0.0)) throw std::invalid_argument("tolerance: expected a number >= 0");
  if (max_iterations < 0) throw std::invalid_argument("max_iterations: expected a number >= 0");
  if (!(max_seconds >= 0.0)) throw std::invalid_argument("max_seconds: expected a number >= 0");
  const Impulses from = start ? impulses_of(problem, *start) : Impulses();
  const auto solver = make_solver(name);
  SolverRun run;
  std::string words;
  {
    // Other threads of Python go on.
    const py::gil_scoped_release released;
    if (!is_absolute) tolerance *= scale_of(problem);
    run =
        SolverRunner().run(*solver, problem, from, {tolerance, max_iterations, max_seconds, true});
    words = explained(problem, run, tolerance);
  }
  py::dict d;
  d["impulses"] = in_threes(three_rows(problem, run.solved.impulses));
  d["verdict"] = name_of(run.verdict);
  d["words"] = run.failure.empty() ? words : run.failure;
  d["reason"] = name_of(run.solved.reason);
  d["iterations"] = run.solved.iterations;
  d["own_residual"] = run.solved.own_residual;
  d["seconds"] = run.prepare_seconds + run.solve_seconds;
  d["error"] = measures(run.error);
  Doubles history({static_cast<py::ssize_t>(run.solved.history.size()), py::ssize_t{3}});
  for (size_t k = 0; k < run.solved.history.size(); ++k) {
    const HistoryPoint& point = run.solved.history[k];
    double* row = history.mutable_data(static_cast<py::ssize_t>(k), 0);
    row[0] = point.iteration;
    row[1] = point.seconds;
    row[2] = point.error;
  }
  d["history"] = history;
  return d;
}

std::vector<std::string> solver_names() {
  std::vector<std::string> names;
  for (const SolverEntry& entry : solver_list())
    if (entry.make) names.emplace_back(entry.name);
  return names;
}

Eigen::VectorXd free_velocity(const FrictionProblem& problem) {
  Eigen::VectorXd q;
  free_contact_velocity(problem, q);
  return q;
}

}  // namespace

Impulses impulses_of(const FrictionProblem& problem, const Doubles& r) {
  return own_rows(problem, vector_of(r, 3 * problem.contact_count(), "r"));
}

void add_problems(py::module_& module) {
  py::class_<FrictionProblem>(module, "Problem")
      .def_static("from_delassus", from_delassus)
      .def_static("from_bodies", from_bodies)
      .def_static("read", [](const std::filesystem::path& file) { return read_problem(file); })
      .def("write", [](const FrictionProblem& p,
                       const std::filesystem::path& file) { write_problem(file, p); })
      .def_property_readonly("contact_count", &FrictionProblem::contact_count)
      .def_property_readonly("has_bodies", [](const FrictionProblem& p) { return p.has_dynamics; })
      .def_property_readonly("mu",
                             [](const FrictionProblem& p) {
                               return Doubles(static_cast<py::ssize_t>(p.friction.size()),
                                              p.friction.data());
                             })
      .def_property_readonly(
          "q", [](const FrictionProblem& p) { return in_threes(three_rows(p, free_velocity(p))); })
      .def("delassus", delassus)
      .def("bodies", bodies);
  module.def("solve", solve);
  module.def("judge", judge);
  module.def("velocities", velocities);
  module.def("body_velocities", body_velocities);
  module.def("solvers", solver_names);
}

}  // namespace ballast::python

PYBIND11_MODULE(_ballast, module) {
  namespace py = pybind11;
  // One line each, as the program says it.
  py::register_exception<ballast::Error>(module, "Error", PyExc_RuntimeError);
  py::register_exception<ballast::InvalidProblem>(module, "InvalidProblem", PyExc_ValueError);
  py::register_exception<ballast::UnsupportedProblem>(module, "UnsupportedProblem",
                                                      PyExc_ValueError);
  py::register_exception<ballast::UnknownSolver>(module, "UnknownSolver", PyExc_ValueError);
  py::register_exception<ballast::MissingSolver>(module, "MissingSolver", PyExc_ValueError);
  ballast::python::add_problems(module);
  ballast::python::add_scenes(module);
  ballast::python::add_files(module);
}
