#pragma once

#include <string>

#include "experiments/view/raster.hpp"
#include "experiments/view/view_data.hpp"

namespace ballast {

/// How a still picture is taken.
struct StillOptions {
  double yaw = -52.0, pitch = 20.0;  ///< from where one looks [degrees]
  int width = 960, height = 640;     ///< [pixels]
  std::string colour = "speed";      ///< speed, displacement, size or none
  bool with_chains = false;          ///< force chains; bodies are glass then
};

/// From the words of the command line: "home", "x", "-x", "y", "-y", "z", or "<yaw>,<pitch>" in
/// degrees. Throws std::invalid_argument.
void set_view(StillOptions& options, const std::string& word);
/// Throws std::invalid_argument for a colour that there is not.
void set_colour(StillOptions& options, const std::string& word);

/// So many rows and columns are drawn for each of the picture's.
inline constexpr int still_finer = 2;

/// One frame, drawn without a display and finer than asked for: bodies with the sun's shadow and
/// dark edges, walls as glass, the load as an arrow. Colours are scaled as over all frames.
Picture3 still_picture(const ViewData& view, size_t frame, const StillOptions& options);
/// The same as PNG.
std::string still_png(const ViewData& view, size_t frame, const StillOptions& options);

}  // namespace ballast
