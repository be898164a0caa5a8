#pragma once
// What the files of the Python module share: arrays in and out.

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "problems/files/stored_problem.hpp"

namespace ballast::python {

namespace py = pybind11;

/// Contiguous numbers, converted where they are of another type.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Ints = py::array_t<int, py::array::c_style | py::array::forcecast>;

/// A vector of that many numbers, whatever its shape. Throws std::invalid_argument naming it.
inline Eigen::VectorXd vector_of(const Doubles& values, py::ssize_t size, const std::string& name) {
  if (values.size() != size)
    throw std::invalid_argument(name + " has " + std::to_string(values.size()) +
                                " entries, must have " + std::to_string(size));
  return Eigen::Map<const Eigen::VectorXd>(values.data(), values.size());
}

/// A copy as a new array, (size) or (size / 3, 3).
inline py::array flat(const Eigen::VectorXd& x) { return Doubles(x.size(), x.data()); }
inline py::array in_threes(const Eigen::VectorXd& x) {
  return Doubles({x.size() / 3, py::ssize_t{3}}, x.data());
}

/// The array is this memory, which lives as long as `owner`: nothing is copied. `stride` [bytes].
inline py::array view(double* first, py::ssize_t rows, py::ssize_t columns, py::ssize_t stride,
                      const py::handle& owner) {
  return py::array(py::dtype::of<double>(), {rows, columns}, {stride, py::ssize_t{8}}, first,
                   owner);
}

void add_problems(py::module_& module);
void add_scenes(py::module_& module);

}  // namespace ballast::python
