#include <cctype>
#include <set>

#include "experiments/compare/collection.hpp"
#include "experiments/compare/compare_case.hpp"
#include "experiments/run/run.hpp"
#include "platform/text.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

using Texts = std::vector<std::string>;

struct Entry {
  std::string name, scene, steps, part = "small";
  Texts set, made;
  std::vector<Texts> vary;
};

std::vector<Texts> read_vary(TomlTable& table) {
  table.know("vary");
  constexpr const char* expected = "expected lists of texts, [[\"a.key=1\", \"a.key=2\"]]";
  std::vector<Texts> axes;
  const toml::node* node = table.as_it_stands().get("vary");
  if (!node) return axes;
  if (!node->is_array()) table.fail("vary", expected);
  for (const toml::node& list : *node->as_array()) {
    Texts& axis = axes.emplace_back();
    if (!list.is_array() || list.as_array()->empty()) table.fail("vary", expected);
    for (const toml::node& text : *list.as_array()) {
      axis.push_back(text.is_string() ? text.as_string()->get() : "");
      const std::string first = split(axis.back(), ' ').front();  // it names the run
      if (first.find('=') == std::string::npos) table.fail("vary", expected);
    }
  }
  return axes;
}

Entry read_entry(TomlTable& table, const std::vector<Entry>& before) {
  const std::string name = table.text("name"), like = table.text("like", "");
  // A made problem's file begins with the name, from which a comparison takes its family.
  if (!is_plain(name, "_") || family_of_file(name) != name)
    table.fail("name", "\"" + name + "\": expected letters, digits and _, a letter last");
  Entry entry;
  if (!like.empty()) {
    const auto found = std::ranges::find(before, like, &Entry::name);
    if (found == before.end()) table.fail("like", "\"" + like + "\": no entry further up");
    entry = *found;
  }
  entry.name = name;
  entry.scene = table.text("scene", entry.scene);
  entry.steps = table.text("steps", entry.steps);
  entry.part = "small";
  table.read("part", &entry.part, one_of({"small", "large"}));
  for (std::string& text : table.texts("set")) entry.set.push_back(std::move(text));
  entry.made = table.texts("made");
  if (std::vector<Texts> axes = read_vary(table); !axes.empty()) entry.vary = std::move(axes);
  if (entry.scene.empty() == entry.made.empty())
    table.fail("scene", "expected either a scene or `made`, problems that are made");
  if (entry.made.empty() && entry.steps.empty()) table.text("steps");  // throws, as it is missing
  table.finish();
  return entry;
}

/// The part of a run's name for a text of `vary`: the value of the text's first override.
std::string label_of(const std::string& text) {
  std::string label;
  for (const char c : split(text, ' ').front().substr(text.find('=') + 1))
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-')
      label += c;
    else if (!label.empty() && label.back() != '_' && c != '"')
      label += '_';
  while (!label.empty() && label.back() == '_') label.pop_back();
  return label;
}

/// Adds a run for each combination; the last axis changes fastest.
void add_runs(const Entry& entry, size_t axis, CollectedRun run, std::vector<CollectedRun>& runs) {
  if (axis == entry.vary.size()) {
    const Scene scene = resolve_run(run.scene, run.overrides).scene;
    run.bodies = scene.grains ? scene.grains->count : static_cast<int>(scene.bodies.size());
    for (long step = 1; step <= scene.step_count(); ++step) run.steps += run.capture.takes(step);
    runs.push_back(std::move(run));
    return;
  }
  for (const std::string& text : entry.vary[axis]) {
    CollectedRun next = run;
    next.name += '-' + label_of(text);
    for (std::string& word : split(text, ' '))
      if (!word.empty()) next.overrides.push_back(std::move(word));
    add_runs(entry, axis + 1, std::move(next), runs);
  }
}

void add_entry(const Entry& entry, std::vector<CollectedRun>& runs) {
  CollectedRun run;
  run.family = run.name = entry.name;
  run.is_large = entry.part == "large";
  int number = 0;
  for (const std::string& word : entry.made) {
    compare_cases({word});  // throws for a wrong word
    run.made = word;
    run.name = entry.name + (run.is_large ? "-large-" : "-made-") + std::to_string(++number);
    runs.push_back(run);
  }
  if (!entry.made.empty()) return;
  run.scene = entry.scene;
  run.overrides = entry.set;
  run.capture = CaptureSettings::parse(entry.steps);
  add_runs(entry, 0, std::move(run), runs);
}

}  // namespace

std::vector<CollectedRun> read_collection(const fs::path& file) {
  const toml::table raw = load_toml(file);
  toml::table resolved;
  TomlTable root(file.string(), raw, resolved);
  std::vector<Entry> entries;
  std::vector<CollectedRun> runs;
  for (TomlTable& table : root.sections("family")) {
    entries.push_back(read_entry(table, entries));
    try {
      add_entry(entries.back(), runs);
    } catch (const std::exception& error) {
      throw Error(file.string() + ": family " + entries.back().name + ": " + error.what());
    }
  }
  root.finish();
  std::set<std::string> names;
  for (const CollectedRun& run : runs)
    if (!names.insert(run.name).second)
      throw Error(file.string() + ": family " + run.family + ": " + run.name +
                  " stands twice: expected other values or another name");
  if (runs.empty()) throw Error(file.string() + ": expected tables [[family]]");
  return runs;
}

}  // namespace ballast
