#include "experiments/compare/outcome_tables.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace ballast {
namespace {

/// Why a row is not solved, in a few words.
std::string reason_of(const CompareRow& row) {
  switch (row.verdict) {
    case Verdict::denied:
      return "denied";
    case Verdict::timeout:
      return row.reason.empty() ? "killed" : "time limit";
    case Verdict::crashed:
      return "crashed";
    case Verdict::out_of_memory:
      return "memory";
    case Verdict::unsupported:
      return "not taken";
    case Verdict::no_solution:
      return "no solution";
    default:
      break;
  }
  std::string reason = row.reason.empty() ? "failed" : row.reason;
  std::replace(reason.begin(), reason.end(), '_', ' ');
  return reason;
}

}  // namespace

page::Text time_of(double seconds) {
  if (!std::isfinite(seconds)) return {"–", page::note};
  if (seconds < 1e-4) return page::quantity(1e6 * seconds, "µs");
  return seconds < 1.0 ? page::quantity(1e3 * seconds, "ms") : page::quantity(seconds, "s");
}

page::Table matrix_table(const CompareTable& table) {
  page::Table result;
  result.head = {"case"};
  result.is_number = {false};
  for (const std::string& solver : table.solvers) {
    result.head.push_back(page::Text(solver, page::code));
    result.is_number.push_back(true);
  }
  for (size_t c = 0; c < table.cases.size(); ++c) {
    std::vector<page::Text> line = {table.cases[c]};
    for (const CompareCell& cell : table.cells[c]) {
      if (!cell.row) {
        line.emplace_back();
      } else if (cell.solved) {
        line.push_back(time_of(cell.median));
      } else {
        page::Text why(reason_of(*cell.row), page::bad);
        if (std::isfinite(cell.row->error)) why = why + (" " + page::number(cell.row->error, 1));
        line.push_back(why);
      }
    }
    result.rows.push_back(std::move(line));
  }
  return result;
}

page::Table failures_table(std::span<const CompareRow> rows) {
  page::Table result;
  result.head = {"case", "backend", "tolerance", "what happened", "error"};
  result.is_number = {false, false, true, false, true};
  // What a backend does not take says why once.
  std::set<std::string> told;
  for (const CompareRow& row : rows) {
    const bool is_denied = row.verdict == Verdict::denied;
    const bool died = row.verdict == Verdict::crashed || row.verdict == Verdict::out_of_memory;
    const bool is_noted = row.verdict == Verdict::unsolved || row.verdict == Verdict::timeout;
    const bool is_refused =
        row.verdict == Verdict::unsupported && told.insert(row.solver + row.note).second;
    const bool has_none =
        row.verdict == Verdict::no_solution && told.insert(row.case_name + row.note).second;
    if (!died && !is_denied && !is_refused && !has_none && (row.note.empty() || !is_noted))
      continue;
    const std::string what =
        is_denied ? std::string("claims success, ") +
                        (row.note.empty() ? "the judge denies it" : row.note)
                  : std::string(name_of(row.verdict)) + (row.note.empty() ? "" : ": " + row.note);
    result.rows.push_back(
        {row.case_name, row.solver, page::exact(row.tolerance), what, page::number(row.error, 2)});
  }
  return result;
}

page::Table unreadable_table(std::span<const CompareRow> unreadable) {
  page::Table result;
  result.head = {"case", "why it could not be read"};
  result.is_number = {false, false};
  for (const CompareRow& row : unreadable) result.rows.push_back({row.case_name, row.note});
  return result;
}

}  // namespace ballast
