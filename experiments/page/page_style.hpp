#pragma once

#include <string>

namespace ballast::page {

/// The style sheet of every page (CSS): light, dark and print; colours of the figures' SVG mapped
/// to the page's palette.
std::string style_sheet();

/// style.css, built into the program: light, dark and print.
std::string light_and_dark();

}  // namespace ballast::page
