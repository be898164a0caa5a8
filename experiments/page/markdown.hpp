#pragma once
// Writes a page as Markdown (GitHub's), with its figures as files beside it. Such a page cannot
// have headings within sections, listings or replays: they throw std::logic_error.

#include <string>

#include "experiments/page/page.hpp"

namespace ballast::page {

std::string markdown_of(const Page& page);

/// The Markdown of one part of a page. Characters that Markdown would take for marks are escaped.
std::string markdown_of(const Text& text);
std::string markdown_of(const Block& block);

}  // namespace ballast::page
