// Tables of cases: each case changes something. The tables show the cases at the values they were
// driven at and compare them sample by sample. A section is its rows of case_tables and its words.

#include <array>
#include <set>

#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

/// The columns of every table of cases.
constexpr LabelledMeasure stage_columns[] = {{"rise", "Δx~max~ (mm)", 1e3},
                                             {"prefactor", "C", 1.0},
                                             {"prefactor_theory", "C by the theory", 1.0},
                                             {"push_over_weight", "F/(m g)", 1.0},
                                             {"yield_over_weight", "f/(m g) at the start", 1.0},
                                             {"speed_in", "v~max~ (mm/s)", 1e3},
                                             {"net", "net a period (mm)", 1e3},
                                             {"density_before", "ρ before", 1.0},
                                             {"gain", "Δρ~1~ (10^−4^)", 1e4},
                                             {"rate", "η (10^−3^/s)", 1e3},
                                             {"rate_common", "η, 0.4–1 s", 1e3},
                                             {"first_time90", "t~90~ (s)", 1.0},
                                             {"error", "error (g·h)", 1.0}};

/// A table of some cases. Those along the frequency are compared with the first of them, or with
/// the paper.
struct CaseTable {
  const char* section;
  std::vector<std::pair<const char*, Selection>> cases;  ///< names and rows
  RunMeasure exponent_along = "";                        ///< empty: no exponents
  RunMeasure along = "frequency";                        ///< quantity that varies within a case
  bool has_numbers = false;                              ///< the paper's, against each case
};

/// In the order of a section's tables.
const CaseTable case_tables[] = {
    {"fig9", {{"ν", "frequency; slowest"}}},
    {"tight",
     {{"error ≤ 1e-3 g·h", "tightest"},
      {"error ≤ 1e-2 g·h, the campaign’s own", "frequency"},
      {"LMGC90’s rule", "rule"}},
     "frequency"},
    {"laws", {{"Coulomb’s law", "laws solver!sap"}, {"its convex relaxation", "laws solver=sap"}}},
    {"reading", {{"vibrated_box_paper", "reading"}}},
    // other packings: deposited in other ways, and of other grains
    {"deposits",
     {{"lid pressed, μ 0.4", "deposits lid_pressure>0 deposit_friction=0.4"},
      {"lid pressed, μ 0.8", "deposits lid_pressure>0 deposit_friction=0.8"},
      {"lid placed, μ 0.4", "deposits lid_pressure=0 deposit_friction=0.4"},
      {"lid placed, μ 0.8", "deposits lid_pressure=0 deposit_friction=0.8"}},
     "frequency"},
    {"preparation",
     {{"lid pressed, μ 0.4", "preparation lid_pressure=1 deposit_friction=0.4"},
      {"lid pressed, μ 0.8",
       "preparation lid_pressure=1 deposit_friction=0.8; reading frequency>4"},
      {"a fifth of the pressure, μ 0.4", "preparation lid_pressure=0.2 deposit_friction=0.4"},
      {"a fifth of the pressure, μ 0.8", "preparation lid_pressure=0.2 deposit_friction=0.8"},
      {"lid placed, μ 0.4", "preparation name~lid lid_pressure=0 deposit_friction=0.4"},
      {"lid placed, μ 0.8", "preparation lid_pressure=0 deposit_friction=0.8"},
      {"a shorter fall, lid placed, μ 0.4", "preparation name~fall"}},
     "frequency",
     "frequency",
     true},
    {"shapes",
     {{"as the campaign’s", "shapes name~base"},
      {"angular and platy", "shapes name~platy"},
      {"spheres of 162 vertices", "shapes name~spheres"},
      {"fractions by mass", "shapes name~mass"}}},
    // other boxes and other loads
    {"box", {{"5 Hz", "box frequency=5"}, {"20 Hz", "box frequency=20"}}, "aspect", "length"},
    {"loads",
     {{"f_max = 6 m g", "loads force_over_weight=6 largest_size>0.04"},
      {"f_max = 12 m g", "loads force_over_weight=12 largest_size>0.04"},
      {"f_max = 6 m g, all at half scale", "loads force_over_weight=6 largest_size<0.04"}}},
    {"sizes",
     {{"similar boxes, H/L fixed", "sizes name~similar"},
      {"wider boxes, H/d fixed", "sizes name~wide"}},
     "grains_across",
     "grains"},
    // choices that have to be made, each varied alone
    {"sensitivity", {{"step h", "sensitivity friction=0.4 lid_raise=0.01"}}, "", "step"},
    {"sensitivity", {{"friction μ", "sensitivity friction!0.4"}}, "", "friction"},
    {"sensitivity", {{"gap under the lid", "sensitivity lid_raise!0.01"}}, "", "lid_raise"}};

