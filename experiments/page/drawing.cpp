#include "experiments/page/drawing.hpp"

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast::page {
namespace {

namespace fs = std::filesystem;

/// The picture as a file on its own: on white, whatever is behind it.
std::string with_white_ground(std::string svg) {
  const size_t root = svg.find("<svg");
  const size_t end = root == std::string::npos ? root : svg.find('>', root);
  if (end != std::string::npos)
    svg.insert(end + 1, "\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>");
  return svg;
}

void draw(Picture& picture, const fs::path& folder, const Drawing& drawing) {
  const std::string& name = picture.plot.name;
  picture.svg = render_svg(picture.plot, folder);
  if (drawing.on_white) write_whole_file(folder / (name + ".svg"), with_white_ground(picture.svg));
  if (drawing.with_pdf) render_pdf(picture.plot, folder);
  std::error_code ignored;
  if (!drawing.with_script) fs::remove(folder / (name + ".gnuplot"), ignored);
}

}  // namespace

void draw_pictures(Page& page, const fs::path& folder, const Drawing& drawing) {
  const bool has_gnuplot = !gnuplot_version().empty();
  bool is_any_missing = false;
  // draws one; false: it is to be dropped
  const auto is_drawn = [&](Picture& picture) {
    if (picture.plot.panels.empty()) return false;
    if (!has_gnuplot) is_any_missing = true;
    if (!has_gnuplot) return false;
    try {
      draw(picture, folder / picture_folder, drawing);
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
