#pragma once
// The report of a reproduction: README.md, paper.html (opens offline), figures/*.svg, data/*.csv.
// Defines its sections: the content of each, the stages of the campaign that it needs, and the
// function that fills it. The words of a section are in texts/*.md under its name.

#include <cmath>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "experiments/page/page.hpp"
#include "experiments/paper/paper_data.hpp"
#include "platform/error.hpp"

namespace ballast {

/// One rule decides whether Ballast and the paper agree: words("paper.rule") in texts/report.md.
/// The paper's statement is a range of values, Ballast's result a value with its 95 % interval.
enum class Agreement { agrees, partly, differs, reported };
const char* word_of(Agreement agreement);

/// The values that the paper allows. One side may be infinite.
struct PaperRange {
  double low, high;

  static PaperRange about(double value, double half_width) {
    return {value - half_width, value + half_width};
  }
  static PaperRange exponent(double value) { return about(value, 0.1); }
  /// A number written with "~", or "almost": 30 % to both sides.
  static PaperRange roughly(double value) { return about(value, 0.3 * std::abs(value)); }
  static PaperRange at_most(double value) { return {-HUGE_VAL, value}; }
  static PaperRange at_least(double value) { return {value, HUGE_VAL}; }

  bool holds(double value) const { return low <= value && value <= high; }
};

/// A result of Ballast.
struct Found {
  double value = not_known, low = not_known, high = not_known;  ///< with its 95 % interval
  double law_p = 1.0;    ///< p of the misfit of the law whose parameter it is
  bool is_whole = true;  ///< false: a part of the paper's statement, or samples chosen by it

  static Found about(double value, double half_width, double law_p = 1.0) {
    return {value, value - half_width, value + half_width, law_p};
  }
};
/// The result with Student's interval; one sample has none.
inline Found found(const SampleMean& mean) { return Found::about(mean.mean, mean.half_width()); }
inline Found found(const PowerFit& fit, double law_p) {
  return Found::about(fit.exponent, fit.half_width, law_p);
}

Agreement agreement_of(const PaperRange& paper, const Found& found);

/// "−2.1 … −1.9", "≤ 0.26"
page::Text words_of(const PaperRange& range);
/// "−1.70 [−1.74, −1.66]", and the reasons besides its value why it does not agree.
page::Text words_of(const Found& found);

struct PaperSection {
  std::string id = {};  ///< "fig9"
  page::Text heading = {};
  std::vector<page::Text> notes = {};  ///< prominent notices of missing data
  std::vector<page::Text> text = {};   ///< paragraphs
  std::vector<page::Picture> figures = {};
  std::vector<page::Table> tables = {};
  /// Rows of the report's first tables: claims of words("paper.agreement"), findings of
  /// words("paper.beyond"), which go beyond the paper: there is nothing to agree with.
  std::vector<std::vector<page::Text>> claims = {}, findings = {};
  /// The values that the article cites: every value of the section's figures, claims and findings
  /// by "name.key", and by "name:2.key" those of the second finding of one name.
  page::Values numbers = {};

