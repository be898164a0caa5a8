#include "platform/csv.hpp"

#include <cmath>

#include "platform/random.hpp"
#include "tests/catch.hpp"
#include "tests/support/complaint.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

std::vector<std::vector<std::string>> rows_of(const std::filesystem::path& file) {
  std::vector<std::vector<std::string>> rows;
  for (CsvReader reader(file); reader.next();)
    rows.emplace_back(reader.cells().begin(), reader.cells().end());
  return rows;
}

}  // namespace

TEST_CASE("rows are written as they are documented") {
  CsvWriter csv;
  csv.add_row(std::vector<std::string>{"name", "x"});
  csv.add("plain text");
  csv.add(0.1, 17);
  csv.end_row();
  csv.add("with, comma");
  csv.add(2.0 / 3.0, 4);
  csv.end_row();
  csv.add("with \"quotes\" and\na line end");
  csv.add(-7);
  csv.end_row();
  csv.add("");
  csv.add(std::nan(""), 17);
  csv.end_row();
  CHECK(csv.take() ==
        "name,x\n"
        "plain text,0.10000000000000001\n"
        "\"with, comma\",0.6667\n"
        "\"with \"\"quotes\"\" and a line end\",-7\n"
        ",nan\n");
  CHECK(csv.take().empty());
}

TEST_CASE("a number that is not known is an empty cell") {
  CHECK(number_cell(2.0 / 3.0, 4) == "0.6667");
  CHECK(number_cell(std::nan(""), 17).empty());
  CHECK(number_cell(-HUGE_VAL, 6).empty());
}

TEST_CASE("any cells come back, and numbers bit by bit") {
  const TemporaryFolder folder;
  Random random(3);
  const char letters[] = "ab,\" '\t;";
  std::vector<std::vector<std::string>> rows;
  std::vector<double> numbers;
  CsvWriter csv;
  for (int k = 0; k < 300; ++k) {
    std::vector<std::string> row;
    for (int c = 0; c < 3; ++c) {
      std::string& cell = row.emplace_back(c == 0 ? "k" : "");
      for (int n = random.below(5); n > 0; --n) cell += letters[random.below(6)];
    }
    for (const std::string& cell : row) csv.add(cell);
    rows.push_back(row);
    numbers.push_back(random.normal() * std::exp(50.0 * random.normal()));
    csv.add(numbers.back(), 17);
    csv.end_row();
  }
  const auto file = folder.write("a.csv", csv.take());
  CsvReader reader(file);
  for (size_t k = 0; k < rows.size(); ++k) {
    REQUIRE(reader.next());
    REQUIRE(reader.cells().size() == 4);
    for (size_t c = 0; c < 3; ++c) CHECK(reader.cells()[c] == rows[k][c]);
    CHECK(reader.number(3, "x") == numbers[k]);
  }
  CHECK_FALSE(reader.next());
}

TEST_CASE("files of other programs are read") {
  const TemporaryFolder folder;
  using Rows = std::vector<std::vector<std::string>>;
  CHECK(rows_of(folder.write("a.csv", "a,b\r\n\r\n1,2\r\n")) == Rows{{"a", "b"}, {"1", "2"}});
  CHECK(rows_of(folder.write("a.csv", "a,,\n,\nno line end")) ==
        Rows{{"a", "", ""}, {"", ""}, {"no line end"}});
  CHECK(rows_of(folder.write("a.csv", "\"a\",\"b,\"\"c\"\"\",\"\"\n")) ==
        Rows{{"a", "b,\"c\"", ""}});
  CHECK(rows_of(folder.write("a.csv", "")).empty());
}

TEST_CASE("what is wrong is told with its line") {
  const TemporaryFolder folder;
  using Texts = std::pair<std::string, std::string>;
  for (const auto& [text, said] : {Texts("a,1\nb,2\n", ""),
                                   {"a,1\n\nb,x2\n", ":3: x is not a number: \"x2\""},
                                   {"a,1\nb\n", ":2: 1 fields, expected 2"},
                                   {"\"a,1\n", ":1: a quote is not closed"},
                                   {"\"a\"b,1\n", ":1: a comma is missing after a quoted cell"}}) {
    const auto file = folder.write("a.csv", text);
    const auto read = [&] {
      for (CsvReader reader(file); reader.next();) {
        reader.require_cells(2);
        reader.number(1, "x");
      }
    };
    CHECK(complaint(read) == (said.empty() ? said : file.string() + said));
  }
  CHECK_THROWS_AS(CsvReader(folder.path() / "absent.csv"), Error);
}
