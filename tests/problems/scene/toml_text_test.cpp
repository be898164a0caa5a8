// TOML as it is written: one text for one table, from which the same table is read.

#include "problems/scene/toml_text.hpp"

#include <cmath>
#include <limits>

#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/problems/scene/scene_texts.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

std::string again(const std::string& text) { return toml_text(toml::parse(text)); }

}  // namespace

TEST_CASE("tables come sorted: keys, then tables, then lists of tables") {
  CHECK(again("z = 1\na = [1, 2.5, \"x\"]\n[[list]]\nk = true\n[[list]]\n[b.c]\nd = {e = 1}\n") ==
        "a = [1, 2.5, \"x\"]\nz = 1\n\n[b]\n\n[b.c]\n\n[b.c.d]\ne = 1\n\n[[list]]\nk = true\n"
        "\n[[list]]\n");
}

TEST_CASE("a float keeps its bits and stays a float") {
  for (const double x : {0.1, 1.0, -0.0, 1e300, 5e-324, 1.0 / 3.0, 2e-4, 123456789.0}) {
    const std::string text = toml_value_text(toml::value<double>(x), 99);
    INFO(text);
    const toml::table table = toml::parse("x = " + text);
    REQUIRE(table["x"].is_floating_point());
    CHECK(*table["x"].value<double>() == x);
    CHECK(std::signbit(*table["x"].value<double>()) == std::signbit(x));
  }
  CHECK(toml_value_text(toml::value<double>(std::nan("")), 99) == "nan");
  CHECK(toml_value_text(toml::value<double>(-std::numeric_limits<double>::infinity()), 99) ==
        "-inf");
}

TEST_CASE("odd keys and texts are quoted, and read back") {
  const toml::table odd{{"a b", "quote \" backslash \\ bell \a"}, {"", 1}};
  const std::string text = toml_text(odd);
  CHECK(toml::parse(text) == odd);
  CHECK(toml_text(toml::parse(text)) == text);
}

TEST_CASE("a long value is cut") {
  CHECK(toml_value_text(toml::value<std::string>("abcdefgh"), 5) == "\"abcd...");
  CHECK(toml_value_text(toml::array{1, 2}, 6) == "[1, 2]");
}

TEST_CASE("the resolved text keeps every bit and any text") {
  const TemporaryFolder folder;
  const std::string title = "quote \\\" backslash \\\\ tab \\t bell \\u0007 \xc3\xa9";
  const auto file = folder.write(
      "odd.toml", one_wall +
                      "offset = 0.1000000000000000055511151231257827\n[scene]\nstep = 5e-324\n"
                      "duration = 4e-312\ntitle = \"" +
                      title + "\"\n[contact]\nfriction = 3\n");
  const Scene first = read_scene(file);
  const Scene again = read_scene(folder.write("again.toml", resolved_scene_text(file)));
  CHECK(again.step == first.step);
  CHECK(again.title == first.title);
  CHECK(first.title.find('\a') != std::string::npos);
  CHECK(again.walls[0].offset == first.walls[0].offset);
  CHECK(again.friction == 3.0);
}
