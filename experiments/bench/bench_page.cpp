#include <algorithm>
#include <cmath>
#include <csignal>
#include <iomanip>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/bench/measurement.hpp"
#include "experiments/compare/comparison.hpp"
#include "experiments/compare/ranking.hpp"
#include "experiments/compare/stored_comparison.hpp"
#include "experiments/measure/curve_fit.hpp"
#include "experiments/page/text.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {

std::string bench_page_text();  // results.md

namespace {

namespace fs = std::filesystem;

/// An error in the page; bench_all() puts the file's name before it.
struct PageError final : Error {
  using Error::Error;
};

/// A command whose results the page shows. It is run `turns` times, by turns with the others, each
/// time into a folder of its own, "NAME/TURN".
struct BenchStage {
  std::string name;
  int turns = 1;
  std::vector<std::string> words;  ///< for this program; none: BenchAll::beside is run
};

/// results.md, built into the program, or a file like it: a comment with a line "NAME xTURNS:
/// WORDS" for each stage, then the page. `{{NAME}}` in it stands for the stage's command,
/// `{{EXPRESSION}}` for a number:
///   STAGE: MEASUREMENT         median over the turns of a number of read_stage()
///   EXPRESSION over EXPRESSION their ratio; a plain number is an expression too
/// and `{{date}}`, `{{machine}}`, `{{commit}}` for where and when it was measured.
struct BenchPage {
  std::vector<BenchStage> stages;
  std::string text;
};

/// The measured numbers by stage and name: one value for each turn.
using StageNumbers = std::map<std::string, std::map<std::string, std::vector<double>>>;

/// The words of a line between blanks; a quoted word may contain blanks.
std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream stream(line);
  for (std::string word; stream >> std::quoted(word, '\'');) words.push_back(word);
  return words;
}

/// Reads "NAME xTURNS: WORDS".
BenchStage stage_of(const std::string& line) {
  const size_t colon = line.find(": ");
  const std::vector<std::string> head = words_of(line.substr(0, colon));
  const bool has_turns = head.size() == 2 && head[1].starts_with('x');
  const auto turns = has_turns ? parsed<int>(head[1].substr(1)) : std::nullopt;
  if (colon == std::string::npos || !turns || *turns < 1 || !is_plain(head[0], "_-"))
    throw PageError("'" + line + "': expected NAME xTURNS: WORDS");
  const std::vector<std::string> words = words_of(line.substr(colon + 2));
  if (words.empty()) throw PageError("'" + line + "': has no command");
  return {head[0], *turns, words.front() == "beside" ? std::vector<std::string>() : words};
}

/// Throws PageError: no stages, a stage that cannot be read, a {{ without its }}.
BenchPage read_bench_page(std::string_view file) {
  const std::string_view begin = "<!--\n", end = "-->\n";
  const size_t close = file.find(end);
  if (!file.starts_with(begin) || close == std::string_view::npos)
    throw PageError("does not begin with its stages");
  BenchPage page;
  for (const std::string& line : split(file.substr(begin.size(), close - begin.size()), '\n'))
    if (!words_of(line).empty()) page.stages.push_back(stage_of(line));
  if (page.stages.empty()) throw PageError("has no stages");
  page.text = file.substr(close + end.size());
  try {
    page::filled(page.text, [](const std::string&) { return ""; });
  } catch (const std::logic_error& error) {
    throw PageError(error.what());
  }
  return page;
}

fs::path folder_of(const BenchStage& stage, int turn) {
  return fs::path(stage.name) / std::to_string(turn);
}

/// The stage's command as the page shows it, to be run where the page was.
std::string command_of(const BenchStage& stage) {
  if (stage.words.empty()) return "another program, by turns";
  std::vector<std::string> words = stage.words;
  words.insert(words.begin(), "ballast");
  words.insert(words.end(), {"--output", folder_of(stage, 1).string()});
  return '`' + shell_line(words) + '`';
}

/// Ratios below 10 get two decimals, numbers from 1000 on none, all others three digits.
std::string shown(double value, bool is_ratio) {
  if (std::abs(value) >= 1000.0) return printed("%.0f", value);
  return printed(is_ratio && value < 10.0 ? "%.2f" : "%.3g", value);
}

/// The value of an expression. NaN: not measured.
double value_of(const std::string& expression, const StageNumbers& numbers) {
  if (const size_t over = expression.rfind(" over "); over != std::string::npos)
    return value_of(expression.substr(0, over), numbers) /
           value_of(expression.substr(over + 6), numbers);
  if (const auto number = parsed<double>(expression)) return *number;
  const size_t colon = expression.find(": ");
  if (colon == std::string::npos) throw PageError("{{" + expression + "}} is no number");
  const std::string stage = expression.substr(0, colon), name = expression.substr(colon + 2);
  const auto measured = numbers.find(stage);
  if (measured == numbers.end()) return not_known;  // for another program, and none is given
  const auto values = measured->second.find(name);
  if (values == measured->second.end()) throw PageError(stage + " measures no '" + name + "'");
  return quantile(values->second, 0.5);
}

