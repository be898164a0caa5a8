#include "experiments/paper/point_origins.hpp"

#include <nlohmann/json.hpp>

#include "platform/atomic_file.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Of an origin's name, "runs 3 14": pages that are there, commands for the others; nothing
/// of runs whose records are elsewhere.
Json origin_of(const PaperData& data, const std::string& name, const fs::path& folder) {
  Json links = Json::array(), commands = Json::array();
  const std::vector<std::string> words = split(name, ' ');
  for (size_t k = 1; k < words.size(); ++k) {
    const auto run = parsed<size_t>(words[k]).value_or(0);
    if (!data.has(run)) continue;
    const fs::path page = data.folder(run) / "report.html";
    const std::string& run_name = data.campaign().runs.at(run).planned.name;
    if (is_there(page))
      links.push_back({fs::relative(page, folder).generic_string(), run_name});
    else
      commands.push_back({"ballast report " + shell_word(data.folder(run).string()),
                          run_name + ": its page is written by"});
  }
  return {{"title", words.size() == 2 ? "The run of this point" : "The runs of this point"},
          {"links", links},
          {"commands", commands}};
}

}  // namespace

std::string origins_of_points(const PaperData& data, const std::vector<PaperSection>& sections,
                              const fs::path& folder) {
  Json origins = Json::object();
  for (const PaperSection& section : sections)
    for (const page::Picture& picture : section.figures)
      for (const Panel& panel : picture.plot.panels)
        for (const Curve& curve : panel.curves)
          for (const std::string& name : curve.origins)
            if (!origins.contains(name)) origins[name] = origin_of(data, name, folder);
  return Json{{"origins", origins}}.dump();
}

}  // namespace ballast