/// A case that has rows.
struct Case {
  const char* name;
  Groups groups;
};

/// The table with a row for each case and value. Keeps the numbers that the article cites.
page::Table stage_table(const std::vector<Case>& cases, const std::string& unit,
                        PaperSection& section) {
  page::Table table = page::words_table("case_columns");
  for (const LabelledMeasure& column : stage_columns)
    table.head.push_back(page::marked(column.label));
  for (const Case& row : cases)
    for (const Group& group : row.groups) {
      table.rows.push_back({row.name, group.label + unit, std::to_string(group.samples.size())});
      for (const LabelledMeasure& column : stage_columns)
        table.rows.back().push_back(words_of(group.mean(column.measure), column.factor));
      page::Values cited{{"case", row.name}, {"at", group.label}};
      for (const RunMeasure measure :
           {"prefactor", "aspect", "height", "grain_mass", "first_compaction", "first_time90"})
        cited.emplace(measure, page::number(group.mean(measure).mean));
      section.keep(section.id + ".cases", cited);
    }
  return table;
}

/// The ranges over which exponents are taken: all values of a case, three or more; of frequencies
/// those from 5 to 60 Hz, and pairs with 60 Hz, to compare cases that were driven at fewer.
std::vector<Groups> ranges_of(const Groups& groups, bool is_frequency) {
  std::vector<Groups> ranges;
  Groups wide = groups;
  if (is_frequency)
    std::erase_if(wide, [](const Group& g) { return g.value < 5.0 || g.value > 60.0; });
  const Group *first = at(groups, 5.0), *last = at(groups, 60.0);
  if (wide.size() > 2 && (!is_frequency || (first && last))) ranges.push_back(std::move(wide));
  if (!is_frequency || !last) return ranges;
  for (const double low : {10.0, 20.0})
    if (const Group* slow = at(groups, low)) ranges.push_back({*slow, *last});
  return ranges;
}

SampleMean mean_of(const std::map<double, double>& by_seed) {
  return sample_mean(values_of(by_seed, &std::pair<const double, double>::second));
}

/// The mean difference of the exponents over the samples that both have.
page::Text change_words(const std::map<double, double>& from, const std::map<double, double>& to) {
  std::map<double, double> change;
  for (const auto& [seed, value] : from)
    if (const auto same = to.find(seed); same != to.end()) change[seed] = same->second - value;
  const SampleMean mean = mean_of(change);
  return mean.samples < 2 ? "–" : words_with_interval(mean) + ", p " + words_of_p(mean.p());
}

/// Adds exponents of Delta x_max and v_max, sample by sample; a case's first range is a finding.
void add_exponents(const CaseTable& what, const std::vector<Case>& cases, PaperSection& section) {
  page::Table table = page::words_table("exponents");
  const bool is_frequency = what.exponent_along == "frequency";
  std::map<std::string, std::map<double, double>> reference;  // of the first case, by range
  for (const Case& row : cases) {
    bool is_first = true;
    for (const Groups& groups : ranges_of(row.groups, is_frequency)) {
      const auto exponents = [&](RunMeasure measure) {
        return exponents_of_samples(groups, what.exponent_along, measure,
                                    is_frequency ? groups.size() : 3);
      };
      const std::map<double, double> rise = exponents("rise");
      const std::string over = groups.front().label + (groups.size() == 2 ? " and " : " to ") +
                               groups.back().label + unit_suffix(what.along);
      if (&row == &cases.front()) reference[over] = rise;
      const page::Values words{{"case", row.name},
                               {"range", over},
                               {"rise", words_with_interval(mean_of(rise))},
                               {"speed", words_with_interval(mean_of(exponents("speed_in")))},
                               {"change", change_words(reference[over], rise)}};
      table.rows.push_back(
          {row.name, over, std::to_string(rise.size()), words.at("rise"), words.at("speed")});
      section.keep(section.id + ".exponents", words);
      if (std::exchange(is_first, false)) section.report(section.id + ".claim", words);
    }
  }
  section.add(table);
}