/// Adds the numbers of a comparison. `beside` names the geometric mean over cases of a solver's
/// time over that of the fastest other, both `shift` [s] longer.
void add_comparison(std::span<const CompareRow> rows, double shift, const char* beside,
                    std::map<std::string, double>& numbers) {
  const double unsolved = std::log(limit_of(rows) + shift) - 1e-12;
  for (const TriedCases& tried : tried_cases(rows, shift)) {
    const Eigen::MatrixXd& times = tried.log_seconds;
    if (times.rows() == 0) continue;
    const char* const start = tried.start == StartKind::warm ? " warm" : "";
    for (Eigen::Index s = 0; s < times.cols(); ++s) {
      const std::string name = tried.solvers[s] + start + printed(" to %g, ", tried.tolerance);
      const auto is_solved = (times.col(s).array() < unsolved).cast<double>();
      numbers[name + "solved"] = 100.0 * is_solved.mean();
      numbers[name + "cases solved"] = is_solved.sum();
      if (times.cols() == 1) continue;
      Eigen::MatrixXd others = times;
      others.col(s).setConstant(HUGE_VAL);
      numbers[name + beside] = std::exp((times.col(s) - others.rowwise().minCoeff()).mean());
    }
  }
}

constexpr const char* other_program = "milliseconds.txt";

void run_beside(const BenchAll& options, const fs::path& folder) {
  const std::string& command = options.beside;
  const ProgramResult result =
      run_program("/bin/sh", {"-c", "cd \"$0\" && " + command, options.caller.string()},
                  /*seconds=*/3600.0);
  const std::vector<std::string> words = words_of(result.output);
  const auto number = words.empty() ? std::nullopt : parsed<double>(words.back());
  if (!result.succeeded() || !number)
    throw Error("bench all: '" + command + "' failed, or its last word is no number" +
                (result.errors.empty() ? "" : ": " + one_line(result.errors, ' ')));
  write_whole_file(folder / other_program, printed("%.17g\n", *number));
}

/// The numbers in the folder of a stage, by name: medians of a bench's measurements ("1 thread,
/// all/step"), numbers of a run's summary ("drive_seconds"), and of a comparison "auto to 0.0001,
/// solved" [%], "auto to 0.0001, cases solved" and "auto to 0.0001, beside the others", the
/// geometric mean over cases of its time over the fastest other backend's, both 10 us longer, or
/// "as measured"; from warm starts "auto warm to 0.0001, solved" and so on. Throws Error.
std::map<std::string, double> read_stage(const BenchStage& stage, const fs::path& folder) {
  std::map<std::string, double> numbers;
  if (stage.words.empty()) {
    const fs::path file = folder / other_program;
    const std::vector<std::string> words = words_of(read_whole_file(file));
    const auto number = words.empty() ? std::nullopt : parsed<double>(words[0]);
    if (!number) throw Error(file.string() + ": expected a number of milliseconds");
    numbers["step"] = *number;
  } else if (stage.words[0] == "bench") {
    for (const Measurement& m :
         read_bench_result(folder / (stage.words.at(1) + ".json")).measurements)
      numbers[m.full_name()] = m.median;
  } else if (stage.words[0] == "run") {
    numbers = Manifest::read(folder / "manifest.json").summary_numbers();
  } else if (stage.words.size() > 1 && stage.words[1] != "collect" && stage.words[1] != "--live") {
    const std::vector<CompareRow> rows = read_comparison(folder).rows;
    add_comparison(rows, 1e-5, "beside the others", numbers);
    add_comparison(rows, 0.0, "beside the others, as measured", numbers);
  }
  return numbers;
}

/// Runs one turn of a stage that this program has not run yet. False: interrupted.
bool run_stage(const BenchStage& stage, const BenchAll& options, int turn) {
  const fs::path folder = folder_of(stage, turn), mark = folder / "measured_by";
  const std::string key =
      content_key(binary_key() + (stage.words.empty() ? options.beside : "") + command_of(stage)) +
      "\n";
  if (path_exists(mark)) {
    if (read_whole_file(mark) == key) return true;
    fs::remove_all(folder);  // made by another program or command
  }
  std::cout << folder.string() << ": " << command_of(stage) << std::endl;
  create_folder(folder);
  if (stage.words.empty()) {
    run_beside(options, folder);
  } else {
    std::vector<std::string> words = stage.words;
    words.insert(words.end(), {"--output", folder.string()});
    const fs::path log = fs::path(stage.name) / printed("%d.log", turn);
    const auto child = start_program(executable_path(), words, log);
    bool is_told = false;  // once: a second signal would end it before its checkpoint
    while (!child->ends_within(0.2))
      if (InterruptGuard::requested() && !std::exchange(is_told, true)) child->send(SIGTERM);
    if (InterruptGuard::requested()) return false;
    if (child->status() != 0)
      throw Error("bench all: " + stage.name + " failed: " + last_line(log) + " (" + log.string() +
                  ")");
  }
  write_whole_file(mark, key);
  return true;
}

