#pragma once
// Draws the figures of a page: the one way for every page.

#include <filesystem>
#include <string>

#include "experiments/page/page.hpp"

namespace ballast::page {

/// Where figures stand, beside the page's file.
inline constexpr const char* picture_folder = "figures";

/// What is left beside the page for each figure; the SVG always is.
struct Drawing {
  bool with_pdf = true;     ///< for papers
  bool with_script = true;  ///< gnuplot's script, which holds the data
  bool on_white = false;    ///< the SVG as a file has a white ground: for pages that show the file
  std::string command =
      {};  ///< named where gnuplot is missing: "ballast report RUN" draws them later
};

/// Draws every picture of `page` into folder/figures and fills its svg. Pictures without panels are
/// dropped silently; what gnuplot cannot draw is dropped and becomes one of the page's notices, and
/// without gnuplot one notice stands for all. Throws Error when `folder` cannot be written.
void draw_pictures(Page& page, const std::filesystem::path& folder, const Drawing& drawing = {});

}  // namespace ballast::page
