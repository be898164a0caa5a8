#include "experiments/compare/ranking_page.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "experiments/compare/collection.hpp"
#include "experiments/compare/compare_page.hpp"
#include "experiments/measure/curve_fit.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

constexpr const char* all_families = "all";

/// Tolerance from loose to tight, and start.
using Setting = std::pair<double, StartKind>;
using Summaries = std::map<Setting, std::map<std::string, BackendSummary>>;

Setting setting_of(const TriedCases& tried) { return {-tried.tolerance, tried.start}; }

double share_of(const BackendSummary& s) {
  return static_cast<double>(s.solved) / (s.solved + s.unsolved);
}

/// What became of the cases that are not solved, most often first.
std::string verdicts_of(const BackendSummary& s) {
  const int named = s.timeouts + s.crashes + s.unsupported + s.no_solutions + s.denied;
  std::vector<std::pair<int, const char*>> counts = {
      {s.timeouts, "out of time"},       {s.crashes, "crashed"},
      {s.unsupported, "not taken"},      {s.no_solutions, "said to have no solution"},
      {s.denied, "denied by the judge"}, {s.unsolved - named, "gave up"}};
  std::ranges::stable_sort(counts, std::ranges::greater(), &std::pair<int, const char*>::first);
  std::string text;
  for (const auto& [count, what] : counts)
    if (count > 0) add_to_list(text, std::to_string(count) + ' ' + what);
  return text;
}

/// Problems of one kind that are looked at together.
struct Kind {
  std::string what;
  std::function<bool(const CompareRow&)> has;
};

const Kind sizes[] = {
    {"up to 30 contacts", [](const CompareRow& r) { return r.facts.contacts <= 30; }},
    {"31 to 300 contacts",
     [](const CompareRow& r) { return r.facts.contacts > 30 && r.facts.contacts <= 300; }},
    {"301 to 3000 contacts",
     [](const CompareRow& r) { return r.facts.contacts > 300 && r.facts.contacts <= 3000; }},
    {"more contacts", [](const CompareRow& r) { return r.facts.contacts > 3000; }}};

CaseGroup group_of(const TriedCases& tried, const std::function<bool(const CompareRow&)>& has) {
  CaseGroup group{&tried};
  for (size_t c = 0; c < tried.cases.size(); ++c)
    if (has(*tried.cases[c])) group.members.push_back(static_cast<Eigen::Index>(c));
  return group;
}

bool is_open(const CompareRow& row) { return !is_held(row.facts.content); }

class Ranking {
 public:
  explicit Ranking(std::span<const CompareRow> rows) {
    for (const CompareRow& row : rows) {
      if (row.verdict == Verdict::unreadable) continue;
      rows_.push_back(row);
      rows_.back().history.clear();  // rows are copied by family
      families_.insert(world_of(row));
    }
    for (const bool held : {false, true}) {
      sum_up(held, all_families);
      for (const std::string& family : families_) sum_up(held, family);
    }
    tried_ = tried_cases(rows_);
    for (const TriedCases& tried : tried_) {
      ranks_.push_back(ranks_of(group_of(tried, is_open)));
      std::vector<size_t>& order = orders_.emplace_back(tried.solvers.size());
      for (size_t s = 0; s < order.size(); ++s) order[s] = s;
      std::ranges::stable_sort(order, {}, [&](size_t s) {
        const double rank = ranks_.back()[s].value;
        return std::isnan(rank) ? 1.0 - share(false, all_families, tried, s) : rank;
      });
    }
  }

  page::Page page() const {
    std::set<std::string> cases, solvers;
    for (const CompareRow& row : rows_) {
      cases.insert(row.case_name);
      solvers.insert(row.solver);
    }
    page::Page page{
        .title = "Solvers of frictional contact: who solves what, and how fast",
        .lede = {page::words("ranking.lede", {{"solvers", page::exact(count(solvers))},
                                              {"problems", page::exact(count(cases))},
                                              {"families", page::exact(count(families_))}})}};
    const page::Text limit = page::quantity(limit_of(rows_), "s");
    page::Section order{"order", "The order"}, each{"by-family", "Family by family"},
        failures{"failures", "What each backend fails on"};
    order.add(
        page::words("ranking.order",
                    {{"limit", limit}, {"shift", page::quantity(1e3 * summary_shift, "ms", 1)}}));
    each.add(page::words("ranking.by-family"));
    failures.add(page::words("ranking.failures"));
    for (size_t t = 0; t < tried_.size(); ++t) {
      order.add(order_table(t));
      each.add(family_table(t, "ranking.solved", &Ranking::solved_cell));
      each.add(family_table(t, "ranking.ratio", &Ranking::ratio_cell));
      failures.add(failure_table(t));
    }
    page.add(order);
    page.add({"families", "The problems", {page::words("ranking.families"), problems_table()}});
    page.add(each);
    page.add(
        {"stability", "Does the order hold?", {page::words("ranking.stability"), stability()}});
    page.add(failures);
    page.answers.are_given = true;
    return page;
  }

