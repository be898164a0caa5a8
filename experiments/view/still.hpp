#pragma once
// Pictures without a display: bodies in their box, as PNG files.

#include <string>
#include <vector>

#include "experiments/view/view_data.hpp"

namespace ballast {

/// How a still picture is taken.
struct StillOptions {
  double yaw = -52.0, pitch = 20.0;  ///< from where one looks [degrees]
  int width = 960, height = 640;     ///< [pixels]
  bool with_chains = false;          ///< force chains; bodies are glass then
  bool operator==(const StillOptions&) const = default;
};

/// From the words of the command line: "home", "x", "-x", "y", "-y", "z", or "<yaw>,<pitch>" in
/// degrees. Throws std::invalid_argument.
void set_view(StillOptions& options, const std::string& word);

/// A PNG of one frame: bodies with the sun's shadow and dark edges, walls as glass, the load as an
/// arrow. Colours say how fast grains are, on one scale for all frames of the view; of a view of a
/// single frame how large. Several frames: a picture that moves in every
/// browser (an animated PNG), a tenth of a second each.
std::string still_png(const ViewData& view, const std::vector<size_t>& frames,
                      const StillOptions& options);

}  // namespace ballast
