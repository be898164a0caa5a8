#pragma once
// Writes a page as one HTML file that opens offline: nothing is loaded from elsewhere. Scripts
// stand only in a replay and at the end of a page that answers.

#include <filesystem>
#include <string>
#include <string_view>

#include "experiments/page/page.hpp"

namespace ballast::page {

/// The whole page, figures inlined.
std::string html_of(const Page& page);
/// The same as a file, which is there whole or not at all. Throws Error.
void write_html_file(const std::filesystem::path& file, const Page& page);

/// One part of it. A replay has its data and the script that draws it.
std::string html_of(const Text& text);
std::string html_of(const Block& block);

/// & < > " ' become entities; what clean_utf8 refuses becomes U+FFFD.
std::string escaped_html(std::string_view text);

/// A figure's SVG for inlining: without XML declaration, doctype and comments, with ids of its own
/// (`name` before each), and `title` for screen readers.
std::string inline_svg(std::string_view svg, const std::string& name, const std::string& title);

/// Is the library that draws built in (Chart.js)?
bool can_answer();

}  // namespace ballast::page