/// Adds the changes of every other case against the first at the same value, and the probability p
/// of so large a change of C by chance: alone, and among all changes of the table.
void add_changes(const CaseTable& what, const std::vector<Case>& cases, PaperSection& section) {
  page::Table table = page::words_table("changes", {{"reference", cases.front().name}});
  std::vector<double> chances;
  for (const Case& row : cases)
    for (const Group& group : row.groups) {
      const Group* same = at(cases.front().groups, group.value);
      if (&row == &cases.front() || !same) continue;
      const SampleMean change = log_change(*same, group, "prefactor");
      if (!std::isfinite(change.mean)) continue;
      chances.push_back(change.p());
      table.rows.push_back({row.name, group.label + unit_suffix(what.along),
                            words_of_change(change), words_of_p(change.p()), page::Text(),
                            words_of_change(log_change(*same, group, "aspect_prefactor")),
                            words_of_change(log_change(*same, group, "speed_in")),
                            words_of_change(log_change(*same, group, "gain"))});
    }
  const std::vector<double> corrected = holm(chances);
  for (size_t k = 0; k < corrected.size(); ++k) table.rows[k][4] = words_of_p(corrected[k]);
  for (const std::vector<page::Text>& row : table.rows) {
    const page::Values words{{"case", row[0]}, {"at", row[1]},    {"change", row[2]},
                             {"p", row[3]},    {"shape", row[5]}, {"speed", row[6]},
                             {"gain", row[7]}};
    if (what.exponent_along.empty())
      section.report(section.id + ".claim", words);
    else
      section.keep(section.id + ".change", words);
  }
  section.add(table);
}

/// Standard deviation over the mean, in percent.
page::Text scatter_words(const SampleMean& mean) {
  if (mean.samples < 2) return "–";
  return page::number(100.0 * mean.deviation() / std::abs(mean.mean), 2);
}

/// One of the paper's numbers: an exponent of nu, or a measure at the paper's 5 Hz.
struct PaperNumber {
  const char* name;
  RunMeasure measure;
  PaperRange range;
  bool is_exponent = false;
};
const PaperNumber paper_numbers[] = {
    {"exponent of Δx~max~ in ν", "rise", PaperRange::exponent(-2.0), true},
    {"exponent of v~max~ in ν", "speed_in", PaperRange::exponent(-1.0), true},
    {"C at 5 Hz", "prefactor", PaperRange::roughly(paper::prefactor)},
    {"ρ before the drive", "density_before",
     PaperRange::about(paper::solid_fraction_initial, 0.005)},
    {"ρ~0~, at 0.2 s", "density_reference",
     PaperRange::about(paper::solid_fraction_reference, 0.005)},
    {"Δρ~1~/ρ~0~ a period at 5 Hz", "relative_gain", PaperRange::roughly(paper::gain_per_period)}};

Found found_of(const PaperNumber& number, const Groups& groups) {
  if (!number.is_exponent) {
    const Group* slow = at(groups, 5.0);
    return slow ? found(slow->mean(number.measure)) : Found{};
  }
  const Points points = points_of(groups, "frequency", number.measure);
  const PowerFit fit = fit_power(points.x, points.y);
  return std::isfinite(fit.exponent) ? found(fit, misfit_of(points).p) : Found{};
}

/// Draws C at the paper's 5 Hz against the solid fraction before the drive, a point for each case,
/// and the paper's own. Exponents are fitted packing by packing.
void draw_prefactor_and_density(const std::vector<Case>& cases, PaperSection& section) {
  std::map<double, Groups> by_friction;  // of the deposit
  Groups slow;
  for (const Case& row : cases)
    if (const Group* group = at(row.groups, 5.0))
      for (Groups* groups : {&by_friction[(*group->samples.front())["deposit_friction"]], &slow})
        groups->push_back(*group);
  Panel panel{.x_label = page::marked("*ρ*  before the drive"),
              .y_label = page::marked("*C*  at 5 Hz"),
              .y_min = 0.0};
  constexpr std::array inks{Ink::blue, Ink::vermilion, Ink::green, Ink::purple};
  for (const auto& [friction, groups] : by_friction)
    panel.curves.push_back(curve_of(points_of(groups, "density_before", "prefactor"),
                                    page::marked("*μ*  of the deposit: ") + page::exact(friction),
                                    inks[panel.curves.size() % inks.size()]));
  Points own;
  own.add(paper::solid_fraction_initial, {.mean = paper::prefactor});
  panel.curves.push_back(curve_of(own, "the paper", Ink::black, MarkShape::diamond));
  const auto exponent = [&](RunMeasure measure) {
    return words_with_interval(mean_of(exponents_of_samples(slow, "density_before", measure)));
  };
  double density_error = 0.0;
  for (const Group& group : slow)
    density_error = std::max(density_error, group.mean("density_before").error);
  const Points all = points_of(slow, "density_before", "prefactor");
  const double at_paper = fit_power(all.x, all.y).at(paper::solid_fraction_initial);
  section.draw("preparation", {.panels = {panel}},
               {{"exponent", exponent("prefactor")},
                {"aspect", exponent("aspect")},
                {"density_error", page::number(density_error)},
                {"at_paper", page::number(at_paper)}});
}

