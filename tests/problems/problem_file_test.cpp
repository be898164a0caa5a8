#include "problems/problem_file.hpp"

#include <hdf5.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>

#include "problems/contact_error.hpp"
#include "problems/delassus.hpp"
#include "problems/fclib_file.hpp"
#include "problems/hdf5_arrays.hpp"
#include "problems/known_solutions.hpp"
#include "tests/catch.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// A folder of its own that goes with the test.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("ballast_problem_file_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  fs::path operator/(const std::string& name) const { return path / name; }
};

KnownSolution small(double frictionless = 0.0) {
  KnownSolutionSettings settings;
  settings.bodies = 4;
  settings.contacts = 6;
  settings.frictionless_fraction = frictionless;
  settings.friction_min = 0.1;
  return make_known_solution(settings);
}

FrictionProblem only_delassus(FrictionProblem problem) {
  add_delassus_form(problem);
  problem.has_dynamics = false;
  return problem;
}

std::string complaint(const fs::path& file) {
  try {
    read_problem(file);
  } catch (const ProblemFileError& error) {
    const std::string text = error.what();
    CHECK(text.rfind(file.string() + ": ", 0) == 0);
    CHECK(text.find('\n') == std::string::npos);
    return text.substr(file.string().size() + 2);
  }
  return "";
}

