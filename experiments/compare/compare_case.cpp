#include "experiments/compare/compare_case.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <type_traits>
#include <utility>

#include <Eigen/Eigenvalues>

#include "experiments/measure/curve_fit.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/made_problems.hpp"
#include "problems/files/captured_problem.hpp"
#include "problems/files/problem_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// With more rows a dense eigenvalue problem takes longer than some of the solves.
constexpr int most_rows_for_eigenvalues = 1000;

/// Returns CaseFacts::content, a hash of all bits of the problem, its start and its scale.
std::string content_of(const FrictionProblem& problem, const Impulses& start, double scale) {
  std::uint64_t hash = fnv1a("");
  // of each list first its number of bytes, then its bytes
  const auto add_one = [&](const auto& list) {
    const size_t bytes = static_cast<size_t>(list.size()) * sizeof(*list.data());
    hash = fnv1a({reinterpret_cast<const char*>(&bytes), sizeof bytes}, hash);
    hash = fnv1a({reinterpret_cast<const char*>(list.data()), bytes}, hash);
  };
  const auto add = [&](const auto&... lists) { (..., add_one(lists)); };
  add(problem.row_begin, problem.friction);
  const DynamicsForm& d = problem.dynamics;
  if (problem.has_dynamics) add(d.dof_begin, d.mass, d.body_a, d.body_b, d.h, d.v_free, d.bias);
  if (problem.has_delassus) {
    const SparseRows& w = problem.delassus.w;
    add(std::span(w.outerIndexPtr(), static_cast<size_t>(w.outerSize() + 1)),
        std::span(w.innerIndexPtr(), static_cast<size_t>(w.nonZeros())),
        std::span(w.valuePtr(), static_cast<size_t>(w.nonZeros())), problem.delassus.q);
  }
  add(start, std::span(&scale, 1));
  return hash_text(hash);
}

double rank_deficiency(const FrictionProblem& problem, int touched_dofs) {
  const int rows = problem.row_count();
  if (rows == 0) return 0.0;
  if (rows <= most_rows_for_eigenvalues) {
    const Eigen::MatrixXd w = Eigen::MatrixXd(delassus_matrix(problem));
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                                       0.5 * (w + w.transpose()), Eigen::EigenvaluesOnly)
                                       .eigenvalues();
    const double least = 1e-10 * values.cwiseAbs().maxCoeff();
    return 1.0 - static_cast<double>((values.array() > least).count()) / rows;
  }
  if (!problem.has_dynamics) return not_known;
  return std::max(0.0, 1.0 - static_cast<double>(touched_dofs) / rows);
}

/// Bodies that a contact touches; none where only W is known.
std::set<int> touched_bodies(const FrictionProblem& problem) {
  std::set<int> touched;
  if (!problem.has_dynamics) return touched;
  for (const std::vector<int>* bodies : {&problem.dynamics.body_a, &problem.dynamics.body_b})
    for (const int body : *bodies)
      if (body >= 0) touched.insert(body);
  return touched;
}

/// The largest over the smallest mass, or lambda_max(W_cc), of those > 0; 1 without any.
double mass_ratio(const FrictionProblem& problem, const std::set<int>& touched) {
  std::vector<double> sizes;
  // the mass is its block's first entry: translations come first
  for (const int body : touched)
    sizes.push_back(problem.dynamics.mass[static_cast<size_t>(problem.dynamics.mass_begin[body])]);
  std::vector<Eigen::Matrix3d> blocks;
  if (!problem.has_dynamics) delassus_diagonal(problem, blocks);
  for (const Eigen::Matrix3d& block : blocks) sizes.push_back(largest_eigenvalue(block));
  std::erase_if(sizes, [](double size) { return !(size > 0.0); });
  if (sizes.empty()) return 1.0;
  const auto [least, most] = std::ranges::minmax(sizes);
  return most / least;
}

LoadedCase load_captured(const fs::path& file) {
  const auto captured = std::make_shared<CapturedProblem>(read_captured(file));
  LoadedCase loaded = load_case(captured->problem, captured->velocity_scale(), captured->start);
  loaded.describe_contact = [captured](int c) {
    if (c < 0) return std::string();
    const size_t k = static_cast<size_t>(c);
    return printed("contact %d (bodies %d and %d, gap %.3g µm)", c, captured->id_a[k],
                   captured->id_b[k], 1e6 * captured->gap[k]);
  };
  return loaded;
}

/// Loads a file's problem, and its reference if there is one.
LoadedCase load_file(const fs::path& file) {
  if (!path_exists(file)) throw Error(file.string() + ": no such file");
  LoadedCase loaded = is_captured(file) ? load_captured(file) : load_case(read_problem(file));
  if (const fs::path answer = reference_of(file); path_exists(answer))
    loaded.exact = read_solution(answer, loaded.problem);
  return loaded;
}

