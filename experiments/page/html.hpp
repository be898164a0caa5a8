#pragma once
// Writes a page as one HTML file that opens offline: nothing is loaded from elsewhere. Only replays
// and the ends of pages with answers (page.hpp) have scripts.

#include <filesystem>
#include <string>
#include <string_view>

#include "experiments/page/page.hpp"

namespace ballast::page {

/// The whole page, with its figures inlined.
std::string html_of(const Page& page);
/// Writes the page as a file, whole or not at all. Throws Error.
void write_html_file(const std::filesystem::path& file, const Page& page);

/// The HTML of one part of a page. A replay includes its data and the script that draws it.
std::string html_of(const Text& text);
std::string html_of(const Block& block);

/// Replaces & < > " ' by entities, and everything that clean_utf8 refuses by U+FFFD.
std::string escaped_html(std::string_view text);

/// A figure's SVG for inlining: without XML declaration, doctype and comments, with `name` before
/// every id, so that ids differ between figures, and with `title` for screen readers.
std::string inline_svg(std::string_view svg, const std::string& name, const std::string& title);

/// Returns whether the library that draws charts (Chart.js) is built in.
bool has_chart_library();

}  // namespace ballast::page
