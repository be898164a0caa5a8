#pragma once
// The only list of backends. Tests, bench, figures and help enumerate it.

#include <span>
#include <string_view>

#include "solvers/seam/solver.hpp"

namespace ballast {

struct SolverEntry {
  const char* name;         ///< as on the command line
  const char* description;  ///< one line, with the source
  ContactLaw law;
  SolverMaker make;          ///< null: built without the library it needs
  const char* package = "";  ///< Debian's name of the library it needs; empty: none
  /// The largest number of contacts that the backend is sure to take, as it keeps dense matrices.
  /// It may refuse more (UnsupportedProblem). 0: no limit.
  int largest = 0;
};

std::span<const SolverEntry> solver_list();

/// An unknown name, or a backend whose library is absent; what() lists all names.
class UnknownSolver : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
class MissingSolver : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

const SolverEntry& find_solver(std::string_view name);  ///< throws UnknownSolver
std::unique_ptr<Solver> make_solver(
    std::string_view name);  ///< throws UnknownSolver, MissingSolver

}  // namespace ballast
