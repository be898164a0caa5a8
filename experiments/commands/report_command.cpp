// The page of a run, drawn again: after a full disk, with gnuplot installed meanwhile, or while the
// run goes on.

#include <iostream>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/run_page/report.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace {

ExitCode draw_pages(const std::vector<std::string>& folders) {
  for (const std::filesystem::path folder : folders) {
    if (!RunFolder(folder).has_run())
      throw Error(folder.string() + ": no run here: scene.toml is missing");
    write_report(folder);
    std::cout << (folder / "report.html").string() << std::endl;
  }
  return ExitCode::ok;
}

}  // namespace

Command report_command() {
  const auto folders = std::make_shared<std::vector<std::string>>();
  return {"report",
          "Draws the page of a run from its record, again or while it goes on",
          {{"run", folders.get(), "Folders of runs", required}},
          [folders] { return draw_pages(*folders); }};
}

}  // namespace ballast
