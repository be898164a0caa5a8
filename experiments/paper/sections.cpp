#include "experiments/paper/sections.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "platform/text.hpp"

namespace ballast {
namespace {

constexpr const char* every_section = "all";

bool is_stage(const std::vector<CampaignRun>& campaign, const std::string& name) {
  return std::ranges::any_of(campaign, [&](const CampaignRun& run) { return run.stage == name; });
}

/// The stages that a target runs.
std::set<std::string> needed(const std::vector<CampaignRun>& campaign, const std::string& target) {
  std::set<std::string> stages;
  if (is_stage(campaign, target)) stages.insert(target);
  for (const ReportSection& section : paper_sections())
    if (target == section.name) stages.insert(section.stages.begin(), section.stages.end());
  if (target == every_section)
    for (const CampaignRun& run : campaign) stages.insert(run.stage);
  if (stages.empty())
    throw std::invalid_argument("paper: '" + target + "' is not one of " +
                                joined(paper_targets(campaign)));
  return stages;
}

}  // namespace

std::span<const ReportSection> paper_sections() {
  static const std::vector<ReportSection> table{
      {"curve", {"frequency", "slowest", "force", "gravity", "mass"}, fill_curve},
      {"fig3", {"motion", "frequency", "slowest"}, fill_motion},
      {"fig4", {"motion"}, fill_forces},
      {"fig5", {"motion"}, fill_model},
      {"fig6", {"motion"}, fill_velocities},
      {"fig7", {"motion"}, fill_chains},
      {"fig8", {"frequency"}, fill_portraits},
      {"fig9", {"frequency", "slowest"}},
      {"fig10", {"force", "gravity", "mass"}},
      {"fig11", {"frequency", "slowest", "force", "gravity", "mass"}},
      {"fig12", {"motion"}, fill_density},
      {"fig13", {"frequency", "slowest"}, fill_rates},
      {"packing", {"motion"}, fill_packing},
      {"box", {"box"}},
      {"replicas", {"replicas"}, fill_replicas},
      {"tight", {"tightest", "rule", "frequency"}},
      {"deposits", {"deposits"}},
      {"loads", {"loads"}},
      {"shapes", {"shapes"}},
      {"sizes", {"sizes"}},
      {"laws", {"laws"}},
      {"sensitivity", {"sensitivity"}},
      {"reading", {"reading", "frequency", "slowest"}, fill_reading},
      {"theory", {"frequency", "force", "gravity", "mass", "box"}}};
  return table;
}

std::vector<std::string> paper_targets(const std::vector<CampaignRun>& campaign) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const ReportSection& section : paper_sections()) add(section.name);
  for (const CampaignRun& run : campaign) add(run.stage);
  names.emplace_back(every_section);
  return names;
}

std::vector<Plan> stages_of(const PaperData& data, const std::string& target) {
  const std::set<std::string> wanted = needed(data.campaign(), target);
  std::vector<Plan> stages;
  for (const CampaignRun& run : data.campaign()) {
    if (!wanted.contains(run.stage) || (data.knows(run) && !data.has(run))) continue;
    const std::string name = "paper-" + run.stage;
    if (stages.empty() || stages.back().name != name) stages.push_back({name, {}});
    stages.back().runs.push_back(run.planned);
  }
  return stages;
}

std::vector<PaperSection> make_sections(PaperData& data, const std::string& target) {
  std::vector<PaperSection> made;
  for (const ReportSection& section : paper_sections()) {
    const bool draws_stage =
        std::ranges::any_of(section.stages, [&](const char* stage) { return target == stage; });
    if (target != section.name && target != every_section && !draws_stage) continue;
    const std::string name = section.name;
    PaperSection& part =
        made.emplace_back(PaperSection{.id = name, .heading = page::words(name + ".heading")});
    for (const char* stage : section.stages)
      if (const std::string missing = data.missing(stage); !missing.empty())
        part.notes.emplace_back(missing);
    part.text.push_back(page::words(name + ".intro"));
    add_laws(data, part);
    if (section.fill) section.fill(data, part);
    add_cases(data, part);
  }
  if (made.empty()) throw std::invalid_argument("paper: no section is called '" + target + "'");
  return made;
}

}  // namespace ballast
