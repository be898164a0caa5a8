// Stored problems: they are read back as written, and a failed write does no harm.

#include "problems/algebra/contact_error.hpp"
#include "tests/problems/files/problem_file_support.hpp"

using namespace ballast;

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

TEST_CASE("one-row contacts become frictionless ones of three rows, with tangents without effect") {
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
    for (int c = 0; c < 6; ++c) {
      CHECK(std::abs(wide_u[3 * c] - u[known.problem.row_begin[c]]) < 1e-13);
      if (known.problem.contact_rows(c) == 1) CHECK(wide_u.segment<2>(3 * c + 1).isZero(0.0));
    }
    CHECK(contact_error(back, wide).natural_map_max < 1e-12);
  }
}

TEST_CASE("triplets have the column in p and the row in i, longer arrays than nz are allowed") {
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
  p.push_back(1 << 30);  // beyond nz: never read
  i.push_back(-7);
  x.push_back(not_a_number);
  replace(file, "/fclib_local/W/nz", std::vector<int>{entries});
  replace(file, "/fclib_local/W/p", p);
  replace(file, "/fclib_local/W/i", i);
  replace(file, "/fclib_local/W/x", x);
  CHECK((read_problem(file).delassus.w - problem.delassus.w).norm() == 0.0);
}

TEST_CASE("a file that cannot be written leaves the old one, and no litter") {
  const Folder folder;
  CHECK_THROWS_AS(write_problem(folder / "absent" / "p.hdf5", small().problem), Error);
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
  CHECK(complaint(folder / "p.txt").rfind("is no problem file (.hdf5, .h5, .dat)", 0) == 0);
}

TEST_CASE("A word names a file, a folder or a pattern") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "in" / "deep");
  for (const char* name : {"in/b.dat", "in/a.hdf5", "in/deep/c.h5", "in/notes.txt"})
    folder.write(name, "");
  const std::string top = folder.path().string();
  const auto all = find_problems(top + "/in");
  REQUIRE(all.size() == 3);
  CHECK(all[0].name == "a.hdf5");
  CHECK(all[2].name == "deep/c.h5");
  CHECK(all[2].file == folder.path() / "in/deep/c.h5");
  CHECK(find_problems(top + "/in/*.dat")[0].name == "b.dat");
  CHECK(find_problems(top + "/missing.dat").size() == 1);
  CHECK_THROWS_AS(find_problems(top + "/in/notes.txt"), Error);
  CHECK_THROWS_AS(find_problems(top + "/in/*.csv"), Error);
  CHECK_THROWS_AS(find_problems("no_problem"), Error);
}
