#pragma once
// Siconos' text format (.dat) of FrictionContactProblem and GlobalFrictionContactProblem: numbers
// separated by white space.

#include <filesystem>
#include <variant>

#include "problems/files/stored_problem.hpp"

namespace ballast {

/// Local: dimension, contacts, W, q, mu. Global: dimension, contacts, M, H, q, b, mu: told apart by
/// the first matrix, which has as many rows as the contacts only when it is W. Matrices are dense,
/// by blocks, or sparse. Throws ProblemFileError with the line.
std::variant<LocalProblem, GlobalProblem> read_siconos_text(const std::filesystem::path& file);

}  // namespace ballast
