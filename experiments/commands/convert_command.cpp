// `ballast convert`: stored problems from one format into another.

#include <iostream>
#include <map>
#include <memory>

#include "experiments/commands/command.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/files/problem_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

struct ConvertOptions {
  std::vector<std::string> problems;
  std::string to = "local";
  fs::path output;
};

struct Format {
  const char* name;
  StoredForms forms;
};
const Format formats[] = {{"local", StoredForms::delassus},
                          {"global", StoredForms::as_known},
                          {"both", StoredForms::both}};

/// Throws std::invalid_argument.
const Format& format_of(const std::string& name) {
  std::vector<std::string> names;
  for (const Format& format : formats) {
    if (name == format.name) return format;
    names.emplace_back(format.name);
  }
  throw std::invalid_argument("'" + name + "': expected one of " + joined(names));
}

/// Into `target`, which no other problem is in.
void convert_one(const FoundProblem& found, const Format& format, const fs::path& target) {
  std::error_code error;
  if (fs::equivalent(target, found.file, error))
    throw Error(target.string() + ": would be written over what is read");
  const FrictionProblem problem = read_problem(found.file);
  if (format.forms == StoredForms::as_known && !problem.has_dynamics)
    throw Error("only W is known: there are no bodies for the global form");
  if (target.has_parent_path()) create_folder(target.parent_path());
  write_problem(target, problem, format.forms);
  std::cout << printed("%-40s %7d contacts  ", found.name.c_str(), problem.contact_count())
            << target.string() << std::endl;
}

/// Whether --output is the file of one problem, and not a folder. Throws UsageError: several
/// problems, or a suffix that is not HDF5's.
bool names_a_file(const ConvertOptions& options, size_t problems) {
  if (!is_problem_file(options.output) || is_folder(options.output)) return false;
  const std::string named = "--output " + options.output.string();
  if (problems != 1)
    throw UsageError(named + ": one file for " + std::to_string(problems) +
                     " problems, expected a folder");
  if (options.output.extension() == ".dat")
    throw UsageError(named + ": only .hdf5 and .h5 are written");
  return true;
}

ExitCode convert(const ConvertOptions& options) {
  const Format& format = format_of(options.to);
  std::vector<FoundProblem> problems;
  for (const std::string& word : options.problems)
    for (FoundProblem& found : find_problems(word)) problems.push_back(std::move(found));
  const bool is_file = names_a_file(options, problems.size());
  size_t failed = 0;
  std::string reasons;
  std::map<fs::path, fs::path> written;  // what is in it
  for (const FoundProblem& found : problems) {
    fs::path target = is_file ? options.output : options.output / found.name;
    if (!is_file) target.replace_extension(".hdf5");
    try {
      const auto [before, is_new] = written.try_emplace(target, found.file);
      if (!is_new) throw Error(target.string() + ": holds " + before->second.string() + " already");
      convert_one(found, format, target);
    } catch (const std::exception& error) {
      // The others go on.
      std::string why = error.what();
      if (why.find(found.file.string()) == std::string::npos)
        why = found.file.string() + ": " + why;
      ++failed;
      add_to_list(reasons, why);
    }
  }
  if (failed == 0) return ExitCode::ok;
  std::cerr << "ballast: convert: " << failed << " of " << problems.size()
            << " problems are not converted: " << reasons << '\n';
  return ExitCode::failure;
}

}  // namespace

Command convert_command() {
  const auto options = std::make_shared<ConvertOptions>();
  return {"convert",
          "Stored problems from one format into another, whole collections at once",
          {{"problems", &options->problems, "Files, folders, patterns: .hdf5, .h5, .dat", required},
           {"--to FORMAT", &options->to, "local (FCLIB: W, q), global (FCLIB: M, H) or both",
            parsed([](const std::string& name) { format_of(name); })},
           {"--output PATH", &options->output,
            "Folder for the converted ones; of one problem also its file: .hdf5, .h5", required}},
          [options] { return convert(*options); }};
}

}  // namespace ballast
