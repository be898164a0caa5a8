// The file of a row, and its line in the CSV.

#include "experiments/compare/compare_row.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "platform/error.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("A row survives its file to the last bit") {
  CompareRow row;
  row.key = "k";
  row.tolerance = 1e-6;
  row.case_name = "a, \"b\"";
  row.note = "line\nbreak";
  row.error = 0.1 + 0.2;
  row.judged.fclib = std::nan("");
  row.verdict = Verdict::timeout;
  row.start = StartKind::warm;
  row.measure = Measure::fclib;
  row.history = {{1, 1e-300, 1.0 / 3.0}, {2, 0.5, 5e-324}};
  const CompareRow back = compare_row_of_json(to_json(row), "file");
  CHECK(to_json(back) == to_json(row));
  CHECK(back.error == row.error);
  CHECK(std::isnan(back.judged.fclib));
  REQUIRE(back.history.size() == 2);
  CHECK(back.history[1].error == 5e-324);
  CHECK(compare_csv(std::vector{row}).find("\"a, \"\"b\"\"\"") != std::string::npos);
  CompareRow asked = row;
  asked.word = "a.dat";  // is not stored in the file
  const CompareRow again = compare_row_of_json(to_json(row), "file", asked);
  CHECK((again.word == "a.dat" && to_json(again) == to_json(row)));
  CHECK_THROWS_WITH(compare_row_of_json("{}", "row.json"),
                    Catch::StartsWith("row.json: is no row"));
}

TEST_CASE("A row whose numbers no solve can have is refused with its column") {
  CompareRow row;
  row.tolerance = 1e-6;
  CHECK_NOTHROW(compare_row_of_json(to_json(row), "row.json"));
  const auto complaint = [](const CompareRow& wrong) {
    try {
      compare_row_of_json(to_json(wrong), "row.json");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CompareRow wrong = row;
  wrong.solve_seconds = -5.0;
  CHECK(complaint(wrong) == "row.json: is no row of a comparison: solve_seconds is out of range");
  wrong = row;
  wrong.tolerance = std::nan("");
  CHECK_THAT(complaint(wrong), Catch::Contains("tolerance"));
  wrong = row;
  wrong.facts.contacts = -3;
  CHECK_THAT(complaint(wrong), Catch::Contains("contacts"));
}

TEST_CASE("Names of measures, starts and verdicts are read back, others are refused") {
  for (const Measure measure : {Measure::natural_map, Measure::fclib})
    CHECK(measure_of(name_of(measure)) == measure);
  for (const StartKind start : {StartKind::cold, StartKind::warm})
    CHECK(start_of(name_of(start)) == start);
  CHECK_THROWS_WITH(measure_of("siconos"),
                    "'siconos' is no measure; there are: natural_map, fclib");
  CHECK_THROWS_AS(start_of("Cold"), std::invalid_argument);
  const std::string json = to_json(CompareRow{});
  const size_t at = json.find("crashed");
  REQUIRE(at != std::string::npos);
  CHECK_THROWS_WITH(compare_row_of_json(std::string(json).replace(at, 7, "exploded"), "row.json"),
                    Catch::Contains("exploded"));
}

TEST_CASE("A broken name with a line break in it is refused in one line") {
  std::string json = to_json(CompareRow{});
  const std::string name = name_of(CompareRow{}.verdict);
  json.replace(json.find('"' + name + '"') + 1, name.size(), "ex\\nploded");
  CHECK_THROWS_WITH(compare_row_of_json(json, "row.json"),
                    Catch::Contains("'ex?ploded' is no verdict"));
}

TEST_CASE("A count that no int can hold is refused") {
  const std::string json = to_json(CompareRow{}), count = "\"repeat\":0";
  const size_t at = json.find(count);
  REQUIRE(at != std::string::npos);
  for (const char* wrong : {"1e300", "-9223372036854775809", "2147483648", "0.5", "null", "[]"})
    CHECK_THROWS_WITH(compare_row_of_json(std::string(json).replace(
                                              at, count.size(), std::string("\"repeat\":") + wrong),
                                          "row.json"),
                      Catch::StartsWith("row.json: is no row"));
}

TEST_CASE("Every line of the CSV has every column, and a line break in a note makes no line") {
  CompareRow row;
  row.note = "two\nlines, \"quoted\"";
  const std::string csv = compare_csv(std::vector{row, row});
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 3);
  CHECK(csv.find("\"two lines, \"\"quoted\"\"\"") != std::string::npos);
  const std::string head = csv.substr(0, csv.find('\n'));
  CHECK(std::count(head.begin(), head.end(), ',') + 1 ==
        static_cast<long>(compare_columns().size()));
}
