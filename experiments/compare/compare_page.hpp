#pragma once
// The page of a comparison, compare.html, with its figures as SVG and PDF beside it.

#include <filesystem>
#include <span>

#include "experiments/compare/compare_row.hpp"
#include "experiments/compare/reference_times.hpp"

namespace ballast {

/// Reads manifest.json of `folder`; writes figures/*.svg and compare.html there. Without
/// gnuplot the page has the tables alone and says so. Throws Error.
void write_compare_page(const std::filesystem::path& folder, std::span<const CompareRow> rows,
                        std::span<const ReferenceTimes> reference);

}  // namespace ballast
