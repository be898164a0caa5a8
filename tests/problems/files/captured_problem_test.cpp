// A problem and the run's data about it in one file, which is read whole or refused by name.

#include "problems/files/captured_problem.hpp"

#include "platform/atomic_file.hpp"
#include "platform/random.hpp"
#include "tests/problems/files/problem_file_support.hpp"

using namespace ballast;

namespace {

std::vector<double> numbers(Random& random, int count) {
  std::vector<double> values(static_cast<size_t>(count));
  for (double& value : values) value = random.normal();
  return values;
}

/// Six contacts, some of them without friction and therefore with one row.
CapturedProblem sample() {
  Random random(4);
  CapturedProblem captured;
  captured.problem = small(0.5).problem;
  const int contacts = captured.problem.contact_count(), rows = captured.problem.row_count();
  REQUIRE(rows < 3 * contacts);
  captured.start = as_eigen(numbers(random, rows));
  captured.solution = as_eigen(numbers(random, rows));
  captured.h = 1e-4;
  captured.g = 9.81;
  captured.step = 21;
  captured.time = 0.0021;
  captured.phase = "loading";
  captured.wall_x = -1e-5;
  captured.wall_v = 0.25;
  captured.load = 120.0;
  captured.gap = numbers(random, contacts);
  captured.frame = numbers(random, 9 * contacts);
  captured.position = numbers(random, 3 * contacts);
  for (int c = 0; c < contacts; ++c) {
    captured.key.push_back(random.next());
    captured.id_a.push_back(c);
    captured.id_b.push_back(100 + c);
  }
  return captured;
}

}  // namespace

TEST_CASE("all of a captured problem comes back, bit by bit") {
  const Folder folder;
  const CapturedProblem captured = sample();
  write_captured(folder / "c.hdf5", captured);
  CHECK_FALSE(fs::exists(folder / "c.hdf5.tmp"));
  REQUIRE(is_captured(folder / "c.hdf5"));
  const CapturedProblem back = read_captured(folder / "c.hdf5");
  CHECK(back.problem.row_begin == captured.problem.row_begin);
  CHECK(back.problem.dynamics.h == captured.problem.dynamics.h);
  CHECK((back.step == 21 && back.phase == "loading" && back.load == 120.0));
  CHECK((back.time == captured.time && back.wall_x == captured.wall_x &&
         back.wall_v == captured.wall_v));
  CHECK((back.solution == captured.solution && back.gap == captured.gap &&
         back.frame == captured.frame && back.position == captured.position));
  CHECK((back.key == captured.key && back.start == captured.start));
  // Equal contents give equal bytes.
  write_captured(folder / "again.hdf5", back);
  CHECK(read_whole_file(folder / "again.hdf5") == read_whole_file(folder / "c.hdf5"));
}

TEST_CASE("readers of FCLIB find a global problem, and read_problem() the one that was written") {
  const Folder folder;
  const CapturedProblem captured = sample();
  write_captured(folder / "c.hdf5", captured);
  CHECK(read_fclib(folder / "c.hdf5").row_count() == 3 * captured.problem.contact_count());
  CHECK(read_problem(folder / "c.hdf5").row_begin == captured.problem.row_begin);
}

TEST_CASE("errors are quoted relative to what gravity does in a step") {
  CapturedProblem captured;
  captured.h = 1e-3;
  CHECK(captured.velocity_scale() == 1.0);
  captured.g = 9.81;
  CHECK(captured.velocity_scale() == 9.81 * 1e-3);
}

TEST_CASE("other files are no captured problems") {
  const Folder folder;
  write_problem(folder / "plain.hdf5", small().problem);
  CHECK_FALSE(is_captured(folder / "plain.hdf5"));
  write_text(folder / "text.hdf5", "no HDF5");
  CHECK_FALSE(is_captured(folder / "text.hdf5"));
  CHECK_FALSE(is_captured(folder / "absent.hdf5"));
  write_captured(folder / "c.hdf5", sample());
  fs::copy_file(folder / "c.hdf5", folder / "c.dat");
  CHECK_FALSE(is_captured(folder / "c.dat"));
}