CompareCase file_case(const fs::path& file) {
  CompareCase made{.name = file.filename().string(),
                   .family = family_of_file(file.filename().string()),
                   .load = [file] { return load_file(file); },
                   .word = file.string()};
  try {
    if (!is_captured(file)) return made;
    // the run's folder is above its capture/
    fs::path folder = fs::absolute(file).lexically_normal().parent_path();
    if (folder.filename() == "capture") folder = folder.parent_path();
    const std::string run = folder.filename().string(), phase = read_captured(file).phase;
    made.name = run + "/" + file.stem().string();
    made.family = run + (phase == "none" ? "" : ", " + phase);
    made.has_bodies = true;
  } catch (const std::exception&) {
    // load() throws for a file that cannot be read: it is one row, and the others go on.
  }
  return made;
}

// Problems made on the spot: with known solutions, piles, and those that break solvers.

/// "kind:what,name=value,...". Every setting must be taken before finish().
class MadeWord {
 public:
  explicit MadeWord(const std::string& word) : word_(word) {
    for (const std::string& item : split(word.substr(word.find(':') + 1), ',')) {
      const size_t equals = item.find('=');
      if (equals == std::string::npos) {
        if (!what_.empty()) fail(item + ": expected name=value");
        what_ = item;
        continue;
      }
      const double value = parsed<double>(item.substr(equals + 1)).value_or(-1.0);
      if (!(value >= 0.0 && value <= 1e9)) fail(item + ": expected a number from 0 to 1e9");
      values_[item.substr(0, equals)] = value;  // the last of repeated settings holds
    }
  }

  const std::string& text() const { return word_; }
  /// The item without a value; empty: none.
  const std::string& what() const { return what_; }

  /// Sets `value` if the word gives it. Counts are at most a million by default.
  template <typename Number>
  void take(const char* name, Number& value, double least = 0.0,
            double most = std::is_integral_v<Number> ? 1e6 : 1e9) {
    const auto taken = values_.extract(name);
    if (!taken) return;
    const double given = taken.mapped();
    if (given < least) fail(std::string(name) + ": too small");
    if (given > most) fail(name + printed(": at most %.10g", most));
    value = static_cast<Number>(std::is_integral_v<Number> ? std::round(given) : given);
  }
  /// Throws Error if a setting was not taken: there is no such setting.
  void finish() const {
    if (!values_.empty())
      fail(values_.begin()->first + ": no such setting; see ballast compare --help");
  }
  [[noreturn]] void fail(const std::string& what) const { throw Error(word_ + ": " + what); }

 private:
  std::string word_, what_;
  std::map<std::string, double> values_;
};

/// Adds as many cases as the word says, each with the next seed and a word that makes it alone.
template <typename Settings, typename Make>
void add_seeded(MadeWord& word, Settings settings, const Make& make,
                std::vector<CompareCase>& cases) {
  int count = 1;
  settings.seed = 1;
  word.take("count", count, 1);
  word.take("seed", settings.seed, 0.0, 1e9);
  word.finish();
  for (; count > 0; --count, ++settings.seed) {
    cases.push_back(make(settings));
    cases.back().word = word.text() + (word.text().ends_with(':') ? "" : ",") +
                        "count=1,seed=" + std::to_string(settings.seed);
  }
}

template <typename Settings>
void take_friction(MadeWord& word, Settings& settings) {
  word.take("friction_min", settings.friction_min);
  settings.friction_max = std::max(settings.friction_min, settings.friction_max);
  word.take("friction_max", settings.friction_max, settings.friction_min);
}

void add_known_cases(MadeWord word, std::vector<CompareCase>& cases) {
  if (!word.what().empty()) word.fail(word.what() + ": expected name=value");
  KnownSolutionSettings settings;
  word.take("bodies", settings.bodies, 2);
  word.take("contacts", settings.contacts, 1);
  word.take("mass_ratio", settings.mass_ratio, 1.0);
  take_friction(word, settings);
  word.take("open", settings.open_fraction, 0.0, 1.0);
  settings.slip_fraction = std::min(settings.slip_fraction, 1.0 - settings.open_fraction);
  word.take("slip", settings.slip_fraction, 0.0, 1.0 - settings.open_fraction);
  word.take("frictionless", settings.frictionless_fraction, 0.0, 1.0);
  word.take("copies", settings.copies, 1);
  const auto make = [](const KnownSolutionSettings& s) {
    return CompareCase{printed("known-b%d-c%dx%d-R%g-s%llu", s.bodies, s.contacts, s.copies,
                               s.mass_ratio, static_cast<unsigned long long>(s.seed)),
                       "known", [s] { return load_case(make_known_solution(s).problem); }};
  };
  add_seeded(word, settings, make, cases);
}

