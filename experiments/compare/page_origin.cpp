#include "experiments/compare/page_origin.hpp"

#include <utility>

#include <nlohmann/json.hpp>

#include "experiments/page/html.hpp"
#include "experiments/run_page/report.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {

RunData read_origin(const std::filesystem::path& folder) {
  RunData data;
  data.folder = folder;
  data.manifest_text = read_whole_file(folder / "manifest.json");
  data.stored_manifest = std::make_shared<const nlohmann::ordered_json>(
      nlohmann::ordered_json::parse(data.manifest_text, nullptr, false));
  if (!data.manifest().is_object())
    throw Error((folder / "manifest.json").string() + ": is no JSON object");
  return data;
}

page::Table options_table(const RunData& data) {
  page::Table table = page::facts_table();
  if (const auto summary = data.manifest().find("summary"); summary != data.manifest().end())
    for (const auto& [name, value] : summary->items())
      table.rows.push_back({name, value.is_number()   ? page::exact(value.get<double>())
                                  : value.is_string() ? page::Text(value.get<std::string>())
                                                      : page::Text(value.dump())});
  return table;
}

void write_with_origin(page::Page page, const RunData& data, const std::filesystem::path& file) {
  if (const std::string made = made_by(data); !made.empty()) page.lede.push_back(made);
  page.add({"provenance", "Program and machine", {provenance_table(data)}});
  page::draw_pictures(page, file.parent_path());
  page::write_html_file(file, page);
}

}  // namespace ballast
