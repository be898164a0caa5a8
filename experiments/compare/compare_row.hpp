#pragma once
// One solve of a comparison and its outcome: the row of every table and figure.

#include <span>
#include <string>
#include <vector>

#include "experiments/compare/compare_case.hpp"
#include "problems/algebra/answer_distance.hpp"
#include "problems/algebra/contact_error.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

/// The measure that a tolerance bounds.
enum class Measure {
  natural_map,  ///< the judge's, scaled, rms over contacts, over the case's velocity scale
  fclib,        ///< ContactError::fclib: what Siconos prints
};
enum class StartKind { cold, warm };

const char* name_of(Measure measure);
const char* name_of(StartKind start);
/// Throw std::invalid_argument that lists the names.
Measure measure_of(const std::string& name);
StartKind start_of(const std::string& name);

constexpr const char* not_tried = "not tried: ";

struct CompareRow {
  // the attempt
  std::string key, case_name, family, solver, law;
  std::string word;       ///< of the command line, for the case alone; in no file
  bool can_view = false;  ///< `ballast view WORD --solver SOLVER` shows where the answer is wrong
  Measure measure = Measure::natural_map;
  double tolerance = 0.0;
  StartKind start = StartKind::cold;
  int repeat = 0;
  double max_seconds = 60.0;  ///< the limit of prepare and solve without the start-up [s]
  CaseFacts facts;

  // reported by the process that solved
  std::string reason;  ///< the backend's StopReason; empty where it reported none
  std::string note;    ///< why it failed; begins with not_tried where a looser tolerance timed out
  int iterations = 0;
  int runs = 0;  ///< solves in the child; the times are those of the fastest
  double prepare_seconds = 0.0, solve_seconds = 0.0;
  /// Not part of the other times: making the solver, starting processes, bringing the problem into
  /// a foreign library's form and judging its answers on the way.
  double startup_seconds = 0.0;
  double peak_memory_MB = 0.0;
  /// The backend's own errors: scaled natural map rms, over the case's velocity scale. The seconds
  /// are those of solve() without its start-up.
  std::vector<HistoryPoint> history;

  // found by the judge, in another process
  /// Over the time limit it is `timeout`, whether the case is solved or not.
  Verdict verdict = Verdict::crashed;
  double error = 0.0;   ///< in the row's measure
  ContactError judged;  ///< files store only some of its measures
  std::string worst;    ///< contact of natural_map_max
  /// The distance from a solution at 1e-9, velocities over the case's velocity scale. Where no
  /// solution is known, it is NaN, and statuses is -1.
  AnswerDistance distance;

  double seconds() const { return prepare_seconds + solve_seconds; }
};

/// The columns of the CSV; the members of the JSON have the same names.
std::vector<std::string> compare_columns();
/// Returns a row's cells, one for each column; numbers have six digits.
std::vector<std::string> cells_of(const CompareRow& row);

/// All rows without their histories; fields with commas or quotes are quoted.
std::string compare_csv(std::span<const CompareRow> rows);

/// Convert a row with its history to JSON and back. Numbers keep their bits; NaN and infinity are
/// null. Members that are in no file are those of `row`. Throws Error naming `file`.
std::string to_json(const CompareRow& row);
CompareRow compare_row_of_json(const std::string& text, const std::string& file,
                               CompareRow row = {});

}  // namespace ballast
