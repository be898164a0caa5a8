#pragma once

#include <filesystem>

#include "experiments/page/page.hpp"
#include "experiments/view/view_data.hpp"

namespace ballast {

/// So much of a page may be a replay [bytes]: frames and contacts are thinned out until it is.
inline constexpr size_t replay_bytes = 12u << 20;

/// The data of a replay, without picture and caption; experiments/page/replay/data.js reads them.
/// Where all would be more than `most_bytes` in the page, every second, fourth, ... frame is packed
/// (the first and the last always), then the contacts of every second, ... of these. Throws
/// std::invalid_argument without a frame.
page::Replay pack_view(const ViewData& view, size_t most_bytes = replay_bytes);

/// A view as a part of a page: its data, a still picture of its first frame, and words about what
/// can be done with it.
page::Replay replay_of(const ViewData& view);

/// A page of its own. Written beside and renamed. Throws Error.
void write_view_page(const ViewData& view, const std::filesystem::path& file);

}  // namespace ballast
