#include "experiments/compare/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <tuple>

#include "experiments/compare/collection.hpp"
#include "experiments/measure/curve_fit.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/random.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;
using Eigen::VectorXd;
using Weights = std::map<std::string, double>;  ///< by run

/// The weighted mean of each backend over `members`, of which some run has a weight > 0.
VectorXd means_of(const TriedCases& tried, const std::vector<Eigen::Index>& members,
                  const Weights& weights) {
  VectorXd sum = VectorXd::Zero(tried.log_seconds.cols());
  double total = 0.0;
  for (const Eigen::Index c : members) {
    const double weight = weights.at(run_of(tried.cases[static_cast<size_t>(c)]->case_name));
    sum += weight * tried.log_seconds.row(c).transpose();
    total += weight;
  }
  return sum / total;
}

// The page.

const std::string everything = "all";

bool is_open(const CompareRow& row) { return !is_held(row.facts.content); }

/// "11 to 100 contacts"
std::string size_of(const CompareRow& row) {
  int most = 10;
  while (most < row.facts.contacts) most *= 10;
  return printed("%d to %d contacts", most == 10 ? 1 : most / 10 + 1, most);
}

bool is_of(const CompareRow& row, const std::string& kind) {
  return kind == everything || base_family(row) == kind || size_of(row) == kind;
}

page::Text solved(const BackendSummary& s) {
  return page::quantity(100.0 * s.solved / s.tried(), "%");
}

/// The outcomes of the unsolved cases, most frequent first.
std::string verdicts_of(const BackendSummary& s) {
  const int named = s.timeouts + s.crashes + s.unsupported + s.no_solutions + s.denied;
  std::pair<int, const char*> counts[] = {
      {s.timeouts, "out of time"},       {s.crashes, "crashed"},
      {s.unsupported, "not taken"},      {s.no_solutions, "said to have no solution"},
      {s.denied, "denied by the judge"}, {s.unsolved - named, "gave up"}};
  std::ranges::sort(counts, std::ranges::greater());
  std::string text;
  for (const auto& [number, what] : counts)
    if (number > 0) add_to_list(text, std::to_string(number) + ' ' + what);
  return text;
}

/// The open cases, as rows of log_seconds.
std::vector<Eigen::Index> open_cases(const TriedCases& tried) {
  std::vector<Eigen::Index> open;
  for (size_t c = 0; c < tried.cases.size(); ++c)
    if (is_open(*tried.cases[c])) open.push_back(static_cast<Eigen::Index>(c));
  return open;
}

page::Values words_for(const TriedCases& tried) {
  return {{"tolerance", page::exact(tried.tolerance)}, {"start", name_of(tried.start)}};
}

class Ranking {
 public:
  explicit Ranking(std::span<const CompareRow> rows) {
    std::set<std::string> families;
    std::map<int, std::string> sizes;
    for (const CompareRow& row : rows) {
      if (row.verdict == Verdict::unreadable) continue;
      rows_.push_back(row);
      rows_.back().history.clear();  // rows are copied for each kind
      families.insert(base_family(row));
      sizes[row.facts.contacts] = size_of(row);
    }
    kinds_.assign(families.begin(), families.end());
    for (const auto& [contacts, size] : sizes)
      if (size != kinds_.back()) kinds_.push_back(size);
    for (const bool held : {false, true}) {
      sum_up(held, everything);
      for (const std::string& kind : kinds_) sum_up(held, kind);
    }
  }

  page::Page page() const {
    page::Page page{.title = "Solvers of frictional contact: who solves what, and how fast",
                    .lede = {page::words(
                        "ranking.lede", {{"solvers", different(rows_, &CompareRow::solver)},
                                         {"problems", different(rows_, &CompareRow::case_name)}})}};
    page::Section order{"order", "The order"}, each{"by-family", "Family by family, size by size"},
        failures{"failures", "What each backend fails on"};
    order.add(
        page::words("ranking.order", {{"limit", page::quantity(limit_of(rows_), "s")},
                                      {"shift", page::quantity(1e3 * summary_shift, "ms", 1)}}));
    failures.add(page::words("ranking.failures"));
    for (const TriedCases& tried : tried_cases(rows_)) add_tables(tried, order, each, failures);
    page.add(order);
    page.add({"families", "The problems", {page::words("ranking.families"), problems()}});
    page.add(each);
    page.add(failures);
    page.answers.is_enabled = true;
    return page;
  }

