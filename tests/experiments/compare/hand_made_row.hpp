#pragma once
// Rows made by hand: cases whose name begins with x have 10 contacts, others 20.

#include "experiments/compare/compare_row.hpp"

namespace ballast {

inline CompareRow hand_made_row(const char* case_name, const char* solver, double seconds,
                                Verdict verdict, int repeat = 0) {
  CompareRow r;
  r.case_name = case_name;
  r.family = "hand";
  r.solver = solver;
  r.law = "coulomb";
  r.tolerance = 1e-4;
  r.repeat = repeat;
  r.max_seconds = 60.0;
  r.verdict = verdict;
  r.solve_seconds = seconds;
  r.error = verdict == Verdict::solved ? 5e-5 : 1e-2;
  r.judged.natural_map_rms = r.error;
  r.facts.contacts = case_name[0] == 'x' ? 10 : 20;
  r.facts.mass_ratio = case_name[0] == 'x' ? 2.0 : 5.0;
  r.worst = "contact 3 <of> two";
  r.history = {{0, 0.0, 1.0}, {1, 0.5 * seconds, 1e-2}, {2, seconds, r.error}};
  return r;
}

}  // namespace ballast
