#include "experiments/compare/compare_case.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "experiments/view/problem_view.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/files/captured_problem.hpp"
#include "problems/files/problem_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

LoadedCase load_captured(const fs::path& file) {
  const auto captured = std::make_shared<CapturedProblem>(read_captured(file));
  LoadedCase loaded;
  loaded.problem = captured->problem;
  loaded.warm_start = captured->start;
  loaded.facts = case_facts(loaded.problem, loaded.warm_start, captured->velocity_scale());
  loaded.h = captured->h;
  loaded.phase = captured->phase;
  loaded.describe_contact = [captured](int c) {
    if (c < 0) return std::string();
    const size_t k = static_cast<size_t>(c);
    return printed("contact %d (bodies %d and %d, gap %.3g µm)", c, captured->id_a[k],
                   captured->id_b[k], 1e6 * captured->gap[k]);
  };
  return loaded;
}

/// The run's folder, which is above its capture/.
std::string run_of_captured(const fs::path& file) {
  fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  if (folder.filename() == "capture") folder = folder.parent_path();
  return folder.filename().string();
}

CompareCase stored_case(const fs::path& file) {
  return {file.filename().string(), family_of_file(file.filename().string()), [file] {
            if (!is_there(file)) throw Error(file.string() + ": no such file");
            return load_case(read_problem(file));
          }};
}

CompareCase captured_case(const fs::path& file) {
  const CapturedProblem captured = read_captured(file);
  const std::string run = run_of_captured(file);
  return {.name = run + "/" + file.stem().string(),
          .family = run + (captured.phase == "none" ? "" : ", " + captured.phase),
          .load = [file] { return load_captured(file); },
          .has_bodies = true};
}

/// What cannot be read says so when it is loaded: it is one row, and the others go on.
CompareCase file_case(const fs::path& file) {
  try {
    if (is_there(file) && is_captured(file)) return captured_case(file);
  } catch (const std::exception&) {
  }
  return stored_case(file);
}

void add_file_cases(const std::string& word, std::vector<CompareCase>& cases) {
  std::vector<fs::path> files;
  for (const FoundProblem& found : find_problems(word)) files.push_back(found.file);
  for (const fs::path& file : files) {
    cases.push_back(file_case(file));
    cases.back().word = file.string();
  }
}

/// Equal names: the place in the list decides.
void make_names_unique(std::vector<CompareCase>& cases) {
  std::map<std::string, int> seen;
  for (CompareCase& c : cases)
    if (const int count = ++seen[c.name]; count > 1) c.name += " (" + std::to_string(count) + ")";
}

}  // namespace

std::string family_of_file(const std::string& file_name) {
  std::string family = file_name.substr(0, file_name.find('-'));
  family = family.substr(0, family.find('.'));
  while (!family.empty() &&
         (std::isdigit(static_cast<unsigned char>(family.back())) || family.back() == '_'))
    family.pop_back();
  return family.empty() ? file_name : family;
}

std::vector<CompareCase> compare_cases(const std::vector<std::string>& words) {
  std::vector<CompareCase> cases;
  for (const std::string& word : words) {
    if (is_made_case(word))
      add_made_cases(word, cases);
    else
      add_file_cases(word, cases);
  }
  make_names_unique(cases);
  return cases;
}

}  // namespace ballast
