#include "experiments/compare/comparison_site.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "experiments/compare/compare_figures.hpp"
#include "experiments/compare/compare_page.hpp"
#include "experiments/page/html.hpp"
#include "experiments/run/manifest.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

page::Text number_of(size_t count) { return page::exact(static_cast<double>(count)); }

std::string short_name(size_t machine) { return "M" + std::to_string(machine + 1); }

/// "machines/M1-AMD-EPYC-9B45-2-cores"
std::string folder_of(size_t machine, const std::string& name) {
  std::string plain = short_name(machine) + "-";
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      plain += c;
    else if (plain.back() != '-')
      plain += '-';
  while (plain.back() == '-') plain.pop_back();
  return "machines/" + plain;
}

/// A machine's rows as the comparison that it could have made in one go.
void write_machine(const fs::path& folder, const MachineRows& machine,
                   const StoredComparison& newest) {
  create_folder(folder / "rows");
  std::set<std::string> names;
  for (const CompareRow& row : machine.rows) {
    names.insert(row.key + ".json");
    write_whole_file(folder / "rows" / (row.key + ".json"), to_json(row));
  }
  // Rows of an earlier merge that count no more.
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "rows"))
    if (!names.contains(entry.path().filename().string())) fs::remove(entry.path());
  write_whole_file(folder / "results.csv", compare_csv(machine.rows));
  write_whole_file(folder / "manifest.json", read_whole_file(newest.folder / "manifest.json"));
  write_compare_page(folder, machine.rows, {});
}

void write_rows(const fs::path& file, std::span<const StoredComparison> comparisons) {
  CsvWriter csv;
  for (const char* name : {"machine", "program", "started"}) csv.add(name);
  for (const CompareColumn& column : compare_columns()) csv.add(column.name);
  csv.end_row();
  for (const StoredComparison& comparison : comparisons)
    for (const CompareRow& row : comparison.rows) {
      for (const std::string& text : {comparison.machine, comparison.program, comparison.started})
        csv.add(text);
      csv.add_row(cells_of(row));
    }
  write_whole_file(file, csv.take());
}

/// One row for each problem: of a machine that tried it.
std::map<std::string, const CompareRow*> problems_in(std::span<const MachineRows> machines) {
  std::map<std::string, const CompareRow*> problems;
  for (const MachineRows& machine : machines)
    for (const CompareRow& row : machine.rows) problems.try_emplace(row.case_name, &row);
  return problems;
}

page::Table machines_table(std::span<const MachineRows> machines,
                           std::span<const StoredComparison> comparisons) {
  page::Table table;
  table.head = {"machine", "processor", "programs", "days", "solves", "its page"};
  table.is_number = {false, false, false, false, true, false};
  for (size_t m = 0; m < machines.size(); ++m) {
    std::set<std::string> programs, days;
    for (const size_t k : machines[m].sources) {
      programs.insert(comparisons[k].program.substr(0, 12));
      days.insert(comparisons[k].started.substr(0, 10));
    }
    table.rows.push_back(
        {short_name(m), machines[m].machine, joined(programs), joined(days),
         number_of(machines[m].rows.size()),
         page::Text("compare.html", 0, folder_of(m, machines[m].machine) + "/compare.html")});
  }
  return table;
}

page::Table problems_table(const std::map<std::string, const CompareRow*>& problems) {
  page::Table table;
  table.head = {"problem", "family", "contacts", "rank deficiency", "mass ratio", "content"};
  table.is_number = {false, false, true, true, true, false};
  for (const auto& [name, row] : problems)
    table.rows.push_back({name, row->family, page::exact(row->facts.contacts),
                          page::number(row->facts.rank_deficiency, 2),
                          page::number(row->facts.mass_ratio, 2),
                          page::Text(row->facts.content, page::code)});
  return table;
}

page::Page index_page(std::span<const MachineRows> machines,
                      std::span<const StoredComparison> comparisons,
                      std::span<const CompareRow> pooled,
                      const std::map<std::string, const CompareRow*>& problems) {
  page::Page page{.title = "Solvers of frictional contact, on several machines"};
  page.lede = {page::words("site.lede", {{"machines", number_of(machines.size())},
                                         {"comparisons", number_of(comparisons.size())},
                                         {"problems", number_of(problems.size())},
                                         {"solves", number_of(pooled.size())},
                                         {"measure", name_of(pooled.front().measure)}})};
  page.add({"machines", "Machines", {machines_table(machines, comparisons)}});
  page::Section backends{"backends", "The backends"}, profiles{"profiles", "Profiles"};
  backends.add(
      page::words("site.backends", {{"shift", page::quantity(1e3 * summary_shift, "ms", 1)},
                                    {"limit", page::quantity(limit_of(pooled), "s")}}));
  profiles.add(page::words("site.profiles"));
  for (const CompareTable& table : compare_tables(pooled)) {
    backends.add(page::Subheading{table.heading()});
    backends.add(backends_table(table, limit_of(pooled), true));
    const CompareTable common = tried_by_all(table);
    profiles.add(page::words("site.common", {{"table", table.heading()},
                                             {"common", number_of(common.cases.size())},
                                             {"all", number_of(table.cases.size())}}));
    // The first alone: a time per contact means one machine's.
    std::vector<page::Picture> figures = profile_figures(common);
    if (!figures.empty()) profiles.add(std::move(figures.front()));
  }
  page.add(backends);
  page.add(profiles);
  page.add({"problems", "The problems", {page::words("site.problems"), problems_table(problems)}});
  if (page::can_answer()) page.answers = {.are_given = true, .with_curves = true};
  return page;
}

}  // namespace

void write_comparison_site(const fs::path& folder, std::span<const StoredComparison> comparisons,
                           const std::string& command) {
  const std::vector<MachineRows> machines = merged_machines(comparisons);
  const std::vector<CompareRow> pooled = pooled_rows(machines);
  const auto problems = problems_in(machines);
  Manifest manifest("compare merge", {command}, "");
  create_folder(folder);
  for (size_t m = 0; m < machines.size(); ++m)
    write_machine(folder / folder_of(m, machines[m].machine), machines[m],
                  comparisons[machines[m].sources.back()]);
  write_rows(folder / "rows.csv", comparisons);
  manifest.summary("comparisons", static_cast<double>(comparisons.size()));
  manifest.summary("machines", static_cast<double>(machines.size()));
  manifest.write(folder / "manifest.json");
  write_with_origin(index_page(machines, comparisons, pooled, problems), read_origin(folder),
                    folder / "index.html");
}

}  // namespace ballast
