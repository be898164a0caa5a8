#pragma once
// The words of `ballast compare` -> settings. Everything wrong is a std::invalid_argument that says
// what was expected.

#include <string>
#include <vector>

#include "experiments/compare/bench.hpp"

namespace ballast {

/// "pgs,nncg", or "all": every backend that was built. Throws UnknownSolver, MissingSolver for
/// names.
std::vector<BenchSolver> bench_solvers(const std::string& list);

/// "1e-4,1e-8": numbers > 0, sorted from loose to tight, each once.
std::vector<double> bench_tolerances(const std::string& list);

/// "cold", "warm", "cold,warm".
std::vector<StartKind> bench_starts(const std::string& list);

}  // namespace ballast
