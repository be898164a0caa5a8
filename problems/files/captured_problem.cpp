#include "problems/files/captured_problem.hpp"

#include <variant>

#include "platform/hdf5_file.hpp"
#include "platform/text.hpp"
#include "problems/files/fclib_file.hpp"
#include "problems/files/problem_file_error.hpp"

namespace ballast {
namespace {

const std::string side_group = "/ballast";

std::string path_of(const char* name) { return side_group + "/" + name; }

/// Reads arrays whose sizes are known and says which one is wrong.
class SideReader {
 public:
  explicit SideReader(const std::filesystem::path& file) : file_(file) {}

  std::vector<double> doubles(const char* name, std::size_t size) const {
    return sized(name, file_.read_doubles(path_of(name)), size);
  }
  std::vector<int> ints(const char* name, std::size_t size) const {
    return sized(name, file_.read_ints(path_of(name)), size);
  }
  std::vector<int> ints(const char* name) const { return file_.read_ints(path_of(name)); }
  double number(const char* name) const { return doubles(name, 1)[0]; }
  int integer(const char* name) const { return file_.read_int(path_of(name)); }
  std::string text(const char* name) const { return file_.read_text(path_of(name)); }
  std::vector<std::uint64_t> keys(const char* name, std::size_t size) const {
    return sized(name, file_.read_keys(path_of(name)), size);
  }
  [[noreturn]] void fail(const std::string& what) const { file_.fail(what); }

