#include "experiments/compare/compare_case.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include <Eigen/Eigenvalues>

#include "experiments/measure/curve_fit.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/files/captured_problem.hpp"
#include "problems/files/problem_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// Above it a dense eigenvalue problem takes longer than some of the solves.
constexpr int most_rows_for_eigenvalues = 1000;

/// A hash goes on over plain numbers, led by how many bytes they are.
void add_to_hash(std::uint64_t& hash, const void* data, size_t bytes) {
  hash = fnv1a(std::string_view(reinterpret_cast<const char*>(&bytes), sizeof bytes), hash);
  hash = fnv1a(std::string_view(static_cast<const char*>(data), bytes), hash);
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

/// Largest over smallest of what is > 0; 1 without any.
double mass_ratio(const FrictionProblem& problem, const std::set<int>& touched) {
  double least = HUGE_VAL, most = 0.0;
  const auto look_at = [&](double value) {
    if (!(value > 0.0)) return;
    least = std::min(least, value);
    most = std::max(most, value);
  };
  // a block's first entry: translations come first
  for (const int body : touched)
    look_at(problem.dynamics.mass[static_cast<size_t>(problem.dynamics.mass_begin[body])]);
  if (!problem.has_dynamics) {
    std::vector<Eigen::Matrix3d> blocks;
    delassus_diagonal(problem, blocks);
    for (const Eigen::Matrix3d& block : blocks) look_at(largest_eigenvalue(block));
  }
  return most > 0.0 ? most / least : 1.0;
}

LoadedCase load_captured(const fs::path& file) {
  const auto captured = std::make_shared<CapturedProblem>(read_captured(file));
  LoadedCase loaded;
  loaded.problem = captured->problem;
  loaded.warm_start = captured->start;
  loaded.facts = case_facts(loaded.problem, loaded.warm_start, captured->velocity_scale());
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

std::string content_of(const FrictionProblem& problem, const Impulses& start, double scale) {
  std::uint64_t hash = fnv1a("");
  const auto add = [&](const auto&... lists) {
    (...,
     add_to_hash(hash, lists.data(), static_cast<size_t>(lists.size()) * sizeof(*lists.data())));
  };
  add(problem.row_begin, problem.friction);
  const DynamicsForm& d = problem.dynamics;
  if (problem.has_dynamics) add(d.dof_begin, d.mass, d.body_a, d.body_b, d.h, d.v_free, d.bias);
  if (problem.has_delassus) {
    const SparseRows& w = problem.delassus.w;
    add(std::span(w.outerIndexPtr(), static_cast<size_t>(w.outerSize() + 1)),
        std::span(w.innerIndexPtr(), static_cast<size_t>(w.nonZeros())),
        std::span(w.valuePtr(), static_cast<size_t>(w.nonZeros())), problem.delassus.q);
  }
  add(start);
  add_to_hash(hash, &scale, sizeof scale);
  return hash_text(hash);
}

LoadedCase load_case(FrictionProblem problem, double velocity_scale) {
  problem.validate();
  LoadedCase loaded;
  loaded.problem = std::move(problem);
  // what the judge calls velocity scale: the rms of q
  if (!(velocity_scale > 0.0))
    velocity_scale =
        contact_error(loaded.problem, Impulses::Zero(loaded.problem.row_count())).velocity_scale;
  loaded.facts = case_facts(loaded.problem, {}, velocity_scale);
  loaded.describe_contact = [](int c) {
    return c < 0 ? std::string() : "contact " + std::to_string(c);
  };
  return loaded;
}

CaseFacts case_facts(const FrictionProblem& problem, const Impulses& warm_start,
                     double velocity_scale) {
  problem.validate();
  CaseFacts facts;
  facts.contacts = problem.contact_count();
  facts.rows = problem.row_count();
  const std::set<int> touched = touched_bodies(problem);
  for (const int body : touched) facts.dofs += problem.dynamics.body_dofs(body);
  facts.rank_deficiency = rank_deficiency(problem, facts.dofs);
  facts.mass_ratio = mass_ratio(problem, touched);
  // a problem at rest (q = 0) has no scale of its own
  facts.velocity_scale = velocity_scale > 0.0 ? velocity_scale : 1.0;
  facts.content = content_of(problem, warm_start, facts.velocity_scale);
  return facts;
}

}  // namespace ballast