  /// Returns a line for each part, kind, setting and backend.
  std::string csv() const {
    CsvWriter csv;
    const auto whole = [](int number) { return std::to_string(number); };
    const auto real = [](double number) { return printed("%.4g", number); };
    csv.add_row(std::vector<std::string>{"part", "kind", "tolerance", "start", "solver", "law",
                                         "cases", "solved", "share", "mean_seconds", "over_fastest",
                                         "timeouts", "crashes", "not_taken", "no_solution",
                                         "denied"});
    for (const auto& [place, s] : summaries_) {
      const auto& [held, kind, tolerance, start, solver] = place;
      csv.add_row(std::vector<std::string>{
          held ? "held" : "open", kind, printed("%g", tolerance), name_of(start), solver, s.law,
          whole(s.tried()), whole(s.solved), real(1.0 * s.solved / s.tried()), real(s.mean_seconds),
          real(s.mean_ratio), whole(s.timeouts), whole(s.crashes), whole(s.unsupported),
          whole(s.no_solutions), whole(s.denied)});
    }
    return csv.take();
  }

 private:
  void sum_up(bool held, const std::string& kind) {
    std::vector<CompareRow> some;
    for (const CompareRow& row : rows_)
      if (is_open(row) != held && is_of(row, kind)) some.push_back(row);
    for (const CompareTable& table : compare_tables(some))
      for (const BackendSummary& s : table.backends)
        summaries_[{held, kind, table.tolerance, table.start, s.solver}] = s;
  }

  /// Returns no cases and NaN where the backend tried no such case.
  BackendSummary summary(bool held, const std::string& kind, const TriedCases& tried,
                         size_t s) const {
    const auto found =
        summaries_.find({held, kind, tried.tolerance, tried.start, tried.solvers[s]});
    return found == summaries_.end() ? BackendSummary() : found->second;
  }

  /// Adds all tables of one start and tolerance, with the backends in the order of their ranks.
  void add_tables(const TriedCases& tried, page::Section& order, page::Section& each,
                  page::Section& failures) const {
    const std::vector<Estimate> ranks = ranks_of(tried, open_cases(tried));
    std::vector<std::pair<double, size_t>> by_rank;
    for (size_t s = 0; s < ranks.size(); ++s)
      by_rank.emplace_back(std::isnan(ranks[s].value) ? HUGE_VAL : ranks[s].value, s);
    std::ranges::sort(by_rank);
    page::Table all = page::words_table("ranking.order-table", words_for(tried)),
                failed = page::words_table("ranking.failure-table", words_for(tried)),
                shares{.head = {"backend"}, .is_number = {false}};
    all.is_number = {true, true, false, false, true, true, true, true, true};
    failed.is_number = {false, true, false, false};
    shares.head.insert(shares.head.end(), kinds_.begin(), kinds_.end());
    shares.is_number.resize(shares.head.size(), true);
    page::Table ratios = shares;
    shares.caption = page::words("ranking.solved", words_for(tried));
    ratios.caption = page::words("ranking.ratio", words_for(tried));
    for (const auto& [rank, s] : by_rank) {
      const std::string& name = tried.solvers[s];
      const BackendSummary open = summary(false, everything, tried, s),
                           held = summary(true, everything, tried, s);
      const page::Text range = page::exact(ranks[s].low) + "–" + page::exact(ranks[s].high);
      all.rows.push_back({page::exact(ranks[s].value), std::isnan(ranks[s].low) ? "–" : range, name,
                          open.law, solved(open), solved(held),
                          page::quantity(1e3 * open.mean_seconds, "ms"),
                          page::number(open.mean_ratio), page::number(held.mean_ratio)});
      shares.rows.push_back({name});
      ratios.rows.push_back({name});
      for (const std::string& kind : kinds_) {
        const BackendSummary some = summary(false, kind, tried, s);
        shares.rows.back().push_back(solved(some));
        ratios.rows.back().push_back(page::number(some.mean_ratio));
      }
      if (open.unsolved > 0)
        failed.rows.push_back(
            {name, page::exact(open.unsolved), verdicts_of(open), worst(tried, s)});
    }
    order.add(all);
    for (const page::Table& table : {shares, ratios}) each.add(table);
    failures.add(failed);
  }

  /// Names the three kinds of which a backend leaves the largest shares unsolved.
  std::string worst(const TriedCases& tried, size_t s) const {
    std::vector<std::pair<double, std::string>> places;
    for (const std::string& kind : kinds_)
      if (const BackendSummary some = summary(false, kind, tried, s); some.unsolved > 0)
        places.emplace_back(1.0 * some.solved / some.tried(),
                            printed("%s (%d of %d)", kind.c_str(), some.unsolved, some.tried()));
    std::ranges::sort(places);
    std::string text;
    places.resize(std::min<size_t>(3, places.size()));
    for (const auto& [share, place] : places) add_to_list(text, place);
    return text;
  }