void write_text(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

/// The dataset replaced by other numbers, or removed when `values` is null.
template <typename Value>
void replace(const fs::path& file, const char* path, const std::vector<Value>* values) {
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  REQUIRE(id >= 0);
  REQUIRE(H5Ldelete(id, path, H5P_DEFAULT) >= 0);
  if (values) {
    const hid_t type = std::is_same_v<Value, int> ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE;
    const hsize_t size = values->size();
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    const hid_t data = H5Dcreate2(id, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    REQUIRE(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values->data()) >= 0);
    H5Dclose(data);
    H5Sclose(space);
  }
  H5Fclose(id);
}

void replace(const fs::path& file, const char* path, std::vector<int> values) { replace(file, path, &values); }
void replace(const fs::path& file, const char* path, std::vector<double> values) { replace(file, path, &values); }
void remove(const fs::path& file, const char* path) { replace<int>(file, path, nullptr); }

const double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("a problem with dynamics survives a global file") {
  const Folder folder;
  const KnownSolution known = small();
  write_problem(folder / "global.hdf5", known.problem);
  const FrictionProblem back = read_problem(folder / "global.hdf5");
  REQUIRE(back.has_dynamics);
  CHECK_FALSE(back.has_delassus);
  CHECK(back.friction == known.problem.friction);
  CHECK(back.dynamics.mass == known.problem.dynamics.mass);
  CHECK(back.dynamics.bias == known.problem.dynamics.bias);
  CHECK((back.dynamics.v_free - known.problem.dynamics.v_free).norm() < 1e-14);
  CHECK(contact_error(back, known.r).natural_map_max < 1e-12);
  CHECK_FALSE(fs::exists(folder / "global.hdf5.tmp"));
}

TEST_CASE("a problem in Delassus form survives a local file, bit by bit") {
  const Folder folder;
  const FrictionProblem problem = only_delassus(small().problem);
  write_problem(folder / "local.h5", problem);
  const FrictionProblem back = read_problem(folder / "local.h5");
  REQUIRE(back.has_delassus);
  CHECK_FALSE(back.has_dynamics);
  CHECK(back.friction == problem.friction);
  CHECK(back.delassus.q == problem.delassus.q);
  CHECK((back.delassus.w - problem.delassus.w).norm() == 0.0);
}

TEST_CASE("one-row contacts become frictionless ones of three rows") {
  const Folder folder;
  const KnownSolution known = small(0.5);
  Eigen::VectorXd u;
  contact_velocity(known.problem, known.r, u);
  for (const bool local : {false, true}) {
    write_problem(folder / "rows.hdf5", local ? only_delassus(known.problem) : known.problem);
    const FrictionProblem back = read_problem(folder / "rows.hdf5");
    REQUIRE(back.row_count() == 18);
    Impulses wide = Impulses::Zero(18);
    for (int c = 0; c < 6; ++c) {
      const int rows = known.problem.contact_rows(c);
      wide.segment(3 * c, rows) = known.r.segment(known.problem.row_begin[c], rows);
      CHECK((rows == 3) == (back.friction[c] > 0.0));
    }
    Eigen::VectorXd wide_u;
    contact_velocity(back, wide, wide_u);
    for (int c = 0; c < 6; ++c) CHECK(std::abs(wide_u[3 * c] - u[known.problem.row_begin[c]]) < 1e-13);
    CHECK(contact_error(back, wide).natural_map_max < 1e-12);
  }
}

TEST_CASE("a global file whose unknowns are no bodies is condensed to W") {
  const Folder folder;
  GlobalProblem chain;  // nine masses in a row, coupled: no group of six or three of them is alone
  chain.m.resize(9, 9);
  chain.h.resize(9, 6);
  for (int i = 0; i < 9; ++i) {
    chain.m.insert(i, i) = 2.0 + 0.1 * i;
    if (i > 0) chain.m.insert(i, i - 1) = chain.m.insert(i - 1, i) = -0.5;
  }
  for (int k = 0; k < 6; ++k) chain.h.insert((2 * k) % 9, k) = 1.0 + k;
  chain.f = Eigen::VectorXd::LinSpaced(9, -1.0, 1.0);
  chain.w = Eigen::VectorXd::LinSpaced(6, 0.5, 1.0);
  chain.mu = {0.3, 0.7};
  write_fclib(folder / "chain.hdf5", chain);
  const FrictionProblem problem = read_problem(folder / "chain.hdf5");
  REQUIRE(problem.has_delassus);
  CHECK_FALSE(problem.has_dynamics);
  const Eigen::MatrixXd m = chain.m, h = chain.h, inverse = m.inverse();
  CHECK((Eigen::MatrixXd(problem.delassus.w) - h.transpose() * inverse * h).norm() < 1e-13);
  CHECK((problem.delassus.q - (h.transpose() * inverse * chain.f + chain.w)).norm() < 1e-13);
}

TEST_CASE("triplets have the column in p and the row in i; longer arrays than nz are allowed") {
  const Folder folder;
  const fs::path file = folder / "triplets.hdf5";
  FrictionProblem problem = only_delassus(small().problem);
  problem.delassus.w.coeffRef(0, 5) = 0.125;  // unsymmetric, to tell rows from columns
  write_problem(file, problem);
  std::vector<int> p, i;
  std::vector<double> x;
  for (int row = 0; row < problem.row_count(); ++row)
    for (SparseRows::InnerIterator entry(problem.delassus.w, row); entry; ++entry) {
      p.push_back(static_cast<int>(entry.col()));
      i.push_back(row);
      x.push_back(entry.value());
    }
  const int entries = static_cast<int>(x.size());
  p.push_back(1 << 30);  // beyond nz: never looked at
  i.push_back(-7);
  x.push_back(not_a_number);
  replace(file, "/fclib_local/W/nz", std::vector<int>{entries});
  replace(file, "/fclib_local/W/p", p);
  replace(file, "/fclib_local/W/i", i);
  replace(file, "/fclib_local/W/x", x);
  CHECK((read_problem(file).delassus.w - problem.delassus.w).norm() == 0.0);
}

TEST_CASE("each broken local file is refused with one line that says where") {
  struct Damage {
    const char* says;
    std::function<void(const fs::path&)> make;
  };
  const Damage damages[] = {
      {"not an HDF5 file", [](const fs::path& f) { write_text(f, "not a problem"); }},
      {"not an HDF5 file", [](const fs::path& f) { write_text(f, ""); }},
      {"no such file", [](const fs::path& f) { fs::remove(f); }},
      {"damaged or truncated HDF5 file", [](const fs::path& f) { fs::resize_file(f, fs::file_size(f) / 2); }},
      {"has neither /fclib_local nor /fclib_global", [](const fs::path& f) { remove(f, "/fclib_local"); }},
      {"/fclib_local/W/p: no such dataset", [](const fs::path& f) { remove(f, "/fclib_local/W/p"); }},
      {"/fclib_local/W/m: no such dataset", [](const fs::path& f) { remove(f, "/fclib_local/W"); }},
      {"/fclib_local/vectors/q: no such dataset", [](const fs::path& f) { remove(f, "/fclib_local/vectors"); }},
      {"/fclib_local/spacedim = 2: only 3 is supported",
       [](const fs::path& f) { replace(f, "/fclib_local/spacedim", std::vector<int>{2}); }},
      {"/fclib_local/spacedim has 0 entries",
       [](const fs::path& f) { replace(f, "/fclib_local/spacedim", std::vector<int>{}); }},
      {"/fclib_local/vectors/q has 5 entries, must have 18",
       [](const fs::path& f) { replace(f, "/fclib_local/vectors/q", std::vector<double>(5)); }},
      {"/fclib_local/vectors/mu[2] = nan is not finite",
       [](const fs::path& f) {
         replace(f, "/fclib_local/vectors/mu", std::vector<double>{0, 0, not_a_number, 0, 0, 0});
       }},
      {"friction[1] = -1 is negative",
       [](const fs::path& f) {
         replace(f, "/fclib_local/vectors/mu", std::vector<double>{0, -1, 0, 0, 0, 0});
       }},
      {"/fclib_local/W has 17 contact rows",
       [](const fs::path& f) { replace(f, "/fclib_local/W/m", std::vector<int>{17}); }},
      {"/fclib_local/W is 18 x 15, must be 18 x 18",
       [](const fs::path& f) { replace(f, "/fclib_local/W/n", std::vector<int>{15}); }},
      {"/fclib_local/W: -3 x 18", [](const fs::path& f) { replace(f, "/fclib_local/W/m", std::vector<int>{-3}); }},
      {"/fclib_local/W/nz = -5", [](const fs::path& f) { replace(f, "/fclib_local/W/nz", std::vector<int>{-5}); }},
      {"/fclib_local/W/p has 2 entries, must have 19",
       [](const fs::path& f) {
         replace(f, "/fclib_local/W/p", std::vector<int>{0, 0});
       }},
      {"/fclib_local/W/i has 3 entries",
       [](const fs::path& f) {
         replace(f, "/fclib_local/W/i", std::vector<int>{0, 1, 2});
       }},
      {"/fclib_local/W/x: does not hold numbers",
       [](const fs::path& f) {
         remove(f, "/fclib_local/W/x");
         const hid_t id = H5Fopen(f.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), type = H5Tcopy(H5T_C_S1);
         const hid_t space = H5Screate(H5S_SCALAR);
         H5Dclose(H5Dcreate2(id, "/fclib_local/W/x", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
         H5Sclose(space);
         H5Tclose(type);
         H5Fclose(id);
       }},
      {"/fclib_local/V: bilateral",
       [](const fs::path& f) {
         const hid_t id = H5Fopen(f.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
         H5Gclose(H5Gcreate2(id, "/fclib_local/V", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
         H5Fclose(id);
       }},
  };
  const Folder folder;
  const fs::path file = folder / "broken.hdf5";
  const FrictionProblem problem = only_delassus(small().problem);
  for (const Damage& damage : damages) {
    write_problem(file, problem);
    damage.make(file);
    const std::string text = complaint(file);
    CAPTURE(text, damage.says);
    CHECK(text.rfind(damage.says, 0) == 0);
  }
}

TEST_CASE("indices out of range are refused") {
  const Folder folder;
  const fs::path file = folder / "indices.hdf5";
  const FrictionProblem problem = only_delassus(small().problem);
  write_problem(file, problem);
  std::vector<int> i = Hdf5Arrays(file, Hdf5Arrays::Mode::read).read_ints("/fclib_local/W/i");
  std::vector<int> p = Hdf5Arrays(file, Hdf5Arrays::Mode::read).read_ints("/fclib_local/W/p");
  const int good = i[4];
  for (const int bad : {-1, 18}) {
    i[4] = bad;
    replace(file, "/fclib_local/W/i", i);
    const std::string text = complaint(file);
    CHECK(text.rfind("/fclib_local/W: entry 4 at (", 0) == 0);
    CHECK(text.find(", " + std::to_string(bad) + ") is outside 18 x 18") != std::string::npos);
  }
  i[4] = good;
  replace(file, "/fclib_local/W/i", i);
  p[3] = -4;
  replace(file, "/fclib_local/W/p", p);
  CHECK(complaint(file).rfind("/fclib_local/W/p[3] = -4 decreases", 0) == 0);
}

TEST_CASE("each broken global file is refused") {
  const Folder folder;
  const fs::path file = folder / "global.hdf5";
  const auto broken = [&](const char* path, auto values) {
    write_problem(file, small().problem);
    replace(file, path, values);
    return complaint(file);
  };
  CHECK(broken("/fclib_global/H/m", std::vector<int>{23}).rfind("/fclib_global/H is 23 x 18, must be 24 x 18", 0) == 0);
  CHECK(broken("/fclib_global/H/n", std::vector<int>{17}).rfind("/fclib_global/H has 17 contact rows", 0) == 0);
  CHECK(broken("/fclib_global/M/n", std::vector<int>{23}).rfind("/fclib_global/M is 24 x 23", 0) == 0);
  CHECK(broken("/fclib_global/vectors/f", std::vector<double>(23)).rfind("/fclib_global/vectors/f has 23", 0) == 0);
  CHECK(broken("/fclib_global/vectors/w", std::vector<double>(3)).rfind("/fclib_global/vectors/w has 3", 0) == 0);
  write_problem(file, small().problem);
  std::vector<double> x = Hdf5Arrays(file, Hdf5Arrays::Mode::read).read_doubles("/fclib_global/M/x");
  x[0] = -1.0;
  CHECK(broken("/fclib_global/M/x", x).rfind("M(0, 0) = -1", 0) == 0);
}

TEST_CASE("HDF5 prints nothing of its own, and speaks again afterwards") {
  const Folder folder;
  write_problem(folder / "p.hdf5", small().problem);
  remove(folder / "p.hdf5", "/fclib_global/M/x");
  const fs::path log = folder / "stderr.txt";
  const int saved = ::dup(STDERR_FILENO);
  REQUIRE(std::freopen(log.c_str(), "w", stderr) != nullptr);
  const std::string text = complaint(folder / "p.hdf5");
  std::fflush(stderr);
  const auto silent = fs::file_size(log);
  H5Fopen((folder / "absent").c_str(), H5F_ACC_RDONLY,
          H5P_DEFAULT);  // not through us: HDF5 complains as it was told to
  std::fflush(stderr);
  const auto loud = fs::file_size(log);
  ::dup2(saved, STDERR_FILENO);
  ::close(saved);
  CHECK(text == "/fclib_global/M/x: no such dataset");
  CHECK(silent == 0);
  CHECK(loud > 0);
}

TEST_CASE("a file that cannot be written leaves the old one, and no litter") {
  const Folder folder;
  CHECK_THROWS_AS(write_problem(folder.path / "absent" / "p.hdf5", small().problem), ProblemFileError);
  FrictionProblem broken = small().problem;
  write_problem(folder / "p.hdf5", broken);
  broken.friction[0] = -1.0;
  CHECK_THROWS_AS(write_problem(folder / "p.hdf5", broken), InvalidProblem);
  CHECK_NOTHROW(read_problem(folder / "p.hdf5"));
  CHECK_FALSE(fs::exists(folder / "p.hdf5.tmp"));
}

TEST_CASE("an unknown extension is refused") {
  const Folder folder;
  write_text(folder / "p.txt", "3");
  CHECK(complaint(folder / "p.txt").rfind("unknown kind of file '.txt'", 0) == 0);
}
