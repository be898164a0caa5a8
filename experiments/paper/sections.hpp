#pragma once
// The report's sections: which stages of the campaign each needs, and what makes it.

#include <span>

#include "experiments/paper/section.hpp"

namespace ballast {

/// One section of the report: the target of `ballast paper` that makes it. Its heading is
/// words(name.heading), its first paragraph words(name.intro). `fill` adds to what its rows in the
/// tables of laws and cases give; null: nothing.
struct ReportSection {
  const char* name;  ///< "fig9"
  std::vector<const char*> stages;
  void (*fill)(PaperData& data, PaperSection& section) = nullptr;
};
/// The first result, then in the paper's order. A new section is its row in sections.cpp, its words
/// in texts/, and a row of a table (laws.cpp, cases.cpp) or a function of its own.
std::span<const ReportSection> paper_sections();

/// Names that `ballast paper` takes: those of the sections, of the stages, and "all".
std::vector<std::string> paper_targets(const std::vector<CampaignRun>& campaign);
/// What a target needs as plans, one for each stage: to be run in this order. Runs of which a row
/// alone is known are left out. Throws std::invalid_argument naming the target and what there is.
std::vector<Plan> stages_of(const PaperData& data, const std::string& target);
/// The sections of a target; of a stage's, all that draw it.
std::vector<PaperSection> make_sections(PaperData& data, const std::string& target);

/// Figures and tables that are rows of a table: power laws (laws.cpp), then cases (cases.cpp).
void add_laws(PaperData& data, PaperSection& section);
void add_cases(PaperData& data, PaperSection& section);

// what fills sections besides
void fill_curve(PaperData& data, PaperSection& section);  ///< all that is varied on one curve
void fill_rates(PaperData& data, PaperSection& section);  ///< Fig. 13 (Eqs. 4 and 5)
void fill_replicas(PaperData& data, PaperSection& section);
void fill_reading(PaperData& data, PaperSection& section);     ///< both scenes beside the paper
void fill_motion(PaperData& data, PaperSection& section);      ///< Fig. 3: x(t), first contraction
void fill_forces(PaperData& data, PaperSection& section);      ///< Fig. 4: f_g(x), the jam
void fill_model(PaperData& data, PaperSection& section);       ///< Fig. 5: Eq. 2 integrated
void fill_velocities(PaperData& data, PaperSection& section);  ///< Fig. 6: grains, the roll
void fill_chains(PaperData& data, PaperSection& section);      ///< Fig. 7: chains, stress
void fill_portraits(PaperData& data, PaperSection& section);   ///< Fig. 8: phase portraits
void fill_density(PaperData& data, PaperSection& section);     ///< Fig. 12: solid fraction
void fill_packing(PaperData& data, PaperSection& section);     ///< contacts, forces, anisotropies

}  // namespace ballast
