// The packing itself: solid fraction, coordination, forces, fabric and anisotropies, by phase of
// the wall.

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/paper/motion.hpp"

namespace ballast {
namespace {

struct ForcePhase {
  WallPhase phase;
  const char* name;
  Ink ink;
};
constexpr std::array force_phases{ForcePhase{WallPhase::jammed, "jammed", Ink::green},
                                  ForcePhase{WallPhase::active, "active", Ink::blue},
                                  ForcePhase{WallPhase::passive, "passive", Ink::vermilion}};

struct Row {
  const char* name;
  double PackingStatistics::*value;
};
constexpr std::array table_rows{
    Row{"coordination number Z", &PackingStatistics::coordination},
    Row{"Z without rattlers", &PackingStatistics::coordination_backbone},
    Row{"share of rattlers", &PackingStatistics::rattlers},
    Row{"contact points per contact", &PackingStatistics::points_per_contact},
    Row{"mean normal force (N)", &PackingStatistics::mean_force},
    Row{"share of contacts below the mean force", &PackingStatistics::weak_share},
    Row{"share of contacts that slide", &PackingStatistics::sliding_share},
    Row{"fabric anisotropy a_c", &PackingStatistics::fabric},
    Row{"normal-force anisotropy a_n", &PackingStatistics::normal},
    Row{"friction anisotropy a_t", &PackingStatistics::tangential},
    Row{"q/p of the stress", &PackingStatistics::shear_ratio},
    Row{"2/5 (a_c + a_n + a_t)", &PackingStatistics::shear_from_anisotropy}};

/// Histogram of f/<f>, as a density.
class Histogram {
 public:
  void add(const std::vector<double>& values) {
    for (const double value : values) {
      const auto bin = static_cast<size_t>(value / width);
      if (bin < bins) counts_[bin] += 1.0;
      total_ += 1.0;
    }
  }
  bool is_empty() const { return total_ == 0.0; }
  Curve curve(const char* title, Ink ink) const {
    Curve result{.title = title, .ink = ink};
    for (size_t k = 0; k < bins; ++k) {
      if (counts_[k] == 0.0) continue;
      result.x.push_back(middle(k));
      result.y.push_back(counts_[k] / (total_ * width));
    }
    return result;
  }
  /// Decay of the tail: P ~ exp(-beta f/<f>) from the mean to six means.
  double beta() const {
    std::vector<double> x, y;
    // Bins 4 to 23 reach from the mean force to six of them; nearly empty ones say nothing.
    for (size_t k = 4; k < 24; ++k) {
      if (counts_[k] <= 4.0) continue;
      x.push_back(middle(k));
      y.push_back(std::log(counts_[k]));
    }
    return -fit_line(x, y).slope;
  }

 private:
  static constexpr double width = 0.25;  // of a bin, in means
  static constexpr size_t bins = 40;
  static double middle(size_t bin) { return (static_cast<double>(bin) + 0.5) * width; }
  std::array<double, bins> counts_{};
  double total_ = 0.0;
};

/// By row of the table: a value for each state, or for each sample.
using RowValues = std::array<std::vector<double>, table_rows.size()>;

/// What all states of all runs in one phase say.
struct PhaseFindings {
  RowValues samples;  ///< means over each run's states
  Histogram forces;
};

/// Takes in one run's states of a phase; returns how many states of any phase it has.
int add_run(const MotionRun& run, std::array<PhaseFindings, force_phases.size()>& findings) {
  std::array<RowValues, force_phases.size()> of_run;
  const int states = for_each_state(run, [&](const StoredState& state) {
    for (size_t p = 0; p < force_phases.size(); ++p) {
      if (state.phase != force_phases[p].phase) continue;
      const PackingStatistics found =
          packing_statistics(state.system, state.at.state, state.at.memory.contacts,
                             state.at.memory.impulses, state.step);
      for (size_t r = 0; r < table_rows.size(); ++r)
        of_run[p][r].push_back(found.*table_rows[r].value);
      findings[p].forces.add(relative_normal_forces(state.system, state.pairs()));
    }
  });
  for (size_t p = 0; p < force_phases.size(); ++p)
    for (size_t r = 0; r < table_rows.size(); ++r)
      findings[p].samples[r].push_back(statistics(of_run[p][r]).mean);
  return states;
}

}  // namespace

PaperSection packing_section(PaperData& data) {
  PaperSection section{.text = {page::words("packing.intro")}};
  std::array<PhaseFindings, force_phases.size()> findings;
  int states = 0;
  for (const MotionRun& run : read_motion(data, section)) states += add_run(run, findings);
  if (states == 0) {
    section.notes.push_back("PARTIAL: no stored states.");
    return section;
  }
  page::Table table = page::words_table("packing.table");
  for (size_t r = 0; r < table_rows.size(); ++r) {
    table.rows.push_back({table_rows[r].name});
    for (const PhaseFindings& phase : findings)
      table.rows.back().push_back(words_of(sample_mean(phase.samples[r])));
  }
  section.tables = {table};
  Panel panel{.x_label = "{/:Italic f}_n / ⟨{/:Italic f}_n⟩",
              .y_label = "probability density",
              .log_y = true};
  page::Text tails;
  for (size_t p = 0; p < force_phases.size(); ++p) {
    const Histogram& forces = findings[p].forces;
    if (forces.is_empty()) continue;
    panel.curves.push_back(forces.curve(force_phases[p].name, force_phases[p].ink));
    add_to_list(tails, std::string(force_phases[p].name) + " β = " + page::number(forces.beta()),
                ", ");
  }
  if (!panel.curves.empty()) section.draw("forces", {.panels = {panel}}, {{"tails", tails}});
  return section;
}

}  // namespace ballast
