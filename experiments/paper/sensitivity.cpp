// What the choices that the paper leaves open do: step, size convention, friction.

#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

page::Table table_of(const std::vector<VariedValue>& values, const char* caption,
                     const char* first) {
  page::Table table{caption, {first, "samples"}, {}};
  for (const ObservableColumn& column : observable_columns())
    table.head.push_back(std::string(column.name) + " (" + column.unit + ")");
  table.head.insert(table.head.end(), {"C of Eq. 3", "error (g·h)", "ms a step (median)"});
  for (const VariedValue& value : values) {
    table.rows.push_back({value.label, std::to_string(value.samples.size())});
    for (const ObservableColumn& column : observable_columns()) {
      const SampleMean mean = value.mean(column.value);
      table.rows.back().push_back(
          page::with_error(column.factor * mean.mean, column.factor * mean.error));
    }
    table.rows.back().push_back(page::number(prefactor_of(value).mean));
    table.rows.back().push_back(page::number(value.mean(&Observation::error_mean).mean, 2));
    table.rows.back().push_back(
        page::number(1e3 * value.mean(&Observation::seconds_per_step).mean));
  }
  return table;
}

struct Question {
  Varied varied;
  const char* what;
  const char* caption;
  const char* first;
};
constexpr Question questions[] = {
    {Varied::time_step, "steps", "Step h, sample 1 at 10 Hz (the iterations a step stay the same)",
     "h"},
    {Varied::size, "size conventions",
     "Size convention at 10 Hz: the paper’s “diameter” read as barycentre–vertex distance, or "
     "twice it; box and grains "
     "at half scale, the lid’s gap of 1 cm as it is or halved",
     "size"},
    {Varied::friction, "frictions", "Friction between grains, floor and lid, sample 1 at 10 Hz",
     "μ"},
    {Varied::deposit, "deposits",
     "Deposit (lid pressed or only placed, friction while depositing), sample 1 at 10 Hz; driven "
     "with μ = 0.4",
     "deposit"},
    {Varied::lid, "gaps under the lid",
     "Gap by which the lid is raised (paper: 1 cm), sample 1 at 10 Hz", "gap"}};

}  // namespace

PaperSection sensitivity_section(PaperData& data) {
  PaperSection section;
  for (const Question& question : questions) {
    note_missing(data, question.varied, question.what, section);
    const std::vector<VariedValue> values = data.values(question.varied);
    if (values.empty()) continue;
    section.tables.push_back(table_of(values, question.caption, question.first));
    if (values.size() < 2) continue;
    page::Text found;
    for (const VariedValue& value : values)
      found += (found.empty() ? "" : "; ") + value.label + ": " +
               page::number(1e3 * value.mean(&Observation::rise).mean) + " mm";
    section.rows.push_back({"beyond", "–", std::string("Δx_max by ") + question.what + ": " + found,
                            Agreement::reported});
  }
  return section;
}

}  // namespace ballast
