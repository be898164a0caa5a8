// The packing itself: solid fraction, coordination, forces, fabric and anisotropies, by phase of
// the wall.

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/stored_states.hpp"

namespace ballast {
namespace {

constexpr std::array force_phases{std::pair{WallPhase::jammed, "jammed"},
                                  std::pair{WallPhase::active, "active"},
                                  std::pair{WallPhase::passive, "passive"}};

struct Column {
  const char* name;
  double PackingStatistics::*value;
};
constexpr std::array columns{
    Column{"coordination number Z", &PackingStatistics::coordination},
    Column{"Z without rattlers", &PackingStatistics::coordination_backbone},
    Column{"share of rattlers", &PackingStatistics::rattlers},
    Column{"contact points per contact", &PackingStatistics::points_per_contact},
    Column{"mean normal force (N)", &PackingStatistics::mean_force},
    Column{"share of contacts below the mean force", &PackingStatistics::weak_share},
    Column{"share of contacts that slide", &PackingStatistics::sliding_share},
    Column{"fabric anisotropy a_c", &PackingStatistics::fabric},
    Column{"normal-force anisotropy a_n", &PackingStatistics::normal},
    Column{"friction anisotropy a_t", &PackingStatistics::tangential},
    Column{"q/p of the stress", &PackingStatistics::shear_ratio},
    Column{"2/5 (a_c + a_n + a_t)", &PackingStatistics::shear_from_anisotropy},
};

/// Histogram of f/<f> in bins of half a mean, as a density.
struct Histogram {
  static constexpr double width = 0.25;
  std::vector<double> counts = std::vector<double>(40, 0.0);
  double total = 0.0;
  void add(const std::vector<double>& values) {
    for (const double value : values) {
      const auto bin = static_cast<size_t>(value / width);
      if (bin < counts.size()) counts[bin] += 1.0;
      total += 1.0;
    }
  }
  Curve curve(const char* title, Ink ink) const {
    Curve result;
    for (size_t k = 0; k < counts.size(); ++k) {
      if (counts[k] == 0.0) continue;
      result.x.push_back((static_cast<double>(k) + 0.5) * width);
      result.y.push_back(counts[k] / (total * width));
    }
    result.title = title;
    result.ink = ink;
    return result;
  }
  /// Decay of the tail: P ~ exp(-beta f/<f>) from the mean to six means.
  LineFit tail() const {
    std::vector<double> x, y;
    for (size_t k = 4; k < 24; ++k)
      if (counts[k] > 4.0)
        x.push_back((static_cast<double>(k) + 0.5) * width), y.push_back(std::log(counts[k]));
    return fit_line(x, y);
  }
};

/// By phase and column: a value for each state, or for each sample.
using PhaseValues =
    std::array<std::array<std::vector<double>, columns.size()>, force_phases.size()>;

page::Table phases_table(const PhaseValues& values) {
  page::Table table{"By phase at 5 Hz, means over samples ± standard error",
                    {"", "jammed", "active", "passive"},
                    {}};
  for (size_t c = 0; c < columns.size(); ++c) {
    table.rows.push_back({columns[c].name});
    for (size_t p = 0; p < force_phases.size(); ++p) {
      const SampleMean mean = sample_mean(values[p][c]);
      table.rows.back().push_back(page::with_error(mean.mean, mean.error));
    }
  }
  return table;
}

}  // namespace

PaperSection packing_section(PaperData& data) {
  PaperSection section;
  section.text = {page::words("packing.intro")};
  const std::vector<MotionRun> runs = read_motion(data, section);
  PhaseValues values;
  std::array<Histogram, force_phases.size()> histograms;
  int states = 0;
  for (const MotionRun& run : runs) {
    PhaseValues of_run;
    states += for_each_state(run, [&](const StoredState& state) {
      for (size_t p = 0; p < force_phases.size(); ++p) {
        if (state.phase != force_phases[p].first) continue;
        const PackingStatistics found =
            packing_statistics(state.system, state.at.state, state.at.memory.contacts,
                               state.at.memory.impulses, state.step);
        for (size_t c = 0; c < columns.size(); ++c) of_run[p][c].push_back(found.*columns[c].value);
        histograms[p].add(relative_normal_forces(
            state.system,
            pair_forces(state.at.memory.contacts, state.at.memory.impulses, state.step)));
      }
    });
    for (size_t p = 0; p < force_phases.size(); ++p)
      for (size_t c = 0; c < columns.size(); ++c)
        values[p][c].push_back(statistics(of_run[p][c]).mean);
  }
  if (states == 0) {
    section.notes.push_back("PARTIAL: no stored states.");
    return section;
  }
  section.tables = {phases_table(values)};
  Panel panel;
  panel.x_label = "{/:Italic f}_n / ⟨{/:Italic f}_n⟩";
  panel.y_label = "probability density";
  panel.log_y = true;
  const Ink inks[] = {Ink::green, Ink::blue, Ink::vermilion};
  page::Text tails;
  for (size_t p = 0; p < force_phases.size(); ++p) {
    if (histograms[p].total == 0.0) continue;
    panel.curves.push_back(histograms[p].curve(force_phases[p].second, inks[p]));
    tails += (tails.empty() ? "" : ", ") + std::string(force_phases[p].second) +
             " β = " + page::number(-histograms[p].tail().slope);
  }
  if (panel.curves.empty()) return section;
  PaperFigure figure;
  figure.plot.name = "forces";
  figure.plot.title = "Distribution of normal forces by phase";
  figure.plot.panels = {panel};
  figure.paper = page::words("forces.paper");
  figure.found = page::words("forces.found", {{"tails", tails}});
  section.figures = {figure};
  return section;
}

}  // namespace ballast
