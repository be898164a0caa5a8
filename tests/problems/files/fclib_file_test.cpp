// For every defect of a stored problem the reader says in one line where it is.

#include "problems/files/fclib_file.hpp"

#include <functional>

#include "platform/hdf5_file.hpp"
#include "tests/problems/files/problem_file_support.hpp"

using namespace ballast;

TEST_CASE("each broken local file is refused with one line that says where") {
  struct Damage {
    const char* says;
    std::function<void(const fs::path&)> make;
  };
  const auto with = [](const char* name, const auto& values) {
    return [=](const fs::path& f) {
      replace(f, (std::string("/fclib_local/") + name).c_str(), values);
    };
  };
  const auto entry = [](const char* path, size_t k, int value) {
    return [=](const fs::path& f) {
      std::vector<int> values = Hdf5Reader(f).read<int>(path);
      values[k] = value;
      replace(f, path, values);
    };
  };
  const auto without = [](const char* path) { return [=](const fs::path& f) { remove(f, path); }; };
  const Damage damages[] = {
      {"not an HDF5 file", [](const fs::path& f) { write_text(f, "not a problem"); }},
      {"not an HDF5 file", [](const fs::path& f) { write_text(f, ""); }},
      {"no such file", [](const fs::path& f) { fs::remove(f); }},
      {"damaged or truncated HDF5 file",
       [](const fs::path& f) { fs::resize_file(f, fs::file_size(f) / 2); }},
      {"has neither /fclib_local nor /fclib_global", without("/fclib_local")},
      {"/fclib_local/W/p: no such dataset", without("/fclib_local/W/p")},
      {"/fclib_local/W/m: no such dataset", without("/fclib_local/W")},
      {"/fclib_local/vectors/mu: no such dataset", without("/fclib_local/vectors")},
      {"/fclib_local/spacedim = 2: only 3 is supported", with("spacedim", std::vector<int>{2})},
      {"/fclib_local/spacedim has 0 entries", with("spacedim", std::vector<int>{})},
      {"/fclib_local/vectors/q has 5 entries, must have 18",
       with("vectors/q", std::vector<double>(5))},
      {"/fclib_local/vectors/mu[2] = nan is not finite",
       with("vectors/mu", std::vector<double>{0, 0, not_a_number, 0, 0, 0})},
      {"friction[1] = -1 is negative", with("vectors/mu", std::vector<double>{0, -1, 0, 0, 0, 0})},
      {"/fclib_local/W is 17 x 18, must be 18 x 18", with("W/m", std::vector<int>{17})},
      {"/fclib_local/W is 18 x 15, must be 18 x 18", with("W/n", std::vector<int>{15})},
      {"/fclib_local/W is -3 x 18, must be 18 x 18", with("W/m", std::vector<int>{-3})},
      {"/fclib_local/W/nz = -5", with("W/nz", std::vector<int>{-5})},
      {"/fclib_local/W/p has 2 entries, must have 19", with("W/p", std::vector<int>{0, 0})},
      {"/fclib_local/W/i has 3 entries", with("W/i", std::vector<int>{0, 1, 2})},
      {"/fclib_local/W: entry 4 at (1, -1) is outside 18 x 18", entry("/fclib_local/W/i", 4, -1)},
      {"/fclib_local/W: entry 4 at (1, 18) is outside 18 x 18", entry("/fclib_local/W/i", 4, 18)},
      {"/fclib_local/W/p[3] = -4 decreases", entry("/fclib_local/W/p", 3, -4)},
      {"/fclib_local/W/x: claims 2000000000 entries, of which 0 bytes are stored",
       [](const fs::path& f) { claim(f, "/fclib_local/W/x", 2000000000); }},
      {"/fclib_local/vectors/q has 2000000000 entries, must have 18",
       [](const fs::path& f) { claim(f, "/fclib_local/vectors/q", 2000000000); }},
      {"/fclib_local/W/x: does not hold numbers",
       [](const fs::path& f) {
         remove(f, "/fclib_local/W/x");
         const hid_t id = H5Fopen(f.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), type = H5Tcopy(H5T_C_S1);
         const hid_t space = H5Screate(H5S_SCALAR);
         H5Dclose(H5Dcreate2(id, "/fclib_local/W/x", type, space, H5P_DEFAULT, H5P_DEFAULT,
                             H5P_DEFAULT));
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

TEST_CASE("the entries of a row may stand in any order") {
  const Folder folder;
  const fs::path file = folder / "turned.hdf5";
  const FrictionProblem problem = only_delassus(small().problem);
  write_problem(file, problem);
  std::vector<int> i = Hdf5Reader(file).read<int>("/fclib_local/W/i");
  std::vector<double> x = Hdf5Reader(file).read<double>("/fclib_local/W/x");
  REQUIRE(Hdf5Reader(file).read<int>("/fclib_local/W/p")[1] >= 2);
  std::swap(i[0], i[1]);
  std::swap(x[0], x[1]);
  replace(file, "/fclib_local/W/i", i);
  replace(file, "/fclib_local/W/x", x);
  const SparseRows w = read_problem(file).delassus.w;
  CHECK(w.isCompressed());
  CHECK((Eigen::MatrixXd(w) - Eigen::MatrixXd(problem.delassus.w)).norm() == 0.0);
}

TEST_CASE("each broken global file is refused") {
  const Folder folder;
  const fs::path file = folder / "global.hdf5";
  const auto broken = [&](const std::string& name, auto change) {
    write_problem(file, small().problem);
    const std::string path = "/fclib_global/" + name;
    std::vector<double> values = Hdf5Reader(file).read<double>(path);
    change(values);
    replace(file, path.c_str(), values);
    return complaint(file);
  };
  const auto set = [](size_t k, double value) {
    return [=](std::vector<double>& values) { values[k] = value; };
  };
  const auto pop = [](std::vector<double>& values) { values.pop_back(); };
  const std::pair<std::string, std::string> wrongs[] = {
      {broken("H/m", set(0, 23)), "/fclib_global/H is 23 x 18, must be 24 x 18"},
      {broken("H/n", set(0, 17)), "/fclib_global/H is 24 x 17, must be 24 x 18"},
      {broken("M/n", set(0, 23)), "/fclib_global/M is 24 x 23, must be 24 x 24"},
      {broken("vectors/f", pop), "/fclib_global/M is 24 x 24, must be 23 x 23"},
      {broken("vectors/w", pop), "/fclib_global/vectors/w has 17 entries, must have 18"},
      {broken("M/x", set(0, -1.0)), "M(0, 0) = -1"},
      {broken("M/x", set(2, not_a_number)), "/fclib_global/M/x[2] = nan is not finite"},
      {broken("H/x", set(2, not_a_number)), "/fclib_global/H/x[2] = nan is not finite"},
      {broken("vectors/f", set(0, not_a_number)), "/fclib_global/vectors/f[0] = nan is not finite"},
      {broken("vectors/w", set(0, not_a_number)), "/fclib_global/vectors/w[0] = nan is not finite"},
      {broken("vectors/mu", set(1, -0.5)), "friction[1] = -0.5 is negative"}};
  for (const auto& [text, says] : wrongs) CHECK_THAT(text, Catch::StartsWith(says));
}

TEST_CASE("an answer comes back with its bits, and its file holds what FCLIB reads") {
  const Folder folder;
  const fs::path file = folder / "answer.hdf5";
  const KnownSolution known = make_known_solution({.contacts = 20, .frictionless_fraction = 0.3});
  REQUIRE(known.problem.row_count() < 60);
  write_solution(file, known.problem, {known.r, {{"iterations", 7.0}}, {{"solver", "pgs"}}});
  CHECK(read_solution(file, known.problem) == known.r);
  const Hdf5Reader stored(file);
  CHECK(stored.shape("/solution/u")[0] == 60);
  CHECK(stored.shape("/solution/v")[0] ==
        static_cast<unsigned long long>(known.problem.dynamics.dof_count()));
  CHECK(stored.read<double>("/ballast_answer/iterations")[0] == 7.0);
  CHECK(stored.read_text("/ballast_answer/solver") == "pgs");
}

TEST_CASE("another problem's answer and a broken one are refused") {
  const Folder folder;
  const fs::path file = folder / "answer.hdf5";
  KnownSolution known = make_known_solution({.contacts = 20});
  write_solution(file, known.problem, {known.r, {}, {}});
  CHECK_THROWS_WITH(read_solution(file, make_known_solution({.contacts = 21}).problem),
                    Catch::Contains("/solution/r has 60 entries, must have 63"));
  Hdf5Writer writer(file, Hdf5Storage::plain);
  writer.add_group("/solution");
  writer.add("/solution/r", std::vector<double>(60, std::nan("")));
  writer.commit();
  CHECK_THROWS_WITH(read_solution(file, known.problem),
                    Catch::Contains("/solution/r[0] = nan is not finite"));
  CHECK_THROWS_AS(read_solution(folder.write("x.hdf5", "text"), known.problem), Error);
}
