#include "experiments/view/view_page.hpp"

#include "experiments/page/html.hpp"
#include "experiments/view/pack_view.hpp"
#include "experiments/view/still.hpp"

namespace ballast {

page::Replay replay_of(const ViewData& view) {
  const bool moves = view.frames.size() > 1;
  std::string still =
      still_png(view, 0, {.width = 640, .height = 420, .colour = moves ? "speed" : "size"});
  page::Replay replay = pack_view(view);
  replay.still = std::move(still);
  replay.caption = page::words(moves ? "view.motion" : "view.still");
  if (!view.errors.empty()) replay.caption += page::words("view.errors");
  if (!view.has_shapes) replay.caption += page::words("view.no_shapes");
  if (view.errors.empty() && moves && !view.contacts)
    replay.caption += page::words("view.no_forces");
  return replay;
}

void write_view_page(const ViewData& view, const std::filesystem::path& file) {
  page::Page page;
  page.title = view.title;
  page::Section motion{"motion", view.errors.empty() ? "In 3D" : "The error in space"};
  motion.add(replay_of(view));
  page.add(std::move(motion));
  write_html_file(file, page);
}

}  // namespace ballast
