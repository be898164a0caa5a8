#include "experiments/report_tables.hpp"

#include <cmath>

namespace ballast {
namespace {

/// quantity | this run | bound or paper | verdict
class Results {
 public:
  void group(const char* name) { table_.rows.push_back({Html{std::string("<b>") + name + "</b>"}, {}, {}, {}}); }
  void bounded(const char* what, double value, double bound, const char* unit = "", double factor = 1.0) {
    row(what, *unit ? quantity(factor * value, unit) : number(value), Html{"≤&nbsp;"} + exact(factor * bound) + Html{*unit ? "&#8239;" : ""} + Html{unit}, verdict(value, bound));
  }
  void compared(const char* what, Html value, Html paper) { row(what, std::move(value), std::move(paper), {"<span class=\"note\">paper</span>"}); }
  void plain(const char* what, Html value, Html remark = {}) { row(what, std::move(value), {}, std::move(remark)); }

  Html html() {
    table_.head = {{""}, {"this run"}, {"asked, or paper"}, {""}};
    table_.is_number = {false, true, true, false};
    return to_html(table_);
  }

 private:
  void row(const char* what, Html value, Html bound, Html mark) {
    table_.rows.push_back({Html{what}, std::move(value), std::move(bound), std::move(mark)});
  }
  HtmlTable table_;
};

Html range_of(const Statistics& values, double factor, const char* unit) {
  if (values.samples < 2) return quantity(factor * values.mean, unit);
  return quantity(factor * values.mean, unit) + Html{" <span class=\"note\">("} + number(factor * values.min) + Html{" … "} +
         number(factor * values.max) + Html{")</span>"};
}

void add_accuracy(const RunSummary& summary, Results& results) {
  results.group("Contact law");
  if (std::isfinite(summary.facts.velocity_scale)) {
    results.bounded("error, rms over contacts, over <i>gh</i>: mean of the steps", summary.error_mean_relative, target::error_mean);
    results.bounded("the same: worst step", summary.error_max_relative, target::error_max);
    results.plain("worst contact of all steps, over <i>gh</i>", number(summary.error_worst_contact));
    results.plain("steps with an error above 10<sup>−3</sup> <i>gh</i>", quantity(100.0 * summary.above_target, "%"));
  } else {
    results.plain("error, rms over contacts: mean of the steps", quantity(summary.error_rms.mean, "m/s"));
    results.plain("the same: worst step", quantity(summary.error_rms.max, "m/s"));
  }
  results.group("Overlap");
  results.bounded("deepest of all steps", summary.penetration_max, target::penetration_max, "µm", 1e6);
  results.bounded("mean over active contact points and steps", summary.penetration_mean, target::penetration_mean, "µm", 1e6);
  results.group("Energy");
  results.plain("|Δ<i>K</i> − works + dissipation| over absolute work", number(summary.energy.relative));
}

void add_wall(const RunSummary& summary, Results& results) {
  const JammedState& jammed = summary.jammed;
  results.group("Jammed state (<i>f</i> above its mean)");
  results.bounded("|<i>f</i><sub>g</sub> − <i>f</i>|/<i>f</i><sub>max</sub>, mean of the steps", jammed.force_mean, target::jammed_force);
  results.plain("the same: 95&#8239;% of the steps below, worst step",
                number(jammed.force_p95) + Html{", "} + number(jammed.force_max));
  results.plain("|<i>v</i>|: mean, largest", quantity(1e3 * jammed.speed_mean, "mm/s") + Html{", "} + quantity(1e3 * jammed.speed_max, "mm/s"),
                Html{"<span class=\"note\">moving phases: up to "} + quantity(1e3 * summary.wall.v_peak, "mm/s") + Html{"</span>"});
  results.plain("jammed stretch found in", exact(summary.wall.jammed_periods) + Html{" of "} +
                                               exact(static_cast<double>(summary.wall.periods.size())) + Html{" periods"});
  results.group("Motion of the wall");
  results.plain("first contraction", quantity(1e3 * summary.contraction.size, "mm"));
  results.compared("90&#8239;% of it reached at", quantity(summary.contraction.time90, "s"), Html{"~&nbsp;0.2&#8239;s"});
  results.plain("Δ<i>x</i><sub>max</sub> per period: mean (least … largest)", range_of(summary.rise, 1e3, "mm"));
  results.plain("contraction per period", range_of({-summary.net.mean, -summary.net.max, -summary.net.min, summary.net.samples}, 1e3, "mm"));
  results.plain("<i>v</i><sub>max</sub> inwards", range_of(summary.speed_in, 1e3, "mm/s"));
  results.compared("<i>C</i> of Eq. 3, <i>m</i> the mass of all grains", number(summary.prefactor),
                   Html{"~&nbsp;"} + number(paper::prefactor, 1));
  results.plain("exponential fit, active: <i>R</i>², length", number(summary.loop.active.r2) + Html{", "} +
                                                                  quantity(1e3 / summary.loop.active.rate, "mm"));
  results.plain("linear fit, passive: <i>R</i>², slope",
                number(summary.loop.passive.r2) + Html{", "} + quantity(1e-3 * summary.loop.passive.slope, "N/mm"));
}

void add_compaction(const RunSummary& summary, Results& results) {
  const Compaction& compaction = summary.compaction;
  results.group("Solid fraction");
  results.compared("before the drive", number(compaction.initial, 4), number(paper::solid_fraction_initial, 2));
  results.compared("&rho;<sub>0</sub>, at 0.2&#8239;s", number(compaction.reference, 4), number(paper::solid_fraction_reference, 2));
  results.plain("at the end", number(compaction.last, 4));
  results.compared("gain per period over &rho;<sub>0</sub>", number(compaction.relative_gain),
                   Html{"~&nbsp;"} + number(paper::gain_per_period, 2));
  results.plain("compaction rate (Eq. 4)", quantity(compaction.rate, "1/s"));
}

/// "rest_velocity_m_s" is "rest velocity" in m/s.
struct NamedUnit {
  const char *suffix, *unit;
};
constexpr NamedUnit named_units[] = {{"_m_s2", "m/s²"}, {"_kg_m3", "kg/m³"}, {"_m_s", "m/s"}, {"_kg", "kg"}, {"_Hz", "Hz"}, {"_MB", "MB"},
                                     {"_GB", "GB"},     {"_N", "N"},         {"_J", "J"},     {"_s", "s"},   {"_m", "m"}};

/// Lists and objects on one line, without JSON's quotes and braces.
std::string readable(const nlohmann::ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_structured()) return value.dump();
  std::string text;
  for (const auto& [name, part] : value.items())
    text += (text.empty() ? "" : ", ") + (value.is_object() ? name + ' ' : std::string()) + readable(part);
  return text;
}

Html summary_row_value(const nlohmann::ordered_json& value, const char* unit) {
  if (value.is_number_integer()) return escaped(value.dump());
  if (value.is_number()) return exact(value.get<double>(), 6) + Html{*unit ? "&#8239;" : ""} + Html{unit};
  if (value.is_null()) return number(not_known);
  return escaped(readable(value));
}

std::string text_at(const nlohmann::ordered_json& json, const char* group, const char* name) {
  const auto part = json.find(group);
  if (part == json.end() || !part->is_object()) return {};
  const auto value = part->find(name);
  if (value == part->end() || value->is_null()) return {};
  return readable(*value);
}

HtmlTable facts_table() {
  HtmlTable table;
  table.css_class = "facts";
  return table;
}

/// A setting with its unit, as it was given.
Html setting(double value, const char* unit) { return exact(value) + Html{"&#8239;"} + Html{unit}; }

void add_scene(const Scene& scene, HtmlTable& table) {
  const auto row = [&](const char* what, Html value) { table.rows.push_back({Html{what}, std::move(value)}); };
  row("step <i>h</i>, duration", setting(scene.step, "s") + Html{", "} + setting(scene.duration, "s"));
  row("gravity", setting(scene.gravity.norm(), "m/s²"));
  row("friction, restitution between bodies", exact(scene.friction) + Html{", "} + exact(scene.restitution));
  row("solver", escaped(scene.solver.name) + Html{", tolerance "} + exact(scene.solver.tolerance) +
                    Html{scene.gravity.isZero() ? " m/s" : " <i>gh</i>"} + Html{", at most "} +
                    exact(scene.solver.max_iterations) + Html{scene.solver.warm_start ? " iterations, warm start" : " iterations, cold start"});
  row("overlap correction", scene.correction.enabled
                                ? setting(100.0 * scene.correction.fraction, "%") + Html{" of what exceeds "} +
                                      setting(1e6 * scene.correction.slop, "µm") + Html{" per step, "} +
                                      exact(scene.correction.sweeps) + Html{" sweeps"}
                                : Html{"off"});
  if (!scene.grains) return;
  const DriveSpec& drive = scene.drive;
  row("drive", setting(drive.frequency, "Hz") + Html{", <i>f</i><sub>max</sub> = "} + exact(drive.f_max_over_weight) +
                   Html{" <i>mg</i>, <i>f</i><sub>min</sub> = "} + exact(drive.f_min_over_weight) + Html{" <i>mg</i>, wall "} +
                   exact(drive.wall_mass_over_grains) + Html{" <i>m</i>, lid raised "} + setting(1e3 * drive.lid_raise, "mm"));
  row("grains", exact(scene.grains->count, 6) + Html{", seed "} + Html{std::to_string(scene.grains->seed)} + Html{", "} +
                    setting(scene.grains->density, "kg/m³"));
  row("box, length × width", setting(scene.box.length, "m") + Html{" × "} + setting(scene.box.width, "m"));
  row("friction of floor and lid, of side walls", exact(scene.box.friction_horizontal) + Html{", "} + exact(scene.box.friction_vertical));
}

}  // namespace

