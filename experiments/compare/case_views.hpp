#pragma once
// Where in a packing backends are wrong: pages in 3D of a comparison's captured cases.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "experiments/compare/comparison.hpp"

namespace ballast {

/// The page of a case in the comparison's folder: "views/run-step_0000200.html".
std::filesystem::path view_page_of(const std::string& case_name);

/// Writes the page of every case whose bodies are known, with all of its backends that gave an
/// answer, after 1, 3, 10, ... 1000 iterations; a solve ends after the comparison's limit of time.
/// A page that is there stays. `goes_on` is asked before each. Returns how many there are now.
/// Throws Error.
size_t write_case_views(std::span<const CompareRow> rows, const CompareOptions& options,
                        const std::function<bool()>& goes_on);

}  // namespace ballast
