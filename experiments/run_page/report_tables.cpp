#include "experiments/run_page/report_tables.hpp"

#include <cmath>

namespace ballast {
namespace {

/// quantity | this run | bound or paper | verdict
class Results {
 public:
  /// Its name stands above its first row; without rows it does not stand.
  void group(const char* name) { group_ = name; }
  void bounded(const char* what, double value, double bound, const char* unit = "",
               double factor = 1.0) {
    row(page::marked(what), page::quantity(factor * value, unit),
        "≤\u00a0" + page::exact_quantity(factor * bound, unit), page::verdict(value, bound));
  }
  void compared(const char* what, page::Text value, page::Text paper) {
    row(page::marked(what), std::move(value), std::move(paper), {"paper", page::note});
  }
  void plain(const char* what, page::Text value, page::Text remark = {}) {
    row(page::marked(what), std::move(value), {}, std::move(remark));
  }

  /// `has_paper`: of the vibrated box, for which the paper's values are known.
  page::Table table(bool has_paper) {
    table_.head = {"", "this run", has_paper ? "asked, or paper" : "asked", ""};
    table_.is_number = {false, true, true, false};
    return std::move(table_);
  }

 private:
  void row(page::Text what, page::Text value, page::Text bound, page::Text mark) {
    // what is not known of this run takes no row
    const std::string words = plain_words(value);
    if (words.find_first_not_of("–, ") == std::string::npos) return;
    if (!group_.empty())
      table_.rows.push_back({styled(page::marked(group_), page::strong), {}, {}, {}});
    group_.clear();
    table_.rows.push_back({std::move(what), std::move(value), std::move(bound), std::move(mark)});
  }
  page::Table table_;
  std::string group_;
};

page::Text range_of(const Statistics& values, double factor, const char* unit) {
  const page::Text mean = page::quantity(factor * values.mean, unit);
  if (values.samples < 2) return mean;
  return mean + " " +
         styled("(" + page::number(factor * values.min) + " … " +
                    page::number(factor * values.max) + ")",
                page::note);
}

void add_accuracy(const RunSummary& summary, Results& results) {
  const auto bounded = [&](const char* what, double value, double bound, const char* unit,
                           double factor) {
    if (std::isfinite(bound))
      results.bounded(what, value, bound, unit, factor);
    else
      results.plain(what, page::quantity(factor * value, unit));
  };
  // errors are judged by what the scene asks of each step
  const double tolerance = summary.facts.tolerance;
  results.group("Contact law");
  if (std::isfinite(summary.facts.velocity_scale)) {
    bounded("error, rms over contacts, over *gh*: mean of the steps", summary.error_mean_relative,
            tolerance, "", 1.0);
    bounded("the same: worst step", summary.error_max_relative, tolerance, "", 1.0);
    results.plain("worst contact of all steps, over *gh*",
                  page::number(summary.error_worst_contact));
    results.plain("steps with an error above the tolerance",
                  page::quantity(100.0 * summary.above_tolerance, "%"));
  } else {
    results.plain("error, rms over contacts: mean of the steps",
                  page::quantity(summary.error_rms.mean, "m/s"));
    results.plain("the same: worst step", page::quantity(summary.error_rms.max, "m/s"));
  }
  // these bounds are the vibrated box's: its grains' size, its drive
  const double known = *summary.facts.has_packing ? 1.0 : not_known;
  results.group("Overlap");
  bounded("deepest of all steps", summary.penetration_max, known * target::penetration_max, "µm",
          1e6);
  bounded("mean over active contact points and steps", summary.penetration_mean,
          known * target::penetration_mean, "µm", 1e6);
  results.group("Energy");
  results.plain("|Δ*K* − works + dissipation| over absolute work",
                page::number(summary.energy.relative));
}

void add_wall(const RunSummary& summary, Results& results) {
  const JammedState& jammed = summary.jammed;
  results.group("Jammed state (*f* above its mean)");
  results.bounded("|*f*~g~ − *f*|/*f*~max~, mean of the steps", jammed.force_mean,
                  target::jammed_force);
  results.plain("the same: 95\u202f% of the steps below, worst step",
                page::number(jammed.force_p95) + ", " + page::number(jammed.force_max));
  results.plain("|*v*|: mean, largest",
                page::quantity(1e3 * jammed.speed_mean, "mm/s") + ", " +
                    page::quantity(1e3 * jammed.speed_max, "mm/s"),
                styled("moving phases: up to " + page::quantity(1e3 * summary.wall.v_peak, "mm/s"),
                       page::note));
  if (!summary.wall.periods.empty())
    results.plain("jammed stretch found in",
                  page::exact(summary.wall.jammed_periods) + " of " +
                      page::exact(static_cast<double>(summary.wall.periods.size())) + " periods");
  results.group("Motion of the wall");
  results.plain("first contraction", page::quantity(1e3 * summary.contraction.size, "mm"));
  results.compared("90\u202f% of it reached at", page::quantity(summary.contraction.time90, "s"),
                   "~\u00a00.2\u202fs");
  results.plain("Δ*x*~max~ per period: mean (least … largest)", range_of(summary.rise, 1e3, "mm"));
  results.plain("contraction per period", range_of({-summary.net.mean, -summary.net.max,
                                                    -summary.net.min, summary.net.samples},
                                                   1e3, "mm"));
  results.plain("*v*~max~ inwards", range_of(summary.speed_in, 1e3, "mm/s"));
  results.compared("*C* of Eq. 3, *m* the mass of all grains", page::number(summary.prefactor),
                   "~\u00a0" + page::number(paper::prefactor, 1));
  results.plain("exponential fit, active: *R*², length",
                page::number(summary.loop.active.r2) + ", " +
                    page::quantity(1e3 / summary.loop.active.rate, "mm"));
  results.plain("linear fit, passive: *R*², slope",
                page::number(summary.loop.passive.r2) + ", " +
                    page::quantity(1e-3 * summary.loop.passive.slope, "N/mm"));
}

void add_compaction(const RunSummary& summary, Results& results) {
  const Compaction& compaction = summary.compaction;
  results.group("Solid fraction");
  results.compared("before the drive", page::number(compaction.initial, 4),
                   page::number(paper::solid_fraction_initial, 2));
  results.compared("ρ~0~, at 0.2\u202fs", page::number(compaction.reference, 4),
                   page::number(paper::solid_fraction_reference, 2));
  results.plain("at the end", page::number(compaction.last, 4));
  results.compared("gain per period over ρ~0~", page::number(compaction.relative_gain),
                   "~\u00a0" + page::number(paper::gain_per_period, 2));
  results.plain("compaction rate (Eq. 4)", page::quantity(compaction.rate, "1/s"));
}

}  // namespace

page::Table results_table(const RunSummary& summary) {
  Results results;
  add_accuracy(summary, results);
  if (*summary.facts.has_wall && *summary.facts.has_packing) add_wall(summary, results);
  if (*summary.facts.has_packing) add_compaction(summary, results);
  results.group("Effort");
  results.plain("iterations per step: mean, most",
                page::number(summary.iterations.mean) + ", " + page::exact(summary.iterations.max));
  results.plain("contact points per step: mean, most",
                page::number(summary.contacts.mean, 4) + ", " + page::exact(summary.contacts.max));
  results.plain("wall clock per step", page::quantity(summary.ms_per_step, "ms"));
  return results.table(*summary.facts.has_packing);
}

page::Table periods_table(const RunSummary& summary) {
  page::Table table;
  for (const char* head :
       {"period", "from\n(s)", "to\n(s)", "Δ*x*~max~\n(mm)", "contraction\n(mm)",
        "*v*~max~ in\n(mm/s)", "*v* out\n(mm/s)", "jammed\n(%)", "ρ,\nmean", "gain\nof ρ"})
    table.head.push_back(page::marked(head));
  table.is_number.assign(10, true);
  double before = not_known;
  for (const WallPeriod& period : summary.wall.periods) {
    table.rows.push_back(
        {page::exact(std::round(period.end * summary.facts.frequency)),
         page::exact(period.begin, 4), page::exact(period.end, 4), page::number(1e3 * period.rise),
         page::number(-1e3 * period.net), page::number(1e3 * period.speed_in),
         page::number(1e3 * period.speed_out), page::number(100.0 * period.jammed_share),
         page::number(period.solid_fraction, 5), page::number(period.solid_fraction - before, 2)});
    before = period.solid_fraction;
  }
  return table;
}

page::Table cost_table(const RunSummary& summary) {
  page::Table table;
  table.head = {"phase", "ms per step", "%"};
  table.is_number = {false, true, true};
  for (const PhaseCost& phase : summary.cost)
    table.rows.push_back(
        {phase.name, page::number(phase.ms_per_step), page::number(100.0 * phase.share)});
  table.rows.push_back({page::Text("all", page::strong), page::number(summary.ms_per_step),
                        page::number(summary.ms_per_step > 0.0 ? 100.0 : not_known)});
  return table;
}

page::Table energy_table(const RunSummary& summary) {
  const EnergyBalance& energy = summary.energy;
  page::Table table;
  table.head = {"over the whole run", "J"};
  table.is_number = {false, true};
  const auto row = [&](const char* what, double value) {
    table.rows.push_back({what, page::number(value, 4)});
  };
  row("work of the load on the wall", energy.work_load);
  row("work of gravity", energy.work_gravity);
  row("work of prescribed walls and applied forces", energy.work_prescribed);
  row("dissipated in contacts", energy.dissipated);
  row("kinetic energy after the first step", energy.kinetic_first);
  row("kinetic energy after the last step", energy.kinetic_last);
  row("residual: change of kinetic energy − works + dissipation, after the first step",
      energy.residual);
  row("the same, summed by the stepper over all steps", energy.residual_recorded);
  row("of it, work of the gyroscopic term", energy.work_gyroscopic);
  row("potential energy given by the overlap correction (not in the balance: it moves bodies, not "
      "velocities)",
      energy.work_correction);
  row("sum over steps of |works|", energy.work_absolute);
  return table;
}

}  // namespace ballast
