#include "platform/status_line.hpp"

#include <iostream>
#include <sstream>
#include <utility>

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("a line rewrites itself on a terminal, elsewhere each is a line, and quiet is quiet") {
  using Style = StatusLine::Style;
  for (const auto& [style, expected] :
       {std::pair(Style::bar,
                  "\r\x1b[K\x1b[?7lone\x1b[?7h\r\x1b[K\x1b[?7ltwo\x1b[?7h\n"  // ended once
                  "\r\x1b[K\x1b[?7lthree\x1b[?7h\n"),                         // by destructor
        {Style::lines, "one\ntwo\nthree\n"},
        {Style::quiet, ""}}) {
    std::ostringstream out;
    {
      StatusLine line(style, out);
      line.write("one");
      line.write("two");
      line.end();
      line.end();
      line.write("three");
    }
    CHECK(out.str() == expected);
  }
  CHECK(StatusLine(Style::bar, std::cerr).interval() <
        0.1 * StatusLine(Style::lines, std::cerr).interval());
}

TEST_CASE("bars have one length") {
  CHECK(bar_text(0.0) == "[............] ");
  CHECK(bar_text(0.5) == "[######......] ");
  CHECK(bar_text(1.0) == "[############] ");
  CHECK(bar_text(-1.0) == bar_text(0.0));
  CHECK(bar_text(7.0) == bar_text(1.0));
}
