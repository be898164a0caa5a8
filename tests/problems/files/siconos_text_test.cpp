// Problems in Siconos' text format.

#include "tests/problems/files/problem_file_support.hpp"

using namespace ballast;

namespace {

FrictionProblem read_text(const std::string& text) {
  const Folder folder;
  return read_problem(folder.write("p.dat", text));
}

std::string complaint_of_text(const std::string& text) {
  const Folder folder;
  return complaint(folder.write("p.dat", text));
}

/// W is unsymmetric, so that a wrong layout shows.
const Eigen::Matrix3d one_contact =
    (Eigen::Matrix3d() << 2, 0.25, 0, 0.26, 3, 0, 0, 0, 4).finished();

}  // namespace

TEST_CASE("dense matrices, column by column") {
  const FrictionProblem local =
      read_text("3\n1\n0\n3\n3\n3\t3\n2 0.26 0\n0.25 3 0\n0 0 4\n-1 0.5 +1e-1\n0.7\n");
  CHECK((Eigen::MatrixXd(local.delassus.w) - one_contact).norm() == 0.0);
  CHECK(local.delassus.q == Eigen::Vector3d(-1, 0.5, 0.1));
  CHECK(local.friction == std::vector<double>{0.7});
}

TEST_CASE("matrices by blocks, with what may follow the problem") {
  const FrictionProblem local = read_text(
      "3 2 1 6 6\n3 2 2\n3 6\n3 6\n4 3\n0 2 3 3\n0 1 1\n"
      "0\n2 0.26 0 0.25 3 0 0 0 4\n"
      "1\n1 2 3 4 5 6 7 8 9\n"
      "2\n5 0 0 0 5 0 0 0 5\n"
      "-1 0 0 -2 0 0\n0.3 0.4\ntrailing words are not looked at\n");
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, 6);
  expected.topLeftCorner<3, 3>() = one_contact;
  expected.topRightCorner<3, 3>() << 1, 4, 7, 2, 5, 8, 3, 6, 9;
  expected.bottomRightCorner<3, 3>() = 5 * Eigen::Matrix3d::Identity();
  CHECK((Eigen::MatrixXd(local.delassus.w) - expected).norm() == 0.0);
  CHECK(local.delassus.q[3] == -2.0);
  CHECK(local.friction == std::vector<double>{0.3, 0.4});
}

TEST_CASE("sparse matrices as CSparse prints them") {
  const std::string version =
      "CSparse Version 3.1.4, Oct 10, 2014.  Copyright (c) Timothy A. Davis\n";
  const std::string tail = "-1 0 0\n0.5\n";
  const std::string columns = "3\n1\n2\n3\n3\n2\n" + version +
                              "3-by-3, nzmax: 5 nnz: 5, 1-norm: 4\n" +
                              "    col 0 : locations 0 to 1\n      0 : 2\n      1 : 0.26\n" +
                              "    col 1 : locations 2 to 3\n      0 : 0.25\n      1 : 3\n" +
                              "    col 2 : locations 4 to 4\n      2 : 4\n";
  const std::string rows = "3\n1\n2\n3\n3\n3\n" + version +
                           "csr: 3-by-3, nzmax: 5 nnz: 5, 1-norm: 4\n" +
                           "    row 0 : locations 0 to 1\n      0 : 2\n      1 : 0.25\n" +
                           "    row 1 : locations 2 to 3\n      0 : 0.26\n      1 : 3\n" +
                           "    row 2 : locations 4 to 4\n      2 : 4\n";
  const std::string triplets =
      "3\n1\n2\n3\n3\n1\n" + version + "triplet: 3-by-3, nzmax: 5 nnz: 5\n" +
      "    0 0 : 2\n    1 0 : 0.26\n    0 1 : 0.25\n    1 1 : 3\n    2 2 : 4\n";
  for (const std::string& matrix : {columns, rows, triplets}) {
    const FrictionProblem local = read_text(matrix + tail);
    CHECK((Eigen::MatrixXd(local.delassus.w) - one_contact).norm() == 0.0);
    CHECK(local.delassus.q == Eigen::Vector3d(-1, 0, 0));
    CHECK(local.friction == std::vector<double>{0.5});
  }
}

TEST_CASE("a global problem is told by its first matrix") {
  // A body of mass 2 with six unknowns that touches the ground with the first three.
  std::string text = "3\n1\n0\n6\n6\n6 6\n";
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) text += i == j ? "2 " : "0 ";
  text += "\n0\n6\n3\n6 3\n";
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 6; ++i) text += i == j ? "1 " : "0 ";
  text += "\n-4 2 0 0 0 0\n0.5 0 0\n0.6\n";
  const FrictionProblem problem = read_text(text);
  REQUIRE(problem.has_dynamics);
  CHECK(problem.dynamics.body_count() == 1);
  CHECK(problem.dynamics.v_free[0] == Approx(-2.0));
  CHECK(problem.dynamics.bias == Eigen::Vector3d(0.5, 0, 0));
  CHECK(problem.dynamics.body_b == std::vector<int>{0});
  CHECK(problem.dynamics.body_a == std::vector<int>{-1});
  Eigen::VectorXd q;
  free_contact_velocity(problem, q);
  CHECK((q - Eigen::Vector3d(-1.5, 1, 0)).norm() < 1e-15);
}