  /// A line for each part, family, setting and backend.
  std::string csv() const {
    CsvWriter csv;
    csv.add_row(std::vector<std::string>{"part", "family", "tolerance", "start", "solver", "law",
                                         "cases", "solved", "share", "mean_seconds", "over_fastest",
                                         "timeouts", "crashes", "not_taken", "no_solution",
                                         "denied"});
    for (const auto& [place, summaries] : summaries_)
      for (const auto& [setting, by_solver] : summaries)
        for (const auto& [solver, s] : by_solver) {
          for (const std::string& text :
               {std::string(place.first ? "held" : "open"), place.second,
                printed("%g", -setting.first), std::string(name_of(setting.second)), solver, s.law})
            csv.add(text);
          csv.add(long{s.solved + s.unsolved});
          csv.add(long{s.solved});
          for (const double value : {share_of(s), s.mean_seconds, s.mean_ratio}) csv.add(value, 4);
          for (const int number : {s.timeouts, s.crashes, s.unsupported, s.no_solutions, s.denied})
            csv.add(long{number});
          csv.end_row();
        }
    return csv.take();
  }

 private:
  static double count(const std::set<std::string>& of) { return static_cast<double>(of.size()); }

  void sum_up(bool held, const std::string& family) {
    std::vector<CompareRow> some;
    for (const CompareRow& row : rows_)
      if (is_held(row.facts.content) == held && (family == all_families || world_of(row) == family))
        some.push_back(row);
    for (const CompareTable& table : compare_tables(some))
      for (const BackendSummary& backend : table.backends)
        summaries_[{held, family}][{-table.tolerance, table.start}][backend.solver] = backend;
  }

  /// Null: it tried none of them.
  const BackendSummary* find(bool held, const std::string& family, const TriedCases& tried,
                             size_t s) const {
    const auto place = summaries_.find({held, family});
    if (place == summaries_.end()) return nullptr;
    const auto setting = place->second.find(setting_of(tried));
    if (setting == place->second.end()) return nullptr;
    const auto found = setting->second.find(tried.solvers[s]);
    return found == setting->second.end() ? nullptr : &found->second;
  }

  double share(bool held, const std::string& family, const TriedCases& tried, size_t s) const {
    const BackendSummary* found = find(held, family, tried, s);
    return found ? share_of(*found) : not_known;
  }

  page::Text solved_cell(const std::string& family, const TriedCases& tried, size_t s) const {
    return page::quantity(100.0 * share(false, family, tried, s), "%");
  }
  page::Text ratio_cell(const std::string& family, const TriedCases& tried, size_t s) const {
    const BackendSummary* found = find(false, family, tried, s);
    return page::number(found ? found->mean_ratio : not_known);
  }

  static page::Values words_for(const TriedCases& tried) {
    return {{"tolerance", page::exact(tried.tolerance)}, {"start", name_of(tried.start)}};
  }

  page::Table order_table(size_t t) const {
    const TriedCases& tried = tried_[t];
    page::Table table = page::words_table("ranking.order-table", words_for(tried));
    table.is_number = {true, true, false, false, true, true, true, true, true};
    for (const size_t s : orders_[t]) {
      const Estimate& rank = ranks_[t][s];
      const BackendSummary *open = find(false, all_families, tried, s),
                           *held = find(true, all_families, tried, s);
      const page::Text none{"–", page::note};
      table.rows.push_back(
          {page::exact(rank.value),
           std::isnan(rank.low) ? none : page::exact(rank.low) + "–" + page::exact(rank.high),
           tried.solvers[s],
           open   ? open->law
           : held ? held->law
                  : "",
           solved_cell(all_families, tried, s),
           page::quantity(100.0 * share(true, all_families, tried, s), "%"),
           open ? page::quantity(1e3 * open->mean_seconds, "ms") : none,
           ratio_cell(all_families, tried, s), held ? page::number(held->mean_ratio) : none});
    }
    return table;
  }

  /// Backends by families.
  page::Table family_table(size_t t, const char* caption,
                           page::Text (Ranking::*cell)(const std::string&, const TriedCases&,
                                                       size_t) const) const {
    page::Table table{.caption = page::words(caption, words_for(tried_[t])),
                      .head = {"backend"},
                      .is_number = {false}};
    for (const std::string& family : families_) {
      table.head.push_back(family);
      table.is_number.push_back(true);
    }
    for (const size_t s : orders_[t]) {
      std::vector<page::Text>& line = table.rows.emplace_back();
      line.push_back(tried_[t].solvers[s]);
      for (const std::string& family : families_)
        line.push_back((this->*cell)(family, tried_[t], s));
    }
    return table;
  }

