#include "experiments/page/page.hpp"

#include "platform/atomic_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/environment_guard.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast::page {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

Picture picture(const std::string& name) {
  return {.plot = {.name = name, .panels = {{.curves = {{.x = {0, 1}, .y = {1, 2}}}}}}};
}

Page page_with(std::vector<Picture> pictures) {
  Page page;
  page.add({"figures", "Figures", {"before"}});
  page.sections[0].add(pictures);
  return page;
}

TEST_CASE("every picture is drawn beside the page, as SVG and script") {
  const TemporaryFolder folder;
  Page page = page_with({picture("one"), picture("two")});
  draw_pictures(page, folder.path());
  CHECK(page.notices.items.empty());
  REQUIRE(page.sections[0].blocks.size() == 3);
  CHECK_THAT(std::get<Picture>(page.sections[0].blocks[2]).svg, Contains("</svg>"));
  for (const char* name : {"one.svg", "one.gnuplot", "two.svg"})
    CHECK(fs::exists(folder.path() / picture_folder / name));
}

TEST_CASE("a picture for pages that show its file is on white, its script gone") {
  const TemporaryFolder folder;
  Page page = page_with({picture("one")});
  draw_pictures(page, folder.path(), {.is_file_shown = true});
  const fs::path figures = folder.path() / picture_folder;
  CHECK_THAT(read_whole_file(figures / "one.svg"), Contains("fill=\"#ffffff\"/>"));
  CHECK_THAT(std::get<Picture>(page.sections[0].blocks[1]).svg, !Contains("fill=\"#ffffff\"/>"));
  CHECK(std::distance(fs::directory_iterator(figures), fs::directory_iterator()) == 1);
}

TEST_CASE("what cannot be drawn is dropped and said, what has no panel is dropped") {
  const TemporaryFolder folder;
  Picture wrong = picture("wrong"), bare = picture("bare");
  wrong.plot.panels[0].curves[0].y.assign(2, std::nan(""));
  bare.plot.panels.clear();
  Page page = page_with({wrong, bare, picture("one")});
  draw_pictures(page, folder.path());
  REQUIRE(page.notices.items.size() == 1);
  CHECK_THAT(plain_words(page.notices.items[0]),
             Contains("figure wrong") && Contains("The figure is left out."));
  CHECK(page.sections[0].blocks.size() == 2);
}

TEST_CASE("without gnuplot one notice stands for all figures") {
  const TemporaryFolder folder, empty;
  const EnvironmentGuard guard("PATH", empty.path().string());
  Page page = page_with({picture("one"), picture("two")});
  draw_pictures(page, folder.path(), {.command = "ballast report"});
  REQUIRE(page.notices.items.size() == 1);
  CHECK(plain_words(page.notices.items[0]) ==
        "gnuplot was not found: this page has no figures. With gnuplot installed, \"ballast "
        "report\" makes them.");
  Page words = page_with({});
  draw_pictures(words, folder.path());
  CHECK(words.notices.items.empty());
}

}  // namespace
}  // namespace ballast::page
