// The dependence of C: fits of its logarithm over settings that differ in any quantity, and C
// beside the theory without a free parameter.

#include <algorithm>
#include <map>

#include "experiments/paper/laws.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// Fits of ln C of settings to logarithms of measured or set quantities, with the pooled error.
class LogFits {
 public:
  /// Settings in which C or one of `needed` is not known are left out.
  LogFits(Groups settings, std::vector<RunMeasure> needed) : settings_(std::move(settings)) {
    needed.push_back("prefactor");
    std::erase_if(settings_, [&](const Group& group) {
      return std::ranges::any_of(
          needed, [&](RunMeasure measure) { return !std::isfinite(group.log_mean(measure)); });
    });
    error_ = scatter_between(settings_, "prefactor");
  }

  size_t size() const { return settings_.size(); }
  bool is_known(size_t fewest) const { return size() >= fewest && error_.degrees_of_freedom > 0; }

  /// One value for each setting.
  Eigen::VectorXd log(RunMeasure measure) const {
    Eigen::VectorXd values(size());
    for (size_t k = 0; k < size(); ++k) values[k] = settings_[k].log_mean(measure);
    return values;
  }

  /// Fits ln C by a constant (value 0) and these columns (values 1, 2 ...).
  WeightedFit fit(const std::vector<Eigen::VectorXd>& columns) const {
    Eigen::MatrixXd design = Eigen::MatrixXd::Ones(size(), 1 + columns.size());
    for (size_t k = 0; k < columns.size(); ++k) design.col(1 + k) = columns[k];
    Eigen::VectorXd errors(size());
    for (size_t k = 0; k < size(); ++k)
      errors[k] = error_.deviation / std::sqrt(static_cast<double>(settings_[k].samples.size()));
    return fit_weighted(design, log("prefactor"), errors);
  }
  page::Text exponent(const WeightedFit& fit, Eigen::Index k) const {
    const Eigen::VectorXd row = Eigen::VectorXd::Unit(fit.value.size(), k);
    return words_of(
        Found::about(fit.at(row), student_t95(error_.degrees_of_freedom) * fit.error_at(row)));
  }
  page::Text misfit(const WeightedFit& fit) const { return words_of(misfit_of(fit, error_)); }

 private:
  Groups settings_;
  PooledError error_;
};

/// The columns of the theory's variables, F/(m g) and the ratio of masses, and of `more`.
std::vector<Eigen::VectorXd> theory_and(RunMeasure more, const LogFits& all) {
  const Eigen::VectorXd force = all.log("push_over_weight");
  return {force, all.log("prefactor_theory") - 2.0 * force, all.log(more)};
}

/// Reports whether the theory's factor depends on the load at which a jam gives way, over all
/// settings in which this load is known.
void report_start(PaperData& data, PaperSection& section) {
  const LogFits all(data.settings("slowest; deposits; loads; shapes; sizes; reading; preparation"),
                    {"prefactor_theory", "yield_over_push"});
  if (!all.is_known(6)) return;
  const WeightedFit start = all.fit(theory_and("yield_over_push", all));
  section.report("theory.start", {{"points", std::to_string(all.size())},
                                  {"start", all.exponent(start, 3)},
                                  {"misfit", all.misfit(start)},
                                  {"with_x", all.misfit(all.fit(theory_and("eq3", all)))}});
}

/// Reports the factor of C over the theory's C, frequency by frequency, in every deposit that was
/// driven.
void report_factors(PaperData& data, PaperSection& section) {
  // by frequency: one value for each deposit
  std::map<double, std::vector<double>> factors, starts, over_push;
  for (const Group& group : data.settings("preparation")) {
    const double frequency = (*group.samples.front())["frequency"];
    factors[frequency].push_back(group.log_mean("theory_ratio"));
    starts[frequency].push_back(group.mean("yield_over_weight").mean);
    over_push[frequency].push_back(group.mean("yield_over_push").mean);
  }
  for (const auto& [frequency, logs] : factors) {
    const SampleMean mean = sample_mean(logs);
    const Statistics start = statistics(starts[frequency]);
    section.report("theory.deposits",
                   {{"frequency", page::number(frequency)},
                    {"deposits", std::to_string(mean.samples)},
                    {"factor", page::number(std::exp(mean.mean))},
                    {"scatter", page::number(100.0 * mean.deviation(), 2) + " %"},
                    {"start_least", page::number(start.min, 2)},
                    {"start_most", page::number(start.max, 2)},
                    {"start_push", page::number(statistics(over_push[frequency]).mean, 2)}});
  }
}

}  // namespace

void report_box(PaperData& data, PaperSection& section) {
  const LogFits all(
      data.settings(printed("frequency; slowest; force force_over_weight>%g; gravity; "
                            "mass wall_mass_over_grains>%g; box",
                            0.99 * least_load, least_wall)),
      {"aspect"});
  if (!all.is_known(8)) return;
  const Eigen::VectorXd x = all.log("eq3");
  const WeightedFit fit = all.fit({x, x.cwiseAbs2(), all.log("aspect")});
  section.report("curve.box", {{"points", std::to_string(all.size())},
                               {"aspect", all.exponent(fit, 3)},
                               {"misfit", all.misfit(fit)}});
}

void fill_theory(PaperData& data, PaperSection& section) {
  report_factors(data, section);
  const LogFits all(data.settings("frequency; slowest; force; gravity; mass; box; "
                                  "loads largest_size>0.04"),
                    {"prefactor_theory"});
  if (!all.is_known(6)) return;
  std::vector<Eigen::VectorXd> columns = theory_and("eq3", all);
  const WeightedFit more = all.fit(columns);
  columns.pop_back();
  const WeightedFit free = all.fit(columns);
  section.report("theory.free", {{"points", std::to_string(all.size())},
                                 {"force", all.exponent(more, 1)},
                                 {"mass", all.exponent(more, 2)},
                                 {"x", all.exponent(more, 3)},
                                 {"misfit", all.misfit(more)},
                                 {"without", all.misfit(free)}});
  report_start(data, section);
}

}  // namespace ballast