 private:
  template <typename Values>
  Values sized(const char* name, Values values, std::size_t size) const {
    if (values.size() != size)
      file_.fail(path_of(name) + " has " + std::to_string(values.size()) + " entries, must have " +
                 std::to_string(size));
    return values;
  }
  Hdf5Reader file_;
};

/// dof_begin and the masses, taken out of M.
void restore_bodies(const SideReader& side, const GlobalProblem& global, DynamicsForm& dynamics) {
  dynamics.dof_begin = side.ints("dof_begin");
  const std::vector<int>& begin = dynamics.dof_begin;
  const auto bad = [&] {
    side.fail(path_of("dof_begin") + " does not divide the unknowns of M into bodies of 1 to 6");
  };
  if (begin.empty() || begin.front() != 0 || begin.back() != global.m.rows()) bad();
  // all of them before the first block is taken: rising as far as M's rows, they stay within M
  for (std::size_t b = 0; b + 1 < begin.size(); ++b)
    if (begin[b + 1] <= begin[b] || begin[b + 1] > begin[b] + 6) bad();
  for (std::size_t b = 0; b + 1 < begin.size(); ++b) {
    const int d = begin[b + 1] - begin[b];
    // M is block diagonal: a body's mass is its diagonal block.
    const Eigen::MatrixXd block =
        Eigen::SparseMatrix<double>(global.m.block(begin[b], begin[b], d, d));
    dynamics.mass.insert(dynamics.mass.end(), block.data(), block.data() + block.size());
    dynamics.mass_begin.push_back(static_cast<int>(dynamics.mass.size()));
  }
  const std::vector<double> v_free = side.doubles("v_free", static_cast<std::size_t>(begin.back()));
  dynamics.v_free = Eigen::Map<const Eigen::VectorXd>(v_free.data(), begin.back());
}

/// The blocks of H, taken out of the three-row H of the file.
void restore_contacts(const SideReader& side, const GlobalProblem& global,
                      FrictionProblem& problem) {
  const std::size_t contacts = global.mu.size();
  DynamicsForm& dynamics = problem.dynamics;
  dynamics.body_a = side.ints("body_a", contacts);
  dynamics.body_b = side.ints("body_b", contacts);
  const std::vector<int> rows = side.ints("rows", contacts);
  std::vector<double> bias;
  for (std::size_t c = 0; c < contacts; ++c) {
    if (rows[c] != 1 && rows[c] != 3)
      side.fail(path_of("rows") + "[" + std::to_string(c) + "] is neither 1 nor 3");
    // FCLIB has u = H^T v + w: a contact is three columns of H, and the transposes of what stands
    // there in the rows of either body are the blocks of ours.
    const Eigen::SparseMatrix<double> columns = global.h.middleCols(3 * static_cast<int>(c), 3);
    for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
      if (body >= dynamics.body_count())
        side.fail(path_of("body_a") + ", body_b: no such body: " + std::to_string(body));
      if (body < 0) continue;
      const Eigen::MatrixXd wide = Eigen::SparseMatrix<double>(
          columns.middleRows(dynamics.dof_begin[body], dynamics.body_dofs(body)));
      const Eigen::MatrixXd block = wide.transpose().topRows(rows[c]);
      dynamics.h.insert(dynamics.h.end(), block.data(), block.data() + block.size());
    }
    dynamics.h_begin.push_back(static_cast<int>(dynamics.h.size()));
    problem.row_begin.push_back(problem.row_begin.back() + rows[c]);
    for (int row = 0; row < rows[c]; ++row) bias.push_back(global.w[3 * static_cast<int>(c) + row]);
  }
  dynamics.bias =
      Eigen::Map<const Eigen::VectorXd>(bias.data(), static_cast<Eigen::Index>(bias.size()));
  problem.friction = global.mu;
}

/// The step and gravity, from which tolerances are made: what would make any answer right, or none,
/// is refused.
void read_scales(const SideReader& side, CapturedProblem& captured) {
  constexpr double longest_step = 1e6, fastest = 1e3;  // [s], [m/s]
  captured.h = side.number("h");
  captured.g = side.number("g");
  const auto words = [](double x) { return printed("%.6g", x); };
  if (!(captured.h > 0.0) || !(captured.h <= longest_step))
    side.fail(path_of("h") + " = " + words(captured.h) + " s; a step is > 0 and at most " +
              words(longest_step) + " s long");
  if (!(captured.g >= 0.0) || !(captured.velocity_scale() <= fastest))
    side.fail(path_of("g") + " = " + words(captured.g) + " m/s^2: g h must be from 0 to " +
              words(fastest) + " m/s");
  if (captured.g > 0.0 && captured.velocity_scale() < smallest_scale)
    side.fail(path_of("g") + " = " + words(captured.g) + " m/s^2: g h is " +
              words(captured.velocity_scale()) + " m/s, too small to measure by");
}

Impulses read_rows(const SideReader& side, const char* name, const FrictionProblem& problem) {
  const std::vector<double> values =
      side.doubles(name, static_cast<std::size_t>(problem.row_count()));
  return Eigen::Map<const Eigen::VectorXd>(values.data(), problem.row_count());
}

void write_side_group(Hdf5Writer& file, const CapturedProblem& captured) {
  const auto number = [&](const char* name, double value) {
    file.add(path_of(name), std::vector<double>{value});
  };
  // FCLIB knows neither bodies nor steps: what divides its M and H into bodies is kept beside them,
  // and what the run knew of the step.
  file.add_group(side_group);
  number("h", captured.h);
  number("g", captured.g);
  number("time", captured.time);
  number("wall_x", captured.wall_x);
  number("wall_v", captured.wall_v);
  number("load", captured.load);
  file.add(path_of("step"), std::vector<int>{captured.step});
  file.add_text(path_of("phase"), captured.phase);
  const DynamicsForm& dynamics = captured.problem.dynamics;
  file.add(path_of("dof_begin"), dynamics.dof_begin);
  file.add(path_of("body_a"), dynamics.body_a);
  file.add(path_of("body_b"), dynamics.body_b);
  std::vector<int> rows;
  for (int c = 0; c < captured.problem.contact_count(); ++c)
    rows.push_back(captured.problem.contact_rows(c));
  file.add(path_of("rows"), rows);
  file.add(path_of("v_free"), as_vector(dynamics.v_free));
  file.add(path_of("start"), as_vector(captured.start));
  file.add(path_of("solution"), as_vector(captured.solution));
  file.add(path_of("gap"), captured.gap);
  file.add(path_of("frame"), captured.frame);
  file.add(path_of("position"), captured.position);
  file.add(path_of("key"), captured.key);
  file.add(path_of("id_a"), captured.id_a);
  file.add(path_of("id_b"), captured.id_b);
}

CapturedProblem read_side_group(const std::filesystem::path& path) {
  // M, H, w and mu from the FCLIB part; how they divide into bodies and rows from the side group.
  const auto stored = read_fclib(path);
  const SideReader side(path);
  const GlobalProblem* global = std::get_if<GlobalProblem>(&stored);
  if (!global)
    side.fail("has " + side_group + " beside a local problem: it belongs beside a global one");
  CapturedProblem captured;
  captured.problem.has_dynamics = true;
  restore_bodies(side, *global, captured.problem.dynamics);
  restore_contacts(side, *global, captured.problem);
  try {
    captured.problem.validate();
  } catch (const InvalidProblem& error) {
    side.fail(error.what());
  }
  // What the run knew about the step.
  captured.start = read_rows(side, "start", captured.problem);
  captured.solution = read_rows(side, "solution", captured.problem);
  read_scales(side, captured);
  captured.time = side.number("time");
  captured.wall_x = side.number("wall_x");
  captured.wall_v = side.number("wall_v");
  captured.load = side.number("load");
  captured.step = side.integer("step");
  captured.phase = side.text("phase");
  const std::size_t contacts = global->mu.size();
  captured.gap = side.doubles("gap", contacts);
  captured.frame = side.doubles("frame", 9 * contacts);
  captured.position = side.doubles("position", 3 * contacts);
  captured.key = side.keys("key", contacts);
  captured.id_a = side.ints("id_a", contacts);
  captured.id_b = side.ints("id_b", contacts);
  return captured;
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
  return with_problem_file_errors([&] { return read_side_group(path); });
}

void write_captured(const std::filesystem::path& file, const CapturedProblem& captured) {
  captured.problem.validate();
  if (!captured.problem.has_dynamics)
    throw InvalidProblem(file.string() + ": only a dynamics form can be captured");
  write_problem(file, captured.problem,
                [&](Hdf5Writer& opened) { write_side_group(opened, captured); });
}

}  // namespace ballast
