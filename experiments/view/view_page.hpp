#pragma once

#include <filesystem>

#include "experiments/page/page.hpp"
#include "experiments/view/view_data.hpp"

namespace ballast {

/// The most bytes of a replay in a page: frames and contacts are thinned out until it fits.
inline constexpr size_t replay_bytes = 12u << 20;

/// Packs the data of a replay, without picture and caption; experiments/page/replay/data.js reads
/// them. If they would be more than `most_bytes` in the page, every second, fourth, ... frame is
/// packed (the first and the last always), and the contacts of every second, ... of these frames.
/// Throws std::invalid_argument without a frame.
page::Replay pack_view(const ViewData& view, size_t most_bytes = replay_bytes);

/// Returns a view as a part of a page: its data, a still picture of its first frame, and a caption
/// that says how to use it.
page::Replay replay_of(const ViewData& view);

/// Writes the view as a page of its own, first beside `file`, then renamed to it. Throws Error.
void write_view_page(const ViewData& view, const std::filesystem::path& file);

}  // namespace ballast
