#pragma once
// Tables of the comparison's page that say what came of every case under every backend, and why.

#include <span>

#include "experiments/compare/compare_table.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// Milliseconds or seconds; a dash for what is not finite.
page::Text time_of(double seconds);

/// Case by backend: the time, or why there is none and how near it came.
page::Table matrix_table(const CompareTable& table);

/// Claims that the judge denies, crashes, memory, what is not taken, and whatever left a note.
page::Table failures_table(std::span<const CompareRow> rows);

/// Cases that could not be had, and why.
page::Table unreadable_table(std::span<const CompareRow> unreadable);

}  // namespace ballast
