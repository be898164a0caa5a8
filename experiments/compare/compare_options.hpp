#pragma once
// The lists on the command lines of `ballast compare` and `ballast bench` -> settings. Everything
// wrong is a std::invalid_argument that says what was expected.

#include <string>
#include <vector>

#include "experiments/compare/comparison.hpp"
#include "experiments/external/external_program.hpp"

namespace ballast {

/// "pgs,nncg", or "all": every backend that was built. Throws UnknownSolver, MissingSolver for
/// names.
std::vector<ComparedSolver> parse_solvers(const std::string& list);

/// Programs that solve (experiments/external). Throws std::invalid_argument: also for the name of a
/// backend.
std::vector<ComparedSolver> external_solvers(const std::vector<std::string>& words,
                                             const ExternalLimits& limits);

/// "1e-4,1e-8": numbers > 0, sorted from loose to tight, each once.
std::vector<double> parse_tolerances(const std::string& list);

/// "1000,10000": whole numbers from 1 to `most`, in the order given.
std::vector<long> parse_counts(const std::string& list, long most);

/// "cold", "warm", "cold,warm".
std::vector<StartKind> parse_starts(const std::string& list);

}  // namespace ballast
