// What the choices that the paper leaves open do: step, size convention, friction.

#include "experiments/paper/run_groups.hpp"

namespace ballast {
namespace {

/// Each has a table of its own, with the words sensitivity.<name>.
constexpr std::pair<Varied, const char*> questions[] = {{Varied::time_step, "step"},
                                                        {Varied::size, "size"},
                                                        {Varied::friction, "friction"},
                                                        {Varied::deposit, "deposit"},
                                                        {Varied::lid, "lid"}};

std::vector<page::Text> row_of(const VariedValue& value) {
  std::vector<page::Text> row{value.label, samples_of(value)};
  for (const ObservableColumn& column : observable_columns())
    row.push_back(words_of(value.mean(column.value), column.factor));
  row.push_back(page::number(prefactor_of(value).mean));
  row.push_back(page::number(value.mean(&Observation::error_mean).mean, 2));
  row.push_back(page::number(1e3 * value.mean(&Observation::seconds_per_step).mean));
  return row;
}

}  // namespace

PaperSection sensitivity_section(PaperData& data) {
  PaperSection section;
  for (const auto& [varied, name] : questions) {
    const std::vector<VariedValue> values = read_values(data, varied, section);
    if (values.empty()) continue;
    page::Table table = observable_table(std::string("sensitivity.") + name);
    page::Text found;
    for (const VariedValue& value : values) {
      table.rows.push_back(row_of(value));
      add_to_list(found, value.label + ": " +
                             page::number(1e3 * value.mean(&Observation::rise).mean) + " mm");
    }
    section.tables.push_back(table);
    if (values.size() > 1)
      section.report("sensitivity.claim", {{"what", plural_of(varied)}, {"found", found}});
  }
  return section;
}

}  // namespace ballast
