#pragma once

#include <filesystem>

#include "experiments/page/page.hpp"
#include "experiments/view/view_data.hpp"

namespace ballast {

/// A view as a part of a page: its data, a still picture of its first frame, and words about what
/// can be done with it.
page::Replay replay_of(const ViewData& view);

/// A page of its own. Written beside and renamed. Throws Error.
void write_view_page(const ViewData& view, const std::filesystem::path& file);

}  // namespace ballast
