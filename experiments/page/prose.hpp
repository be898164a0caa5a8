#pragma once
// Prose in text files: experiments/<room>/texts/*.md are built into the program (ballast_texts of
// CMake), one paragraph under each headline, in the notation of text.hpp:
//
//   # fig3.caption
//   **Paper, Fig. 3.** Displacement *x* of the wall. Here it first goes in by {size}.
//
//   run_page_text("fig3.caption", {{"size", page::quantity(1e3 * size, "mm")}})

#include <initializer_list>
#include <map>
#include <string>
#include <string_view>

#include "experiments/page/text.hpp"

namespace ballast::page {

class Prose {
 public:
  /// Contents of the files. A paragraph's lines are joined by spaces, an empty line in it is a line
  /// break. Throws std::logic_error when a name occurs twice, or words stand before a headline.
  explicit Prose(std::initializer_list<std::string_view> files);

  /// The paragraph with its values filled in. Throws std::logic_error when there is none of that
  /// name, and as marked() does.
  Text operator()(const std::string& name, const Values& values = {}) const;

 private:
  std::map<std::string, std::string> paragraphs_;
};

}  // namespace ballast::page
