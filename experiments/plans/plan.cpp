#include "experiments/plans/plan.hpp"

#include <functional>
#include <set>

#include <fnmatch.h>

#include "experiments/box/vibrated_box.hpp"
#include "experiments/run/run.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {

namespace fs = std::filesystem;

PlannedRun planned_run(const std::string& name, const std::string& text,
                       const std::vector<std::string>& overrides) {
  const ResolvedScene resolved = resolve_run(text, overrides);
  const Scene& scene = resolved.scene;
  PlannedRun run{name, text, overrides, resolved.key, {}, scene.step_count()};
  const double bodies = scene.grains ? scene.grains->count : std::ssize(scene.bodies);
  run.work = bodies * run.steps;
  if (!scene.grains) return run;
  run.packing = packing_key(scene);
  const DepositSpec& deposit = scene.deposit;
  // the rain rests long before its time is up
  const double rain_time = deposit.max_time / 3.0;
  run.packing_work = bodies * ((rain_time + deposit.lid_time) / deposit.step +
                               deposit.settle_time / deposit.settle_step);
  return run;
}

std::vector<PlannedRun> select(const Plan& plan, const std::string& pattern) {
  std::vector<PlannedRun> runs;
  for (const PlannedRun& run : plan.runs)
    if (pattern.empty() || fnmatch(pattern.c_str(), run.name.c_str(), 0) == 0) runs.push_back(run);
  if (runs.empty()) throw Error("plan " + plan.name + ": no run is named like " + pattern);
  return runs;
}

// A plan's file has single runs, and grids, which are all combinations of lists of values. See
// docs/manual/plans.md.

namespace {

// Limits of a plan: every run is resolved when the plan is read.
constexpr size_t most_runs = 10'000;
constexpr size_t most_text = 32 << 20;  // bytes of all names and overrides

/// Reads the scene and overrides of a plan, run or grid; the inner one adds to the outer `base`.
PlannedRun read_base(TomlTable& table, const fs::path& file, PlannedRun base) {
  // the path of a scene's file is relative to the plan's; the name of a scene stays a name
  const fs::path scene = table.text("scene", "");
  const bool is_path = scene.has_parent_path() || scene.extension() == ".toml";
  if (!scene.empty())
    base.scene = (is_path ? (file.parent_path() / scene).lexically_normal() : scene).string();
  for (std::string& text : table.texts("set")) base.overrides.push_back(std::move(text));
  return base;
}

/// One key with its values, each as the text of an override.
struct Axis {
  std::string key;
  std::vector<std::string> values;
};

/// "drive.frequency" = [...] and drive.frequency = [...] mean the same.
void collect_axes(const toml::table& table, const std::string& prefix, std::vector<Axis>& axes) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table()) {
      collect_axes(*inner, name + '.', axes);
      continue;
    }
    Axis& axis = axes.emplace_back(Axis{name, {}});
    if (const toml::array* array = node.as_array())
      for (const toml::node& value : *array) axis.values.push_back(toml_value_text(value));
    else
      axis.values.push_back(toml_value_text(node));
  }
}

/// The axes of a sub-table, which may be missing. Its keys are those of the scene.
std::vector<Axis> read_axes(TomlTable& table, const char* key) {
  std::vector<Axis> axes;
  collect_axes(table.section(key).as_it_stands(), "", axes);
  for (auto axis = axes.begin(); axis != axes.end(); ++axis) {
    if (axis->values.empty()) table.fail(key, axis->key + " has no values");
    if (std::any_of(axes.begin(), axis, [&](const Axis& a) { return a.key == axis->key; }))
      table.fail(key, axis->key + " is there twice");
  }
  return axes;
}

/// Returns whether `value` is among `values`; 1 and 1.0 are the same value.
bool contains(const std::vector<std::string>& values, const std::string& value) {
  const auto number = parsed_number(value);
  return std::ranges::any_of(values, [&](const std::string& other) {
    const auto its = parsed_number(other);
    return number && its ? *number == *its : value == other;
  });
}

/// Overrides for the members of a grid whose values are among those of `when`.
struct Where {
  std::vector<Axis> when;
  std::vector<std::string> set;
};

struct Grid {
  PlannedRun base;
  std::vector<Axis> axes;
  std::vector<Where> where;
};

Where read_where(TomlTable& table, const std::vector<Axis>& axes) {
  Where where{read_axes(table, "when"), table.texts("set")};
  if (where.when.empty())
    table.fail("when", "no condition, expected when = { \"a varied key\" = its values }");
  // A condition that no member can meet is a mistake.
  for (const Axis& condition : where.when) {
    const auto axis = std::ranges::find(axes, condition.key, &Axis::key);
    if (axis == axes.end()) table.fail("when", condition.key + " is not varied here");
    for (const std::string& value : condition.values)
      if (!contains(axis->values, value)) table.fail("when", condition.key + " never is " + value);
  }
  table.finish();
  return where;
}

