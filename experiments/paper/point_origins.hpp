#pragma once
// What a click on a point of the paper's page opens: the runs that it is the mean of.

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/paper/sections.hpp"

namespace ballast {

/// The JSON object of page::Answers for the origins of all figures' points: of each run its page,
/// from `folder` on, or where none is written the command that does it.
std::string origins_of_points(const PaperData& data, const std::vector<PaperSection>& sections,
                              const std::filesystem::path& folder);

}  // namespace ballast
