#include <algorithm>

#include "experiments/box/deposit.hpp"
#include "experiments/record/bits_generation.hpp"
#include "experiments/step/time_step.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/golden/golden_values.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast::golden {
namespace {

using Numbers = std::vector<double>;

/// vibrated_box_small with so few grains that all stages of it together take a second.
Scene small_scene() {
  const std::vector<std::string> overrides = {
      "grains.count=12",           "box.length=0.12",          "box.width=0.12",
      "deposit.lid_time=0.02",     "deposit.settle_time=0.02", "control_volume.margin_x=0.02",
      "solver.max_iterations=200", "correction.slop=0"};
  return read_scene(find_scene("vibrated_box_small"), overrides);
}

/// The columns of a record but wall clocks and the solid fraction, which the run's loop measures.
std::vector<StepColumn> physics_columns() {
  std::vector<StepColumn> columns;
  for (const StepColumn& column : step_columns())
    if (!column.phase && column.value != &StepRecord::solid_fraction) columns.push_back(column);
  return columns;
}

/// A table with a column for each of the record's; a cell is the digest of some steps of it,
/// and the row is called by the last of them.
class StepTable {
 public:
  StepTable(const char* name, size_t steps_per_row) : steps_per_row_(steps_per_row) {
    table_ = {name, Through::libm, "step", {}, {}};
    for (const StepColumn& column : columns_) table_.columns.push_back(column.name);
  }

  void add(const std::string& stage, const StepRecord& step) {
    if (!steps_.empty() && (stage != stage_ || steps_.size() == steps_per_row_)) end_row();
    stage_ = stage;
    ++count_;
    steps_.push_back(step);
  }
  Table take() {
    end_row();
    return table_;
  }

 private:
  void end_row() {
    constexpr int digits = 4;  // enough: what differs once differs from then on
    std::vector<std::string> cells;
    for (const StepColumn& column : columns_)
      cells.push_back(digest(record_column(steps_, column.value), digits));
    table_.rows.emplace_back(stage_ + "_" + std::to_string(count_), cells);
    steps_.clear();
  }

  const std::vector<StepColumn> columns_ = physics_columns();
  size_t steps_per_row_, count_ = 0;
  Table table_;
  std::string stage_;
  std::vector<StepRecord> steps_;
};

Table state_values(const char* name, const MechanicalSystem& system, const MotionState& state) {
  Table table{name, Through::libm, "body", {"position", "rotation", "velocity", "spin"}};
  for (size_t b = 0; b < state.pose.size(); ++b) {
    const auto vector = [](const auto& x) { return digest({x.data(), size_t(x.size())}); };
    std::string body = system.bodies[b].name;
    std::replace(body.begin(), body.end(), ' ', '_');
    table.rows.push_back({body,
                          {vector(state.pose[b].position), vector(state.pose[b].rotation.coeffs()),
                           vector(state.velocity[b]), vector(state.spin[b])}});
  }
  return table;
}

Table packing_values(const Packing& packing) {
  const DepositState& d = packing.deposit;
  Table table{"packing", Through::libm, "what", {"exact"}};
  table.rows = {{"lid", {exact(d.lid)}},
                {"top", {exact(d.top)}},
                {"rain_time", {exact(d.rain_time)}},
                {"rest_velocity", {exact(d.rest_velocity)}},
                {"contacts", {std::to_string(packing.memory.contacts.size())}}};
  return table;
}

/// All columns of one step, readable.
Table step_values(const char* name, const StepRecord& step) {
  Table table{name, Through::libm, "column", {"exact", "about"}};
  for (const StepColumn& column : physics_columns()) {
    const double value = step.*column.value;
    table.rows.push_back({column.name, {exact(value), printed("%.4g", value)}});
  }
  return table;
}

}  // namespace

std::vector<Table> box_values() {
  const Scene scene = small_scene();
  const Rain rain = make_rain(scene);
  const TemporaryFolder folder;

  StepTable deposit_steps("deposit", 100);
  const auto listen = [&](BoxStage stage, double, double, const StepRecord& step) {
    deposit_steps.add(name_of(stage), step);
    return true;
  };
  Packing packing;
  if (!deposit(scene, rain, folder.path() / "part", listen, packing)) return {};

  MotionState state;
  const MechanicalSystem system = drive_system(scene, rain, packing, state);
  std::vector<Table> tables = {deposit_steps.take(), packing_values(packing),
                               state_values("packing_bodies", system, state)};

  TimeStepper stepper(system, step_settings(scene), system.first_driven_wall());
  StepTable drive_steps("drive", 1);
  StepRecord step;
  for (int k = 0; k < 40; ++k) {
    step = stepper.step(state, packing.memory);
    drive_steps.add("drive", step);
  }
  tables.push_back(drive_steps.take());
  tables.push_back(step_values("drive_last_step", step));
  tables.push_back(state_values("drive_bodies", system, state));
  return tables;
}

File values_today() {
  File file{bits_generation, {libm_values(), grain_values()}};
  for (const std::vector<Table>& tables : {heap_values(), box_values()})
    file.tables.insert(file.tables.end(), tables.begin(), tables.end());
  return file;
}

}  // namespace ballast::golden
