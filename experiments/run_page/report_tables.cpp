#include "experiments/run_page/report_tables.hpp"

#include <cmath>

namespace ballast {
namespace {

/// quantity | this run | bound or paper | verdict
class Results {
 public:
  void group(const char* name) {
    table_.rows.push_back({Html{std::string("<b>") + name + "</b>"}, {}, {}, {}});
  }
  void bounded(const char* what, double value, double bound, const char* unit = "",
               double factor = 1.0) {
    row(what, *unit ? quantity(factor * value, unit) : number(value),
        Html{"≤&nbsp;"} + exact(factor * bound) + Html{*unit ? "&#8239;" : ""} + Html{unit},
        verdict(value, bound));
  }
  void compared(const char* what, Html value, Html paper) {
    row(what, std::move(value), std::move(paper), {"<span class=\"note\">paper</span>"});
  }
  void plain(const char* what, Html value, Html remark = {}) {
    row(what, std::move(value), {}, std::move(remark));
  }

  Html html() {
    table_.head = {{""}, {"this run"}, {"asked, or paper"}, {""}};
    table_.is_number = {false, true, true, false};
    return to_html(table_);
  }

 private:
  void row(const char* what, Html value, Html bound, Html mark) {
    table_.rows.push_back({Html{what}, std::move(value), std::move(bound), std::move(mark)});
  }
  HtmlTable table_;
};

Html range_of(const Statistics& values, double factor, const char* unit) {
  if (values.samples < 2) return quantity(factor * values.mean, unit);
  return quantity(factor * values.mean, unit) + Html{" <span class=\"note\">("} +
         number(factor * values.min) + Html{" … "} + number(factor * values.max) + Html{")</span>"};
}

void add_accuracy(const RunSummary& summary, Results& results) {
  results.group("Contact law");
  if (std::isfinite(summary.facts.velocity_scale)) {
    results.bounded("error, rms over contacts, over <i>gh</i>: mean of the steps",
                    summary.error_mean_relative, target::error_mean);
    results.bounded("the same: worst step", summary.error_max_relative, target::error_max);
    results.plain("worst contact of all steps, over <i>gh</i>",
                  number(summary.error_worst_contact));
    results.plain("steps with an error above 10<sup>−3</sup> <i>gh</i>",
                  quantity(100.0 * summary.above_target, "%"));
  } else {
    results.plain("error, rms over contacts: mean of the steps",
                  quantity(summary.error_rms.mean, "m/s"));
    results.plain("the same: worst step", quantity(summary.error_rms.max, "m/s"));
  }
  results.group("Overlap");
  results.bounded("deepest of all steps", summary.penetration_max, target::penetration_max, "µm",
                  1e6);
  results.bounded("mean over active contact points and steps", summary.penetration_mean,
                  target::penetration_mean, "µm", 1e6);
  results.group("Energy");
  results.plain("|Δ<i>K</i> − works + dissipation| over absolute work",
                number(summary.energy.relative));
}

void add_wall(const RunSummary& summary, Results& results) {
  const JammedState& jammed = summary.jammed;
  results.group("Jammed state (<i>f</i> above its mean)");
  results.bounded("|<i>f</i><sub>g</sub> − <i>f</i>|/<i>f</i><sub>max</sub>, mean of the steps",
                  jammed.force_mean, target::jammed_force);
  results.plain("the same: 95&#8239;% of the steps below, worst step",
                number(jammed.force_p95) + Html{", "} + number(jammed.force_max));
  results.plain("|<i>v</i>|: mean, largest",
                quantity(1e3 * jammed.speed_mean, "mm/s") + Html{", "} +
                    quantity(1e3 * jammed.speed_max, "mm/s"),
                Html{"<span class=\"note\">moving phases: up to "} +
                    quantity(1e3 * summary.wall.v_peak, "mm/s") + Html{"</span>"});
  results.plain("jammed stretch found in",
                exact(summary.wall.jammed_periods) + Html{" of "} +
                    exact(static_cast<double>(summary.wall.periods.size())) + Html{" periods"});
  results.group("Motion of the wall");
  results.plain("first contraction", quantity(1e3 * summary.contraction.size, "mm"));
  results.compared("90&#8239;% of it reached at", quantity(summary.contraction.time90, "s"),
                   Html{"~&nbsp;0.2&#8239;s"});
  results.plain("Δ<i>x</i><sub>max</sub> per period: mean (least … largest)",
                range_of(summary.rise, 1e3, "mm"));
  results.plain("contraction per period", range_of({-summary.net.mean, -summary.net.max,
                                                    -summary.net.min, summary.net.samples},
                                                   1e3, "mm"));
  results.plain("<i>v</i><sub>max</sub> inwards", range_of(summary.speed_in, 1e3, "mm/s"));
  results.compared("<i>C</i> of Eq. 3, <i>m</i> the mass of all grains", number(summary.prefactor),
                   Html{"~&nbsp;"} + number(paper::prefactor, 1));
  results.plain(
      "exponential fit, active: <i>R</i>², length",
      number(summary.loop.active.r2) + Html{", "} + quantity(1e3 / summary.loop.active.rate, "mm"));
  results.plain("linear fit, passive: <i>R</i>², slope",
                number(summary.loop.passive.r2) + Html{", "} +
                    quantity(1e-3 * summary.loop.passive.slope, "N/mm"));
}

void add_compaction(const RunSummary& summary, Results& results) {
  const Compaction& compaction = summary.compaction;
  results.group("Solid fraction");
  results.compared("before the drive", number(compaction.initial, 4),
                   number(paper::solid_fraction_initial, 2));
  results.compared("&rho;<sub>0</sub>, at 0.2&#8239;s", number(compaction.reference, 4),
                   number(paper::solid_fraction_reference, 2));
  results.plain("at the end", number(compaction.last, 4));
  results.compared("gain per period over &rho;<sub>0</sub>", number(compaction.relative_gain),
                   Html{"~&nbsp;"} + number(paper::gain_per_period, 2));
  results.plain("compaction rate (Eq. 4)", quantity(compaction.rate, "1/s"));
}

}  // namespace

Html results_table(const RunData&, const RunSummary& summary) {
  Results results;
  add_accuracy(summary, results);
  if (*summary.facts.has_wall && *summary.facts.has_packing) add_wall(summary, results);
  if (*summary.facts.has_packing) add_compaction(summary, results);
  results.group("Effort");
  results.plain("iterations per step: mean, most",
                number(summary.iterations.mean) + Html{", "} + exact(summary.iterations.max));
  results.plain("contact points per step: mean, most",
                number(summary.contacts.mean, 4) + Html{", "} + exact(summary.contacts.max));
  results.plain("wall clock per step", quantity(summary.ms_per_step, "ms"));
  return results.html();
}

Html periods_table(const RunSummary& summary) {
  if (summary.wall.periods.empty()) return {};
  HtmlTable table;
  table.head = {{"period"},
                {"from<br>(s)"},
                {"to<br>(s)"},
                {"Δ<i>x</i><sub>max</sub><br>(mm)"},
                {"contraction<br>(mm)"},
                {"<i>v</i><sub>max</sub> in<br>(mm/s)"},
                {"<i>v</i> out<br>(mm/s)"},
                {"jammed<br>(%)"},
                {"&rho;,<br>mean"},
                {"gain<br>of &rho;"}};
  table.is_number.assign(10, true);
  double before = not_known;
  for (const WallPeriod& period : summary.wall.periods) {
    table.rows.push_back({exact(std::round(period.end * summary.facts.frequency)),
                          exact(period.begin, 4), exact(period.end, 4), number(1e3 * period.rise),
                          number(-1e3 * period.net), number(1e3 * period.speed_in),
                          number(1e3 * period.speed_out), number(100.0 * period.jammed_share),
                          number(period.solid_fraction, 5),
                          number(period.solid_fraction - before, 2)});
    before = period.solid_fraction;
  }
  return to_html(table);
}

Html cost_table(const RunSummary& summary) {
  HtmlTable table;
  table.head = {{"phase"}, {"ms per step"}, {"%"}};
  table.is_number = {false, true, true};
  for (const PhaseCost& phase : summary.cost)
    table.rows.push_back(
        {Html{phase.name}, number(phase.ms_per_step), number(100.0 * phase.share)});
  table.rows.push_back({Html{"<b>all</b>"}, number(summary.ms_per_step),
                        number(summary.ms_per_step > 0.0 ? 100.0 : not_known)});
  return to_html(table);
}

Html energy_table(const RunSummary& summary) {
  const EnergyBalance& energy = summary.energy;
  HtmlTable table;
  table.head = {{"over the whole run"}, {"J"}};
  table.is_number = {false, true};
  const auto row = [&](const char* what, double value) {
    table.rows.push_back({Html{what}, number(value, 4)});
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
  return to_html(table);
}

}  // namespace ballast
