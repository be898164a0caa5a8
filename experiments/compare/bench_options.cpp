#include "experiments/compare/bench_options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

std::vector<std::string> words_of(const std::string& list, const char* what) {
  std::vector<std::string> words;
  for (size_t begin = 0; begin <= list.size();) {
    const size_t end = std::min(list.find(',', begin), list.size());
    words.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  for (const std::string& word : words)
    if (word.empty())
      throw std::invalid_argument("'" + list + "': expected " + what + ", separated by commas");
  return words;
}

}  // namespace

std::vector<BenchSolver> bench_solvers(const std::string& list) {
  std::vector<BenchSolver> solvers;
  if (list == "all") {
    for (const SolverEntry& entry : solver_list())
      if (entry.make) solvers.push_back({entry.name, entry.law, entry.make});
    return solvers;
  }
  for (const std::string& name : words_of(list, "names of solvers")) {
    make_solver(name);  // says what is wrong with a name
    const SolverEntry& entry = find_solver(name);
    if (std::none_of(solvers.begin(), solvers.end(),
                     [&](const BenchSolver& s) { return s.name == name; }))
      solvers.push_back({entry.name, entry.law, entry.make});
  }
  return solvers;
}

std::vector<double> bench_tolerances(const std::string& list) {
  std::vector<double> tolerances;
  for (const std::string& word : words_of(list, "numbers > 0")) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !(value > 0.0) ||
        !std::isfinite(value))
      throw std::invalid_argument("'" + word + "': expected a number > 0");
    tolerances.push_back(value);
  }
  std::sort(tolerances.begin(), tolerances.end(), std::greater<>());
  tolerances.erase(std::unique(tolerances.begin(), tolerances.end()), tolerances.end());
  return tolerances;
}

std::vector<StartKind> bench_starts(const std::string& list) {
  std::vector<StartKind> starts;
  for (const std::string& word : words_of(list, "cold or warm"))
    if (const StartKind start = start_of(word);
        std::find(starts.begin(), starts.end(), start) == starts.end())
      starts.push_back(start);
  return starts;
}

}  // namespace ballast
