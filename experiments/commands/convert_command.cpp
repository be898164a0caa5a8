// `ballast convert`: stored problems from one format into another.

#include <iostream>
#include <map>
#include <memory>

#include "experiments/commands/command.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/files/problem_file.hpp"
#include "problems/files/siconos_text.hpp"

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
  const char* extension;
  void (*write)(const fs::path& file, const FrictionProblem& problem);
};

void write_global(const fs::path& file, const FrictionProblem& problem) {
  if (!problem.has_dynamics)
    throw Error("only W is known: there are no bodies for the global form");
  write_problem(file, problem);
}

const Format formats[] = {
    {"local", ".hdf5",
     [](const fs::path& file, const FrictionProblem& problem) {
       write_fclib(file, condensed(problem));
     }},
    {"global", ".hdf5", write_global},
    {"both", ".hdf5",
     [](const fs::path& file, const FrictionProblem& problem) {
       write_problem_forms(file, problem);
     }},
    {"siconos", ".dat",
     [](const fs::path& file, const FrictionProblem& problem) {
       write_siconos_text(file, condensed(problem));
     }},
};

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
  create_folder(target.parent_path());
  format.write(target, problem);
  std::cout << printed("%-40s %7d contacts  ", found.name.c_str(), problem.contact_count())
            << target.string() << std::endl;
}

ExitCode convert(const ConvertOptions& options) {
  const Format& format = format_of(options.to);
  size_t count = 0, failed = 0;
  std::string reasons;
  std::map<fs::path, fs::path> written;  // what is in it
  for (const std::string& word : options.problems)
    for (const FoundProblem& found : find_problems(word)) {
      ++count;
      fs::path target = options.output / found.name;
      target.replace_extension(format.extension);
      try {
        const auto [before, is_new] = written.try_emplace(target, found.file);
        if (!is_new)
          throw Error(target.string() + ": holds " + before->second.string() + " already");
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
  std::cerr << "ballast: convert: " << failed << " of " << count
            << " problems are not converted: " << reasons << '\n';
  return ExitCode::failure;
}

}  // namespace

Command convert_command() {
  const auto options = std::make_shared<ConvertOptions>();
  return {"convert",
          "Stored problems from one format into another, whole collections at once",
          {{"problems", &options->problems, "Files, folders, patterns: .hdf5, .h5, .dat", required},
           {"--to FORMAT", &options->to,
            "local (FCLIB: W, q), global (FCLIB: M, H), both, siconos (text: W, q)", shown,
            parsed([](const std::string& name) { format_of(name); })},
           {"--output DIR", &options->output, "Folder for the converted ones", required}},
          [options] { return convert(*options); }};
}

}  // namespace ballast