Html results_table(const RunData&, const RunSummary& summary) {
  Results results;
  add_accuracy(summary, results);
  if (*summary.facts.has_wall && *summary.facts.has_packing) add_wall(summary, results);
  if (*summary.facts.has_packing) add_compaction(summary, results);
  results.group("Effort");
  results.plain("iterations per step: mean, most", number(summary.iterations.mean) + Html{", "} + exact(summary.iterations.max));
  results.plain("contact points per step: mean, most", number(summary.contacts.mean, 4) + Html{", "} + exact(summary.contacts.max));
  results.plain("wall clock per step", quantity(summary.ms_per_step, "ms"));
  return results.html();
}

Html periods_table(const RunSummary& summary) {
  if (summary.wall.periods.empty()) return {};
  HtmlTable table;
  table.head = {{"period"}, {"from<br>(s)"}, {"to<br>(s)"}, {"Δ<i>x</i><sub>max</sub><br>(mm)"}, {"contraction<br>(mm)"},
                {"<i>v</i><sub>max</sub> in<br>(mm/s)"}, {"<i>v</i> out<br>(mm/s)"}, {"jammed<br>(%)"}, {"&rho;,<br>mean"}, {"gain<br>of &rho;"}};
  table.is_number.assign(10, true);
  double before = not_known;
  for (const WallPeriod& period : summary.wall.periods) {
    table.rows.push_back({exact(std::round(period.end * summary.facts.frequency)), exact(period.begin, 4), exact(period.end, 4),
                          number(1e3 * period.rise), number(-1e3 * period.net), number(1e3 * period.speed_in),
                          number(1e3 * period.speed_out), number(100.0 * period.jammed_share), number(period.solid_fraction, 5),
                          number(period.solid_fraction - before, 2)});
    before = period.solid_fraction;
  }
  return to_html(table);
}

