#pragma once
// The words of compare's pages: paragraphs of texts/*.md by name, built into the program.

#include "experiments/page/prose.hpp"

namespace ballast {

page::Text compare_text(const std::string& name, const page::Values& values = {});

}  // namespace ballast