/// Adds the paper's numbers in every case with verdicts; how many a case meets is a finding.
void add_numbers(const std::vector<Case>& cases, PaperSection& section) {
  page::Table table = page::words_table("paper_numbers");
  for (const PaperNumber& number : paper_numbers) table.head.push_back(page::marked(number.name));
  std::vector<page::Text> asked{"the paper"};
  for (const PaperNumber& number : paper_numbers) asked.push_back(words_of(number.range));
  table.rows.push_back(asked);
  for (const Case& row : cases) {
    table.rows.push_back({row.name});
    page::Values kept{{"case", row.name}};
    int met = 0;
    for (const PaperNumber& number : paper_numbers) {
      const Found seen = found_of(number, row.groups);
      const Agreement verdict = agreement_of(number.range, seen);
      met += verdict == Agreement::agrees || verdict == Agreement::partly;
      table.rows.back().push_back(words_of(seen) + ": " + word_of(verdict));
      kept.emplace(number.measure, table.rows.back().back());
    }
    section.keep(section.id + ".numbers", kept);
    section.report(section.id + ".met", {{"case", row.name},
                                         {"met", std::to_string(met)},
                                         {"all", std::to_string(std::size(paper_numbers))}});
  }
  section.add(table);
}

void add_table(PaperData& data, const CaseTable& what, PaperSection& section) {
  std::vector<Case> cases;
  for (const auto& [name, rows] : what.cases)
    if (Groups groups = data.groups(rows, what.along); !groups.empty())
      cases.push_back({name, std::move(groups)});
  if (cases.empty()) return;
  if (what.has_numbers) {
    draw_prefactor_and_density(cases, section);
    add_numbers(cases, section);
  }
  section.add(stage_table(cases, unit_suffix(what.along), section));
  if (!what.exponent_along.empty()) add_exponents(what, cases, section);
  if (what.along == "frequency" && !what.has_numbers) add_changes(what, cases, section);
}

}  // namespace

void add_cases(PaperData& data, PaperSection& section) {
  for (const CaseTable& what : case_tables)
    if (section.id == what.section) add_table(data, what, section);
}

void fill_replicas(PaperData& data, PaperSection& section) {
  const Group slow{10.0, "10", data.rows("replicas frequency=10")},
      fast{60.0, "60", data.rows("replicas frequency=60")};
  if (slow.samples.size() + fast.samples.size() < 2) return;
  page::Table table = page::words_table("replicas.table");
  for (const LabelledMeasure& column : stage_columns) {
    table.rows.push_back({page::marked(column.label)});
    for (const Group& group : {slow, fast}) {
      const SampleMean mean = group.mean(column.measure);
      table.rows.back().push_back(page::number(column.factor * mean.mean));
      table.rows.back().push_back(scatter_words(mean));
    }
  }
  section.add(table);
  section.report("replicas.claim", {{"slow", scatter_words(slow.mean("rise"))},
                                    {"slow_runs", std::to_string(slow.samples.size())},
                                    {"fast", scatter_words(fast.mean("rise"))},
                                    {"fast_runs", std::to_string(fast.samples.size())}});
}

void fill_errors(PaperData& data, PaperSection& section) {
  constexpr double tolerance = 1e-2;  // of the campaign's own solver [g h]
  std::vector<double> above;
  std::set<std::string> runs;  // a run of several stages has a row in each
  for (const RunRow& row : data.rows())
    if (row.solver == "nesterov_pgs" && runs.insert(row.record).second && row["error"] > tolerance)
      above.push_back(row["error"]);
  section.report("tight.errors", {{"runs", std::to_string(runs.size())},
                                  {"above", std::to_string(above.size())},
                                  {"most", page::number(statistics(above).max, 2)}});
}

void fill_reading(PaperData& data, PaperSection& section) {
  const Groups reading = data.groups("reading", "frequency");
  if (reading.empty()) return;
  // only frequencies that both scenes were driven at
  Groups base = data.groups("frequency; slowest", "frequency");
  std::erase_if(base, [&](const Group& group) { return !at(reading, group.value); });
  add_numbers({{"vibrated_box", base}, {"vibrated_box_paper", reading}}, section);
}

}  // namespace ballast