  page::Table problems() const {
    page::Table table = page::words_table("ranking.problem-table");
    table.is_number = {false, true, true, true, true, true, true, true};
    const double tightest = std::ranges::min(rows_, {}, &CompareRow::tolerance).tolerance;
    for (const std::string& kind : kinds_) {
      std::set<std::string> seen, mastered;
      std::vector<double> contacts;
      double ratio = 0.0;
      size_t held = 0;
      for (const CompareRow& row : rows_) {
        if (!is_of(row, kind)) continue;
        if (row.tolerance == tightest && row.verdict == Verdict::solved)
          mastered.insert(row.case_name);
        if (!seen.insert(row.case_name).second) continue;
        contacts.push_back(row.facts.contacts);
        ratio = std::max(ratio, row.facts.mass_ratio);
        held += !is_open(row);
      }
      const double percent =
          100.0 * static_cast<double>(mastered.size()) / static_cast<double>(seen.size());
      table.rows.push_back({kind, page::exact(contacts.size()), page::exact(held),
                            page::exact(quantile(contacts, 0.0)),
                            page::exact(quantile(contacts, 0.5)),
                            page::exact(quantile(contacts, 1.0)), page::number(ratio, 2),
                            page::quantity(percent, "%")});
    }
    return table;
  }

  std::vector<CompareRow> rows_;
  std::vector<std::string> kinds_;  ///< families, then sizes
  /// Indexed by held or not, kind, tolerance, start and backend.
  std::map<std::tuple<bool, std::string, double, StartKind, std::string>, BackendSummary>
      summaries_;
};

}  // namespace

std::string base_family(const CompareRow& row) {
  return row.family.substr(0, row.family.find(", "));
}

std::string run_of(const std::string& case_name) {
  return case_name.substr(0, case_name.rfind("step_"));
}

std::vector<TriedCases> tried_cases(std::span<const CompareRow> rows, double shift) {
  const double limit = limit_of(rows);
  std::vector<TriedCases> result;
  for (CompareTable& table : compare_tables(rows)) {
    TriedCases& tried = result.emplace_back(TriedCases{table.start, table.tolerance, {}, {}, {}});
    for (const BackendSummary& s : table.backends) tried.solvers.push_back(s.solver);
    std::ranges::sort(tried.solvers);
    const size_t solvers = tried.solvers.size();
    std::erase_if(table.cases, [&](const auto& one) { return one.second.size() != solvers; });
    tried.log_seconds.resize(static_cast<Eigen::Index>(table.cases.size()),
                             static_cast<Eigen::Index>(solvers));
    for (const auto& [name, solves] : table.cases) {
      Eigen::Index c = std::ssize(tried.cases), s = 0;
      tried.cases.push_back(solves.begin()->second.row);
      for (const auto& [solver, solve] : solves)
        tried.log_seconds(c, s++) =
            std::log(shift + (solve.solved ? std::min(solve.median, limit) : limit));
    }
  }
  std::ranges::stable_sort(result, std::greater(), &TriedCases::tolerance);
  return result;
}

std::vector<Estimate> ranks_of(const TriedCases& tried, const std::vector<Eigen::Index>& members) {
  const size_t solvers = tried.solvers.size();
  if (members.empty()) return std::vector<Estimate>(solvers, {not_known, not_known, not_known});
  std::vector<std::vector<double>> ranks(solvers);
  // a rank is 1 + the number of smaller means + half the number of other equal ones
  const auto rank = [&](const Weights& weights) {
    const Eigen::ArrayXd means = means_of(tried, members, weights);
    for (size_t s = 0; s < solvers; ++s) {
      const double mean = means[static_cast<Eigen::Index>(s)];
      ranks[s].push_back(0.5 + static_cast<double>((means < mean).count()) +
                         0.5 * static_cast<double>((means == mean).count()));
    }
  };
  Weights each;
  for (const Eigen::Index c : members)
    each[run_of(tried.cases[static_cast<size_t>(c)]->case_name)] = 1.0;
  rank(each);
  std::vector<std::string> runs;
  for (const auto& [run, weight] : each) runs.push_back(run);
  Random random(1);
  for (int k = 0; runs.size() >= fewest_runs && k < resamples; ++k) {
    Weights drawn = each;
    for (auto& [run, weight] : drawn) weight = 0.0;
    for (size_t n = 0; n < runs.size(); ++n)
      ++drawn[runs[static_cast<size_t>(random.below(static_cast<int>(runs.size())))]];
    rank(drawn);
  }
  std::vector<Estimate> estimates;
  for (const std::vector<double>& values : ranks) {
    const std::span drawn = std::span(values).subspan(1);
    estimates.push_back({values[0], quantile(drawn, 0.025), quantile(drawn, 0.975)});
  }
  return estimates;
}

void write_ranking(const fs::path& folder, std::span<const CompareRow> rows) {
  const Ranking ranking(rows);
  write_whole_file(folder / "table.csv", ranking.csv());
  const page::Page page = ranking.page();
  write_with_origin(page, folder / "index.html");
  write_whole_file(folder / "ranking.md", markdown_of(page));
}

}  // namespace ballast
