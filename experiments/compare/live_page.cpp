#include "experiments/compare/live_page.hpp"

#include <nlohmann/json.hpp>

#include "experiments/compare/compare_figures.hpp"
#include "experiments/compare/live_figures.hpp"
#include "experiments/compare/live_row.hpp"
#include "experiments/compare/page_origin.hpp"
#include "experiments/page/page.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

page::Table rows_table(const std::vector<LiveRow>& rows, const LiveComparison& comparison) {
  using page::number;
  using page::quantity;
  page::Table table;
  table.head = {"backend, tolerance",
                "law",
                "ended",
                "error, mean",
                "worst",
                "above tolerance",
                page::marked("wall *x*"),
                page::marked("mean *f*~g~"),
                "overlap",
                "kinetic energy",
                "solid fraction",
                "iterations",
                "solve per step",
                "distance"};
  table.is_number.assign(table.head.size(), true);
  table.is_number[0] = table.is_number[1] = table.is_number[2] = false;
  for (const LiveRow& r : rows) {
    const bool is_reference =
        comparison.reference >= 0 &&
        r.trajectory == &comparison.trajectories[static_cast<size_t>(comparison.reference)];
    page::Text label = r.trajectory->label();
    if (is_reference) label += page::Text(" (reference)", page::strong);
    table.rows.push_back({label, r.trajectory->law, r.trajectory->ended, number(r.error_mean),
                          number(r.error_max), quantity(100.0 * r.missed, "%"),
                          quantity(1e3 * r.wall_x, "mm", 4), quantity(r.force_mean, "N", 4),
                          quantity(1e6 * r.penetration_max, "µm"), quantity(r.kinetic_energy, "J"),
                          number(r.solid_fraction, 4), number(r.iterations),
                          quantity(r.solve_ms_per_step, "ms"), quantity(1e6 * r.distance, "µm")});
  }
  return table;
}

/// For a click on a point: its trajectory's row of the table, and the command that makes it again.
std::string origins_of(const LiveComparison& comparison) {
  nlohmann::ordered_json data, &origins = data["origins"] = nlohmann::ordered_json::object();
  for (const Trajectory& t : comparison.trajectories) {
    const std::string label = t.label();
    origins[label] = {{"row", label}};
    // so many iterations whatever the error are no option of the command line
    if (t.max_iterations > 0 || comparison.command.empty()) continue;
    const std::string command = comparison.command + " --solvers " + t.solver +
                                printed(" --tolerances %g --output results/again", t.tolerance);
    origins[label]["commands"].push_back({command, "Made again by:"});
  }
  return data.dump();
}

}  // namespace

void write_live_page(const std::filesystem::path& folder, const LiveComparison& comparison) {
  const std::vector<LiveRow> rows = live_rows(comparison);
  for (const Trajectory& t : comparison.trajectories)
    write_whole_file(folder / ("steps-" + figure_name(t.label()) + ".csv"), steps_csv(t));
  write_whole_file(folder / "live.csv", live_csv(rows));
  page::Page page{.title = "One start, several solvers: " + comparison.scene.name};
  page.add(
      {"table",
       "Side by side",
       {page::words("live.table", {{"scale", page::quantity(comparison.velocity_scale, "m/s")}}),
        rows_table(rows, comparison)}});
  page::Section figures{"figures", "Figures"};
  figures.add(live_figures(comparison));
  page.add(figures);
  page.answers = {.are_given = true, .with_curves = true, .data = origins_of(comparison)};
  write_with_origin(page, read_origin(folder), folder / "live.html");
}

}  // namespace ballast
