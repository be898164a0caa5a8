#pragma once
// How both pages of `ballast compare` begin and end: what made them, from the folder's manifest.

#include <filesystem>

#include "experiments/measure/run_data.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// manifest.json of a folder. Throws Error: missing, no JSON object.
RunData read_origin(const std::filesystem::path& folder);

/// What a comparison noted of its options in the manifest.
page::Table options_table(const RunData& data);

/// Says on `page` which program and machine made it, draws its figures into figures/ beside `file`,
/// and writes it there as HTML. Throws Error.
void write_with_origin(page::Page page, const RunData& data, const std::filesystem::path& file);

}  // namespace ballast
