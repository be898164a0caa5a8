#pragma once

#include <string>

#include "experiments/page/prose.hpp"

namespace ballast {

/// A paragraph of this room's texts/*.md, where captions and introductions of a run's page stand.
/// Throws std::logic_error as page::Prose does.
page::Text run_page_text(const std::string& name, const page::Values& values = {});

}  // namespace ballast
