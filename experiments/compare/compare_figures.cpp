#include "experiments/compare/compare_figures.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "experiments/page/page.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

constexpr const char* seconds_axis = "time  (s)";

/// "cold_1e-08": no two tolerances alike.
std::string suffix_of(const CompareTable& table) {
  std::string text = printed("%.0e", table.tolerance);
  if (parsed_number(text) != table.tolerance) text = printed("%g", table.tolerance);
  return std::string(name_of(table.start)) + "_" + figure_name(text);
}

/// Whole decade at or above.
double decade_above(double value) { return std::pow(10.0, std::ceil(std::log10(value) - 1e-9)); }
double decade_below(double value) { return std::pow(10.0, std::floor(std::log10(value) + 1e-9)); }

page::Text table_words(const CompareTable& table) {
  return page::words("compare.table",
                     {{"tolerance", page::exact(table.tolerance)},
                      {"start", name_of(table.start)},
                      {"cases", page::exact(static_cast<double>(table.cases.size()))}});
}

page::Picture profile(const CompareTable& table, const std::string& name, const std::string& title,
                      const std::string& x_label, const std::vector<StepCurve>& curves,
                      double first, double last) {
  Panel panel;
  panel.x_label = x_label;
  panel.y_label = "fraction of cases solved";
  panel.log_x = true;
  panel.x_min = first;
  panel.x_max = last;
  panel.y_min = 0.0;
  panel.y_max = 1.02;
  for (size_t s = 0; s < curves.size(); ++s)
    panel.curves.push_back(stairs(curves[s], last, backend_curve(s, table.solvers[s])));
  Figure figure;
  figure.name = name + "_" + suffix_of(table);
  figure.title = title;
  figure.height = height_for(curves.size());
  figure.panels = {panel};
  return {figure, {page::words(name + ".caption", {{"table", table_words(table)}})}};
}

/// One quantity of the cases that cost is drawn against.
struct CostAxis {
  const char *name, *label;
  bool is_log;
  double (*value)(const CaseFacts&);
};
constexpr CostAxis cost_axes[] = {
    {"contacts", "contacts", true,
     [](const CaseFacts& f) { return static_cast<double>(f.contacts); }},
    {"rank", "rank deficiency of {/:Italic W},  1 − rank/rows", false,
     [](const CaseFacts& f) { return f.rank_deficiency; }},
    {"mass_ratio", "mass ratio", true, [](const CaseFacts& f) { return f.mass_ratio; }},
};

const CaseFacts& facts_of(const CompareTable& table, size_t c) {
  return std::find_if(table.cells[c].begin(), table.cells[c].end(),
                      [](const CompareCell& cell) { return cell.row != nullptr; })
      ->row->facts;
}

}  // namespace

Curve stairs(const StepCurve& steps, double last, Curve curve) {
  for (size_t k = 0; k < steps.x.size(); ++k) {
    if (k > 0) {
      curve.x.push_back(steps.x[k]);
      curve.y.push_back(steps.y[k - 1]);
    }
    curve.x.push_back(steps.x[k]);
    curve.y.push_back(steps.y[k]);
  }
  curve.x.push_back(last);
  curve.y.push_back(steps.y.back());
  return curve;
}

Curve backend_curve(size_t k, const std::string& title) {
  constexpr Ink inks[] = {Ink::blue,   Ink::vermilion, Ink::green, Ink::orange,
                          Ink::purple, Ink::sky,       Ink::black, Ink::grey};
  constexpr size_t count = std::size(inks);
  Curve curve;
  curve.title = plain_text(title);
  curve.ink = inks[k % count];
  curve.dashed = (k / count) % 2 == 1;
  curve.width = k < 2 * count ? 1.8 : 0.9;
  return curve;
}

int height_for(size_t entries) { return 440 + 22 * static_cast<int>(entries / 3); }

std::string figure_name(const std::string& text) {
  std::string name;
  for (const char c : text)
    name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
  return name;
}

std::vector<page::Picture> profile_figures(const CompareTable& table) {
  const std::vector<std::vector<double>> times = table.times();
  double most_ratio = 1.0, least_cost = infinity, most_cost = 0.0;
  std::vector<double> sizes;
  for (size_t c = 0; c < times.size(); ++c) {
    sizes.push_back(static_cast<double>(facts_of(table, c).contacts));
    for (const double time : times[c]) {
      if (!std::isfinite(time)) continue;
      if (table.fastest(c) > 0.0) most_ratio = std::max(most_ratio, time / table.fastest(c));
      const double cost = time / std::max(1.0, sizes.back());
      if (cost > 0.0) least_cost = std::min(least_cost, cost);
      most_cost = std::max(most_cost, cost);
    }
  }
  if (!(most_cost > 0.0)) return {};
  const double last_ratio = std::max(10.0, decade_above(most_ratio));
  const double first = decade_below(least_cost),
               last = std::max(10.0 * first, decade_above(most_cost));
  return {
      profile(table, "performance", "Performance profile", "time over the fastest backend’s time",
              performance_profiles(times, last_ratio), 1.0, last_ratio),
      profile(table, "data", "Data profile", "time per contact  (s)",
              data_profiles(times, sizes, first, last), first, last)};
}

std::vector<page::Picture> cost_figures(const CompareTable& table) {
  std::vector<page::Picture> figures;
  for (const CostAxis& axis : cost_axes) {
    Panel panel;
    panel.x_label = axis.label;
    panel.y_label = seconds_axis;
    panel.log_x = axis.is_log;
    panel.log_y = true;
    std::set<double> places;
    for (size_t s = 0; s < table.solvers.size(); ++s) {
      Curve curve = backend_curve(s, table.solvers[s]);
      curve.mark = Mark::points;
      curve.width = curve.dashed ? 1.5 : 2.4;
      curve.opacity = 0.8;
      for (size_t c = 0; c < table.cases.size(); ++c) {
        const double x = axis.value(facts_of(table, c)), y = table.cells[c][s].median;
        if (!std::isfinite(x) || !std::isfinite(y) || !(y > 0.0) || (axis.is_log && !(x > 0.0)))
          continue;
        curve.x.push_back(x);
        curve.y.push_back(y);
        places.insert(x);
      }
      if (!curve.x.empty()) panel.curves.push_back(std::move(curve));
    }
    if (places.size() < 2) continue;  // says nothing
    if (!axis.is_log) panel.x_min = std::min(0.0, *places.begin());
    Figure figure;
    figure.name = std::string("cost_") + axis.name + "_" + suffix_of(table);
    figure.title = std::string("Cost against ") + axis.name;
    figure.height = height_for(panel.curves.size());
    figure.panels = {panel};
    figures.push_back({figure,
                       {page::words(std::string("cost.") + axis.name + ".caption",
                                    {{"table", table_words(table)}})}});
  }
  return figures;
}

}  // namespace ballast