/// Whether the stage is this program's, or another one's that is given.
bool is_asked(const BenchStage& stage, const BenchAll& options) {
  return !stage.words.empty() || !options.beside.empty();
}

/// The numbers of the turns that have been measured.
StageNumbers numbers_of(const BenchPage& page, const BenchAll& options) {
  StageNumbers all;
  for (const BenchStage& stage : page.stages)
    for (int turn = 1; turn <= stage.turns && is_asked(stage, options); ++turn)
      if (const fs::path folder = folder_of(stage, turn); path_exists(folder / "measured_by"))
        for (const auto& [name, value] : read_stage(stage, folder))
          all[stage.name][name].push_back(value);
  return all;
}

/// The text of every number of the page, by the words between {{ and }}. Throws Error naming an
/// expression that cannot be read.
std::map<std::string, std::string> page_numbers(const BenchPage& page,
                                                const StageNumbers& numbers) {
  const Manifest here("bench all", process_arguments(), "");
  std::map<std::string, std::string> result{{"date", here.started().substr(0, 10)},
                                            {"machine", here.machine()},
                                            {"commit", here.commit()}};
  page::filled(page.text, [&](const std::string& words) {
    const bool is_known =
        result.contains(words) ||
        std::ranges::find(page.stages, words, &BenchStage::name) != page.stages.end();
    if (is_known) return "";
    const double value = value_of(words, numbers);
    if (!std::isnan(value))
      result[words] = shown(value, words.find(" over ") != std::string::npos ||
                                       words.find("beside the others") != std::string::npos);
    return "";
  });
  return result;
}

/// The page with numbers and commands filled in; "–" for a missing number.
std::string filled_page(const BenchPage& page, const std::map<std::string, std::string>& numbers) {
  return page::filled(page.text, [&](const std::string& words) -> std::string {
    const auto stage = std::ranges::find(page.stages, words, &BenchStage::name);
    if (stage != page.stages.end()) return command_of(*stage);
    const auto number = numbers.find(words);
    return number == numbers.end() ? "–" : number->second;
  });
}

std::map<std::string, std::string> read_rows(const fs::path& file) {
  std::map<std::string, std::string> numbers;
  CsvReader rows(file);
  for (rows.next(); rows.next();) {
    rows.require_cells(2);
    numbers[rows.cells()[0]] = rows.cells()[1];
  }
  return numbers;
}

void write_page(const BenchPage& page, const std::map<std::string, std::string>& numbers) {
  CsvWriter rows;
  rows.add_row(std::vector<std::string>{"number", "value"});
  for (const auto& [name, value] : numbers) rows.add_row(std::vector<std::string>{name, value});
  write_whole_file("measured/numbers.csv", rows.take());
  write_whole_file("results.md", filled_page(page, numbers));
  for (const BenchStage& stage : page.stages)
    if (const fs::path figure = folder_of(stage, 1) / "figures/live_accuracy.svg";
        path_exists(figure))
      write_whole_file("measured/work_precision.svg", read_whole_file(figure));
}

void measure_page(const BenchAll& options, std::string_view text) {
  const BenchPage page = read_bench_page(text);
  std::map<std::string, std::string> kept;
  if (!options.rows.empty()) kept = read_rows(options.rows);
  require_own_folder(options.output, {"measured", "packings"});
  create_folder(options.output / "measured");
  fs::current_path(options.output);
  if (!options.rows.empty()) return write_page(page, kept);
  const InterruptGuard guard;
  const int most = std::ranges::max(page.stages, {}, &BenchStage::turns).turns;
  for (int turn = 1; turn <= most; ++turn)
    for (const BenchStage& stage : page.stages) {
      if (turn > stage.turns || !is_asked(stage, options)) continue;
      if (!run_stage(stage, options, turn))
        throw Error("bench all: interrupted; the same command goes on");
    }
  write_page(page, page_numbers(page, numbers_of(page, options)));
}

}  // namespace

ExitCode bench_all(const BenchAll& options) {
  const bool is_own = !options.page.empty();
  try {
    measure_page(options, is_own ? read_whole_file(options.page) : bench_page_text());
  } catch (const PageError& error) {
    throw Error((is_own ? options.page.string() : "results.md") + ": " + error.what());
  }
  std::cout << "results in " << options.output.string() << ": results.md, measured/" << std::endl;
  return ExitCode::ok;
}

}  // namespace ballast
