#pragma once
// The public table of a collection's comparison, as a page and as rows.

#include <filesystem>
#include <span>

#include "experiments/compare/ranking.hpp"

namespace ballast {

/// Writes into `folder`, whose manifest.json says who made the rows:
///   index.html   the order of the backends, the held part apart; each family; how far the order
///                holds; what each backend fails on; the families
///   ranking.md   the same
///   table.csv    a line for each part (open, held), family or size, tolerance, start and backend
/// Throws Error.
void write_ranking(const std::filesystem::path& folder, std::span<const CompareRow> rows);

}  // namespace ballast
