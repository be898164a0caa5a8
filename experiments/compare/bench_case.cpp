#include "experiments/compare/bench_case.hpp"

#include <glob.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <map>

#include "problems/captured_problem.hpp"
#include "problems/contact_error.hpp"
#include "problems/known_solutions.hpp"
#include "problems/problem_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

bool is_problem_file(const fs::path& file) {
  const std::string extension = file.extension().string();
  return extension == ".hdf5" || extension == ".h5" || extension == ".dat";
}

std::string contact_number(int c) { return "contact " + std::to_string(c); }

LoadedCase load_captured(const fs::path& file) {
  const auto captured = std::make_shared<CapturedProblem>(read_captured(file));
  LoadedCase loaded;
  loaded.problem = captured->problem;
  loaded.warm_start = captured->start;
  loaded.facts = case_facts(loaded.problem, loaded.warm_start, captured->velocity_scale());
  loaded.describe_contact = [captured](int c) {
    if (c < 0) return std::string();
    const size_t k = static_cast<size_t>(c);
    char text[96];
    std::snprintf(text, sizeof text, "contact %d (bodies %d and %d, gap %.2g m)", c, captured->id_a[k], captured->id_b[k],
                  captured->gap[k]);
    return std::string(text);
  };
  return loaded;
}

/// Errors of a problem without gravity and step are relative to the rms of q: what the judge calls its velocity scale.
LoadedCase loaded_case(FrictionProblem problem) {
  problem.validate();
  LoadedCase loaded;
  loaded.problem = std::move(problem);
  const double scale = contact_error(loaded.problem, Impulses::Zero(loaded.problem.row_count())).velocity_scale;
  loaded.facts = case_facts(loaded.problem, {}, scale);
  loaded.describe_contact = [](int c) { return c < 0 ? std::string() : contact_number(c); };
  return loaded;
}

/// The run's folder, which is above its capture/.
std::string run_of_captured(const fs::path& file) {
  fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  if (folder.filename() == "capture") folder = folder.parent_path();
  return folder.filename().string();
}

BenchCase file_case(const fs::path& file) {
  if (!is_captured(file))
    return {file.filename().string(), family_of_file(file.filename().string()),
            [file] { return loaded_case(read_problem(file)); }};
  const CapturedProblem captured = read_captured(file);
  const std::string run = run_of_captured(file);
  return {run + "/" + file.stem().string(), run + (captured.phase == "none" ? "" : ", " + captured.phase),
          [file] { return load_captured(file); }};
}

std::vector<fs::path> matches(const std::string& pattern) {
  glob_t found{};
  std::vector<fs::path> files;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
    for (size_t k = 0; k < found.gl_pathc; ++k) files.emplace_back(found.gl_pathv[k]);
  globfree(&found);
  return files;
}

void add_files(const fs::path& path, std::vector<fs::path>& files) {
  if (!fs::is_directory(path)) {
    files.push_back(path);
    return;
  }
  const size_t before = files.size();
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path))
    if (entry.is_regular_file() && is_problem_file(entry.path())) files.push_back(entry.path());
  if (files.size() == before) throw BenchCaseError(path.string() + ": no problem file (.hdf5, .h5, .dat) in this folder");
  std::sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
}

void add_file_cases(const std::string& word, std::vector<BenchCase>& cases) {
  std::vector<fs::path> files;
  if (fs::exists(word)) {
    add_files(word, files);
  } else {
    for (const fs::path& match : matches(word)) add_files(match, files);
    if (files.empty()) throw BenchCaseError(word + ": no such file, folder or pattern; made cases begin with known:");
  }
  for (const fs::path& file : files) {
    if (!is_problem_file(file)) throw BenchCaseError(file.string() + ": is no problem file (.hdf5, .h5, .dat)");
    cases.push_back(file_case(file));
  }
}

/// The settings of a manufactured problem by the names that a word may use.
struct KnownName {
  const char* name;
  std::function<void(KnownSolutionSettings&, double)> set;
};

const std::vector<KnownName>& known_names() {
  using S = KnownSolutionSettings;
  static const std::vector<KnownName> names = {
      {"bodies", [](S& s, double v) { s.bodies = static_cast<int>(v); }},
      {"contacts", [](S& s, double v) { s.contacts = static_cast<int>(v); }},
      {"mass_ratio", [](S& s, double v) { s.mass_ratio = v; }},
      {"friction_min", [](S& s, double v) { s.friction_min = v; }},
      {"friction_max", [](S& s, double v) { s.friction_max = v; }},
      {"open", [](S& s, double v) { s.open_fraction = v; }},
      {"slip", [](S& s, double v) { s.slip_fraction = v; }},
      {"frictionless", [](S& s, double v) { s.frictionless_fraction = v; }},
      {"seed", [](S& s, double v) { s.seed = static_cast<std::uint64_t>(v); }},
  };
  return names;
}

double number_of(const std::string& word, const std::string& item, std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0.0) || !(value <= 1e9))
    throw BenchCaseError(word + ": " + item + ": expected a number from 0 to 1e9");
  return value;
}

void add_known_cases(const std::string& word, std::vector<BenchCase>& cases) {
  KnownSolutionSettings settings;
  double count = 1.0;
  std::string rest = word.substr(word.find(':') + 1);
  while (!rest.empty()) {
    const std::string item = rest.substr(0, rest.find(','));
    rest.erase(0, item.size() + 1);
    const std::string name = item.substr(0, item.find('='));
    const double value = number_of(word, item, std::string_view(item).substr(std::min(item.size(), name.size() + 1)));
    const auto found = std::find_if(known_names().begin(), known_names().end(), [&](const KnownName& n) { return n.name == name; });
    if (found != known_names().end()) found->set(settings, value);
    else if (name == "count") count = value;
    else throw BenchCaseError(word + ": " + item + ": no such setting; see ballast compare --help");
  }
  if (settings.bodies < 2 || settings.contacts < 1 || count < 1.0)
    throw BenchCaseError(word + ": at least 2 bodies, 1 contact and a count of 1");
  for (int k = 0; k < static_cast<int>(count); ++k, ++settings.seed) {
    char name[96];
    std::snprintf(name, sizeof name, "known-b%d-c%d-R%g-s%llu", settings.bodies, settings.contacts, settings.mass_ratio,
                  static_cast<unsigned long long>(settings.seed));
    cases.push_back({name, "known", [settings] { return loaded_case(make_known_solution(settings).problem); }});
  }
}

/// Equal names: the place in the list decides.
void make_names_unique(std::vector<BenchCase>& cases) {
  std::map<std::string, int> seen;
  for (BenchCase& c : cases)
    if (const int count = ++seen[c.name]; count > 1) c.name += " (" + std::to_string(count) + ")";
}

}  // namespace

std::string family_of_file(const std::string& file_name) {
  std::string family = file_name.substr(0, file_name.find('-'));
  family = family.substr(0, family.find('.'));
  while (!family.empty() && (std::isdigit(static_cast<unsigned char>(family.back())) || family.back() == '_'))
    family.pop_back();
  return family.empty() ? file_name : family;
}

std::vector<BenchCase> bench_cases(const std::vector<std::string>& words) {
  std::vector<BenchCase> cases;
  for (const std::string& word : words) {
    if (word.rfind("known:", 0) == 0) add_known_cases(word, cases);
    else add_file_cases(word, cases);
  }
  make_names_unique(cases);
  return cases;
}

}  // namespace ballast
