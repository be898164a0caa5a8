#include "experiments/page/page.hpp"

#include <algorithm>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast::page {

namespace fs = std::filesystem;

bool is_empty(const Block& block) {
  return std::visit([](const auto& one) { return one.empty(); }, block);
}

void Section::add(const std::vector<Picture>& pictures) {
  blocks.insert(blocks.end(), pictures.begin(), pictures.end());
}

bool Section::is_empty() const {
  // a heading alone is no content
  return std::ranges::all_of(blocks, [](const Block& block) {
    return std::holds_alternative<Subheading>(block) || page::is_empty(block);
  });
}

Table words_table(const std::string& name, const Values& values) {
  const std::vector<Text> lines = parts_of(words(name, values), "\n");
  Table table{.caption = lines.front(), .head = parts_of(lines.at(lines.size() > 1), "||")};
  for (size_t k = 2; k < lines.size(); ++k) table.rows.push_back(parts_of(lines[k], "||"));
  return table;
}

void draw_pictures(Page& page, const fs::path& folder, const Drawing& drawing) {
  const bool has_gnuplot = !gnuplot_version().empty();
  bool is_any_missing = false;
  // draws a picture; false: the picture is to be dropped
  const auto is_drawn = [&](Picture& picture) {
    if (picture.plot.panels.empty()) return false;
    is_any_missing |= !has_gnuplot;
    if (!has_gnuplot) return false;
    const fs::path figures = folder / picture_folder;
    const std::string& name = picture.plot.name;
    try {
      picture.svg = render_svg(picture.plot, figures);
      if (!drawing.is_file_shown) return true;
      // the file has a white ground, whatever program shows it
      std::string svg = picture.svg;
      svg.insert(svg.find('>', svg.find("<svg")) + 1,
                 "\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>");
      write_whole_file(figures / (name + ".svg"), svg);
      std::error_code ignored;
      fs::remove(figures / (name + ".gnuplot"), ignored);
      return true;
    } catch (const Error& error) {
      page.notices.items.push_back(std::string(error.what()) + ". The figure is left out.");
      return false;
    }
  };
  for (Section& section : page.sections)
    std::erase_if(section.blocks, [&](Block& block) {
      Picture* picture = std::get_if<Picture>(&block);
      return picture && !is_drawn(*picture);
    });
  if (!is_any_missing) return;
  std::string notice = "gnuplot was not found: this page has no figures.";
  if (!drawing.command.empty())
    notice += " With gnuplot installed, \"" + drawing.command + "\" makes them.";
  page.notices.items.push_back(notice);
}

}  // namespace ballast::page
