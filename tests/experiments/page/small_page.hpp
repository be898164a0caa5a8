#pragma once
// A page with one block of every kind. Every text that can come from outside is hostile.

#include "experiments/page/page.hpp"

namespace ballast::page {

inline constexpr const char* hostile = "<b>&\"'|`*_x_*[a](b)$~c~\x1b";

inline Page small_page() {
  Table table;
  table.caption = "Costs:";
  table.head = {"phase", marked("*t*~step~\n(ms)")};
  table.rows = {{"a | b", number(1.5)}, {styled("all", strong), quantity(2e-4, "ms")}};
  table.is_number = {false, true};
  Table facts{.is_facts = true};
  facts.rows = {{"commit", Text("0123", code)}};
  Picture picture;
  picture.plot.name = "wall";
  picture.plot.title = "The wall";
  picture.plot.panels = {Panel{}};
  picture.svg = "<svg><title>gnuplot</title></svg>";
  picture.caption = {marked("**Paper:** *x*")};
  picture.files = marked("[PDF](figures/wall.pdf)");
  Page page;
  page.title = "A small page";
  page.lede = {"2 steps", "", "made by hand"};
  page.notices = {"To be known", {"no scene.toml"}};
  page.add({"numbers", marked("In *numbers*"), {Subheading{"h"}, "A paragraph.", table, facts}});
  page.add({"nothing", "Nothing", {Table{}, Text(), List{}, Subheading{"alone"}}});
  page.add(
      {"rest",
       "The rest",
       {picture, List{{"one", "two"}}, Listing{"a <b>\n```\n"}, Listing{"x = 1", "All of it"}}});
  return page;
}

}  // namespace ballast::page
