#include "experiments/paper/section.hpp"

#include "platform/csv.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// The k-th value as a cell; empty where there is none or it is not finite.
void add_value(CsvWriter& csv, const std::vector<double>& values, size_t k) {
  if (k < values.size() && std::isfinite(values[k]))
    csv.add(values[k], 10);
  else
    csv.add("");
}

}  // namespace

void PaperSection::draw(const std::string& name, Figure plot, const page::Values& values) {
  // "fig9" is kept as fig09, so that files sort by number
  const bool has_one_digit = name.starts_with("fig") && name.size() == 4;
  const std::string file = has_one_digit ? "fig0" + name.substr(3) : name;
  if (plot.name.empty()) plot.name = file;
  plot.has_letters = plot.panels.size() > 1;
  if (plot.title.empty()) plot.title = plain_words(page::words(name + ".title"));
  figures.push_back({std::move(plot),
                     {page::marked("**Paper:** ") + page::words(name + ".paper"),
                      page::marked("**Ballast:** ") + page::words(name + ".found", values)},
                     page::Text("data", 0, "data/" + file + ".csv")});
}

void PaperSection::claim(const std::string& name, const page::Values& values,
                         const PaperRange& range, const Found& found) {
  const std::vector<page::Text> cells = parts_of(page::words(name, values), "||");
  rows.push_back({cells.at(0), cells.at(1), cells.at(2), range, found, agreement_of(range, found)});
}

void PaperSection::report(const std::string& name, const page::Values& values) {
  const std::vector<page::Text> cells = parts_of(page::words(name, values), "||");
  findings.push_back({cells.at(0), cells.at(1)});
}

void PaperSection::add(page::Table table) {
  if (!table.rows.empty()) tables.push_back(std::move(table));
}

page::Text words_of(const SampleMean& mean, double factor) {
  return page::with_error(factor * mean.mean, factor * mean.error);
}

page::Text samples_of(const Group& group) { return std::to_string(group.samples.size()); }

page::Text words_of(const PowerFit& fit) {
  if (!std::isfinite(fit.exponent)) return "–";
  page::Text text = page::number(fit.exponent);
  if (std::isfinite(fit.half_width))
    text += std::string(" ") +
            page::interval(fit.exponent - fit.half_width, fit.exponent + fit.half_width);
  return text + " (R² " + page::number(fit.r2, 4) + ", " + std::to_string(fit.samples) + " points)";
}

page::Text words_of(const Proportion& fit, int digits) {
  return page::number(fit.factor, digits) + " " + page::interval(fit.low, fit.high);
}

page::Text words_of(const Misfit& misfit) {
  return "χ²/dof " + page::number(misfit.reduced, 2) + ", p " + words_of_p(misfit.p);
}

page::Text words_of_p(double p) { return p < 1e-4 ? page::Text("< 1e-4") : page::number(p, 2); }

page::Text words_with_interval(const SampleMean& mean) {
  if (!std::isfinite(mean.mean)) return "–";
  page::Text words = page::number(mean.mean);
  if (mean.samples < 2) return words + " (one sample)";
  const double half = mean.half_width();
  return words + " " + page::interval(mean.mean - half, mean.mean + half);
}

page::Text words_of_change(const SampleMean& change) {
  if (!std::isfinite(change.mean)) return "–";
  const page::Text mean = page::percent(std::expm1(change.mean));
  const double half = change.half_width();
  if (!std::isfinite(half)) return mean;
  return mean + " " +
         page::interval(100.0 * std::expm1(change.mean - half),
                        100.0 * std::expm1(change.mean + half));
}

Panel frequency_panel(const std::string& y_label) {
  return {.x_label = "{/:Italic ν}  (Hz)",
          .y_label = y_label,
          .log_x = true,
          .x_min = 0.85,
          .x_max = 70.0,
          .x_ticks = {1, 2, 5, 10, 20, 60}};
}

Curve curve_of(const Points& points, const std::string& title, Ink ink, MarkShape shape) {
  Curve curve{.x = points.x,
              .y = points.y,
              .title = title,
              .ink = ink,
              .mark = Mark::points,
              .shape = shape,
              .width = 2.4,
              .y_error = points.error};
  for (double& bar : curve.y_error)
    if (!std::isfinite(bar)) bar = 0.0;  // one sample: no bar
  return curve;
}

std::string figure_csv(const Figure& figure) {
  CsvWriter csv;
  csv.add_row(std::vector<std::string>{"panel", "y_label", "curve", "x_label", "x", "y", "y_error",
                                       "y_low"});
  for (size_t p = 0; p < figure.panels.size(); ++p) {
    const Panel& panel = figure.panels[p];
    for (size_t c = 0; c < panel.curves.size(); ++c) {
      const Curve& curve = panel.curves[c];
      for (size_t k = 0; k < curve.x.size(); ++k) {
        csv.add(static_cast<long>(p + 1));
        csv.add(panel.y_label);
        csv.add(curve.title.empty() ? std::to_string(c + 1) : curve.title);
        csv.add(panel.x_label);
        for (const auto* values : {&curve.x, &curve.y, &curve.y_error, &curve.y_low})
          add_value(csv, *values, k);
        csv.end_row();
      }
    }
  }
  return csv.take();
}

}  // namespace ballast
