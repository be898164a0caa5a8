#include "experiments/page/html.hpp"
#include "platform/deflate.hpp"
#include "tests/catch.hpp"
#include "tests/support/page_sample.hpp"

namespace ballast::page {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("a replay stands in one page with its data, its script and a still picture") {
  Page page;
  page.title = "t";
  page.add({"motion",
            "Motion",
            {Replay{.head = "{\"title\":\"</script><b>\"}",
                    .parts = {{"positions", std::string(1000, '\1')}},
                    .still = "\x89PNG",
                    .caption = "What is seen."}}});
  const std::string html = html_of(page);
  check_page(html);
  CHECK_THAT(html, Contains("{\"title\":\"<\\/script><b>\"}</script>"));
  CHECK_THAT(html, Contains("id=\"replay-positions\">" +
                            base64(deflated(std::string(1000, '\1'), 9)) + "</script>"));
  CHECK_THAT(html, Contains("src=\"data:image/png;base64," + base64("\x89PNG") + "\""));
  CHECK_THAT(html, Contains("<figcaption>What is seen.</figcaption>"));
  // every module is in it, once
  for (const char* name : {"class Data ", "class Camera ", "class Stage ", "class Plots ",
                           "class Replay ", "function drawResting("})
    CHECK((html.find(name) != std::string::npos && html.find(name) == html.rfind(name)));
}

TEST_CASE("a page without bodies has no script at all") {
  Page page;
  page.add({"motion", "Motion", {Replay{}}});
  CHECK_THAT(html_of(page), !Contains("<script") && !Contains("Motion"));
}

}  // namespace
}  // namespace ballast::page
