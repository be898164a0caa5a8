#pragma once

#include "experiments/page/page.hpp"
#include "experiments/view/view_data.hpp"

namespace ballast {

/// So much of a page may be a replay [bytes]: frames and contacts are thinned out until it is.
inline constexpr size_t replay_bytes = 12u << 20;

/// The data of a replay for a page, without picture and caption. replay.md beside the page's
/// scripts says what each part holds. Where all would be more than `most_bytes` in the page, every
/// second, fourth, ... frame is packed (the first and the last always), then the contacts of every
/// second, ... of these. Throws std::invalid_argument without a frame.
page::Replay pack_view(const ViewData& view, size_t most_bytes = replay_bytes);

/// Every `stride`-th of `count`, and the last.
std::vector<size_t> thinned(size_t count, size_t stride);

}  // namespace ballast
