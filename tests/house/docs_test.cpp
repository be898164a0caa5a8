// What the docs quote is what the files say.

#include <sstream>

#include "tests/catch.hpp"
#include "tests/house/source_tree.hpp"

using namespace ballast::house;

TEST_CASE("what docs/adding_a_solver.md quotes is what the files say") {
  std::istringstream lines(content(root() / "docs" / "adding_a_solver.md"));
  std::string file, quotation;
  bool inside = false;
  int quotations = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!inside) {  // the last file that was named before a block is the one quoted
      for (size_t at = line.find("`solvers/"); at != std::string::npos;
           at = line.find("`solvers/", at + 1))
        file = line.substr(at + 1, line.find('`', at + 1) - at - 1);
      inside = line == "```cpp" || line == "```cmake";
      quotation.clear();
    } else if (line == "```") {
      inside = false;
      ++quotations;
      INFO(file << ":\n" << quotation);
      CHECK(content(root() / file).find(quotation) != std::string::npos);
    } else {
      quotation += line + "\n";
    }
  }
  CHECK(quotations >= 8);
}
