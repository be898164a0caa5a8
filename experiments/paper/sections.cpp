#include "experiments/paper/sections.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "experiments/paper/decisive_stages.hpp"
#include "platform/text.hpp"

namespace ballast {

PaperSection curve_section(PaperData& data);  ///< Fig. 11b: all that is varied on one curve
PaperSection fig3_section(PaperData& data);   ///< x(t) and f(t), first contraction (Eq. 1)
PaperSection fig4_section(PaperData& data);   ///< f_g(x), its branches, the jam
PaperSection fig5_section(PaperData& data);   ///< the phenomenological model (Eq. 2)
PaperSection fig6_section(PaperData& data);   ///< grain velocities, vorticity
PaperSection fig7_section(PaperData& data);   ///< force chains, principal stress directions
PaperSection fig8_section(PaperData& data);   ///< phase portraits
PaperSection fig9_section(PaperData& data);   ///< Delta x_max and v_max against nu
PaperSection fig10_section(PaperData& data);  ///< Delta x_max against f_max
PaperSection fig11_section(PaperData& data);  ///< Eq. 3
PaperSection fig12_section(PaperData& data);  ///< solid fraction against time
PaperSection fig13_section(PaperData& data);  ///< compaction rate (Eqs. 4 and 5)
PaperSection packing_section(PaperData& data);
PaperSection looseness_section(PaperData& data);
PaperSection sensitivity_section(PaperData& data);
PaperSection investigation_section(PaperData& data);  ///< why exponents, C and compaction differ
// the decisive stages, each section under its stage's name
PaperSection box_section(PaperData& data);       ///< C against L/H
PaperSection replicas_section(PaperData& data);  ///< the floor of chaos
PaperSection tight_section(PaperData& data);     ///< solver error and exponents
PaperSection deposits_section(PaperData& data);
PaperSection loads_section(PaperData& data);
PaperSection shapes_section(PaperData& data);
PaperSection sizes_section(PaperData& data);
PaperSection laws_section(PaperData& data);
PaperSection rule_section(PaperData& data);
PaperSection reading_section(PaperData& data);  ///< both scenes beside the paper
PaperSection theory_section(PaperData& data);   ///< C against its theory, over all of them

namespace {

/// Fig. 8 compares the motion at 5 and 10 Hz.
bool is_at_portrait(const CampaignPoint& point) {
  return point.value == motion_frequency || point.value == 2.0 * motion_frequency;
}

std::vector<ReportSection> make_table() {
  using enum Varied;
  return {{"curve", curve_section, false, {frequency, force, gravity, wall_mass}},
          {"fig3", fig3_section, true, {}},
          {"fig4", fig4_section, true, {}},
          {"fig5", fig5_section, true, {}},
          {"fig6", fig6_section, true, {}},
          {"fig7", fig7_section, true, {}},
          {"fig8", fig8_section, true, {frequency}, is_at_portrait},
          {"fig9", fig9_section, false, {frequency}},
          {"fig10", fig10_section, false, {force}},
          {"fig11", fig11_section, false, {frequency, force, gravity, wall_mass}},
          {"fig12", fig12_section, true, {}},
          {"fig13", fig13_section, false, {frequency}},
          {"packing", packing_section, true, {}},
          {"looseness", looseness_section, false, {iterations, iterations_fast, backend, force}},
          {"sensitivity", sensitivity_section, false, {time_step, size, friction, deposit, lid}},
          {"investigation",
           investigation_section,
           false,
           {frequency, force, gravity, size, iterations, iterations_fast, time_step, time_step_fast,
            loose_frequency, rough_frequency, strong_frequency, lid}},
          {"box", box_section, false, {box_length, box_length_fast}},
          {"replicas", replicas_section, false, {replica, replica_fast}},
          {"tight", tight_section, false, {tight_frequency}},
          {"deposits",
           deposits_section,
           false,
           {pressed_frequency, placed_rough_frequency, placed_frequency, pressed_rough_frequency}},
          {"loads",
           loads_section,
           false,
           {light_frequency, light_strong_frequency, light_half_frequency}},
          {"shapes", shapes_section, false, {shape, shape_fast}},
          {"sizes", sizes_section, false, {size_similar, size_wide}},
          {"laws", laws_section, false, {exact_law, convex_law}},
          {"rule", rule_section, false, {rule_frequency}},
          {"reading", reading_section, false, {reading_frequency}},
          {"theory",
           theory_section,
           false,
           {frequency, force, gravity, wall_mass, box_length, box_length_fast}}};
}

constexpr const char* every_section = "all";

/// The sections of a target; empty: there is no such target.
std::vector<const ReportSection*> sections_of(const std::string& target) {
  std::vector<const ReportSection*> found;
  for (const ReportSection& section : paper_sections())
    if (target == every_section || target == section.name) found.push_back(&section);
  return found;
}

bool is_stage(const std::string& target) {
  const auto stages = decisive_stages();
  return std::any_of(stages.begin(), stages.end(),
                     [&](const DecisiveStage& stage) { return target == stage.name; });
}

bool is_needed(const ReportSection& section, const CampaignPoint& point) {
  return std::find(section.needs.begin(), section.needs.end(), point.varied) !=
             section.needs.end() &&
         (!section.needs_point || section.needs_point(point));
}

}  // namespace

std::span<const ReportSection> paper_sections() {
  static const std::vector<ReportSection> table = make_table();
  return table;
}

std::vector<std::string> paper_targets() {
  std::vector<std::string> names;
  for (const ReportSection& section : paper_sections()) names.emplace_back(section.name);
  for (const DecisiveStage& stage : decisive_stages())
    if (sections_of(stage.name).empty()) names.emplace_back(stage.name);
  names.emplace_back(every_section);
  return names;
}

std::vector<size_t> runs_for(const Campaign& campaign, const std::string& target) {
  const std::vector<const ReportSection*> sections = sections_of(target);
  // a set: a run that several sections draw is made once, and in the campaign's order
  std::set<size_t> needed;
  for (const CampaignPoint& point : campaign.points)
    if ((is_stage(target) && target == point.stage) || target == every_section)
      needed.insert(point.run);
  if (sections.empty() && !is_stage(target))
    throw std::invalid_argument("paper: '" + target + "' is not one of " + joined(paper_targets()));
  for (const ReportSection* section : sections) {
    if (section->needs_motion) needed.insert(campaign.motion.begin(), campaign.motion.end());
    for (const CampaignPoint& point : campaign.points)
      if (is_needed(*section, point)) needed.insert(point.run);
  }
  return {needed.begin(), needed.end()};
}

std::vector<Plan> stages_of(const PaperData& data, const std::string& target) {
  std::vector<Plan> stages;
  for (const size_t index : runs_for(data.campaign(), target)) {
    if (data.knows(index) && !data.has(index)) continue;
    const CampaignRun& run = data.campaign().runs[index];
    const std::string name = "paper-" + run.stage;
    // runs stand in the order of stages, so a new name is a new stage
    if (stages.empty() || stages.back().name != name) stages.push_back({name, {}});
    stages.back().runs.push_back(run.planned);
  }
  return stages;
}

std::vector<PaperSection> make_sections(PaperData& data, const std::string& target) {
  std::vector<PaperSection> made;
  // a stage that no section is called after: all sections, with what there is
  const bool draws_all = sections_of(target).empty() && is_stage(target);
  for (const ReportSection* section : sections_of(draws_all ? every_section : target)) {
    made.push_back(section->make(data));
    made.back().id = section->name;
    made.back().heading = page::words(section->name + std::string(".heading"));
  }
  if (made.empty()) throw std::invalid_argument("paper: no section is called '" + target + "'");
  return made;
}

}  // namespace ballast