  /// Adds a figure with its captions: words(name.paper) and words(name.found). Unless `plot` has a
  /// title it is words(name.title); its files are called `name`, with two digits for "fig9".
  void draw(const std::string& name, Figure plot, const page::Values& values = {});
  /// Adds a claim, judged by the rule above. words(name) is "place || what the paper says || what
  /// was measured".
  void claim(const std::string& name, const page::Values& values, const PaperRange& range,
             const Found& found);
  /// Adds a finding. words(name) is "what || what was measured".
  void report(const std::string& name, const page::Values& values);
  void keep(const std::string& name, const page::Values& values);
  /// Adds a table, unless it has no rows.
  void add(page::Table table);
};

/// "1.230 ± 0.040"
page::Text words_of(const SampleMean& mean, double factor = 1.0);
/// Text of a fitted exponent: "−1.93 [−2.05, −1.81] (R² 0.995, 5 points)".
page::Text words_of(const PowerFit& fit);
/// "0.03 [0.02, 0.04]": with its 95 % interval.
page::Text words_of(const Proportion& fit);
/// "χ²/dof 3.2, p 0.004"; words("misfit") explain it to the reader.
page::Text words_of(const VarianceRatio& found, const char* name = "χ²/dof");
/// "0.004", "< 1e-4"
page::Text words_of_p(double p);
/// "−1.00 [−1.2, −0.8]": with the 95 % interval by Student's t; one sample has none.
page::Text words_with_interval(const SampleMean& mean);
/// A difference of logarithms in percent: "+3.1 % [0.2, 6.1]"; one sample has no interval.
page::Text words_of_change(const SampleMean& change);

/// A measure as figures and tables show it.
struct LabelledMeasure {
  RunMeasure measure;
  const char* label;  ///< with its unit, in the notation of page::marked()
  double factor;      ///< from SI units to those shown
};

/// Points with error bars.
Curve curve_of(const Points& points, const page::Text& title, Ink ink,
               MarkShape shape = MarkShape::circle);

/// The range of x in which a function is drawn, evenly in log x where `is_log`.
struct Drawn {
  double low, high;
  bool is_log;
};
template <class Function>
Curve curve_of(const Function& function, const Drawn& range, const page::Text& title, Ink ink,
               bool dashed = true) {
  Curve curve{.title = title, .ink = ink, .dash = dashed};
  constexpr int parts = 200;
  for (int k = 0; k <= parts; ++k) {
    const double s = static_cast<double>(k) / parts;
    curve.x.push_back(range.is_log ? range.low * std::pow(range.high / range.low, s)
                                   : range.low + s * (range.high - range.low));
    curve.y.push_back(function(curve.x.back()));
  }
  return curve;
}

/// The figure's data: panel, curve, x, y, y_error, y_low as CSV.
std::string figure_csv(const Figure& figure);

/// Adds figures, tables, claims and findings to a section.
using FillSection = void(PaperData& data, PaperSection& section);

/// One section of the report. `name` is the target of `ballast paper` that makes it. Its heading is
/// words(name.heading), its first paragraph words(name.intro). `fill` adds to the figures and
/// tables that its rows in the tables of laws and cases give; null: nothing.
struct ReportSection {
  const char* name;  ///< "fig9"
  std::vector<const char*> stages;
  FillSection* fill = nullptr;
};
/// All sections: the main result first, then in the paper's order. A new one needs a row in
/// sections.cpp, words in texts/, and a row of a table (laws.cpp, cases.cpp) or its own function.
std::span<const ReportSection> paper_sections();

/// Names that `ballast paper` takes: those of the sections, of the stages, and "all".
std::vector<std::string> paper_targets(const std::vector<PlannedRun>& campaign);
/// The plans that a target needs, one for each stage, to be run in this order. Runs that are known
/// by a row alone are left out. Throws std::invalid_argument naming the target and the valid ones.
std::vector<Plan> stages_of(const PaperData& data, const std::string& target);
/// The sections of a target; if it is a stage, all sections that draw the stage.
std::vector<PaperSection> make_sections(PaperData& data, const std::string& target);

/// Add what is a row of a table: power laws (laws.cpp), cases (cases.cpp).
FillSection add_laws, add_cases;
// the functions of single sections, in the order of paper_sections()
FillSection fill_curve, fill_motion, fill_forces, fill_model, fill_velocities, fill_chains,
    fill_portraits, fill_density, fill_rates, fill_replicas, fill_errors, fill_compaction,
    fill_reading, fill_theory;

/// Writes the report of these sections into `folder`, each file whole or not at all. A figure that
/// gnuplot cannot draw becomes a notice. Throws Error.
void write_paper_report(PaperData& data, const std::vector<PaperSection>& sections,
                        const std::filesystem::path& folder);

/// The page from which paper.html and README.md are written; its figures are not drawn yet.
/// `origin` are sentences about the programs and machines that made the runs.
page::Page paper_page(const std::vector<PaperSection>& sections,
                      const std::vector<page::Text>& origin);

// The article about the reproduction: prose (article.md, built into the program) in Pandoc's
// Markdown. {{name.key}} in it stands for a number of the report, the value `key` of its figure,
// claim or finding `name`; figures/NAME.svg stands for one of the report's figures.

/// `prose` with every number put in. Throws Error naming the first number that is missing.
std::string article_of(std::string_view prose, const page::Values& numbers);

/// The article with the numbers of the whole report.
std::string article_of(const std::vector<PaperSection>& sections);

/// Writes article.md and the figures that it shows into `folder`, and by Pandoc and XeLaTeX
/// article.html and article.pdf. Writes to `notes` what is missing for them. Throws Error.
ExitCode write_article(PaperData& data, const std::filesystem::path& folder, std::ostream& notes);

/// The campaign as a dataset that can be cited: rows, plan, scenes, packings' checksums, a reader.
struct ArchiveOptions {
  std::filesystem::path plan = {};  ///< the campaign's; empty: campaign.toml
  std::filesystem::path packings;   ///< folder of the packings; those in it get checksums
  std::filesystem::path output;
};

/// Writes the folder `<output>/ballast-paper` and packs it as `<output>/ballast-paper.tar.gz`; the
/// same rows give the same bytes. Returns the packed file. Throws Error.
std::filesystem::path write_archive(PaperData& data, const ArchiveOptions& order);

}  // namespace ballast
