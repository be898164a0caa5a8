#include "experiments/bench/captured_bench.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/measure/curve_fit.hpp"
#include "experiments/measure/exact_answer.hpp"
#include "experiments/measure/jam_stiffness.hpp"
#include "platform/csv.hpp"
#include "platform/text.hpp"
#include "platform/worker_team.hpp"
#include "solvers/seam/run_solver.hpp"

namespace ballast {
namespace {

/// What may be drawn over the cost; NaN: not known of this row.
struct RowMeasure {
  const char *name, *unit, *label;
  double (*of)(const CapturedRow&);
};
const RowMeasure row_measures[] = {
    {"error rms", "g h", "error [g h]", [](const CapturedRow& r) { return r.error; }},
    {"distance of velocities", "g h", "bodies off [g h]",
     [](const CapturedRow& r) { return r.distance.velocity; }},
    {"distance of contact velocities", "g h", "contacts off [g h]",
     [](const CapturedRow& r) { return r.distance.contact_velocity; }},
    {"distance of body impulses", "1", "impulses off [1]",
     [](const CapturedRow& r) { return r.distance.body_impulse; }},
    {"distance of the wall's force", "1", "wall force off [1]",
     [](const CapturedRow& r) { return r.distance.wall_force; }},
    {"wrong statuses", "1", "statuses off [1]",
     [](const CapturedRow& r) {
       return r.distance.statuses < 0 ? std::nan("") : 1.0 * r.distance.statuses / r.contacts;
     }},
    {"k_art", "N/m", "k_{art} [N/m]", [](const CapturedRow& r) { return r.k_art; }},
};

std::vector<double> values_of(const std::vector<const CapturedRow*>& rows, const RowMeasure& m) {
  std::vector<double> values;
  for (const CapturedRow* row : rows)
    if (const double value = m.of(*row); std::isfinite(value)) values.push_back(value);
  return values;
}

/// One solver from one start to one tolerance, on all problems.
struct SolveGroup {
  std::string solver;
  StartKind start;
  double tolerance;
  std::vector<const CapturedRow*> rows = {};
};

std::vector<SolveGroup> grouped(const CapturedOptions& options,
                                const std::vector<CapturedRow>& rows) {
  std::vector<SolveGroup> groups;
  for (const ComparedSolver& solver : options.solvers)
    for (const StartKind start : options.starts)
      for (const double tolerance : options.tolerances) {
        SolveGroup group{solver.name, start, tolerance};
        for (const CapturedRow& row : rows)
          if (row.solver == solver.name && row.start == start && row.tolerance == tolerance)
            group.rows.push_back(&row);
        if (!group.rows.empty()) groups.push_back(std::move(group));
      }
  return groups;
}

/// One problem of the bench: its tolerances from loose to tight under one solver and start.
class CapturedSolves {
 public:
  CapturedSolves(const CompareCase& tried, const LoadedCase& loaded, const CapturedOptions& options)
      : loaded_(loaded), options_(options) {
    blank_.problem = tried.name;
    blank_.phase = loaded.phase;
    blank_.contacts = loaded.problem.contact_count();
    blank_.k_art = std::nan("");
  }

  CapturedRow row(const ComparedSolver& solver, StartKind start, double tolerance) const {
    CapturedRow row = blank_;
    row.solver = solver.name;
    row.start = start;
    row.tolerance = tolerance;
    const std::unique_ptr<Solver> method = solver.make();
    WorkerTeam team;
    team.resize(options_.threads);
    method->use_team(&team);
    const double scale = loaded_.facts.velocity_scale;
    const Budget budget{.tolerance = tolerance * scale,
                        .max_iterations = 1 << 30,
                        .max_seconds = options_.max_seconds};
    const SolverRun run =
        SolverRunner().run(*method, loaded_.problem,
                           start == StartKind::warm ? loaded_.warm_start : Impulses(), budget);
    row.solved = run.is_solved();
    row.iterations = run.solved.iterations;
    row.seconds = run.processor_seconds;
    row.error = run.error.natural_map_rms / scale;
    const Impulses& answer = run.solved.impulses;
    row.distance = answer_distance(loaded_.problem, answer, loaded_.exact, scale);
    // What a next step would do to a jam, with as many iterations as this one.
    if (loaded_.phase == "jammed" && loaded_.h > 0.0 && row.solved) {
      const Budget again{.tolerance = 0.0,
                         .max_iterations = std::max(1, row.iterations),
                         .max_seconds = options_.max_seconds};
      row.k_art = jam_stiffness(*method, loaded_.problem, answer, again, loaded_.h);
    }
    return row;
  }

  /// Not tried: a looser tolerance was missed already.
  static CapturedRow missed(CapturedRow looser, double tolerance) {
    looser.tolerance = tolerance;
    return looser;
  }

