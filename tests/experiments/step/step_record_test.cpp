#include "experiments/step/step_record.hpp"

#include <set>
#include <string>

#include "tests/catch.hpp"

namespace ballast {
namespace {

TEST_CASE("every member of a step's record is one column of the table") {
  StepRecord record;
  CHECK(step_columns().size() * sizeof(double) == sizeof record);
  std::set<std::string> names;
  for (const StepColumn& column : step_columns()) {
    INFO(column.name);
    CHECK(names.insert(column.name).second);
    CHECK(record.*column.value == 0.0);  // no other column has this member
    record.*column.value = 1.0;
    CHECK(std::string(column.description).size() > 10);
  }
}

TEST_CASE("phases are the columns of seconds, and add up to the step") {
  StepRecord record;
  double sum = 0.0, each = 1.0;
  size_t phases = 0;
  for (const StepColumn& column : step_columns()) {
    INFO(column.name);
    const bool is_seconds = std::string(column.name).starts_with("seconds_");
    CHECK((column.phase != nullptr) == is_seconds);
    record.*column.value = 1e6;  // the other columns do not count
    if (!column.phase) continue;
    record.*column.value = each;
    sum += each;
    each *= 2.0;
    CHECK(&step_phases()[phases++] == &column);
    CHECK("seconds_" + column.phase_word() == column.name);
  }
  CHECK(phases == step_phases().size());
  CHECK(step_seconds(record) == sum);
}

TEST_CASE("a column is one value per step, in the unit that is asked") {
  std::vector<StepRecord> steps(3);
  steps[1].wall_x = 2e-3;
  steps[2].wall_x = -1e-3;
  CHECK(record_column(steps, &StepRecord::wall_x, 1e3) == std::vector<double>{0.0, 2.0, -1.0});
  CHECK(record_column({}, &StepRecord::wall_x).empty());
}

}  // namespace
}  // namespace ballast
