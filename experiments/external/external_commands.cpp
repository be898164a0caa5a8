// Which programs solve: the words of the command line, and lists in TOML.

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "experiments/external/external_program.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

/// Commands of a list start in the folder of the list.
std::vector<ExternalCommand> read_list(const fs::path& file) {
  const toml::table content = load_toml(file);
  toml::table resolved;
  TomlTable list(file.string(), content, resolved);
  std::vector<ExternalCommand> commands;
  const fs::path folder = fs::absolute(file).parent_path();
  for (TomlTable& entry : list.sections("external")) {
    ExternalCommand command;
    command.name = entry.text("name");
    command.command = entry.text("command");
    entry.read("serve", {}, false, &command.is_served);
    std::string forms = "both";
    entry.read("forms", {}, false, &forms);
    try {
      command.forms = asked_forms_of(forms);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(file.string() + ": " + command.name +
                                  ": forms = " + error.what());
    }
    command.folder = folder.string();
    entry.finish();
    commands.push_back(std::move(command));
  }
  list.finish();
  if (commands.empty())
    throw std::invalid_argument(file.string() + ": has no [[external]] with name and command");
  return commands;
}

}  // namespace

std::vector<ExternalCommand> external_commands(const std::vector<std::string>& words) {
  std::vector<ExternalCommand> commands;
  for (const std::string& word : words) {
    const size_t equals = word.find('=');
    if (equals != std::string::npos)
      commands.push_back({word.substr(0, equals), word.substr(equals + 1), false, ""});
    else if (fs::path(word).extension() == ".toml")
      for (ExternalCommand& command : read_list(word)) commands.push_back(std::move(command));
    else
      throw std::invalid_argument("'" + word + "': expected name=command, or a list as .toml");
  }
  for (auto c = commands.begin(); c != commands.end(); ++c) {
    if (!is_plain(c->name, "_-.+"))
      throw std::invalid_argument("'" + c->name + "': a name has letters, digits and _ - . +");
    if (c->command.find_first_not_of(' ') == std::string::npos)
      throw std::invalid_argument(c->name + ": expected a command behind the =");
    if (std::any_of(commands.begin(), c, [&](const auto& other) { return other.name == c->name; }))
      throw std::invalid_argument(c->name + ": this name is there twice");
  }
  return commands;
}

std::string key_of(const ExternalCommand& command) {
  std::string known = command.command + '|' + command.folder + (command.is_served ? "|served" : "");
  if (command.forms != AskedForms::both)
    known += "|forms " + std::to_string(static_cast<int>(command.forms));
  std::istringstream words(command.command);
  for (std::string word; words >> word;) {
    std::erase_if(word, [](char c) { return c == '\'' || c == '"'; });
    const fs::path file = fs::path(command.folder) / word;
    if (is_file(file)) known += '|' + content_key(read_whole_file(file));
  }
  return content_key(known);
}

}  // namespace ballast