TEST_CASE("a global problem with as many unknowns as contact rows is not taken for a local one") {
  // One body with six unknowns and two contacts: M and H are 6 x 6, as W would be.
  const auto diagonal = [](const char* value) {
    std::string text;
    for (int k = 0; k < 36; ++k) text += k % 7 == 0 ? std::string(value) + " " : "0.0 ";
    return text + "\n";
  };
  const std::string head = "3\n2\n0\n6\n6\n6 6\n" + diagonal("2.0");
  const FrictionProblem global = read_text(head + "0\n6\n6\n6 6\n" + diagonal("1.0") +
                                           "-1 -1 -1 -1 -1 -1\n0 0 0 0 0 0\n0.3 0.4\n");
  REQUIRE(global.has_dynamics);
  CHECK(global.friction == std::vector<double>{0.3, 0.4});
  // The same matrix with a q that begins with 0 is W.
  CHECK(read_text(head + "0.0 6.0 6.0 0 0 0\n0.3 0.4\n").delassus.q[1] == 6.0);
}

TEST_CASE("each broken text is refused, with its line") {
  const std::string sound = "3\n1\n0\n3\n3\n3 3\n2 0 0 0 3 0 0 0 4\n-1 0 0\n0.5\n";
  CHECK(complaint_of_text(sound) == "");
  const std::string blocks = "3\n1\n1\n3 3\n1 1 1\n", of_block = "1 0 0 0 1 0 0 0 1\n1 1 1\n1\n";
  const std::pair<std::string, const char*> wrongs[] = {
      {"", "line 1: the file ends within the dimension"},
      {"2\n1\n", "line 1: dimension 2: only 3 is supported"},
      {"3\n-1\n", "line 2: the number of contacts = -1 is negative"},
      {"3\nmany\n", "line 2: the number of contacts: 'many' is not a number"},
      {"3\n1\n7\n3 3\n", "line 3: storage 7 is none of"},
      {"3\n1\n0\n3 3\n3 4\n", "line 5: the matrix states two different sizes"},
      {"3\n1\n0\n3 3\n3 3\n2 0 0 nan 3 0 0 0 4\n1 1 1\n", "line 6: a dense matrix = nan"},
      {sound.substr(0, sound.size() - 5), "line 8: the file ends within mu"},
      {sound.substr(0, 25), "line 7: the file ends within"},
      {"3\n1000000\n0\n3000000 3000000\n3000000 3000000\n1 2\n",
       "line 2: the file ends within the number of contacts"},
      {"3\n1\n2\n3 3\n4\n", "line 5: sparse origin 4 is not supported"},
      {"3\n1\n0\n4 4\n4 4\n1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n0\n3 3\n3 3\n1 0 0 0 1 0 0 0 1\n",
       "line 10: H is 3 x 3, must be 4 x 3"},
      {blocks + "3\n3\n2 1\n0 1\n0\n5\n" + of_block, "line 11: the blocks are not in order"},
      {blocks + "3\n3\n2 1\n0 1\n4\n0\n" + of_block, "line 10: block 0 is outside the matrix"},
      // The reader must not walk through 2e9 columns without rows.
      {blocks + "0\n2000000000\n", "line 6: the ends of block rows do not ascend to 3"},
      {blocks + "0\n3\n", "line 6: the ends of block rows do not ascend to 3"},
      {blocks + "3\n2\n2 1\n0 1\n0\n0\n" + of_block,
       "line 7: the ends of block columns do not ascend to 3"},
      {blocks + "-1\n3\n", "line 6: ends of block rows = -1 is negative"},
      {"3\n1\n1\n3 3\n1 1 2\n3\n3 3\n", "line 7: the ends of block columns do not ascend to 3"},
      {"3\n1\n0\n3\n3\n3 3\n-2 0 0 0 3 0 0 0 4\n-1 0 0\n0.5\n",
       "delassus.w(0, 0) = -2 is negative"}};
  for (const auto& [text, says] : wrongs)
    CHECK_THAT(complaint_of_text(text), Catch::StartsWith(says));
}

TEST_CASE("sizes that the file cannot hold are refused before memory is asked for") {
  const std::string ends = "the file ends within ";
  std::vector<std::pair<std::string, std::string>> wrongs = {
      // Three times the number of contacts does not fit an int.
      {"3\n1500000000\n2\n3\n3\n", "the number of contacts = 1500000000 is too large"},
      {"3\n700000000\n2\n3\n3\n", ends + "the number of contacts"}};
  for (const std::string storage : {"0", "1", "2"}) {
    wrongs.emplace_back("3\n1\n" + storage + "\n700000000\n700000000\n", ends + "rows");
    wrongs.emplace_back("3\n1\n" + storage + "\n2147483647\n3\n", "rows = 2147483647 is too large");
  }
  for (const auto& [text, says] : wrongs)
    CHECK_THAT(complaint_of_text(text), Catch::Contains(says));
}