Html cost_table(const RunSummary& summary) {
  HtmlTable table;
  table.head = {{"phase"}, {"ms per step"}, {"%"}};
  table.is_number = {false, true, true};
  for (const PhaseCost& phase : summary.cost)
    table.rows.push_back({Html{phase.name}, number(phase.ms_per_step), number(100.0 * phase.share)});
  table.rows.push_back({Html{"<b>all</b>"}, number(summary.ms_per_step), number(summary.ms_per_step > 0.0 ? 100.0 : not_known)});
  return to_html(table);
}

Html energy_table(const RunSummary& summary) {
  const EnergyBalance& energy = summary.energy;
  HtmlTable table;
  table.head = {{"over the whole run"}, {"J"}};
  table.is_number = {false, true};
  const auto row = [&](const char* what, double value) { table.rows.push_back({Html{what}, number(value, 4)}); };
  row("work of the load on the wall", energy.work_load);
  row("work of gravity", energy.work_gravity);
  row("work of prescribed walls and applied forces", energy.work_prescribed);
  row("dissipated in contacts", energy.dissipated);
  row("kinetic energy after the first step", energy.kinetic_first);
  row("kinetic energy after the last step", energy.kinetic_last);
  row("residual: change of kinetic energy − works + dissipation, after the first step", energy.residual);
  row("the same, summed by the stepper over all steps", energy.residual_recorded);
  row("of it, work of the gyroscopic term", energy.work_gyroscopic);
  row("potential energy given by the overlap correction (not in the balance: it moves bodies, not velocities)", energy.work_correction);
  row("sum over steps of |works|", energy.work_absolute);
  return to_html(table);
}

Html parameters_table(const RunData& data) {
  HtmlTable table = facts_table();
  if (data.scene) add_scene(*data.scene, table);
  const auto overrides = data.manifest.find("overrides");
  if (overrides != data.manifest.end() && overrides->is_array() && !overrides->empty()) {
    std::string list;
    for (const auto& entry : *overrides) list += (list.empty() ? "" : "\n") + (entry.is_string() ? entry.get<std::string>() : entry.dump());
    table.rows.push_back({Html{"settings other than the scene’s (--set)"}, Html{"<code>"} + escaped(list) + Html{"</code>"}});
  }
  const auto summary = data.manifest.find("summary");
  if (summary != data.manifest.end() && summary->is_object())
    for (const auto& [name, value] : summary->items()) {
      std::string label = name;
      const char* unit = "";
      for (const NamedUnit& known : named_units) {
        const std::string suffix = known.suffix;
        if (label.size() <= suffix.size() || label.compare(label.size() - suffix.size(), suffix.size(), suffix) != 0) continue;
        label.resize(label.size() - suffix.size());
        unit = known.unit;
        break;
      }
      for (char& c : label)
        if (c == '_') c = ' ';
      table.rows.push_back({escaped(label), summary_row_value(value, unit)});
    }
  return to_html(table);
}

