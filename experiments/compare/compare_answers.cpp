#include "experiments/compare/compare_answers.hpp"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "experiments/compare/backend_summary.hpp"
#include "experiments/compare/case_views.hpp"
#include "experiments/compare/compare_table.hpp"
#include "platform/atomic_file.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {

std::string comparison_file(const std::string& name);  // of experiments/compare/answers

namespace {

using Json = nlohmann::ordered_json;

/// In the order in which they build upon each other.
constexpr std::array modules = {"rows.js",      "statistics.js", "asks.js",      "views.js",
                                "histories.js", "details.js",    "comparison.js"};

/// Points of all histories together: what a page can hold.
constexpr size_t most_points = 25000;

/// Of a row, as far as the options of the comparison are known; names in braces are filled in by
/// the page.
std::string again(const RunData& data, const CompareRow& row) {
  std::string command =
      "ballast compare {case} --solvers {solver} --tolerances {tolerance} --starts {start} "
      "--measure " +
      std::string(name_of(row.measure)) + printed(" --max-seconds %g", row.max_seconds);
  if (data.manifest().contains("/summary/memory_MB"_json_pointer))
    command += printed(" --memory %g", data.manifest()["summary"]["memory_MB"].get<double>());
  return command + " --output results/again";
}

/// Least error so far: seconds and error by turns, four digits each.
Json history_json(const CompareRow& row, size_t limit) {
  StepCurve best = best_so_far(row);
  thin_out(best.x, best.y, limit);
  Json flat = Json::array();
  for (size_t k = 0; k < best.x.size(); ++k)
    for (const double value : {best.x[k], best.y[k]})
      flat.push_back(parsed_number(printed("%.4g", value)).value_or(0.0));
  return flat;
}

}  // namespace

page::Answers comparison_answers(const RunData& data, std::span<const CompareRow> rows,
                                 double limit) {
  Json json = {{"measure", name_of(rows[0].measure)},
               {"limit", limit},
               {"shift", summary_shift},
               {"again", again(data, rows[0])}};
  // `views`: where the bodies of a case are known its page in 3D, empty where none was asked for
  Json columns = Json::array(), cells = Json::array(), words = Json::object(),
       histories = Json::object(), views = Json::object();
  for (const CompareColumn& column : compare_columns())
    columns.push_back({column.name, column.description});
  const size_t points = std::clamp<size_t>(most_points / rows.size(), 8, 100);
  for (const CompareRow& row : rows) {
    Json line = Json::array();
    for (const CompareColumn& column : compare_columns()) line.push_back(column.text(row));
    cells.push_back(std::move(line));
    words[row.case_name] = shell_word(row.word.empty() ? row.case_name : row.word);
    if (row.can_view) {
      const std::filesystem::path page = view_page_of(row.case_name);
      views[row.case_name] = is_there(data.folder / page) ? page.string() : "";
    }
    if (row.history.size() > 1) histories[row.key] = history_json(row, points);
  }
  // only now: a member that is added moves the others
  for (const auto& [name, part] : {std::pair("columns", &columns),
                                   {"rows", &cells},
                                   {"words", &words},
                                   {"histories", &histories},
                                   {"views", &views}})
    json[name] = std::move(*part);
  page::Answers answers{.are_given = true};
  answers.data = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (const char* name : modules) answers.modules.push_back(comparison_file(name));
  return answers;
}

}  // namespace ballast
