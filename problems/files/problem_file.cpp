#include "problems/files/problem_file.hpp"

#include <glob.h>

#include <algorithm>

#include "platform/atomic_file.hpp"
#include "problems/files/captured_problem.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

constexpr const char* suffixes = "(.hdf5, .h5, .dat)";

std::vector<fs::path> matches(const std::string& pattern) {
  glob_t found{};
  std::vector<fs::path> files;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
    for (size_t k = 0; k < found.gl_pathc; ++k) files.emplace_back(found.gl_pathv[k]);
  globfree(&found);
  return files;
}

void add_problems(const fs::path& path, std::vector<FoundProblem>& problems) {
  if (!is_folder(path)) {
    if (!is_problem_file(path)) throw Error(path.string() + ": is no problem file " + suffixes);
    problems.push_back({path, path.filename()});
    return;
  }
  const auto before = static_cast<std::ptrdiff_t>(problems.size());
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path))
    if (entry.is_regular_file() && is_problem_file(entry.path()))
      problems.push_back({entry.path(), entry.path().lexically_relative(path)});
  if (problems.size() == static_cast<size_t>(before))
    throw Error(path.string() + ": no problem file " + suffixes + " in this folder");
  std::ranges::sort(problems.begin() + before, problems.end(), {}, &FoundProblem::file);
}

}  // namespace

bool is_problem_file(const fs::path& file) {
  const std::string suffix = file.extension().string();
  return suffix == ".hdf5" || suffix == ".h5" || suffix == ".dat";
}

FrictionProblem read_problem(const fs::path& file) {
  if (!is_problem_file(file)) throw Error(file.string() + ": is no problem file " + suffixes);
  // A captured problem has the exact dynamics form beside the FCLIB one.
  if (is_captured(file)) return read_captured(file).problem;
  try {
    FrictionProblem problem =
        file.extension() == ".dat" ? read_siconos_text(file) : read_fclib(file);
    problem.validate();
    return problem;
  } catch (const InvalidProblem& error) {
    throw Error(file.string() + ": " + error.what());
  }
}

std::vector<FoundProblem> find_problems(const std::string& word) {
  std::vector<FoundProblem> problems;
  const bool is_pattern = word.find_first_of("*?[") != std::string::npos;
  if (path_exists(word) || (!is_pattern && is_problem_file(word))) {
    add_problems(word, problems);
    return problems;
  }
  for (const fs::path& match : matches(word)) add_problems(match, problems);
  if (problems.empty())
    throw Error(
        word + ": no such file, folder or pattern; made cases begin with known:, pile: or stress:");
  return problems;
}

}  // namespace ballast