TEST_CASE("what does not fit the problem is named") {
  const Folder folder;
  const fs::path file = folder / "c.hdf5";
  const auto broken = [&](const char* path, auto values) {
    write_captured(file, sample());
    replace(file, path, values);
    return complaint(file, read_captured);
  };
  for (const char* path : {"/ballast/gap", "/ballast/frame", "/ballast/position", "/ballast/start",
                           "/ballast/solution", "/ballast/v_free", "/ballast/load"}) {
    CAPTURE(path);
    CHECK(broken(path, std::vector<double>(2))
              .starts_with(path + std::string(" has 2 entries, must have ")));
  }
  for (const char* path : {"/ballast/id_a", "/ballast/body_b", "/ballast/rows"}) {
    CAPTURE(path);
    CHECK(broken(path, std::vector<int>(5)) == path + std::string(" has 5 entries, must have 6"));
  }
  const std::string bodies =
      "/ballast/dof_begin does not divide the unknowns of M into bodies of 1 to 6";
  CHECK(broken("/ballast/dof_begin", std::vector<int>{}) == bodies);
  CHECK(broken("/ballast/dof_begin", std::vector<int>{0, 6, 12, 18}) == bodies);
  CHECK(broken("/ballast/dof_begin", std::vector<int>{0, 7, 12, 18, 24}) == bodies);
  CHECK(broken("/ballast/dof_begin", std::vector<int>{0, 6, 6, 12, 18, 24}) == bodies);
  // Beyond M and back; then a difference that no int holds.
  CHECK(broken("/ballast/dof_begin", std::vector<int>{0, 6, 12, 18, 24, 30, 24}) == bodies);
  CHECK(broken("/ballast/dof_begin", std::vector<int>{0, 6, -2147483647 - 1, 24}) == bodies);
  CHECK(broken("/ballast/rows", std::vector<int>{3, 2, 3, 3, 3, 3}) ==
        "/ballast/rows[1] is neither 1 nor 3");
  CHECK(broken("/ballast/body_a", std::vector<int>{9, 0, 0, 0, 0, 0}) ==
        "/ballast/body_a, body_b: no such body: 9");
  CHECK(broken("/ballast/body_a", std::vector<int>{2147483647, 0, 0, 0, 0, 0}) ==
        "/ballast/body_a, body_b: no such body: 2147483647");
  std::vector<double> start(as_vector(sample().start));
  start[1] = std::nan("");
  CHECK(broken("/ballast/start", start) == "/ballast/start[1] = nan is not finite");
  write_captured(file, sample());
  remove(file, "/ballast/phase");
  CHECK(complaint(file, read_captured) == "/ballast/phase: no such dataset");
}

TEST_CASE("a step or gravity by which nothing can be measured is refused") {
  const Folder folder;
  const fs::path file = folder / "c.hdf5";
  const std::string range = " s; a step is > 0 and at most 1e+06 s long";
  const std::string scale = " m/s^2: g h must be from 0 to 1000 m/s";
  const std::tuple<const char*, double, std::string> wrongs[] = {
      {"/ballast/h", not_a_number, "/ballast/h = nan" + range},
      {"/ballast/h", -2e-4, "/ballast/h = -0.0002" + range},
      {"/ballast/h", 0.0, "/ballast/h = 0" + range},
      {"/ballast/h", 1e300, "/ballast/h = 1e+300" + range},
      {"/ballast/g", not_a_number, "/ballast/g = nan" + scale},
      {"/ballast/g", 1e300, "/ballast/g = 1e+300" + scale},
      {"/ballast/g", -9.81, "/ballast/g = -9.81" + scale},
      {"/ballast/g", 1e-200,
       "/ballast/g = 1e-200 m/s^2: g h is 1e-204 m/s, too small to measure by"},
      {"/ballast/g", 0.0, ""}};
  for (const auto& [path, value, says] : wrongs) {
    write_captured(file, sample());
    replace(file, path, std::vector<double>{value});
    CHECK(complaint(file, read_captured) == says);
  }
}

TEST_CASE("only a problem with bodies can be captured") {
  const Folder folder;
  CapturedProblem captured = sample();
  captured.problem = only_delassus(captured.problem);
  CHECK_THROWS_AS(write_captured(folder / "c.hdf5", captured), InvalidProblem);
  CHECK_FALSE(fs::exists(folder / "c.hdf5"));
}
