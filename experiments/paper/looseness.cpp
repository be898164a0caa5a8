// How loose may the solver be? The same start under more and fewer iterations and other backends:
// which observables move, by how much beyond the spread between samples, and at what cost.

#include <algorithm>
#include <cmath>

#include "experiments/paper/run_groups.hpp"

namespace ballast {
namespace {

/// One way in which the solver was loosened, on sample 1: a table and a curve.
struct Loosening {
  Varied varied;
  const char *name, *title;  ///< of the table's words, and in the legend
  Ink ink;
  MarkShape shape;
};
constexpr Loosening loosenings[] = {
    {Varied::iterations, "slow", "nncg, 10 Hz", Ink::blue, MarkShape::circle},
    {Varied::iterations_fast, "fast", "nncg, 60 Hz", Ink::vermilion, MarkShape::triangle},
    {Varied::backend, "backends", "other backends, 10 Hz", Ink::green, MarkShape::square}};

double error_of(const VariedValue& value) { return value.samples.front().error_mean; }

double milliseconds(const VariedValue& value) {
  return 1e3 * value.samples.front().seconds_per_step;
}

bool is_tighter(const VariedValue& a, const VariedValue& b) { return error_of(a) < error_of(b); }

/// A quantity of the only sample.
double seen(const VariedValue& value, double Observation::*quantity) {
  return value.samples.front().*quantity;
}

/// What Delta x_max of two runs of one packing differs by at most, by chance alone (95 %):
/// relative.
double chance_of(const std::vector<VariedValue>& base) {
  const PooledError scatter = scatter_paired(base, &Observation::rise);
  return student_t95(scatter.degrees_of_freedom) * std::sqrt(2.0) * scatter.deviation;
}

page::Table table_of(const Loosening& what, const std::vector<VariedValue>& values,
                     const VariedValue& tightest) {
  page::Table table = observable_table(std::string("looseness.") + what.name);
  for (const VariedValue& value : values) {
    table.rows.push_back(
        {value.label, page::number(error_of(value), 2), page::number(milliseconds(value))});
    for (const ObservableColumn& column : observable_columns()) {
      const double now = seen(value, column.value), best = seen(tightest, column.value);
      page::Text cell = page::number(column.factor * now);
      if (value.label != tightest.label)
        cell += " (" + (best == 0.0 ? page::Text("–") : page::percent(now / best - 1.0)) + ")";
      table.rows.back().push_back(cell);
    }
  }
  return table;
}

/// Deviation of Delta x_max from the tightest run's, against the error or the time of a step.
Curve deviation_curve(const Loosening& what, const std::vector<VariedValue>& values,
                      const VariedValue& tightest, bool against_time) {
  VariedCurve points;
  for (const VariedValue& value : values) {
    if (value.label == tightest.label) continue;
    const double ratio = seen(value, &Observation::rise) / seen(tightest, &Observation::rise);
    points.x.push_back(against_time ? milliseconds(value) : error_of(value));
    points.y.push_back(std::max(1e-4, std::abs(ratio - 1.0)));
  }
  Curve curve = points_of(points, what.title, what.ink);
  curve.shape = what.shape;
  return curve;
}

Panel deviation_panel(const char* x_label, double spread) {
  Panel panel{.x_label = x_label,
              .y_label = "|deviation of Δ{/:Italic x}_{max}|",
              .log_x = true,
              .log_y = true};
  if (std::isfinite(spread) && spread > 0.0)
    panel.lines = {{spread, "chance, runs of one packing (95 %)", false, Ink::grey}};
  return panel;
}

/// Loosest run whose Delta x_max lies within the samples' spread of the tightest one's, and so do
/// all tighter ones.
page::Text loosest_good(std::vector<VariedValue> values, double spread) {
  std::sort(values.begin(), values.end(), is_tighter);
  page::Text good;
  for (const VariedValue& value : values) {
    const double best = seen(values.front(), &Observation::rise);
    if (!(std::abs(seen(value, &Observation::rise) / best - 1.0) <= spread)) break;
    good = value.label + " iterations, error " + page::number(error_of(value), 2) + " g·h";
  }
  return good;
}

}  // namespace

PaperSection looseness_section(PaperData& data) {
  PaperSection section{.text = {page::words("looseness.intro")}};
  const double spread = chance_of(data.values(Varied::force));
  Figure figure{.height = 800,
                .panels = {deviation_panel("rms error / ({/:Italic g h})", spread),
                           deviation_panel("wall clock of a step, median  (ms)", spread)}};
  for (const Loosening& what : loosenings) {
    std::vector<VariedValue> values = read_values(data, what.varied, section), compared = values;
    // at one frequency there is one reference: other backends are compared with the tightest nncg
    if (what.varied == Varied::backend) {
      for (const VariedValue& value : data.values(Varied::iterations)) compared.push_back(value);
      // nncg's own run is drawn among its iterations
      std::erase_if(values, [](const VariedValue& value) { return value.value == 0.0; });
    }
    if (values.empty() || compared.size() < 2) continue;
    // the others are compared with the run of the smallest error
    const VariedValue& tightest = *std::min_element(compared.begin(), compared.end(), is_tighter);
    section.tables.push_back(table_of(what, values, tightest));
    for (const bool against_time : {false, true})
      figure.panels[against_time].curves.push_back(
          deviation_curve(what, values, tightest, against_time));
    if (what.varied == Varied::iterations && values.size() > 2 && std::isfinite(spread))
      section.report("looseness.claim", {{"spread", page::number(100.0 * spread, 2)},
                                         {"good", loosest_good(values, spread)}});
  }
  if (!section.tables.empty()) section.draw("looseness", figure);
  return section;
}

}  // namespace ballast
