// Problems, their solution and their judge for Python, and what runs and foreign programs leave in
// files; what users see is ballast/__init__.py.

#include <cmath>
#include <limits>
#include <type_traits>

#include "experiments/external/external_program.hpp"
#include "experiments/step/step_record.hpp"
#include "platform/clock.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/files/captured_problem.hpp"
#include "problems/files/problem_file.hpp"
#include "python/binding.hpp"
#include "solvers/seam/run_solver.hpp"
#include "solvers/solver_list.hpp"

namespace ballast::python {
namespace {

std::vector<double> frictions(const Doubles& mu) { return {mu.data(), mu.data() + mu.size()}; }

FrictionProblem from_delassus(SparseRows w, const Doubles& q, const Doubles& mu) {
  const auto rows = static_cast<py::ssize_t>(w.rows());
  FrictionProblem problem = local_problem(std::move(w), vector_of(q, rows, "q"), frictions(mu));
  problem.validate();
  return problem;
}

FrictionProblem from_bodies(Eigen::SparseMatrix<double> m, Eigen::SparseMatrix<double> h,
                            const Doubles& f, const Doubles& w, const Doubles& mu) {
  const auto unknowns = static_cast<py::ssize_t>(h.rows()),
             rows = static_cast<py::ssize_t>(h.cols());
  FrictionProblem problem =
      to_friction_problem(GlobalProblem{std::move(m), std::move(h), vector_of(f, unknowns, "f"),
                                        vector_of(w, rows, "w"), frictions(mu)});
  problem.validate();
  return problem;
}

Impulses impulses_of(const FrictionProblem& problem, const Doubles& r, const char* name = "r") {
  return own_rows(problem, vector_of(r, 3 * problem.contact_count(), name));
}

/// W by rows, as SciPy has it: the problem's own memory where W is stored with three rows per
/// contact, else built.
py::object delassus(const py::object& self) {
  const auto& problem = self.cast<const FrictionProblem&>();
  if (!problem.has_delassus || problem.row_count() != 3 * problem.contact_count())
    return py::cast(condensed(problem).delassus.w);
  const SparseRows& w = problem.delassus.w;
  const auto entries = static_cast<py::ssize_t>(w.nonZeros());
  const auto rows = static_cast<py::ssize_t>(w.rows());
  const py::tuple parts = py::make_tuple(Doubles({entries}, w.valuePtr(), self),
                                         Ints({entries}, w.innerIndexPtr(), self),
                                         Ints({rows + 1}, w.outerIndexPtr(), self));
  for (const py::handle& part : parts) part.attr("setflags")(py::arg("write") = false);
  return py::module_::import("scipy.sparse").attr("csr_matrix")(parts, py::make_tuple(rows, rows));
}

/// M and H' by columns, and f.
py::tuple bodies(const FrictionProblem& problem) {
  if (!problem.has_dynamics) throw std::invalid_argument("only W is known: there are no bodies");
  GlobalProblem global = to_global_problem(problem);
  return py::make_tuple(global.m, global.h, owned(std::move(global.f)));
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
  return owned(std::move(v));
}

py::dict solve(const FrictionProblem& problem, const std::string& name, double tolerance,
               bool is_absolute, const std::optional<Doubles>& start, int max_iterations,
               double max_seconds) {
  // NaN is refused by the same comparisons
  if (!(tolerance >= 0.0)) throw std::invalid_argument("tolerance: expected a number >= 0");
  if (max_iterations < 0) throw std::invalid_argument("max_iterations: expected a number >= 0");
  if (!(max_seconds >= 0.0)) throw std::invalid_argument("max_seconds: expected a number >= 0");
  const Impulses from = start ? impulses_of(problem, *start, "start") : Impulses();
  const auto solver = make_solver(name);
  SolverRun run;
  std::string words;
  bool is_interrupted = false;
  {
    // Other threads of Python go on.
    GilRelease unlocked;
    if (!is_absolute)
      tolerance *= contact_error(problem, Impulses::Zero(problem.row_count())).velocity_scale;
    Budget budget{tolerance, max_iterations, max_seconds, /*keep_history=*/true};
    budget.is_cancelled = [&, asked = Stopwatch()]() mutable {
      if (is_interrupted || !asked.has_passed(0.05)) return is_interrupted;
      asked.restart();
      return is_interrupted = unlocked.is_interrupted();
    };
    run = SolverRunner().run(*solver, problem, from, budget);
    if (!is_interrupted) words = explained(problem, run, tolerance, max_seconds);
  }
  if (is_interrupted) throw py::error_already_set();
  py::dict d;
  d["impulses"] = in_threes(three_rows(problem, run.solved.impulses));
  d["verdict"] = name_of(run.verdict);
  d["words"] = run.failure.empty() ? words : run.failure;
  d["reason"] = name_of(run.solved.reason);
  d["iterations"] = run.solved.iterations;
  d["own_residual"] = run.solved.own_residual;
  d["seconds"] = run.prepare_seconds + run.solve_seconds;
  d["error"] = measures(run.error);
  std::vector<double> history;
  for (const HistoryPoint& point : run.solved.history)
    history.insert(history.end(), {double(point.iteration), point.seconds, point.error});
  const auto points = static_cast<py::ssize_t>(run.solved.history.size());
  d["history"] = owned(std::move(history), {points, 3});
  return d;
}

/// Lists as they are in the file, in one dimension.
py::dict captured(const std::filesystem::path& file) {
  CapturedProblem c = read_captured(file);
  for (Impulses* r : {&c.start, &c.solution}) *r = three_rows(c.problem, *r);
  py::dict d;
  each_member(c, [&]<class Member>(const char* name, Member& member, auto...) {
    if constexpr (std::is_arithmetic_v<Member> || std::is_same_v<Member, std::string>)
      d[name] = member;
    else
      d[name] = owned(std::move(member));
  });
  d["velocity_scale"] = c.velocity_scale();
  d["problem"] = std::move(c.problem);
  return d;
}

/// A dataset of numbers of an HDF5 file, in its shape.
py::array dataset(const std::filesystem::path& path, const std::string& name) {
  const Hdf5Reader file(path);
  std::vector<py::ssize_t> shape;
  for (const auto length : file.shape(name)) shape.push_back(static_cast<py::ssize_t>(length));
  return owned(file.read<double>(name), shape);
}

void answer(const ExternalRequest& request, const std::filesystem::path& file, int status,
            const std::optional<Doubles>& r, int iterations, double residual, double seconds,
            const Doubles& history) {
  ExternalAnswer answer;
  answer.status = status;
  if (r) answer.solved.impulses = impulses_of(request.problem, *r);
  answer.solved.iterations = iterations;
  answer.solved.own_residual = residual;
  answer.seconds = seconds;
  if (history.size() % 3 != 0 || (history.ndim() == 2 && history.shape(1) != 3))
    throw std::invalid_argument("history: expected three numbers per point, the shape (k, 3)");
  for (const double* point = history.data(); point != history.data() + history.size(); point += 3) {
    if (!Vec3(point).allFinite()) continue;
    if (std::abs(point[0]) > std::numeric_limits<int>::max())
      throw std::invalid_argument("history has an iteration that is no count");
    answer.solved.history.push_back({static_cast<int>(point[0]), point[1], point[2]});
  }
  write_answer(file, request, answer);
}

/// One line, as the program says it: the bytes of a path in it are what Python makes of them.
template <class CppError>
void add_error(py::module_& module, const char* name, PyObject* base) {
  static const auto* type = new py::exception<CppError>(module, name, base);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const CppError& error) {
      const auto words = py::reinterpret_steal<py::str>(PyUnicode_DecodeFSDefault(error.what()));
      PyErr_SetObject(type->ptr(), words.ptr());
    }
  });
}

}  // namespace

