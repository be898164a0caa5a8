#include "experiments/compare/case_views.hpp"

#include <algorithm>
#include <map>

#include "experiments/compare/compare_figures.hpp"
#include "experiments/view/problem_view.hpp"
#include "experiments/view/view_page.hpp"
#include "platform/atomic_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

struct ViewedCase {
  std::string file;
  std::vector<std::string> backends;  ///< in the order of their rows
};

/// What crashed once would take this process with it.
bool gave_an_answer(const CompareRow& row) {
  return row.verdict == Verdict::solved || row.verdict == Verdict::unsolved ||
         row.verdict == Verdict::denied || row.verdict == Verdict::timeout;
}

}  // namespace

fs::path view_page_of(const std::string& case_name) {
  return fs::path("views") / (figure_name(case_name) + ".html");
}

size_t write_case_views(std::span<const CompareRow> rows, const CompareOptions& options,
                        const std::function<bool()>& goes_on) {
  std::map<std::string, ViewedCase> cases;
  for (const CompareRow& row : rows) {
    if (!row.can_view || !gave_an_answer(row)) continue;
    ViewedCase& viewed = cases[row.case_name];
    viewed.file = row.word;
    if (std::find(viewed.backends.begin(), viewed.backends.end(), row.solver) ==
        viewed.backends.end())
      viewed.backends.push_back(row.solver);
  }
  size_t count = 0;
  for (const auto& [name, viewed] : cases) {
    if (!goes_on()) break;
    const fs::path page = options.folder / view_page_of(name);
    ++count;
    if (is_there(page)) continue;
    create_folder(page.parent_path());
    write_view_page(
        view_of_problem(viewed.file, {.backends = viewed.backends,
                                      .is_warm = options.starts.front() == StartKind::warm,
                                      .max_seconds = options.max_seconds}),
        page);
  }
  return count;
}

}  // namespace ballast