Html provenance_table(const RunData& data) {
  HtmlTable table = facts_table();
  const auto row = [&](const char* what, const std::string& value) {
    if (!value.empty()) table.rows.push_back({Html{what}, escaped(value)});
  };
  const auto& manifest = data.manifest;
  row("ballast", text_at(manifest, "ballast", "version"));
  std::string commit = text_at(manifest, "ballast", "commit");
  if (!commit.empty() && text_at(manifest, "ballast", "modified") == "true") commit += ", with changes that are not committed";
  row("commit", commit);
  row("compiler", text_at(manifest, "ballast", "compiler"));
  row("build", text_at(manifest, "ballast", "build_type"));
  row("flags", text_at(manifest, "ballast", "flags"));
  row("libraries", text_at(manifest, "ballast", "libraries"));
  row("processor", text_at(manifest, "machine", "cpu"));
  row("cores", text_at(manifest, "machine", "cores"));
  row("memory (GB)", text_at(manifest, "machine", "memory_GB"));
  row("load average at the start (1, 5, 15 min)", text_at(manifest, "machine", "load_average"));
  row("environment", text_at(manifest, "machine", "environment"));
  for (const char* name : {"started", "key"})
    if (const auto value = manifest.find(name); value != manifest.end() && value->is_string())
      row(name, value->get<std::string>());
  if (const auto resumed = manifest.find("resumed"); resumed != manifest.end() && resumed->is_array())
    for (const auto& entry : *resumed) row("resumed", readable(entry));
  return to_html(table);
}

Html files_table(const RunData& data) {
  constexpr std::pair<const char*, const char*> files[] = {
      {"steps.csv", "every step’s scalars, one column each"},
      {"record.h5", "the same and the poses, with units and descriptions (HDF5)"},
      {"manifest.json", "program, machine, parameters, summary"},
      {"scene.toml", "the resolved scene: runs again as it is"},
      {"figures", "each figure as SVG, and as a gnuplot script that holds its data"},
      {"checkpoint.bin", "state to resume from"},
      {"paraview", "poses and contacts for ParaView"}};
  HtmlTable table = facts_table();
  for (const auto& [name, what] : files)
    if (std::filesystem::exists(data.folder / name))
      table.rows.push_back({Html{std::string("<a href=\"") + name + "\"><code>" + name + "</code></a>"}, Html{what}});
  return to_html(table);
}

std::string made_by(const RunData& data) {
  std::string text;
  const auto add = [&](const std::string& before, const std::string& part) {
    if (!part.empty()) text += (text.empty() ? "" : ", ") + before + part;
  };
  add("ballast ", text_at(data.manifest, "ballast", "version"));
  add("commit ", text_at(data.manifest, "ballast", "commit").substr(0, 12));
  add("", text_at(data.manifest, "machine", "cpu"));
  if (const auto started = data.manifest.find("started"); started != data.manifest.end() && started->is_string())
    add("started ", started->get<std::string>());
  return text;
}

std::string shell_word(const std::string& word) {
  const bool is_plain = !word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=+:,@%") ==
                                             std::string::npos;
  if (is_plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + '\'';
}

std::string reproduce_commands(const RunData& data) {
  std::string text;
  const std::string commit = text_at(data.manifest, "ballast", "commit");
  if (!commit.empty() && commit != "unknown") text += "git checkout " + shell_word(commit) + '\n';
  const auto scene = data.manifest.find("scene");
  if (scene != data.manifest.end() && scene->is_string()) {
    text += "./run.sh " + shell_word(scene->get<std::string>());
    const auto overrides = data.manifest.find("overrides");
    if (overrides != data.manifest.end() && overrides->is_array())
      for (const auto& entry : *overrides)
        if (entry.is_string()) text += " --set " + shell_word(entry.get<std::string>());
    text += '\n';
  }
  if (!data.scene_text.empty()) text += "# or from the resolved scene of this folder:\n./run.sh " +
                                        shell_word((data.folder / "scene.toml").lexically_normal().string()) + " --output results/again\n";
  return text;
}

}  // namespace ballast
