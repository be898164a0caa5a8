#pragma once
// What the files of the Python module share: arrays in and out, and the interpreter's lock.

#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <unistd.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "problems/files/fclib_file.hpp"

namespace ballast::python {

namespace py = pybind11;

/// Contiguous numbers, converted where they are of another type.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Ints = py::array_t<int, py::array::c_style | py::array::forcecast>;

/// A vector of that many numbers, of one dimension or in rows of three. Throws
/// std::invalid_argument naming it.
inline Eigen::VectorXd vector_of(const Doubles& values, py::ssize_t size, const std::string& name) {
  if (values.size() != size)
    throw std::invalid_argument(name + " has " + std::to_string(values.size()) +
                                " entries, must have " + std::to_string(size));
  if (values.ndim() > 2 || (values.ndim() == 2 && values.shape(1) != 3 && values.shape(1) != 1))
    throw std::invalid_argument(name + ": expected the shape (3n) or (n, 3)");
  return Eigen::Map<const Eigen::VectorXd>(values.data(), values.size());
}

/// The array is the vector's own memory, which it takes over.
template <class Vector>
py::array_t<typename Vector::value_type> owned(Vector values, std::vector<py::ssize_t> shape) {
  auto* kept = new Vector(std::move(values));
  const py::capsule owner(kept, [](void* memory) { delete static_cast<Vector*>(memory); });
  return py::array_t<typename Vector::value_type>(std::move(shape), kept->data(), owner);
}

template <class Vector>
auto owned(Vector values) {
  const auto size = static_cast<py::ssize_t>(values.size());
  return owned(std::move(values), {size});
}

inline py::array in_threes(Eigen::VectorXd x) {
  const py::ssize_t contacts = x.size() / 3;
  return owned(std::move(x), {contacts, 3});
}

/// While it lives, this thread does without the interpreter's lock, and Python's others run. When
/// Python ends meanwhile, a thread that wants the lock is unwound, which no solver survives: it
/// waits for the end of the process instead.
class GilRelease {
 public:
  GilRelease() = default;
  ~GilRelease() { lock(); }
  GilRelease(const GilRelease&) = delete;
  GilRelease& operator=(const GilRelease&) = delete;

  /// The handler of a signal, as Ctrl-C, has raised an exception: it is set.
  bool is_interrupted() {
    lock();
    const bool raised = PyErr_CheckSignals() != 0;
    state_ = PyEval_SaveThread();
    return raised;
  }

 private:
  void lock() const {
    try {
      PyEval_RestoreThread(state_);
    } catch (...) {  // of pthread_exit()
      for (;;) pause();
    }
  }
  PyThreadState* state_ = PyEval_SaveThread();
};

void add_problems(py::module_& module);
void add_scenes(py::module_& module);

}  // namespace ballast::python
