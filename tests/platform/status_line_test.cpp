#include "platform/status_line.hpp"

#include <sstream>

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("on a terminal a line rewrites itself, and a shorter one wipes the rest") {
  std::ostringstream out;
  {
    StatusLine line(StatusLine::Style::bar, out);
    line.write("12345");
    line.write("abc");
    CHECK(out.str() == "\r12345\rabc  ");
    line.end();
    line.end();  // only a line that is open
    CHECK(out.str() == "\r12345\rabc  \n");
    line.write("x");
  }
  CHECK(out.str() == "\r12345\rabc  \n\rx\n");  // the destructor ends it
}

TEST_CASE("elsewhere each line is a line, and quiet is quiet") {
  std::ostringstream out;
  {
    StatusLine line(StatusLine::Style::lines, out);
    line.write("one");
    line.write("two");
    line.end();
  }
  CHECK(out.str() == "one\ntwo\n");
  std::ostringstream nothing;
  StatusLine(StatusLine::Style::quiet, nothing).write("one");
  CHECK(nothing.str().empty());
  CHECK(StatusLine(StatusLine::Style::bar, out).interval() <
        0.1 * StatusLine(StatusLine::Style::lines, out).interval());
}

TEST_CASE("columns are letters, not bytes") {
  CHECK(columns_of("a▁µ") == 3);
  CHECK(cut_to("a▁µ", 2) == "a▁");
  CHECK(cut_to("ab", 5) == "ab");
  std::ostringstream out;
  StatusLine line(StatusLine::Style::bar, out, 3);
  line.write("▁▂▃▄");
  line.write("▁");
  CHECK(out.str() == "\r▁▂▃\r▁  ");
}

TEST_CASE("bars have one length") {
  CHECK(bar_text(0.0) == "[............] ");
  CHECK(bar_text(0.5) == "[######......] ");
  CHECK(bar_text(1.0) == "[############] ");
  CHECK(bar_text(-1.0) == bar_text(0.0));
  CHECK(bar_text(7.0) == bar_text(1.0));
}
