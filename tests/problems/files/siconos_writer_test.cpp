#include "platform/atomic_file.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/files/problem_file.hpp"
#include "problems/files/siconos_text.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("Siconos' text reads back to the same bits") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "problem.dat";
  const LocalProblem local =
      condensed(make_known_solution({.contacts = 15, .frictionless_fraction = 0.3}).problem);
  write_siconos_text(file, local);
  const LocalProblem read = std::get<LocalProblem>(read_siconos_text(file));
  CHECK(Eigen::MatrixXd(read.w) == Eigen::MatrixXd(local.w));
  CHECK(read.q == local.q);
  CHECK(read.mu == local.mu);
}

TEST_CASE("The text of one contact is what Siconos writes for it") {
  const TemporaryFolder folder;
  LocalProblem local;
  local.w.resize(3, 3);
  local.w.insert(0, 0) = 2.0;
  local.w.insert(1, 0) = 0.5;
  local.w.insert(2, 2) = 1.0;
  local.q = Eigen::Vector3d(-1.0, 0.0, 3.0);
  local.mu = {0.25};
  write_siconos_text(folder.path() / "one.dat", local);
  CHECK(read_whole_file(folder.path() / "one.dat") ==
        "3\n1\n1\n3\n3\n1\n1 1\n 3\n 3\n2 1\n 0 1\n 0\n0\n 2 0.5 0 0 0 0 0 0 1\n -1 0 3\n 0.25\n");
}
