#include "platform/text.hpp"

#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <vector>

#include "platform/error.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("printed() is as long as it needs") {
  CHECK(printed("%s %d %.3g", "a", 7, 0.25) == "a 7 0.25");
  CHECK(printed("%s", "").empty());
  const std::string many(100000, 'x');
  CHECK(printed("%s!", many.c_str()) == many + "!");
  const double x = 0.1 + 0.2;
  CHECK(parsed_number(printed("%.17g", x)) == x);
}

TEST_CASE("lists have a separator between their items alone") {
  CHECK(joined(std::vector<std::string>{}).empty());
  CHECK(joined(std::vector<std::string>{"one"}) == "one");
  CHECK(joined(std::vector<const char*>{"one", "", "three"}) == "one, , three");
  CHECK(joined(std::vector<std::string>{"", "two"}) == ", two");
  CHECK(joined(std::set<std::string>{"b", "a"}) == "a, b");
  std::string list;
  add_to_list(list, "a");
  add_to_list(list, "b");
  CHECK(list == "a, b");
}

TEST_CASE("one line holds no control character, and an Error is one line") {
  const std::string text("a\nb\r\tc\0d\x7f", 9), other = "\xc3\xa9\xff ~";
  CHECK(one_line(text, ' ') == "a b  c d ");
  CHECK(one_line(other, '?') == other);  // characters beyond ASCII stay
  CHECK(std::string(Error("file: " + text).what()) == "file: a?b??c?d?");
}

TEST_CASE("a number is all of a text, or it is none") {
  CHECK(parsed_number("  -1.5e-3 ") == -1.5e-3);
  CHECK(parsed_number("5e-324") == std::numeric_limits<double>::denorm_min());
  CHECK(std::isnan(parsed_number("nan").value()));
  CHECK(parsed_number("-inf") == -std::numeric_limits<double>::infinity());
  for (const char* text : {"", " ", "1,5", "1.5x", "0x10", "1 2", "+", "1e999"}) {
    CAPTURE(text);
    CHECK_FALSE(parsed_number(text));
  }
  CHECK(parsed<long>("-12") == -12);
  CHECK(parsed<double>("1e-4") == 1e-4);
  for (const char* text : {"", " 1", "1 ", "1.5", "1x", "9223372036854775808"}) {
    CAPTURE(text);
    CHECK_FALSE(parsed<long>(text));
  }
}

TEST_CASE("durations are told in two units") {
  CHECK(duration_text(0.4) == "0 s");
  CHECK(duration_text(59.4) == "59 s");
  CHECK(duration_text(59.6) == "1 min 00 s");
  CHECK(duration_text(185) == "3 min 05 s");
  CHECK(duration_text(7800) == "2 h 10 min");
  CHECK(duration_text(1e7) == "?");
  CHECK(duration_text(std::nan("")) == "?");
}

TEST_CASE("a text is cut at every separator and nowhere else") {
  using Parts = std::vector<std::string>;
  CHECK(split("a,b", ',') == Parts{"a", "b"});
  CHECK(split("", ',') == Parts{""});
  CHECK(split(",a,,b c,", ',') == Parts{"", "a", "", "b c", ""});
  CHECK(split("a.b", ',') == Parts{"a.b"});
}

TEST_CASE("a plain text is letters, digits and what else was said") {
  CHECK(is_plain("azAZ09", ""));
  CHECK(is_plain("a_b-c", "_-"));
  CHECK(made_plain("a b-c\xc3\xa9.d", "-") == "a_b-c___d");
  for (const char* text : {"", "a_b", "ä", "a b", "@", "[", "`", "{", "/", ":"}) {
    CAPTURE(text);
    CHECK_FALSE(is_plain(text, "-"));
  }
}

TEST_CASE("a slip of the finger is recognised, another word is not") {
  for (const auto& [a, b, distance] : {std::tuple("", "", 0u),
                                       {"run", "run", 0u},
                                       {"rnu", "run", 2u},
                                       {"kitten", "sitting", 3u},
                                       {"", "abc", 3u},
                                       {"abc", "", 3u}})
    CHECK(edit_distance(a, b) == distance);
  const std::vector<std::string> words{"run", "solve", "compare", "vibrated_box_small"};
  for (const auto& [word, meant] :
       {std::pair("rnu", "run"), {"compere", "compare"}, {"vibratedboxsmal", "vibrated_box_small"}})
    CHECK(did_you_mean(word, words) == ", did you mean \"" + std::string(meant) + "\"?");
  CHECK(did_you_mean("x", std::vector<std::string>{}).empty());
  CHECK(did_you_mean("frobnicate", words).empty());
}

TEST_CASE("an enumerator's name stands at its place") {
  enum class Fruit { apple, pear };
  CHECK(name_in({"apple", "pear"}, Fruit::pear) == std::string("pear"));
  CHECK(name_in({"apple", "pear"}, static_cast<Fruit>(2)) == std::string("unknown"));
}

TEST_CASE("keys are FNV-1a: its published values") {
  CHECK(fnv1a("") == 0xcbf29ce484222325ull);
  CHECK(fnv1a("a") == 0xaf63dc4c8601ec8cull);
  CHECK(fnv1a("foobar") == 0x85944171f73967e8ull);
  CHECK(content_key("foobar") == "85944171f73967e8");
  CHECK(fnv1a("bar", fnv1a("foo")) == fnv1a("foobar"));
}
