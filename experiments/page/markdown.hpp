#pragma once
// Writes a page as Markdown (GitHub's), with its figures as files beside it. Pages that are written
// so have no headings within sections, no listings and no replays: std::logic_error.

#include <string>

#include "experiments/page/page.hpp"

namespace ballast::page {

std::string markdown_of(const Page& page);

/// One part of it. Characters that Markdown would take for marks are escaped.
std::string markdown_of(const Text& text);
std::string markdown_of(const Block& block);

}  // namespace ballast::page
