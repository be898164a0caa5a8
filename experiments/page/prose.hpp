#pragma once
// Prose in text files: experiments/<room>/texts/*.md are built into the program (ballast_texts of
// CMake), one entry under each headline, in the notation of text.hpp:
//
//   # fig3.found
//   Displacement *x* of the wall. Here it first goes in by {size}.
//
//   page::words("fig3.found", {{"size", page::quantity(1e3 * size, "mm")}})

#include <initializer_list>
#include <map>
#include <string>
#include <string_view>

#include "experiments/page/text.hpp"

namespace ballast::page {

class Prose {
 public:
  /// Contents of the files. An entry's lines are joined by spaces, an empty line in it is a line
  /// break. Throws std::logic_error when a name occurs twice, or words stand before a headline.
  explicit Prose(std::initializer_list<std::string_view> files);

  /// The entry with its values filled in; values that it does not name are left out. Throws
  /// std::logic_error when there is no entry of that name, and as marked() does.
  Text operator()(const std::string& name, const Values& values = {}) const;

 private:
  std::map<std::string, std::string> entries_;
};

/// All text files of the program together: a name stands once in all rooms.
const Prose& prose();
inline Text words(const std::string& name, const Values& values = {}) {
  return prose()(name, values);
}

}  // namespace ballast::page
