#include "problems/files/captured_problem.hpp"

#include "platform/text.hpp"
#include "problems/files/fclib_file.hpp"

namespace ballast {
namespace {

const std::string side_group = "/ballast";

std::string path_of(const char* name) { return side_group + "/" + name; }

/// Reads members and names the one that is wrong.
struct SideReader {
  Hdf5Reader file;

  template <typename Value>
  void operator()(const char* name, std::vector<Value>& to, std::size_t size) const {
    to = file.read<Value>(path_of(name), size);
  }
  void operator()(const char* name, std::vector<double>& to, std::size_t size) const {
    to = read_vector(file, path_of(name), size);
  }
  void operator()(const char* name, Eigen::VectorXd& to, std::size_t size) const {
    to = as_eigen(read_vector(file, path_of(name), size));
  }
  void operator()(const char* name, double& to) const {
    to = file.read<double>(path_of(name), 1)[0];
  }
  void operator()(const char* name, int& to) const { to = file.read_int(path_of(name)); }
  void operator()(const char* name, std::string& to) const { to = file.read_text(path_of(name)); }
};

/// Writes members, and the arrays that divide M and H into bodies and rows.
struct SideWriter {
  Hdf5Writer& file;

  template <typename Numbers>
  void operator()(const char* name, const Numbers& numbers, std::size_t = 0) const {
    file.add(path_of(name), numbers);
  }
  void operator()(const char* name, double value) const { (*this)(name, std::vector{value}); }
  void operator()(const char* name, int value) const { (*this)(name, std::vector{value}); }
  void operator()(const char* name, const std::string& text) const {
    file.add_text(path_of(name), text);
  }
};

/// Reads how M and H divide into bodies and rows, checked against their sizes.
Division read_division(const SideReader& side, const GlobalProblem& global) {
  Division division;
  std::vector<int>& begin = division.dof_begin;
  begin = side.file.read<int>(path_of("dof_begin"));
  // All are checked before the first block is taken: ascending to M's rows, they stay within M.
  bool fits = !begin.empty() && begin.front() == 0 && begin.back() == global.m.rows();
  for (std::size_t b = 0; fits && b + 1 < begin.size(); ++b)
    fits = begin[b] < begin[b + 1] && begin[b + 1] - 6 <= begin[b];
  if (!fits)
    side.file.fail(path_of("dof_begin") +
                   " does not divide the unknowns of M into bodies of 1 to 6");
  const std::size_t contacts = global.mu.size();
  side("body_a", division.body_a, contacts);
  side("body_b", division.body_b, contacts);
  side("rows", division.rows, contacts);
  for (std::size_t c = 0; c < contacts; ++c) {
    if (division.rows[c] != 1 && division.rows[c] != 3)
      side.file.fail(path_of("rows") + "[" + std::to_string(c) + "] is neither 1 nor 3");
    const int last = std::max(division.body_a[c], division.body_b[c]);
    if (last >= static_cast<int>(begin.size()) - 1)
      side.file.fail(path_of("body_a") + ", body_b: no such body: " + std::to_string(last));
  }
  return division;
}

/// Checks the step and gravity, which scale the tolerances: values that would make any answer
/// right, or none, are refused.
void require_scales(const Hdf5Reader& file, const CapturedProblem& captured) {
  constexpr double longest_step = 1e6, fastest = 1e3;  // [s], [m/s]
  const auto words = [](double x) { return printed("%.6g", x); };
  if (!(captured.h > 0.0) || !(captured.h <= longest_step))
    file.fail(path_of("h") + " = " + words(captured.h) + " s; a step is > 0 and at most " +
              words(longest_step) + " s long");
  if (!(captured.g >= 0.0) || !(captured.velocity_scale() <= fastest))
    file.fail(path_of("g") + " = " + words(captured.g) + " m/s^2: g h must be from 0 to " +
              words(fastest) + " m/s");
  if (captured.g > 0.0 && captured.velocity_scale() < smallest_scale)
    file.fail(path_of("g") + " = " + words(captured.g) + " m/s^2: g h is " +
              words(captured.velocity_scale()) + " m/s, too small to measure by");
}

}  // namespace

bool is_captured(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension != ".hdf5" && extension != ".h5") return false;
  try {
    return Hdf5Reader(file).has(side_group);
  } catch (const Error&) {
    return false;
  }
}

CapturedProblem read_captured(const std::filesystem::path& path) {
  // M, H, w and mu from the FCLIB part; how they divide into bodies and rows from the side group.
  const SideReader side{Hdf5Reader(path)};
  if (!side.file.has("/fclib_global"))
    side.file.fail("has no global problem: " + side_group + " belongs beside one");
  const GlobalProblem global = read_global(side.file);
  CapturedProblem captured;
  captured.problem = divided(global, read_division(side, global));
  side("v_free", captured.problem.dynamics.v_free, static_cast<std::size_t>(global.m.rows()));
  try {
    captured.problem.validate();
  } catch (const InvalidProblem& error) {
    side.file.fail(error.what());
  }
  each_member(captured, side);
  require_scales(side.file, captured);
  return captured;
}

void write_captured(const std::filesystem::path& file, const CapturedProblem& captured) {
  captured.problem.validate();
  if (!captured.problem.has_dynamics)
    throw InvalidProblem(file.string() + ": only a dynamics form can be captured");
  const DynamicsForm& dynamics = captured.problem.dynamics;
  std::vector<int> rows;
  for (int c = 0; c < captured.problem.contact_count(); ++c)
    rows.push_back(captured.problem.contact_rows(c));
  // FCLIB knows neither bodies nor steps: the side group holds the division of M and H into bodies
  // and the data of the step.
  write_problem(file, captured.problem, StoredForms::as_known, [&](Hdf5Writer& opened) {
    opened.add_group(side_group);
    const SideWriter side{opened};
    side("dof_begin", dynamics.dof_begin);
    side("body_a", dynamics.body_a);
    side("body_b", dynamics.body_b);
    side("rows", rows);
    side("v_free", dynamics.v_free);
    each_member(captured, side);
  });
}

}  // namespace ballast
