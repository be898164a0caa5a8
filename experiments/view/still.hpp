#pragma once
// Draws pictures without a display: bodies in their box, as PNG files.

#include <string>
#include <vector>

#include "experiments/view/view_data.hpp"

namespace ballast {

/// How a still picture is taken.
struct StillOptions {
  double yaw = -52.0, pitch = 20.0;  ///< direction towards the eye [degrees]
  int width = 960, height = 640;     ///< [pixels]
  bool with_chains = false;          ///< draws force chains, and the bodies as glass
  bool operator==(const StillOptions&) const = default;
};

/// Sets yaw and pitch from a word of the command line: "home", "x", "-x", "y", "-y", "z", or
/// "<yaw>,<pitch>" in degrees. Throws std::invalid_argument.
void set_view(StillOptions& options, const std::string& word);

/// Draws one frame as a PNG: bodies with the sun's shadow and dark edges, walls as glass, the load
/// as an arrow. Colours show the speed of grains, on one scale for all frames of the view, or their
/// size in a view of a single frame. Several frames become an animated PNG, which moves in every
/// browser, with a tenth of a second for each.
std::string still_png(const ViewData& view, const std::vector<size_t>& frames,
                      const StillOptions& options);

}  // namespace ballast
