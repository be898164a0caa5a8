// Figs. 3, 4, 12 and 13: the wall at 5 Hz, the force on it, the solid fraction and how fast it
// grows at all frequencies (Eqs. 4 and 5); Fig. 8: the wall's phase portraits at 5 and 10 Hz, raw
// and scaled by nu^-2 and nu^-1.

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/paper/sections.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {
namespace {

/// The largest time lag that the paper's 0.2 s allows, written with one digit and "about" [s].
constexpr double paper_lag = 0.26;

/// Mean over runs of a number of the summary, with its standard error.
template <class Function>
SampleMean mean_over(const std::vector<MeasuredRun>& runs, const Function& quantity) {
  return sample_mean(
      values_of(runs, [&](const MeasuredRun& run) { return quantity(run.summary); }));
}

/// The largest relative deviation of a frequency's value from the mean over frequencies, for each
/// sample by itself; then the mean over samples.
SampleMean spread_over(const Groups& groups, RunMeasure measure, double low, double high) {
  std::vector<double> spreads;
  for (const RunRow* row : groups.front().samples) {
    std::vector<double> seen;
    for (const Group& group : groups)
      if (const RunRow* sample = group.like(*row);
          sample && group.value >= low && group.value <= high)
        seen.push_back((*sample)[measure]);
    const Statistics all = statistics(seen);
    spreads.push_back(std::max(all.max / all.mean - 1.0, 1.0 - all.min / all.mean));
  }
  return sample_mean(spreads);
}

/// The wall's displacement in the colours of its phases, with the paper's time lag.
Figure motion_figure(const MeasuredRun& run) {
  Figure figure = figure_3(run.data, run.summary).plot;
  const std::vector<StepRecord>& steps = run.data.steps;
  for (const auto& [phase, title, ink] : {std::tuple{WallPhase::jammed, "jammed", Ink::green},
                                          std::tuple{WallPhase::active, "active", Ink::sky},
                                          std::tuple{WallPhase::passive, "passive", Ink::orange}}) {
    std::vector<double> x;
    for (size_t k = 0; k < steps.size(); ++k)
      x.push_back(run.summary.wall.phase[k] == phase ? 1e3 * steps[k].wall_x : not_known);
    if (statistics(x).samples == 0) continue;
    figure.panels[0].curves.push_back(
        line_of(record_column(steps, &StepRecord::time), x, title, ink, 3.0));
  }
  for (Panel& panel : figure.panels)
    panel.lines.push_back({paper_window.begin, "0.2 s", true, Ink::grey});
  return figure;
}

/// Adds the motion of the wall at 5 Hz.
void add_motion(const std::vector<MeasuredRun>& runs, PaperSection& section) {
  const SampleMean size = mean_over(runs, [](const auto&s) { return 1e3 * s.contraction.size; }),
                   time = mean_over(runs, [](const auto&s) { return s.contraction.time90; }),
                   rise = mean_over(runs, [](const auto&s) { return 1e3 * s.rise.mean; }),
                   net = mean_over(runs, [](const auto&s) { return -1e3 * s.net.mean; });
  const page::Values words{{"samples", std::to_string(size.samples)},
                           {"size", words_of(size)},
                           {"time", words_of(time)},
                           {"rise", words_of(rise)},
                           {"net", words_of(net)},
                           {"rise_mean", page::number(rise.mean)}};
  section.draw("fig3", motion_figure(runs.front()), words);
  section.claim("fig3.first", words, PaperRange::at_most(paper_lag), found(time));
  section.claim("fig3.slow", words, PaperRange::at_least(0.0), found(net));
}

page::Table branch_table(const std::vector<MeasuredRun>& runs) {
  page::Table table = page::words_table("fig4.table");
  for (size_t k = 0; k < runs.size(); ++k) {
    const RunSummary& s = runs[k].summary;
    const double weight = s.facts.weight();
    table.rows.push_back({std::to_string(k + 1), page::number(s.law.active.amplitude / weight),
                          page::number(std::exp(s.law.active.rate * s.rise.mean)),
                          page::number(s.law.active.r2), page::number(s.law.active_line.r2),
                          page::number(s.law.passive.offset / weight),
                          page::number(1e-3 * s.law.passive.slope / weight),
                          page::number(s.law.passive.r2), page::number(s.jammed.force_mean, 2),
                          page::number(1e3 * s.jammed.speed_mean, 2) + ", " +
                              page::number(1e3 * s.jammed.speed_max, 2)});
  }
  return table;
}

/// A law describes a branch when it leaves at most a tenth of the variance unexplained.
const PaperRange good_fit = PaperRange::at_least(0.9);

/// The change of the gain per period in the course of the drive: the last gain less the first, over
/// the mean gain.
double gain_trend(const RunSummary& summary) {
  const std::vector<double>& gains = summary.compaction.gains;
  return gains.size() < 2 ? not_known : (gains.back() - gains.front()) / summary.compaction.gain;
}

/// Adds the paper's straight line with a constant gain in each period, through the level at 0.2 s;
/// gain and level are those of the first sample.
void add_gain_line(const MeasuredRun& run, Panel& panel) {
  const Compaction& compaction = run.summary.compaction;
  const double level = compaction.reference - run.data.facts.solid_fraction_initial,
               begin = paper_window.begin;
  if (!std::isfinite(compaction.gain)) return;
  panel.lines.push_back(
      {level, page::marked("ρ~0~ = ") + page::number(compaction.reference), false, Ink::grey});
  panel.curves.push_back(curve_of(
      [&](double t) { return level + compaction.gain * run.summary.facts.frequency * (t - begin); },
      {begin, run.data.steps.back().time, false}, page::marked("Δρ~1~ a period, sample 1"),
      Ink::black));
}

constexpr int orbit_phases = 200;  // phases of a period at which orbits are compared
constexpr double portrait_frequencies[] = {5.0, 10.0};

/// The mean orbit over the periods that count: displacement from the period's first jamming
/// position [m], velocity [m/s].
struct Orbit {
  std::vector<double> x = std::vector<double>(orbit_phases, 0.0), v = x;
  int periods = 0;
};

Orbit mean_orbit(const MeasuredRun& run) {
  const WallCycles& wall = run.summary.wall;
  Orbit orbit;
  orbit.periods = static_cast<int>(wall.periods.size());
  for (const WallPeriod& period : wall.periods)
    for (size_t k = 0; k < orbit_phases; ++k) {
      // the same phase of the load in every period, whatever its number of steps
      const size_t sample = period.first + k * (period.last - period.first) / orbit_phases;
      orbit.x[k] += (run.data.steps[sample].wall_x - period.x_before) / orbit.periods;
      orbit.v[k] += wall.velocity[sample] / orbit.periods;
    }
  return orbit;
}

/// Orbits at the two frequencies.
using Portrait = std::array<Orbit, 2>;

/// The orbits scaled by nu^2 in x and nu in v; they coincide where x ~ nu^-2 and v ~ nu^-1.
Portrait collapsed(Portrait orbits) {
  for (size_t k = 0; k < 2; ++k) {
    const double nu = portrait_frequencies[k];
    for (double& x : orbits[k].x) x *= nu * nu;
    for (double& v : orbits[k].v) v *= nu;
  }
  return orbits;
}

/// The rms distance of two orbits over orbit_phases, each axis in units of their mean range.
double distance(const Portrait& orbits) {
  const auto& [a, b] = orbits;
  const auto range_of = [](const std::vector<double>& values) {
    const Statistics all = statistics(values);
    return all.max - all.min;
  };
  const double x_range = 0.5 * (range_of(a.x) + range_of(b.x)),
               v_range = 0.5 * (range_of(a.v) + range_of(b.v));
  double sum = 0.0;
  for (size_t k = 0; k < orbit_phases; ++k)
    sum += (std::pow((a.x[k] - b.x[k]) / x_range, 2) + std::pow((a.v[k] - b.v[k]) / v_range, 2)) /
           orbit_phases;
  return std::sqrt(sum);
}

/// Both orbits in mm and mm/s. They are open: a period ends further in than it began.
/// The labels are in the notation of page::marked().
Panel portrait_panel(const Portrait& orbits, const std::string& x_label,
                     const std::string& v_label) {
  Panel panel{.x_label = page::marked(x_label), .y_label = page::marked(v_label)};
  for (size_t k = 0; k < 2; ++k) {
    Curve curve{.x = orbits[k].x,
                .y = orbits[k].v,
                .title = page::number(portrait_frequencies[k], 2) + " Hz",
                .ink = k == 0 ? Ink::blue : Ink::vermilion,
                .dash = k == 1};
    for (double& x : curve.x) x *= 1e3;
    for (double& v : curve.y) v *= 1e3;
    panel.curves.push_back(std::move(curve));
  }
  return panel;
}

/// A panel over the paper's frequencies, 1 to 60 Hz; the label is in page::marked()'s notation.
Panel frequency_panel(const std::string& label) {
  return {.x_label = page::marked("*ν*  (Hz)"),
          .y_label = page::marked(label),
          .log_x = true,
          .x_min = 0.85,
          .x_max = 70.0,
          .x_ticks = {1, 2, 5, 10, 20, 60}};
}

constexpr double paper_peak = 10.0;  // nu_c [Hz]

/// Eq. 5 over the frequencies of a curve.
Curve law_curve(const PeakedRate& law, const Points& points, const page::Text& title, Ink ink) {
  return curve_of([&](double nu) { return law.at(nu); }, {points.x.front(), points.x.back(), true},
                  title, ink);
}

/// The misfit of Eq. 5 to the rates, with `parameters` of its parameters fitted.
VarianceRatio misfit_of(const PeakedRate& law, const Points& points, int parameters) {
  double misses = 0.0, variances = 0.0;
  const auto count = static_cast<double>(points.x.size());
  for (size_t k = 0; k < points.x.size(); ++k) {
    misses += std::pow(points.y[k] - law.at(points.x[k]), 2) / (count - parameters);
    variances += std::pow(points.error[k], 2) / count;
  }
  return {misses / variances, f_test_p(misses / variances, count - parameters, points.error_dof)};
}

page::Text words_of(const PeakedRate& fit) {
  return "ν_c = " + page::number(fit.critical) + " Hz " + page::interval(fit.low, fit.high) +
         ", Δρ_max/ρ₀ = " + page::number(fit.gain) + ", R² = " + page::number(fit.r2);
}

/// Claims nu_c of a fit with `parameters` parameters; adds the fit to `words`. A corner at an end
/// of the data is no corner: its interval is open on that side.
void claim_peak(const std::string& name, const PeakedRate& fit, int parameters,
                const Points& points, page::Values& words, PaperSection& section) {
  constexpr double no_bound = 1e9;
  const VarianceRatio misfit = misfit_of(fit, points, parameters);
  words[name] = words_of(fit);
  words[name + "_misfit"] = words_of(misfit);
  section.claim("fig13." + name, words, PaperRange::roughly(paper_peak),
                {.value = fit.critical,
                 .low = fit.low < 1.05 * points.x.front() ? 0.0 : fit.low,
                 .high = fit.high > 0.95 * points.x.back() ? no_bound : fit.high,
                 .law_p = misfit.p});
}

/// Claims the fall of the rate beyond its maximum: the paper's rate falls as 1/nu.
void add_falling_branch(const Groups& groups, PaperSection& section) {
  Points falling;
  for (const Group& group : groups)
    if (group.value >= paper_peak) falling.add(group.value, group.mean("rate"));
  const PowerFit fit = fit_power(falling.x, falling.y);
  const VarianceRatio misfit = misfit_of(falling);
  section.claim("fig13.falling", {{"exponent", words_of(fit)}, {"misfit", words_of(misfit)}},
                PaperRange::exponent(-1.0), found(fit, misfit.p));
}

}  // namespace

void fill_motion(PaperData& data, PaperSection& section) {
  const std::vector<MeasuredRun> runs = data.records("motion");
  if (!runs.empty()) add_motion(runs, section);
  const Groups groups = data.groups("frequency; slowest", "frequency");
  if (groups.size() < 2) return;
  // the time when the first contraction is over, at all frequencies
  const Points times = points_of(groups, "frequency", "first_time90");
  Panel panel = frequency_panel("90 % of the first contraction  (s)");
  panel.y_min = 0.0;
  panel.curves = {curve_of(times, "mean over samples ± standard error", Ink::blue)};
  panel.lines = {{paper_window.begin, "the paper’s 0.2 s", false, Ink::vermilion}};
  section.draw("fig3_times", {.height = 400, .panels = {panel}});
  // the paper takes rho_0 at 0.2 s for every frequency: the slowest first contraction decides
  const Group& slowest = *std::ranges::max_element(groups, {}, [](const Group& group) {
    const double time = group.mean("first_time90").mean;
    return time > 0.0 ? time : 0.0;  // NaN, where it is not known, has no order
  });
  const SampleMean latest = slowest.mean("first_time90");
  section.claim("fig3.everywhere",
                {{"time", words_of(latest)}, {"frequency", slowest.label + " Hz"}},
                PaperRange::at_most(paper_lag), found(latest));
  for (const auto& [name, measure] :
       {std::pair("fig3.size", "first_contraction"), {"fig3.time", "first_time90"}}) {
    const SampleMean all = spread_over(groups, measure, 0.0, 1e9);
    section.claim(name,
                  {{"all", words_of(all, 100.0)},
                   {"count", std::to_string(groups.size())},
                   {"middle", words_of(spread_over(groups, measure, 2.0, 20.0), 100.0)}},
                  PaperRange::at_most(0.15), found(all));
  }
}

void fill_forces(PaperData& data, PaperSection& section) {
  const std::vector<MeasuredRun> runs = data.records("motion");
  if (runs.empty() || runs.front().summary.wall.periods.empty()) return;
  const SampleMean active = mean_over(runs, [](const auto&s) { return s.law.active.r2; }),
                   passive = mean_over(runs, [](const auto&s) { return s.law.passive.r2; }),
                   jam = mean_over(runs, [](const auto&s) { return s.jammed.force_mean; }),
                   smooth = mean_over(runs, [](const auto&s) { return s.jammed.force_smooth; }),
                   creep = mean_over(runs, [](const auto&s) { return 1e3 * s.jammed.speed_mean; });
  const SampleMean share =
      mean_over(runs, [](const auto& s) { return s.jammed.speed_mean / s.speed_in.mean; });
  // the slope of f_g in the last tenth of the way in over that in the middle: 1 for a line
  const SampleMean end = sample_mean(values_of(runs, [](const MeasuredRun& run) {
    const RunFacts& facts = run.summary.facts;
    const ForceLaw last_tenth = force_law(run.data.steps, run.summary.wall, facts.grain_mass,
                                          facts.wall_mass, facts.gravity, 0.0, 0.1);
    return last_tenth.passive.slope / run.summary.law.passive.slope;
  }));
  const page::Values words{{"end", words_of(end)},
                           {"active", page::number(active.mean)},
                           {"active_r2", words_of(active)},
                           {"passive", page::number(passive.mean)},
                           {"passive_r2", words_of(passive)},
                           {"jam", page::number(jam.mean, 2)},
                           {"smooth", page::number(smooth.mean, 2)},
                           {"creep", page::number(creep.mean, 2)},
                           {"share", page::number(share.mean, 2)}};
  const MeasuredRun& shown = runs.front();
  section.draw("fig4", figure_4(shown.data, shown.summary).plot, words);
  section.add(branch_table(runs));
  section.claim("fig4.active", words, good_fit, found(active));
  section.claim("fig4.passive", words, good_fit, found(passive));
  section.claim("fig4.end", words, PaperRange::at_least(1.0), found(end));
  section.claim("fig4.jammed", words, PaperRange::at_most(target::jammed_force), found(jam));
  // jammed samples are chosen by their speed, at most 2 % of v_max: this tests a part only
  Found rest = found(share);
  rest.is_whole = false;
  section.claim("fig4.rest", words, PaperRange::at_most(0.01), rest);
}

void fill_density(PaperData& data, PaperSection& section) {
  const std::vector<MeasuredRun> runs = data.records("motion");
  if (runs.empty()) return;
  constexpr Ink inks[] = {Ink::blue, Ink::vermilion, Ink::green, Ink::purple, Ink::orange};
  Panel panel = solid_fraction_panel(runs.back().data);
  for (size_t k = 0; k < runs.size(); ++k)
    panel.curves.push_back(solid_fraction_line(runs[k].data, "sample " + std::to_string(k + 1),
                                               inks[k % std::size(inks)], 1.6));
  const auto initial = [](const RunSummary& s) { return s.facts.solid_fraction_initial; };
  const auto reference = [](const RunSummary& s) { return s.compaction.reference; };
  const SampleMean before = mean_over(runs, initial), at = mean_over(runs, reference),
                   jump = mean_over(runs, [&](const auto&s) { return reference(s) - initial(s); }),
                   gain = mean_over(runs, [](const auto&s) { return s.compaction.gain; }),
                   share = mean_over(runs, [](const auto&s) { return s.compaction.relative_gain; }),
                   trend = mean_over(runs, gain_trend);
  add_gain_line(runs.front(), panel);
  const page::Values words{{"before", words_of(before)},      {"at", words_of(at)},
                           {"jump", words_of(jump)},          {"gain", words_of(gain)},
                           {"trend", words_of(trend, 100.0)}, {"share", words_of(share)}};
  section.draw("fig12", {.height = 460, .panels = {panel}}, words);
  // the paper writes both fractions with two digits
  section.claim("fig12.before", words, PaperRange::about(paper::solid_fraction_initial, 0.005),
                found(before));
  section.claim("fig12.jump", words, PaperRange::about(0.02, 0.01), found(jump));
  section.claim("fig12.gain", words, PaperRange::at_least(0.0), found(gain));
  section.claim("fig12.constant", words, PaperRange::about(0.0, 0.3), found(trend));
}

void fill_portraits(PaperData& data, PaperSection& section) {
  std::vector<double> raw, scaled;
  Portrait shown;
  const auto records = [&](double frequency) {
    return data.records(printed("frequency frequency=%g", frequency));
  };
  const std::vector<MeasuredRun> fast = records(portrait_frequencies[1]);
  for (const MeasuredRun& slow : records(portrait_frequencies[0])) {
    const auto same = std::ranges::find_if(fast, [&](const MeasuredRun& other) {
      return other.data.facts.seed == slow.data.facts.seed;
    });
    if (same == fast.end()) continue;
    const Portrait seen{mean_orbit(slow), mean_orbit(*same)};
    if (seen[0].periods == 0 || seen[1].periods == 0) continue;
    if (raw.empty()) shown = seen;
    raw.push_back(distance(seen));
    scaled.push_back(distance(collapsed(seen)));
  }
  if (raw.empty()) {
    section.notes.push_back("PARTIAL: the records at 5 and 10 Hz are not both there.");
    return;
  }
  const SampleMean after = sample_mean(scaled);
  const page::Values words{{"samples", std::to_string(raw.size())},
                           {"slow", std::to_string(shown[0].periods)},
                           {"fast", std::to_string(shown[1].periods)},
                           {"raw", words_of(sample_mean(raw))},
                           {"scaled", words_of(after)}};
  section.draw("fig8",
               {.height = 860,
                .panels = {portrait_panel(shown, "*x* − *x*~jam~  (mm)", "*v*  (mm/s)"),
                           portrait_panel(collapsed(shown), "(*x* − *x*~jam~) *ν*^2^  (mm/s^2^)",
                                          "*v ν*  (mm/s^2^)")}},
               words);
  section.claim("fig8.collapse", words, PaperRange::at_most(0.1), found(after));
}

void fill_rates(PaperData& data, PaperSection& section) {
  const Groups groups = data.groups("frequency; slowest", "frequency");
  Panel panel = frequency_panel("compaction rate  *η*  (1/s)");
  page::Values words;
  // D as in the paper: the gain of a period at 5 Hz over rho_0
  const Group* slow = at(groups, 5.0);
  const SampleMean gain = slow ? slow->mean("relative_gain") : SampleMean{};
  // two windows of the rate: the paper's, and one that is the same for all frequencies
  for (const auto& [name, title, rate, ink, shape] :
       {std::tuple(std::string("own"), "paper’s window", "rate", Ink::blue, MarkShape::circle),
        {"common", "0.4–1 s", "rate_common", Ink::vermilion, MarkShape::square}}) {
    const Points curve = points_of(groups, "frequency", rate);
    if (curve.x.size() < 2) return;
    panel.curves.push_back(curve_of(curve, title, ink, shape));
    const PeakedRate free = fit_peaked_rate(curve.x, curve.y);
    claim_peak(name, free, 2, curve, words, section);
    if (!std::isfinite(gain.mean)) continue;
    const PeakedRate fixed = fit_peaked_rate(curve.x, curve.y, gain.mean);
    claim_peak(name + "_fixed", fixed, 1, curve, words, section);
    if (name != "own") continue;
    if (std::isfinite(free.critical))
      panel.curves.push_back(law_curve(free, curve, "Eq. 5, both free", Ink::black));
    panel.curves.push_back(
        law_curve(fixed, curve, page::marked("Eq. 5, D = Δρ~1~/ρ~0~"), Ink::green));
    panel.curves.push_back(law_curve({.gain = paper::gain_per_period, .critical = paper_peak},
                                     curve, "the paper’s Eq. 5", Ink::grey));
  }
  if (!std::isfinite(gain.mean)) {
    section.notes.push_back("PARTIAL: no run at 5 Hz has a whole period.");
    return;
  }
  words["gain"] = words_of(gain);
  section.draw("fig13", {.height = 520, .panels = {panel}}, words);
  section.claim("fig13.gain", words, PaperRange::roughly(paper::gain_per_period), found(gain));
  add_falling_branch(groups, section);
}

void fill_compaction(PaperData& data, PaperSection& section) {
  const Groups groups = data.groups("compaction", "frequency");
  Panel panel = frequency_panel("compaction rate  *η*  (1/s)");
  for (const auto& [title, rate, ink, shape] :
       {std::tuple("0.2–1 s", "rate_first", Ink::blue, MarkShape::circle),
        {"0.5–1.5 s", "rate_late", Ink::vermilion, MarkShape::square},
        {"0.2 s to the end", "rate", Ink::green, MarkShape::diamond}}) {
    const Points curve = points_of(groups, "frequency", rate);
    if (curve.x.size() < 2) return;
    panel.curves.push_back(curve_of(curve, title, ink, shape));
    std::vector<std::vector<double>> all, slow, fast;
    for (const Group& group : groups) {
      std::vector<double> values;  // of the packings that every group has
      for (const RunRow* row : groups.front().samples)
        if (std::ranges::all_of(groups, [&](const Group& one) { return one.like(*row); }))
          values.push_back((*group.like(*row))[rate]);
      all.push_back(std::move(values));
      if (group.value <= 5.0) slow.push_back(all.back());
      if (group.value >= 5.0) fast.push_back(all.back());
    }
    const auto most = std::ranges::max_element(curve.y);
    section.report("compaction.claim", {{"window", title},
                                        {"peak", page::number(curve.x[most - curve.y.begin()])},
                                        {"differ", words_of(repeated_anova(all), "F")},
                                        {"differ_slow", words_of(repeated_anova(slow), "F")},
                                        {"differ_fast", words_of(repeated_anova(fast), "F")}});
  }
  section.draw("compaction", {.height = 480, .panels = {panel}},
               {{"samples", std::to_string(groups.front().samples.size())}});
}

}  // namespace ballast