/// "pile-c120-d0.4-R1000-f0.2..0.7-a0.8-s3", with "-w" at the end where only W is stored.
CompareCase pile_case(const PileSettings& s) {
  const char* size = s.contacts < 20 ? "small" : s.contacts < 150 ? "mid" : "large";
  return {printed("pile-c%d-d%.2g-R%.2g-f%.2g..%.2g-a%.2g-s%llu%s", s.contacts, s.redundancy,
                  s.mass_ratio, s.friction_min, s.friction_max, s.active,
                  static_cast<unsigned long long>(s.seed), s.is_stored ? "-w" : ""),
          std::string("pile, ") + size, [s] { return load_case(make_pile(s)); }};
}

/// pile: takes every setting from the word. pile:family draws all of them from successive seeds.
void add_piles(MadeWord word, std::vector<CompareCase>& cases) {
  PileSettings settings;
  if (word.what() == "family") {
    settings.contacts = 1000;  // the most
    word.take("contacts", settings.contacts, 2);
    const auto make = [](const PileSettings& s) {
      return pile_case(random_pile(s.seed, s.contacts));
    };
    add_seeded(word, settings, make, cases);
    return;
  }
  if (!word.what().empty()) word.fail(word.what() + ": expected family or name=value");
  word.take("contacts", settings.contacts, 1);
  word.take("redundancy", settings.redundancy);
  if (settings.redundancy >= 1.0) word.fail("redundancy: expected a number below 1");
  word.take("mass_ratio", settings.mass_ratio, 1.0);
  take_friction(word, settings);
  word.take("active", settings.active, 0.0, 1.0);
  word.take("slenderness", settings.slenderness, 1e-3);
  word.take("shear", settings.shear);
  word.take("mass_unit", settings.mass_unit, 1e-9);
  word.take("stored", settings.is_stored, 0, 1);
  add_seeded(word, settings, pile_case, cases);
}

void add_stress_cases(MadeWord word, std::vector<CompareCase>& cases) {
  if (word.what() != "all") word.fail("expected stress:all");
  word.finish();
  for (const StressProblem& stress : stress_problems()) {
    // the manufactured ones have no gravity
    const double scale = stress.family == "manufactured" ? 0.0 : made_gravity_step;
    const auto load = [problem = stress.problem, scale] { return load_case(problem, scale); };
    cases.push_back({"stress-" + stress.name, "stress " + stress.family, load, word.text()});
  }
}

}  // namespace

fs::path reference_of(const fs::path& problem_file) {
  const fs::path file = fs::absolute(problem_file).lexically_normal(), family = file.parent_path();
  return family.parent_path().parent_path() / "references" / family.filename() /
         file.filename().replace_extension(".exact");
}

std::string family_of_file(const std::string& file_name) {
  std::string family = file_name.substr(0, file_name.find_first_of("-."));
  family.erase(family.find_last_not_of("0123456789_") + 1);
  return family.empty() ? file_name : family;
}

std::vector<CompareCase> compare_cases(const std::vector<std::string>& words) {
  std::vector<CompareCase> cases;
  for (const std::string& word : words) {
    const auto begins = [&](const char* kind) { return word.starts_with(kind); };
    const auto add = begins("known:")    ? add_known_cases
                     : begins("pile:")   ? add_piles
                     : begins("stress:") ? add_stress_cases
                                         : nullptr;
    if (add)
      add(MadeWord(word), cases);
    else
      for (const FoundProblem& found : find_problems(word)) cases.push_back(file_case(found.file));
  }
  std::map<std::string, int> seen;
  for (CompareCase& c : cases)
    if (const int count = ++seen[c.name]; count > 1) c.name += " (" + std::to_string(count) + ")";
  return cases;
}

LoadedCase load_case(FrictionProblem problem, double velocity_scale, Impulses warm_start) {
  problem.validate();
  // the judge's velocity scale is the rms of q; a problem at rest (q = 0) has none
  if (!(velocity_scale > 0.0))
    velocity_scale = contact_error(problem, Impulses::Zero(problem.row_count())).velocity_scale;
  if (!(velocity_scale > 0.0)) velocity_scale = 1.0;
  LoadedCase loaded;
  loaded.problem = std::move(problem);
  loaded.warm_start = std::move(warm_start);
  CaseFacts& facts = loaded.facts;
  facts.contacts = loaded.problem.contact_count();
  facts.rows = loaded.problem.row_count();
  const std::set<int> touched = touched_bodies(loaded.problem);
  for (const int body : touched) facts.dofs += loaded.problem.dynamics.body_dofs(body);
  facts.rank_deficiency = rank_deficiency(loaded.problem, facts.dofs);
  facts.mass_ratio = mass_ratio(loaded.problem, touched);
  facts.velocity_scale = velocity_scale;
  facts.content = content_of(loaded.problem, loaded.warm_start, velocity_scale);
  loaded.describe_contact = [](int c) {
    return c < 0 ? std::string() : "contact " + std::to_string(c);
  };
  return loaded;
}

}  // namespace ballast
