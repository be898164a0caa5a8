#pragma once

#include <optional>

#include "experiments/measure/run_data.hpp"
#include "experiments/view/view_data.hpp"

namespace ballast {

/// What there is to see of a run: stored frames, forces where the record has them, and the wall's
/// curves; without a driven wall the energy's. Nothing where no pose is stored. Throws Error on a
/// damaged record.
std::optional<ViewData> view_of_run(const RunData& run);

}  // namespace ballast
