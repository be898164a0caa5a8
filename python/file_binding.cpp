// What runs and foreign programs leave in files, for Python: captured problems, records, requests
// of `ballast compare --external`.

#include "experiments/external/external_files.hpp"
#include "experiments/step/step_record.hpp"
#include "platform/hdf5_file.hpp"
#include "problems/files/captured_problem.hpp"
#include "python/binding.hpp"

namespace ballast::python {
namespace {

template <class Vector>
py::ssize_t size_of(const Vector& values) {
  return static_cast<py::ssize_t>(values.size());
}

py::dict captured(const std::filesystem::path& file) {
  CapturedProblem c = read_captured(file);
  const py::ssize_t contacts = size_of(c.gap);
  std::vector<int> bodies;
  for (size_t k = 0; k < c.id_a.size(); ++k) bodies.insert(bodies.end(), {c.id_a[k], c.id_b[k]});
  py::dict d;
  d["start"] = in_threes(three_rows(c.problem, c.start));
  d["solution"] = in_threes(three_rows(c.problem, c.solution));
  d["gap"] = owned(std::move(c.gap), {contacts});
  d["frame"] = owned(std::move(c.frame), {contacts, 3, 3});
  d["position"] = owned(std::move(c.position), {contacts, 3});
  d["key"] = owned(std::move(c.key), {contacts});
  d["bodies"] = owned(std::move(bodies), {contacts, 2});
  d["h"] = c.h;
  d["g"] = c.g;
  d["step"] = c.step;
  d["time"] = c.time;
  d["phase"] = c.phase;
  d["wall_x"] = c.wall_x;
  d["wall_v"] = c.wall_v;
  d["load"] = c.load;
  d["velocity_scale"] = c.velocity_scale();
  d["problem"] = std::move(c.problem);
  return d;
}

/// A dataset of numbers of an HDF5 file, in its shape.
py::array dataset(const std::filesystem::path& path, const std::string& name) {
  const Hdf5Reader file(path);
  std::vector<py::ssize_t> shape;
  for (const auto length : file.shape(name)) shape.push_back(static_cast<py::ssize_t>(length));
  return owned(file.read_doubles(name), shape);
}

std::vector<std::string> texts(const std::filesystem::path& path, const std::string& name) {
  return Hdf5Reader(path).read_texts(name);
}

std::vector<std::string> step_column_names() {
  std::vector<std::string> names;
  for (const StepColumn& column : step_columns()) names.emplace_back(column.name);
  return names;
}

void answer(const ExternalRequest& request, const std::filesystem::path& file, int status,
            const std::optional<Doubles>& r, int iterations, double residual, double seconds,
            const Doubles& history) {
  ExternalAnswer answer;
  answer.set_status(status);
  if (r) answer.impulses = impulses_of(request.problem, *r);
  answer.iterations = iterations;
  answer.own_residual = residual;
  answer.seconds = seconds;
  if (history.size() % 3 != 0)
    throw std::invalid_argument("history has " + std::to_string(history.size()) +
                                " entries, must have three per point");
  for (const double* point = history.data(); point != history.data() + history.size(); point += 3)
    answer.history.push_back({static_cast<int>(point[0]), point[1], point[2]});
  write_answer(file, request, answer);
}

}  // namespace

void add_files(py::module_& module) {
  module.def("captured", captured);
  module.def("dataset", dataset);
  module.def("texts", texts);
  module.def("step_columns", step_column_names);
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
