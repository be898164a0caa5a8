// Same input, same bits: compares the values of this build with tests/golden/golden.txt.

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "experiments/record/record_file.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/golden/golden_values.hpp"

using namespace ballast;
using namespace ballast::golden;

namespace {

const std::filesystem::path golden_path =
    std::filesystem::path(BALLAST_SOURCE_FOLDER) / "tests/golden/golden.txt";

File committed() {
  std::ifstream stream(golden_path, std::ios::binary);
  REQUIRE(stream);
  return parsed({std::istreambuf_iterator<char>(stream), {}});
}

File sample() {
  const Table libm{libm_table, Through::arithmetic, "function", {"digest"}, {{"sin", {"12"}}}};
  const Table steps{"steps",
                    Through::arithmetic,
                    "step",
                    {"load", "energy"},
                    {{"1", {"aa", "bb"}}, {"2", {"cc", "dd"}}}};
  const Table drive{"drive", Through::libm, "step", {"load"}, {{"1", {"ee"}}}};
  return {1, {libm, steps, drive}};
}

}  // namespace

TEST_CASE("golden: deposit, detection, assembly, sweeps, correction, backends: the same bits") {
  File expected = committed();
  const File found = values_today();
  // A build without SuiteSparse has no such backends.
  if (!find_solver("prox_newton").make)
    std::erase_if(expected.tables, [](const Table& t) { return t.name == factoring_table; });
  INFO("meant? docs/house/checks.md says how to make them anew");
  const auto different = first_difference(expected, found);
  if (different) FAIL_CHECK(*different);
  if (!same_libm(expected, found))
    WARN("this machine's libm rounds otherwise: the tables that go through it were not compared");
}

TEST_CASE("golden: the values hold what they are meant to hold") {
  const File expected = committed();
  CHECK(expected.generation == bits_generation);
  std::string names;
  for (const Table& table : expected.tables) {
    CHECK_FALSE(table.rows.empty());
    names += table.name + " ";
  }
  CHECK(names ==
        "libm grains contacts problem backends backends_factoring deposit packing packing_bodies "
        "drive "
        "drive_last_step drive_bodies ");
  // The correction does something; contacts slide and stick.
  for (const Table& table : expected.tables)
    if (table.name == "drive_last_step")
      for (const auto& [column, cells] : table.rows)
        if (column == "contacts" || column == "work_correction" || column == "penetration_max") {
          INFO(column);
          CHECK(std::stod(cells[0]) != 0.0);
        }
}

TEST_CASE("golden: a text reads back, and the first difference has a name") {
  const File file = sample();
  CHECK(text_of(parsed(text_of(file))) == text_of(file));
  CHECK_FALSE(first_difference(file, parsed(text_of(file))));

  const auto said = [&](const std::function<void(File&)>& change) {
    File other = file;
    change(other);
    return first_difference(file, other).value_or("");
  };
  CHECK(said([](File& f) { f.tables[1].rows[1].second[1] = "d0"; }) ==
        "table steps, step 2, energy: dd expected, d0 found");
  CHECK(said([](File& f) { f.tables[1].rows.pop_back(); }) ==
        "table steps, 2 rows expected, 1 found");
  CHECK(said([](File& f) { f.tables[1].rows[0].first = "0"; }) ==
        "table steps, step 1 expected, 0 found");
  CHECK(said([](File& f) { f.tables[1].rows[0].second.pop_back(); }) ==
        "table steps, step 1 has another number of cells");
  CHECK(said([](File& f) { f.tables[1].columns[0] = "force"; }) ==
        "table steps, has other columns now");
  CHECK(said([](File& f) { f.tables.pop_back(); }) == "3 tables expected, 2 found");
  CHECK(said([](File& f) { f.generation = 2; }) == "generation 1 expected, 2 found");
}

TEST_CASE("golden: another libm excuses what goes through it, and nothing else") {
  const File file = sample();
  File other = file;
  other.tables[2].rows[0].second[0] = "e0";
  CHECK(first_difference(file, other) == "table drive, step 1, load: ee expected, e0 found");
  other.tables[0].rows[0].second[0] = "13";
  CHECK_FALSE(same_libm(file, other));
  CHECK_FALSE(first_difference(file, other));
  other.tables[1].rows[0].second[0] = "a0";
  CHECK(first_difference(file, other) == "table steps, step 1, load: aa expected, a0 found");
}

TEST_CASE("golden: digests see every bit and the sign of zero") {
  const std::vector<double> a = {0.0, 1.0}, b = {-0.0, 1.0}, c = {0.0, 1.0 + 0x1p-52};
  CHECK(digest(a).size() == 16);
  CHECK(digest(a) != digest(b));
  CHECK(digest(a) != digest(c));
  CHECK(digest(a, 4) == digest(a).substr(12));
  CHECK(exact(0.1) == "0x1.999999999999ap-4");
}

/// Writes the file anew.
TEST_CASE("golden: make the values anew", "[.make_golden]") {
  std::ofstream(golden_path, std::ios::binary) << text_of(values_today());
}
