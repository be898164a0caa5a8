// One run, and its page, which can be drawn again: after a full disk, with gnuplot installed
// meanwhile, or while the run goes on.

#include <algorithm>
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "experiments/commands/command.hpp"
#include "experiments/measure/run_data.hpp"
#include "experiments/measure/run_trust.hpp"
#include "experiments/run/capture.hpp"
#include "experiments/run/run.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/run_page/report.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"
#include "platform/worker_team.hpp"

namespace ballast {
namespace {

ExitCode draw_pages(const std::vector<std::string>& folders) {
  for (const std::filesystem::path folder : folders) {
    if (!RunFolder(folder).has_run())
      throw Error(folder.string() + ": no run here: scene.toml is missing");
    write_report(folder);
    std::cout << (folder / "report.html").string() << std::endl;
  }
  return ExitCode::ok;
}

}  // namespace

Command report_command() {
  const auto folders = std::make_shared<std::vector<std::string>>();
  return {"report",
          "Draws the page of a run from its record, again or while it goes on",
          {{"run", folders.get(), "Folders of runs", required}},
          [folders] { return draw_pages(*folders); }};
}

namespace {

struct RunRequest {
  RunOptions run;
  bool with_page = true, strict = false;
  bool is_quiet = false, is_json = false;
};

/// This command line, so that it goes on with the run that it has begun: from the folder where it
/// was given, with all its options.
std::string command_that_goes_on() {
  std::vector<std::string> words = own_words();
  words[0] = own_program().string();
  // What would begin anew is left out.
  std::erase_if(words, [](const std::string& word) {
    return word == "--overwrite" || word == "--new-packing";
  });
  const auto is_given = [&](const char* word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (!is_given("--continue") && !is_given("--resume") && !is_given("--deposit-only"))
    words.push_back("--continue");
  return "cd " + shell_word(std::filesystem::current_path().string()) + " && " + shell_line(words);
}

/// More threads than cores only wait for each other.
void limit_threads(RunOptions& options) {
  const int cores = available_cores();
  if (options.threads <= cores) return;
  std::cerr << "ballast: --threads " << options.threads << ": there are " << cores
            << " cores for this program, so many threads are used; the results are the same"
            << std::endl;
  options.threads = cores;
}

/// Draws the run's page where it is asked for or missing, and says what is where and what can be
/// done next.
void show_results(const RunEnd& end, const RunOptions& options, bool with_page) {
  const bool has_page = is_there(end.folder / "report.html");
  if (with_page && (!end.was_finished || !has_page)) write_report(end.folder);
  if (end.was_finished || options.telling != Telling::reader) return;
  std::cout << "\nresults in " << end.folder.string() << "\n";
  if (with_page)
    std::cout << "  report.html   figures and the table of the run: open it in a browser\n";
  std::cout << "  steps.csv     every step's scalars\n"
            << "  record.h5     the same and the poses (HDF5)\n";
  if (!options.capture.empty())
    std::cout << "  capture/      friction problems of steps, for ballast compare\n";
  std::cout << "  manifest.json machine, commit, parameters, summary\n\nwhat next\n"
            << next_commands(end.has_grains) << std::flush;
}

/// What the user must know of a run that is finished. Strict: only a clean one is a success.
ExitCode tell_trust(const RunEnd& end, const RunRequest& request,
                    std::vector<std::string>& to_be_known) {
  const RunData data = read_run_data(end.folder);
  const RunSummary run = summarise(data.steps, data.facts);
  to_be_known = trust_words(run);
  if (request.run.telling == Telling::reader) {
    std::cout << "\nto be known\n";
    for (const std::string& words : to_be_known) std::cout << "  " << words << '\n';
    std::cout << std::flush;
  }
  if (!request.strict || is_clean(run)) return ExitCode::ok;
  std::cerr << "ballast: " << request.run.scene << ": --strict: finished, with what is said above"
            << std::endl;
  return ExitCode::failure;
}

/// The last line for a program.
void tell_end(const RunEnd& end, ExitCode code, const std::vector<std::string>& to_be_known) {
  const nlohmann::ordered_json line = {{"event", "end"},
                                       {"folder", end.folder.string()},
                                       {"exit_code", static_cast<int>(code)},
                                       {"was_finished", end.was_finished},
                                       {"to_be_known", to_be_known}};
  std::cout << line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
            << std::endl;
}

ExitCode run_scene(RunRequest& request) {
  restart_with_one_algebra_thread();
  request.run.again = command_that_goes_on();
  request.run.telling = request.is_json    ? Telling::program
                        : request.is_quiet ? Telling::nobody
                                           : Telling::reader;
  limit_threads(request.run);
  const RunEnd end = run(request.run);
  ExitCode code = end.code;
  std::vector<std::string> to_be_known;
  if (end.has_record) show_results(end, request.run, request.with_page);
  if (end.has_record && code == ExitCode::ok && !request.run.deposit_only)
    code = tell_trust(end, request, to_be_known);
  if (request.is_json) tell_end(end, code, to_be_known);
  if (end.code != ExitCode::ok)
    std::cerr << "ballast: " << request.run.scene
              << ": stopped before its end; --continue goes on with it" << std::endl;
  return code;
}

}  // namespace

Command run_command() {
  const auto request = std::make_shared<RunRequest>();
  RunOptions& run = request->run;
  return {
      "run",
      "Runs a scene into a folder of results",
      {{"scene", &run.scene, "A scene's name (ballast scenes) or a TOML file", required},
       {"--set KEY=VALUE", &run.overrides,
        "Overrides one value of the scene: dotted.key=value, body.0.mass=2"},
       {"--output DIR", &run.output, "The run's folder (results/<scene>)"},
       {"--resume", &run.resume, "Continues the run found in the folder"},
       {"--overwrite", &run.overwrite, "Replaces the run found in the folder",
        excludes("--resume")},
       {"--continue", &run.begin_or_resume,
        "Continues the run found in the folder or begins one; does nothing when it is finished",
        excludes("--resume"), excludes("--overwrite")},
       {"--deposit-only", &run.deposit_only, "Only sees to it that the packing is in the cache"},
       {"--new-packing", &run.new_packing, "Deposits the grains again, whatever the cache has"},
       {"--packing-cache DIR", &run.packing_cache,
        "Where deposited packings are kept (<output>/../packings)"},
       {"--capture WHICH", &run.capture,
        "Keeps the friction problems of steps as FCLIB files in <output>/capture: every=50 (two "
        "consecutive ones each; steps=3: three), from=1000,to=1020",
        parsed([](const std::string& which) {
          if (!which.empty()) CaptureSettings::parse(which);
        })},
       {"--threads N", &run.threads,
        "Threads of the solver (1), at most the cores; the results are the same to the last bit",
        between(1, 256)},
       {"--max-seconds S", &run.max_seconds,
        "Wall clock after which to write a checkpoint and exit with 3", above(0)},
       {"--strict", &request->strict,
        "Exit code 1 when steps missed their tolerance, overlaps can be seen or energy was gained"},
       {"--quiet", &request->is_quiet, "Says nothing but failures"},
       {"--json", &request->is_json,
        "Progress and end for programs: one JSON object a line on stdout, nothing else",
        excludes("--quiet")},
       {"--no-report", &request->with_page, "No figures and no page at the end"}},
      [request] { return run_scene(*request); }};
}

}  // namespace ballast
