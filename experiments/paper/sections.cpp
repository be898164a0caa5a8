#include "experiments/paper/sections.hpp"

#include <stdexcept>

namespace ballast {
namespace {

struct Entry {
  const char* target;
  PaperSection (*make)(PaperData&);
};
constexpr Entry entries[] = {{"fig3", fig3_section},
                             {"fig4", fig4_section},
                             {"fig5", fig5_section},
                             {"fig6", fig6_section},
                             {"fig7", fig7_section},
                             {"fig8", fig8_section},
                             {"fig9", fig9_section},
                             {"fig10", fig10_section},
                             {"fig11", fig11_section},
                             {"fig12", fig12_section},
                             {"fig13", fig13_section},
                             {"packing", packing_section},
                             {"looseness", looseness_section},
                             {"sensitivity", sensitivity_section},
                             {"investigation", investigation_section}};

}  // namespace

std::vector<PaperSection> make_sections(PaperData& data, const std::string& target) {
  std::vector<PaperSection> sections;
  for (const Entry& entry : entries)
    if (target == "all" || target == entry.target) sections.push_back(entry.make(data));
  if (sections.empty()) throw std::invalid_argument("paper: no section is called '" + target + "'");
  return sections;
}

}  // namespace ballast
