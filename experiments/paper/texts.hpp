#pragma once

#include <string>

#include "experiments/page/prose.hpp"

namespace ballast {

/// A paragraph of this room's texts/*.md, where introductions, what the paper says and what was
/// found stand. Throws std::logic_error as page::Prose does.
page::Text paper_text(const std::string& name, const page::Values& values = {});

}  // namespace ballast
