#pragma once
// Figures (gnuplot, SVG) and one HTML page that opens offline, from a run's folder.

#include <filesystem>

namespace ballast {

/// Reads steps.csv (or the record) and manifest.json of `folder`; writes figures/*.svg and
/// report.html, each beside and renamed. Without gnuplot the page says so and has the table alone.
/// Throws Error when there is no record.
void write_report(const std::filesystem::path& folder);

}  // namespace ballast
