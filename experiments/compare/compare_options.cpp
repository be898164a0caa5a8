#include "experiments/compare/compare_options.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "platform/text.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

/// The words between the commas of a list; `what` says what was expected there.
std::vector<std::string> words_of(const std::string& list, const std::string& what) {
  std::vector<std::string> words = split(list, ',');
  for (const std::string& word : words)
    if (word.empty())
      throw std::invalid_argument("'" + list + "': expected " + what + ", separated by commas");
  return words;
}

}  // namespace

std::vector<ComparedSolver> parse_solvers(const std::string& list) {
  std::vector<ComparedSolver> solvers;
  if (list == "all") {
    for (const SolverEntry& entry : solver_list())
      if (entry.make) solvers.push_back({entry.name, entry.law, entry.make});
    return solvers;
  }
  for (const std::string& name : words_of(list, "names of solvers")) {
    make_solver(name);  // says what is wrong with a name
    const SolverEntry& entry = find_solver(name);
    if (std::none_of(solvers.begin(), solvers.end(),
                     [&](const ComparedSolver& s) { return s.name == name; }))
      solvers.push_back({entry.name, entry.law, entry.make});
  }
  return solvers;
}

std::vector<ComparedSolver> external_solvers(const std::vector<std::string>& words,
                                             const ExternalLimits& limits) {
  std::vector<ComparedSolver> solvers;
  for (const ExternalCommand& command : external_commands(words)) {
    for (const SolverEntry& entry : solver_list())
      if (command.name == entry.name)
        throw std::invalid_argument(command.name + ": is the name of one of Ballast's solvers");
    solvers.push_back(
        {command.name, ContactLaw::coulomb, external_solver(command, limits), key_of(command)});
  }
  return solvers;
}

std::vector<double> parse_tolerances(const std::string& list) {
  std::vector<double> tolerances;
  for (const std::string& word : words_of(list, "numbers > 0")) {
    const double value = parsed<double>(word).value_or(-1.0);
    if (!(value > 0.0) || !std::isfinite(value))
      throw std::invalid_argument("'" + word + "': expected a number > 0");
    tolerances.push_back(value);
  }
  std::sort(tolerances.begin(), tolerances.end(), std::greater<>());
  tolerances.erase(std::unique(tolerances.begin(), tolerances.end()), tolerances.end());
  return tolerances;
}

std::vector<long> parse_counts(const std::string& list, long most) {
  const std::string expected = "whole numbers from 1 to " + std::to_string(most);
  std::vector<long> counts;
  for (const std::string& word : words_of(list, expected)) {
    const long count = parsed<long>(word).value_or(0);
    if (count < 1 || count > most)
      throw std::invalid_argument("'" + word + "': expected " + expected + ", separated by commas");
    counts.push_back(count);
  }
  return counts;
}

std::vector<StartKind> parse_starts(const std::string& list) {
  std::vector<StartKind> starts;
  for (const std::string& word : words_of(list, "cold or warm"))
    if (const StartKind start = start_of(word);
        std::find(starts.begin(), starts.end(), start) == starts.end())
      starts.push_back(start);
  return starts;
}

}  // namespace ballast
