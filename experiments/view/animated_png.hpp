#pragma once
// Pictures one after the other in a file that every browser plays: an animated PNG.

#include <vector>

#include "experiments/view/raster.hpp"

namespace ballast {

/// Adds up what colours pictures have, and chooses at most `most` that stand for all: the widest
/// group of colours is split at its median, again and again (Heckbert 1982).
std::vector<std::array<std::uint8_t, 3>> palette_of(const std::vector<std::string>& pictures,
                                                    size_t most);

/// Pictures of equal size as 256 colours of all, played for ever, each for `milliseconds`.
/// `shrink`: so many rows and columns become one. Throws std::invalid_argument without a picture.
std::string animated_png(const std::vector<Picture3>& pictures, int shrink, int milliseconds);

}  // namespace ballast
