#include "experiments/box/packing.hpp"
#include "experiments/page/text.hpp"
#include "experiments/paper/sections.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {

std::string archive_file(const std::string& name);  // of experiments/paper/archive
std::string citation_text();
std::string licence_text();

namespace {

namespace fs = std::filesystem;

/// The output of a program that reads or makes `file`. Throws Error that names the file.
std::string output_of(const std::string& program, const std::vector<std::string>& arguments,
                      const fs::path& file) {
  const ProgramResult result = run_program(program, arguments, /*seconds=*/300.0);
  if (!result.succeeded())
    throw Error(file.string() + ": " + program + ": " + one_line(result.errors, ' '));
  return result.output;
}

/// The SHA-256 of a file as 64 hexadecimal digits.
std::string sha256_of(const fs::path& file) {
  // sha256sum's line begins with \ where the name has one
  const std::string line = output_of("sha256sum", {"--", file.string()}, file);
  return line.substr(line.starts_with('\\'), 64);
}

/// One row for each packing that the campaign starts from.
std::string packings_csv(const PaperData& data, const fs::path& folder) {
  struct Start {
    std::string scene, seed;
    int runs = 0;
  };
  std::map<std::string, Start> starts;
  std::set<std::string> counted;
  for (const PlannedRun& run : data.campaign()) {
    if (!counted.insert(run.key).second) continue;
    Start& start = starts[run.packing];
    start.scene = run.scene;
    for (const std::string& word : run.overrides)
      if (word.starts_with("grains.seed=")) start.seed = word.substr(word.find('=') + 1);
    ++start.runs;
  }
  CsvWriter csv;
  csv.add_row({"packing", "scene", "seed", "runs", "sha256"});
  for (const auto& [key, start] : starts) {
    const fs::path file = packing_file(folder, key);
    csv.add_row({key, start.scene, start.seed, std::to_string(start.runs),
                 path_exists(file) ? sha256_of(file) : ""});
  }
  return csv.take();
}

/// The texts of the archive's files by their paths within the archive.
std::map<std::string, std::string> files_of(PaperData& data, const ArchiveOptions& order) {
  const std::vector<RunRow>& rows = data.rows();
  std::map<std::string, std::string> files{
      {"CITATION.cff", citation_text()},
      {"LICENSE", licence_text()},
      {"campaign.toml", order.plan.empty() ? campaign_plan() : read_whole_file(order.plan)},
      {"runs.csv", runs_csv(rows)},
      {"columns.csv", run_columns_csv()},
      {"packings.csv", packings_csv(data, order.packings)},
      {"curve.py", archive_file("curve.py")}};
  std::set<std::string> scenes;
  for (const PlannedRun& run : data.campaign()) scenes.insert(run.scene);
  for (const std::string& scene : scenes) {
    const fs::path file = find_scene(scene);
    fs::path place = fs::path("scenes") / file.filename();
    // a plan that names a scene by a path finds it from the plan's own folder
    if (!order.plan.empty() && file == scene)
      place = fs::absolute(file).lexically_normal().lexically_relative(
          fs::absolute(order.plan).lexically_normal().parent_path());
    const std::string text = read_whole_file(file);
    if (*place.begin() == ".." || files.emplace(place.string(), text).first->second != text)
      throw Error(file.string() +
                  ": expected a scene below the plan's folder, at no other file's place there");
  }
  const std::map<std::string, std::string> facts{
      {"known", std::to_string(data.finished() + data.known_by_row())},
      {"planned", std::to_string(data.planned())},
      {"rows", std::to_string(rows.size())}};
  files["README.md"] = page::filled(archive_file("README.md"),
                                    [&](const std::string& name) { return facts.at(name); });
  return files;
}

}  // namespace

fs::path write_archive(PaperData& data, const ArchiveOptions& order) {
  const std::string name = "ballast-paper";
  const fs::path folder = order.output / name, packed = order.output / (name + ".tar.gz"),
                 neighbour = packed.string() + ".tmp";
  require_own_folder(folder, {"scenes"});
  create_folder(folder / "scenes");
  // without owner and date the same rows give the same bytes
  std::vector<std::string> words{"--create",
                                 "--force-local",
                                 "--file=" + neighbour.string(),
                                 "--use-compress-program=gzip -n",
                                 "--owner=0",
                                 "--group=0",
                                 "--numeric-owner",
                                 "--mode=u=rw,go=r",
                                 "--mtime=@0",
                                 "--directory=" + order.output.string(),
                                 "--"};
  std::string sums;
  for (const auto& [member, text] : files_of(data, order)) {
    create_folder((folder / member).parent_path());
    write_whole_file(folder / member, text);
    sums += sha256_of(folder / member) + "  " + member + "\n";
    words.push_back(name + "/" + member);
  }
  write_whole_file(folder / "SHA256SUMS", sums);
  words.push_back(name + "/SHA256SUMS");
  output_of("tar", words, packed);
  fs::rename(neighbour, packed);
  return packed;
}

}  // namespace ballast