 private:
  const LoadedCase& loaded_;
  const CapturedOptions& options_;
  CapturedRow blank_;
};

}  // namespace

std::vector<CapturedRow> measure_captured(const std::vector<CompareCase>& cases,
                                          const CapturedOptions& options,
                                          const std::function<bool(const CapturedRow&)>& said) {
  std::vector<CapturedRow> rows;
  for (const CompareCase& tried : cases) {
    LoadedCase loaded = tried.load();
    const ExactSearch search{loaded.facts.velocity_scale, options.exact_seconds,
                             options.folder / "exact", loaded.facts.content};
    if (auto exact = find_exact_answer(loaded.problem, loaded.warm_start, search))
      loaded.exact = std::move(exact->impulses);
    const CapturedSolves solves(tried, loaded, options);
    for (const ComparedSolver& solver : options.solvers)
      for (const StartKind start : options.starts) {
        if (start == StartKind::warm && loaded.warm_start.size() == 0) continue;
        bool missed = false;
        for (const double tolerance : options.tolerances) {
          rows.push_back(missed ? CapturedSolves::missed(rows.back(), tolerance)
                                : solves.row(solver, start, tolerance));
          missed = !rows.back().solved;
          if (!said(rows.back())) return rows;
        }
      }
  }
  return rows;
}

std::vector<Measurement> captured_measurements(const CapturedOptions& options,
                                               const std::vector<CapturedRow>& rows) {
  std::vector<Measurement> result;
  for (const SolveGroup& group : grouped(options, rows)) {
    const std::string name =
        printed("%s, %s, %g", group.solver.c_str(), name_of(group.start), group.tolerance);
    std::vector<double> cost;
    for (const CapturedRow* row : group.rows)
      if (row->solved) cost.push_back(row->seconds);
    const auto add = [&](const std::string& what, const char* unit, std::vector<double> values) {
      if (!values.empty()) result.push_back(measurement_of(name, what, unit, std::move(values)));
    };
    add("solved", "problems", {static_cast<double>(cost.size())});
    for (const double seconds : options.within)
      add(printed("solved within %g s", seconds), "problems",
          {static_cast<double>(
              std::count_if(cost.begin(), cost.end(), [&](double s) { return s <= seconds; }))});
    add("cost", "s", cost);
    for (const RowMeasure& m : row_measures) add(m.name, m.unit, values_of(group.rows, m));
  }
  return result;
}

std::string captured_csv(const std::vector<CapturedRow>& rows) {
  CsvWriter csv;
  for (const char* name : {"problem", "phase", "solver", "start", "tolerance", "solved", "contacts",
                           "iterations", "seconds"})
    csv.add(name);
  for (const RowMeasure& m : row_measures) csv.add(std::string(m.name) + " [" + m.unit + "]");
  csv.end_row();
  for (const CapturedRow& row : rows) {
    for (const std::string& text : {row.problem, row.phase, row.solver}) csv.add(text);
    csv.add(name_of(row.start));
    csv.add(row.tolerance, 6);
    for (const int count : {int{row.solved}, row.contacts, row.iterations})
      csv.add(static_cast<long>(count));
    csv.add(row.seconds, 6);
    for (const RowMeasure& m : row_measures) csv.add(m.of(row), 6);
    csv.end_row();
  }
  return csv.take();
}

Figure captured_figure(const CapturedOptions& options, const std::vector<CapturedRow>& rows) {
  const Ink inks[] = {Ink::blue,   Ink::vermilion, Ink::green, Ink::orange,
                      Ink::purple, Ink::sky,       Ink::black};
  Figure figure;
  figure.name = "captured";
  figure.title = "Every measure of an answer's error against its cost";
  const std::vector<SolveGroup> groups = grouped(options, rows);
  for (const RowMeasure& m : row_measures) {
    Panel panel;
    panel.x_label = "cost of a solve, median over problems [s]";
    panel.y_label = m.label;
    panel.log_x = panel.log_y = true;
    for (size_t k = 0; k < options.solvers.size(); ++k)
      for (const StartKind start : options.starts) {
        Curve line;
        for (const SolveGroup& group : groups) {
          if (group.solver != options.solvers[k].name || group.start != start) continue;
          // What is not solved costs more than any that is: half of all must be.
          std::vector<double> cost;
          for (const CapturedRow* row : group.rows)
            cost.push_back(row->solved ? row->seconds : HUGE_VAL);
          const std::vector<double> values = values_of(group.rows, m);
          const double x = quantile(cost, 0.5), y = values.empty() ? 0.0 : quantile(values, 0.5);
          if (!std::isfinite(x) || !(y > 0.0)) continue;
          line.x.push_back(x);
          line.y.push_back(y);
        }
        if (line.x.empty()) continue;
        line.ink = inks[k % std::size(inks)];
        line.dashed = start == StartKind::cold;
        Curve marks = line;
        marks.mark = Mark::points;
        if (figure.panels.empty())
          line.title = plain_text(options.solvers[k].name + ", " + name_of(start));
        panel.curves.push_back(std::move(line));
        panel.curves.push_back(std::move(marks));
      }
    if (!panel.curves.empty()) figure.panels.push_back(std::move(panel));
  }
  figure.height = 60 + 170 * static_cast<int>(figure.panels.size());
  return figure;
}

}  // namespace ballast