  /// The worst three families of each backend.
  page::Table failure_table(size_t t) const {
    page::Table table = page::words_table("ranking.failure-table", words_for(tried_[t]));
    table.is_number = {false, true, false, false};
    for (const size_t s : orders_[t]) {
      const BackendSummary* all = find(false, all_families, tried_[t], s);
      if (!all || all->unsolved == 0) continue;
      std::vector<std::tuple<double, std::string, const BackendSummary*>> worst;
      for (const std::string& family : families_)
        if (const BackendSummary* own = find(false, family, tried_[t], s); own && own->unsolved > 0)
          worst.emplace_back(share_of(*own), family, own);
      std::ranges::sort(worst);
      std::string where;
      for (size_t k = 0; k < std::min<size_t>(3, worst.size()); ++k) {
        const auto& [solved, family, own] = worst[k];
        add_to_list(where, printed("%s (%d of %d)", family.c_str(), own->unsolved,
                                   own->solved + own->unsolved));
      }
      table.rows.push_back(
          {tried_[t].solvers[s], page::exact(all->unsolved), verdicts_of(*all), where});
    }
    return table;
  }

  page::Table problems_table() const {
    page::Table table = page::words_table("ranking.problem-table");
    table.is_number = {false, true, true, true, true, true, true, true};
    for (const std::string& family : families_) {
      std::map<std::string, const CompareRow*> cases;
      std::set<std::string> held, solved;
      double tightest = HUGE_VAL;
      for (const CompareRow& row : rows_) tightest = std::min(tightest, row.tolerance);
      for (const CompareRow& row : rows_) {
        if (world_of(row) != family) continue;
        cases[row.case_name] = &row;
        if (!is_open(row)) held.insert(row.case_name);
        if (row.tolerance == tightest && row.verdict == Verdict::solved)
          solved.insert(row.case_name);
      }
      std::vector<double> contacts, ratios;
      for (const auto& [name, row] : cases) {
        contacts.push_back(row->facts.contacts);
        ratios.push_back(row->facts.mass_ratio);
      }
      const double all = static_cast<double>(cases.size());
      table.rows.push_back(
          {family, page::exact(all), page::exact(count(held)),
           page::exact(std::ranges::min(contacts)), page::exact(quantile(contacts, 0.5)),
           page::exact(std::ranges::max(contacts)), page::number(std::ranges::max(ratios), 2),
           page::quantity(100.0 * count(solved) / all, "%")});
    }
    return table;
  }

  /// The order of all open problems beside that of some of them, of the held ones, and of other
  /// settings.
  page::Table stability() const {
    page::Table table = page::words_table("ranking.stability-table");
    table.is_number = {false, false, true, true, true, false};
    const auto add = [&](const std::string& where, const std::string& what, const CaseGroup& all,
                         const CaseGroup& some) {
      if (some.members.empty()) return;
      std::set<std::string> runs;
      for (const Eigen::Index c : some.members)
        runs.insert(run_of(some.tried->cases[static_cast<size_t>(c)]->case_name));
      const std::vector<Estimate> ranks = ranks_of(some);
      const auto first = std::ranges::min_element(ranks, {}, &Estimate::value) - ranks.begin();
      const Estimate tau = agreement(all, some);
      page::Text value = page::number(tau.value, 2);
      if (!std::isnan(tau.low)) value += page::Text(" ") + page::interval(tau.low, tau.high);
      table.rows.push_back({where, what, page::exact(static_cast<double>(some.members.size())),
                            page::exact(count(runs)), value,
                            some.tried->solvers[static_cast<size_t>(first)]});
    };
    for (const TriedCases& tried : tried_) {
      const std::string where = printed("%g, %s", tried.tolerance, name_of(tried.start));
      const CaseGroup all = group_of(tried, is_open);
      const auto open_and = [&](const std::function<bool(const CompareRow&)>& has) {
        return group_of(tried, [&](const CompareRow& row) { return is_open(row) && has(row); });
      };
      add(where, "held problems", all, group_of(tried, [](const auto& r) { return !is_open(r); }));
      for (const TriedCases& other : tried_)
        if (setting_of(tried) < setting_of(other))
          add(where, printed("tolerance %g, %s start", other.tolerance, name_of(other.start)), all,
              group_of(other, is_open));
      for (const Kind& size : sizes) add(where, size.what, all, open_and(size.has));
      for (const std::string& family : families_)
        add(where, family, all, open_and([&](const auto& r) { return world_of(r) == family; }));
    }
    return table;
  }

  std::vector<CompareRow> rows_;
  std::set<std::string> families_;
  std::map<std::pair<bool, std::string>, Summaries> summaries_;  ///< by held or not, and family
  std::vector<TriedCases> tried_;
  std::vector<std::vector<Estimate>> ranks_;  ///< of tried_, open problems
  std::vector<std::vector<size_t>> orders_;   ///< backends of tried_, the first first
};

}  // namespace

void write_ranking(const fs::path& folder, std::span<const CompareRow> rows) {
  const RunData data = read_origin(folder);
  const Ranking ranking(rows);
  write_whole_file(folder / "table.csv", ranking.csv());
  write_with_origin(ranking.page(), data, folder / "index.html");
}

}  // namespace ballast
