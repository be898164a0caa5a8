#pragma once
// What one solve of a comparison was and what came of it: the row of every table and figure.

#include <span>
#include <string>
#include <vector>

#include "experiments/compare/compare_case.hpp"
#include "problems/algebra/answer_distance.hpp"
#include "problems/algebra/contact_error.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

/// What a tolerance bounds.
enum class Measure {
  natural_map,  ///< the judge's scaled natural map, rms over contacts, relative to the case's
                ///< velocity scale
  fclib,        ///< ContactError::fclib: what Siconos prints
};
enum class StartKind { cold, warm };

const char* name_of(Measure measure);
const char* name_of(StartKind start);
/// Throw std::invalid_argument listing what there is.
Measure measure_of(const std::string& name);
StartKind start_of(const std::string& name);

constexpr const char* not_tried = "not tried: ";

struct CompareRow {
  // what was tried
  std::string key, case_name, family, solver, law;
  // of the command line, for the case alone; in no file
  std::string word;
  bool can_view = false;  ///< `ballast view WORD --solver SOLVER` shows where the answer is wrong
  Measure measure = Measure::natural_map;
  double tolerance = 0.0;
  StartKind start = StartKind::cold;
  int repeat = 0;
  double max_seconds = 60.0;  ///< the limit of prepare and solve, start-up apart
  CaseFacts facts;

  // what the process that solved says
  std::string reason;  ///< the backend's StopReason; empty when none was heard
  std::string note;    ///< why it failed; begins with not_tried where a looser tolerance took all
  int iterations = 0;
  int runs = 0;  ///< solves in the child, of which the fastest is timed here
  double prepare_seconds = 0.0, solve_seconds = 0.0;
  /// In none of the others: making the solver, starting processes, bringing the problem into a
  /// foreign library's form and judging its answers on the way.
  double startup_seconds = 0.0;
  double peak_memory_MB = 0.0;
  /// Errors as the backend has them: scaled natural map rms, over the case's velocity scale.
  /// Seconds are of solve(), start-up apart.
  std::vector<HistoryPoint> history;

  // what the judge says, in another process
  /// Over the time limit it is `timeout`, be it solved or not.
  Verdict verdict = Verdict::crashed;
  double error = 0.0;   ///< in the row's measure
  ContactError judged;  ///< of which files know some measures alone
  std::string worst;    ///< contact of natural_map_max
  /// From a solution at 1e-9, velocities over the case's velocity scale; where none is known NaN,
  /// and statuses -1.
  AnswerDistance distance;

  double seconds() const { return prepare_seconds + solve_seconds; }
};

/// The columns of the CSV; the members of the JSON have the same names.
std::vector<std::string> compare_columns();
/// A row's cells, a column each; numbers in six digits.
std::vector<std::string> cells_of(const CompareRow& row);

/// All rows without their histories; fields with commas or quotes are quoted.
std::string compare_csv(std::span<const CompareRow> rows);

/// A row as JSON with its history, and back: bits of numbers kept, NaN and infinity as null; what
/// is in no file is that of `row`. Throws Error naming `file`.
std::string to_json(const CompareRow& row);
CompareRow compare_row_of_json(const std::string& text, const std::string& file,
                               CompareRow row = {});

}  // namespace ballast
