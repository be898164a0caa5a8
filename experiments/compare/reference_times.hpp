#pragma once
// Times that others reached on the same problems, beside ours.

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "experiments/compare/compare_table.hpp"

namespace ballast {

/// One tolerance of a reference file.
struct ReferenceTimes {
  double tolerance = 0.0;
  struct Entry {
    double seconds = not_reached;  ///< infinite: nobody solved it
    std::string solver = {};
  };
  std::map<std::string, Entry> entries;  ///< by problem_stem()
};

/// A file's name without what formats and conversions append: "CubeH8-condensed.dat", "CubeH8.hdf5"
/// -> "CubeH8".
std::string problem_stem(std::string name);

/// CSV with the header problem,ms_<tolerance>,solver_<tolerance>[,...]: milliseconds, empty where
/// nobody got there. Throws Error naming file and line.
std::vector<ReferenceTimes> read_reference_times(const std::filesystem::path& file);

/// Ours beside theirs at one tolerance, cold starts.
struct ReferenceComparison {
  double tolerance = 0.0;
  struct Line {
    std::string case_name, their_solver, our_solver;
    double theirs = 0.0, ours = 0.0;  ///< [s]; ours: our fastest; infinite when we did not solve it
    double automatic = 0.0;           ///< of the solver `auto` [s]; NaN when it was not tried
  };
  std::vector<Line> lines;             ///< problems that both have
  std::vector<std::string> only_ours;  ///< solved here, by nobody there
  std::vector<std::string> missing;    ///< not solved here

  /// Shifted geometric mean of (our fastest / theirs), or of (auto / theirs). Unsolved problems
  /// count with `limit` seconds: nobody gains by failing. NaN without lines, or without auto.
  double ratio(double shift, double limit, bool of_auto) const;
};

/// For each reference tolerance that the comparison has. Adapters to Siconos (siconos_*) are not
/// ours.
std::vector<ReferenceComparison> compare_with_reference(std::span<const CompareTable> tables,
                                                        std::span<const ReferenceTimes> reference);

}  // namespace ballast
