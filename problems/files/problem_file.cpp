#include "problems/files/problem_file.hpp"

#include <variant>

#include "problems/files/captured_problem.hpp"
#include "problems/files/fclib_file.hpp"
#include "problems/files/siconos_text.hpp"

namespace ballast {

FrictionProblem read_problem(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  const bool hdf5 = extension == ".hdf5" || extension == ".h5";
  if (!hdf5 && extension != ".dat")
    throw ProblemFileError(file.string() + ": unknown kind of file '" + extension +
                           "'; known: .hdf5, .h5, .dat");
  // A captured problem has the exact dynamics form beside the FCLIB one.
  if (is_captured(file)) return read_captured(file).problem;
  const auto stored = hdf5 ? read_fclib(file) : read_siconos_text(file);
  try {
    FrictionProblem problem =
        std::visit([](const auto& form) { return to_friction_problem(form); }, stored);
    problem.validate();
    return problem;
  } catch (const InvalidProblem& error) {
    throw ProblemFileError(file.string() + ": " + error.what());
  }
}

}  // namespace ballast
