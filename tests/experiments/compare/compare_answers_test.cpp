// What the comparison's page is given: the CSV's cells, histories that fit into a page, and a
// command for every row.

#include "experiments/compare/compare_answers.hpp"

#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"

using namespace ballast;
using Json = nlohmann::json;

TEST_CASE("The page's data are the cells of the CSV, to the letter") {
  std::vector<CompareRow> rows = {hand_made_row("x, \"1\"", "a", 0.1, Verdict::solved),
                                  hand_made_row("y", "b", 60.0, Verdict::timeout)};
  rows[0].key = "k0";
  rows[0].word = "my problems/x.dat";
  const page::Answers answers = comparison_answers({}, rows, 60.0);
  CHECK(answers.are_given);
  const Json data = Json::parse(answers.data);
  REQUIRE(data["columns"].size() == compare_columns().size());
  REQUIRE(data["rows"].size() == 2);
  for (size_t r = 0; r < 2; ++r)
    for (size_t c = 0; c < compare_columns().size(); ++c) {
      CHECK(data["columns"][c][0] == compare_columns()[c].name);
      CHECK(data["rows"][r][c] == compare_columns()[c].text(rows[r]));
    }
  CHECK(data["limit"] == 60.0);
  // a shell reads the word as one; a case without one is named
  CHECK(data["words"]["x, \"1\""] == "'my problems/x.dat'");
  CHECK(data["words"]["y"] == "y");
  CHECK(data["again"].get<std::string>().find("--measure natural_map --max-seconds 60 --output") !=
        std::string::npos);
  // seconds and error by turns
  CHECK(data["histories"]["k0"] == Json{0.0, 1.0, 0.05, 0.01, 0.1, 5e-5});
}

TEST_CASE("Memory is limited as it was") {
  RunData data;
  auto manifest = std::make_shared<nlohmann::ordered_json>();
  (*manifest)["summary"]["memory_MB"] = 512.0;
  data.stored_manifest = manifest;
  const std::vector<CompareRow> rows = {hand_made_row("x", "a", 0.1, Verdict::solved)};
  const Json json = Json::parse(comparison_answers(data, rows, 60.0).data);
  CHECK(json["again"].get<std::string>().find("--memory 512") != std::string::npos);
}

TEST_CASE("Long histories are thinned out to what a page can hold") {
  CompareRow row = hand_made_row("x", "a", 1.0, Verdict::solved);
  row.history.clear();
  for (int k = 0; k < 5000; ++k) row.history.push_back({k, 1e-4 * k, 1.0 / (1.0 + k)});
  const std::vector<CompareRow> rows(3000, row);
  const Json data = Json::parse(comparison_answers({}, rows, 60.0).data);
  const size_t points = data["histories"][""].size() / 2;
  CHECK(points >= 8);
  CHECK(points <= 40);
  CHECK(data["histories"][""].back() == 1.0 / 5000);  // the last error is kept
}