void add_problems(py::module_& module) {
  py::class_<FrictionProblem>(module, "Problem")
      .def_static("from_delassus", from_delassus)
      .def_static("from_bodies", from_bodies)
      .def_static("read", [](const std::filesystem::path& file) { return read_problem(file); })
      .def("write", [](const FrictionProblem& p,
                       const std::filesystem::path& file) { write_problem(file, p); })
      .def_property_readonly("contact_count", &FrictionProblem::contact_count)
      .def_property_readonly("has_bodies", [](const FrictionProblem& p) { return p.has_dynamics; })
      .def_property_readonly("mu", [](const FrictionProblem& p) { return owned(p.friction); })
      .def_property_readonly("q",
                             [](const FrictionProblem& p) {
                               Eigen::VectorXd q;
                               free_contact_velocity(p, q);
                               return in_threes(three_rows(p, q));
                             })
      .def("delassus", delassus)
      .def("bodies", bodies);
  module.def("solve", solve);
  module.def("judge", judge);
  module.def("velocities", velocities);
  module.def("body_velocities", body_velocities);
  module.def("solvers", [] {
    std::vector<std::string> names;
    for (const SolverEntry& entry : solver_list())
      if (entry.make) names.emplace_back(entry.name);
    return names;
  });
  module.def("captured", captured);
  module.def("dataset", dataset);
  module.def("texts", [](const std::filesystem::path& path, const std::string& name) {
    return Hdf5Reader(path).read_texts(name);
  });
  module.def("step_columns", [] {
    std::vector<std::string> names;
    for (const StepColumn& column : step_columns()) names.emplace_back(column.name);
    return names;
  });
  py::class_<ExternalRequest>(module, "Request")
      .def_static("read", [](const std::filesystem::path& file) { return read_request(file); })
      .def_readonly("problem", &ExternalRequest::problem)
      .def_readonly("tolerance", &ExternalRequest::tolerance)
      .def_readonly("fclib_tolerance", &ExternalRequest::fclib_tolerance)
      .def_readonly("max_iterations", &ExternalRequest::max_iterations)
      .def_readonly("max_seconds", &ExternalRequest::max_seconds)
      .def_property_readonly("start",
                             [](const ExternalRequest& request) {
                               return in_threes(three_rows(request.problem, request.start));
                             })
      .def("answer", answer);
}

}  // namespace ballast::python

PYBIND11_MODULE(_ballast, module) {
  namespace py = pybind11;
  using ballast::python::add_error;
  add_error<ballast::Error>(module, "Error", PyExc_RuntimeError);
  add_error<ballast::InvalidProblem>(module, "InvalidProblem", PyExc_ValueError);
  add_error<ballast::UnsupportedProblem>(module, "UnsupportedProblem", PyExc_ValueError);
  add_error<ballast::UnknownSolver>(module, "UnknownSolver", PyExc_ValueError);
  add_error<ballast::MissingSolver>(module, "MissingSolver", PyExc_ValueError);
  ballast::python::add_problems(module);
  ballast::python::add_scenes(module);
}