/// Reads a grid: its axes, and the further overrides of some of its members.
Grid read_grid(TomlTable& table, const fs::path& file, const PlannedRun& base) {
  Grid grid;
  const std::string name = table.text("name");
  grid.base = read_base(table, file, base);
  grid.base.name = name;
  grid.axes = read_axes(table, "vary");
  if (grid.axes.empty())
    table.fail("vary", "nothing varied, expected vary.\"dotted.key\" = [values]");
  for (TomlTable& condition : table.sections("where"))
    grid.where.push_back(read_where(condition, grid.axes));
  table.finish();
  return grid;
}

/// The run at chosen[a] of each axis a. The overrides of `where` come last and replace others.
PlannedRun member(const Grid& grid, const std::vector<size_t>& chosen) {
  PlannedRun run = grid.base;
  const auto value_of = [&](const std::string& key) {
    const auto a = std::ranges::find(grid.axes, key, &Axis::key) - grid.axes.begin();
    return grid.axes[a].values[chosen[a]];
  };
  for (const Axis& axis : grid.axes) {
    std::string value = value_of(axis.key);
    run.overrides.push_back(axis.key + '=' + value);
    std::erase(value, '"');
    run.name += '-' + axis.key + '=' + made_plain(value, ".-");
  }
  for (const Where& where : grid.where) {
    const bool holds = std::ranges::all_of(where.when, [&](const Axis& condition) {
      return contains(condition.values, value_of(condition.key));
    });
    if (holds) run.overrides.insert(run.overrides.end(), where.set.begin(), where.set.end());
  }
  return run;
}

/// Adds all members; the last key changes fastest.
void expand(const Grid& grid, const std::function<void(PlannedRun)>& add) {
  std::vector<size_t> chosen(grid.axes.size(), 0);
  for (;;) {
    add(member(grid, chosen));
    size_t a = chosen.size();
    while (a > 0 && ++chosen[a - 1] == grid.axes[a - 1].values.size()) chosen[--a] = 0;
    if (a == 0) return;
  }
}

/// Checks that names are valid and each stands once, and reads the scene of every run.
void validate(Plan& plan, const std::string& origin) {
  const auto check_name = [&](const std::string& what, const std::string& name) {
    if (!is_plain(name, "_-.=") || name[0] == '.' || name[0] == '-')
      throw Error(origin + ": " + what + " = \"" + name +
                  "\": expected letters, digits, _, -, . and =");
  };
  check_name("name", plan.name);
  std::set<std::string> names;
  for (PlannedRun& run : plan.runs) {
    check_name("run.name", run.name);
    if (!names.insert(run.name).second)
      throw Error(origin + ": run.name = \"" + run.name +
                  "\": stands twice, expected another name for each run");
    try {
      run = planned_run(run.name, run.scene, run.overrides);
    } catch (const Error& error) {
      throw Error(origin + ": run " + run.name + ": " + error.what());
    }
  }
}

}  // namespace

Plan read_plan(const fs::path& file) { return plan_of(read_whole_file(file), file); }

Plan plan_of(const std::string& toml, const fs::path& file) {
  const toml::table raw = parse_toml(toml, file);
  toml::table resolved;
  TomlTable root(file.string(), raw, resolved);
  Plan plan;
  plan.name = root.text("name", file.stem().string());
  const PlannedRun base = read_base(root, file, {});
  std::vector<TomlTable> runs = root.sections("run");
  std::vector<TomlTable> grids = root.sections("grid");
  root.finish();
  // Limits the number and size of the runs before any of them is resolved.
  size_t text = 0;
  const auto add = [&](PlannedRun run) {
    text += run.name.size() + run.scene.size();
    for (const std::string& set : run.overrides) text += set.size();
    if (text > most_text || plan.runs.size() == most_runs)
      throw Error(file.string() + ": more than " +
                  (text > most_text ? std::to_string(most_text >> 20) + " MB of names and overrides"
                                    : std::to_string(most_runs) + " runs") +
                  ": expected several smaller plans");
    plan.runs.push_back(std::move(run));
  };
  for (TomlTable& table : runs) {
    const std::string name = table.text("name");
    PlannedRun run = read_base(table, file, base);
    if (run.scene.empty()) table.text("scene");  // throws Error: it is missing
    table.finish();
    run.name = name;
    add(std::move(run));
  }
  for (TomlTable& table : grids) {
    const Grid grid = read_grid(table, file, base);
    if (grid.base.scene.empty()) table.text("scene");
    expand(grid, add);
  }
  if (plan.runs.empty())
    throw Error(file.string() + ": no runs in it, expected [[run]] or [[grid]]");
  validate(plan, file.string());
  return plan;
}

}  // namespace ballast
