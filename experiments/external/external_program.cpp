#include "experiments/external/external_program.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <new>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <stdlib.h>

#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/hdf5_file.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "problems/files/problem_file.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {

namespace fs = std::filesystem;
namespace {

const std::string asked = "/ballast_request/", answered = "/ballast_answer/";

template <typename Number>
void add_number(Hdf5Writer& file, const std::string& name, Number value) {
  file.add(name, std::vector{value});
}

double read_number(const Hdf5Reader& file, const std::string& name, bool may_be_infinite = false) {
  const double value = file.read<double>(name, 1)[0];
  if (std::isnan(value) || (!may_be_infinite && std::isinf(value)))
    file.fail(name + " is not finite");
  return value;
}

/// Returns `otherwise` where the number is not there or not finite.
double optional_number(const Hdf5Reader& file, const std::string& name, double otherwise) {
  const double value = file.has(name) ? file.read<double>(name, 1)[0] : otherwise;
  return std::isfinite(value) ? value : otherwise;
}

void require_protocol(const Hdf5Reader& file, const std::string& group) {
  if (const int version = file.read_int(group + "protocol"); version != external_protocol)
    file.fail(group + "protocol = " + std::to_string(version) + ", this program speaks " +
              std::to_string(external_protocol));
}

std::vector<HistoryPoint> read_history(const Hdf5Reader& file) {
  constexpr std::size_t most_points = 1'000'000;
  const std::string name = answered + "history";
  std::vector<HistoryPoint> history;
  if (!file.has(name)) return history;
  const auto shape = file.shape(name);
  if (shape.size() == 2 && shape[1] != 3)
    file.fail(printed("%s is %zu x %zu, must be points x 3: iteration, seconds, error",
                      name.c_str(), std::size_t{shape[0]}, std::size_t{shape[1]}));
  std::size_t entries = 1;
  for (const auto extent : shape) entries *= extent;
  if (entries % 3 != 0 || entries > 3 * most_points)
    file.fail(
        name + " has " + std::to_string(entries) +
        " entries, must have three per point (iteration, seconds, error) of a million at most");
  const std::vector<double> values = file.read<double>(name);
  for (std::size_t k = 0; k + 2 < values.size(); k += 3) {
    if (!Vec3(&values[k]).allFinite()) continue;
    if (!(values[k] >= 0.0 && values[k] < 2e9) || !(values[k + 1] >= 0.0))
      file.fail(name + ": point " + std::to_string(k / 3) + " is no iteration, time and error");
    history.push_back({static_cast<int>(values[k]), values[k + 1], values[k + 2]});
  }
  return history;
}

/// A path that is removed with this object, with everything under it.
struct PassingPath {
  explicit PassingPath(fs::path passing) : path(std::move(passing)) {}
  PassingPath(const PassingPath&) = delete;
  ~PassingPath() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  const fs::path path;
};

/// Makes a folder of our own, in TMPDIR if that is set: in memory, files cost no wait for a disk.
fs::path make_work_folder() {
  const char* wanted = std::getenv("TMPDIR");
  const fs::path folder = fs::absolute(wanted && *wanted ? wanted : "/tmp");
  std::string name = folder / "ballast-XXXXXX";
  if (!mkdtemp(name.data())) throw Error(name + ": cannot be made: " + std::strerror(errno));
  return name;
}

/// One program; the requests to it are numbered.
class ExternalProgram {
 public:
  ExternalProgram(ExternalCommand command, const ExternalLimits& limits)
      : command_(std::move(command)), limits_(limits) {}

  ExternalAnswer ask(ExternalRequest& request) {
    const std::string number = std::to_string(++count_);
    const PassingPath problem(folder_.path / ("problem" + number + ".hdf5")),
        answer(folder_.path / ("answer" + number + ".hdf5"));
    request.id = count_;
    if (command_.is_served) see_to_served();
    write_request(problem.path, request);
    // Methods look at the clock between iterations: there is some grace before it is killed.
    const double seconds = 1.25 * request.max_seconds + 2.0;
    if (command_.is_served)
      tell(problem.path, answer.path, seconds);
    else
      start(problem.path, answer.path, seconds + limits_.startup_seconds);
    ExternalAnswer given = answer_in(answer.path, request);
    if (given.status == ExternalAnswer::unsupported)
      throw UnsupportedProblem(command_.name + ": says that it cannot take the problem");
    if (given.status == ExternalAnswer::out_of_memory) throw std::bad_alloc();
    if (!given.is_solution()) throw Error(command_.name + ": says that it failed");
    return given;
  }

 private:
  [[noreturn]] void lost(const SupervisedProgram& program) const {
    const int status = program.status();
    std::string how =
        status > 128 ? printed("signal %d", status - 128) : printed("exit code %d", status);
    if (const std::string words = program.last_words(); !words.empty()) how += ": " + words;
    throw LostProcess(command_.name + ": the program ended with " + how, false);
  }
  [[noreturn]] void late(double seconds) const {
    throw LostProcess(
        printed("%s: killed: no answer within %.3g s", command_.name.c_str(), seconds), true);
  }
  SupervisedLimits limits_of_program() const { return {limits_.memory_MB, command_.folder}; }

  /// Starts one process for one problem.
  void start(const fs::path& problem, const fs::path& answer, double seconds) const {
    SupervisedProgram program(command_.command, {problem, answer}, limits_of_program());
    program.close_input();
    if (!program.wait(seconds)) late(seconds);
    if (program.status() != 0) lost(program);
  }

  /// Starts the process that is kept, unless it runs, and waits until it is ready.
  void see_to_served() {
    if (served_) return;
    served_ = std::make_unique<SupervisedProgram>(
        command_.command, std::vector<std::string>{"--serve"}, limits_of_program());
    const std::string said = await("ready", limits_.startup_seconds);
    if (said == "ready") return;
    served_.reset();
    throw Error(command_.name + ": " + said);
  }

  /// Tells it one problem and waits for its reply.
  void tell(const fs::path& problem, const fs::path& answer, double seconds) {
    served_->write_line(problem.string() + '\t' + answer.string());
    const std::string reply = await("done", seconds);
    if (reply != "done") throw Error(command_.name + ": " + reply);
  }

  /// Returns the next line that is this word or begins with "failed"; ignores other lines.
  std::string await(const std::string& word, double seconds) {
    const Stopwatch watch;
    for (std::string line;;) {
      const double left = seconds - watch.seconds();
      const auto heard = served_->read_line(line, left);
      if (heard == SupervisedProgram::Heard::line) {
        if (line == word || line.starts_with("failed")) return line;
        if (left > 0.0) continue;
      }
      // The next request starts a new process.
      const std::unique_ptr<SupervisedProgram> gone = std::move(served_);
      if (heard != SupervisedProgram::Heard::end || !gone->wait(1.0)) late(seconds);
      lost(*gone);
    }
  }

  ExternalAnswer answer_in(const fs::path& file, const ExternalRequest& request) const {
    try {
      return read_answer(file, request);
    } catch (const Error& error) {
      // The message leaves out the folder, which is removed.
      std::string words = error.what();
      if (words.starts_with(file.string()))
        words = file.filename().string() + words.substr(file.string().size());
      throw Error(command_.name + ": " + words);
    }
  }

  const ExternalCommand command_;
  const ExternalLimits limits_;
  const PassingPath folder_{make_work_folder()};
  int count_ = 0;
  std::unique_ptr<SupervisedProgram> served_;
};

class ExternalSolver final : public Solver {
 public:
  explicit ExternalSolver(std::shared_ptr<ExternalProgram> program)
      : program_(std::move(program)) {}

  void prepare(const FrictionProblem&) override {}

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    const Stopwatch watch;
    ExternalRequest request{.problem = problem,
                            .start = start,
                            .tolerance = budget.tolerance,
                            .fclib_tolerance = budget.fclib ? budget.fclib->tolerance() : 0.0,
                            .max_iterations = budget.max_iterations,
                            .max_seconds = budget.max_seconds};
    ExternalAnswer answer = program_->ask(request);
    Solved solved = std::move(answer.solved);
    solved.reason = static_cast<StopReason>(answer.status);
    if (!budget.keep_history) solved.history.clear();
    // The program's own time is used only where it does not exceed ours.
    const double all = watch.seconds();
    if (answer.seconds >= 0.0 && answer.seconds <= all)
      solved.startup_seconds = all - answer.seconds;
    return solved;
  }

 private:
  const std::shared_ptr<ExternalProgram> program_;
};

// The programs that solve: words of the command line, and lists in TOML.

/// Commands of a list start in the folder of the list.
std::vector<ExternalCommand> read_list(const fs::path& file) {
  const toml::table content = load_toml(file);
  toml::table resolved;
  TomlTable list(file.string(), content, resolved);
  std::vector<ExternalCommand> commands;
  const fs::path folder = fs::absolute(file).parent_path();
  for (TomlTable& entry : list.sections("external")) {
    ExternalCommand& command = commands.emplace_back();
    command.name = entry.text("name");
    command.command = entry.text("command");
    entry.read("serve", &command.is_served);
    command.folder = folder.string();
    entry.finish();
  }
  list.finish();
  if (commands.empty())
    throw std::invalid_argument(file.string() + ": has no [[external]] with name and command");
  return commands;
}

}  // namespace

void write_request(const std::filesystem::path& path, const ExternalRequest& request) {
  const auto add = [&](Hdf5Writer& file) {
    file.add_group("/ballast_request");
    add_number(file, asked + "protocol", external_protocol);
    add_number(file, asked + "id", request.id);
    add_number(file, asked + "tolerance", request.tolerance);
    add_number(file, asked + "fclib_tolerance", request.fclib_tolerance);
    add_number(file, asked + "max_iterations", request.max_iterations);
    add_number(file, asked + "max_seconds", request.max_seconds);
    file.add(asked + "start", as_vector(three_rows(request.problem, request.start)));
  };
  write_problem(path, request.problem, StoredForms::both, add);
}

ExternalRequest read_request(const std::filesystem::path& path) {
  ExternalRequest request;
  const Hdf5Reader file(path);
  if (!file.has("/ballast_request")) file.fail("has no group /ballast_request: is no request");
  require_protocol(file, asked);
  request.problem = read_problem(path);
  request.id = file.read_int(asked + "id");
  request.tolerance = read_number(file, asked + "tolerance");
  request.fclib_tolerance = read_number(file, asked + "fclib_tolerance");
  request.max_iterations = file.read_int(asked + "max_iterations");
  request.max_seconds = read_number(file, asked + "max_seconds", true);
  request.start = read_impulses(file, asked + "start", request.problem);
  return request;
}

void write_answer(const std::filesystem::path& path, const ExternalRequest& request,
                  const ExternalAnswer& answer) {
  Hdf5Writer file(path, Hdf5Storage::plain);
  file.add_group("/ballast_answer");
  add_number(file, answered + "protocol", external_protocol);
  add_number(file, answered + "id", request.id);
  add_number(file, answered + "status", answer.status);
  add_number(file, answered + "iterations", answer.solved.iterations);
  add_number(file, answered + "residual", answer.solved.own_residual);
  add_number(file, answered + "seconds", answer.seconds);
  if (answer.solved.impulses.size() == request.problem.row_count())
    file.add(answered + "r", as_vector(three_rows(request.problem, answer.solved.impulses)));
  std::vector<double> history;
  for (const HistoryPoint& point : answer.solved.history)
    history.insert(history.end(),
                   {static_cast<double>(point.iteration), point.seconds, point.error});
  file.add(answered + "history", history);
  file.commit();
}

ExternalAnswer read_answer(const std::filesystem::path& path, const ExternalRequest& request) {
  const Hdf5Reader file(path);
  require_protocol(file, answered);
  if (const int id = file.read_int(answered + "id"); id != request.id)
    file.fail(answered + "id = " + std::to_string(id) + ", the request's is " +
              std::to_string(request.id) + ": this answers another problem");
  ExternalAnswer answer;
  const double status = file.read<double>(answered + "status", 1)[0];
  if (!(status >= 0.0 && status <= ExternalAnswer::out_of_memory))
    file.fail(answered + printed("status = %g, expected 0 to %d", status,
                                 static_cast<int>(ExternalAnswer::out_of_memory)));
  answer.status = static_cast<int>(status);
  if (!answer.is_solution()) return answer;
  Solved& solved = answer.solved;
  solved.impulses = read_impulses(file, answered + "r", request.problem);
  // The other entries are optional.
  const double iterations = optional_number(file, answered + "iterations", 0.0);
  if (iterations < 0.0) file.fail(answered + "iterations is negative");
  solved.iterations = static_cast<int>(std::min<double>(iterations, request.max_iterations));
  solved.own_residual = optional_number(file, answered + "residual", 0.0);
  answer.seconds = optional_number(file, answered + "seconds", -1.0);
  solved.history = read_history(file);
  return answer;
}

MakeSolver external_solver(const ExternalCommand& command, const ExternalLimits& limits) {
  // A program that is not asked makes no folder.
  const auto shared = std::make_shared<std::shared_ptr<ExternalProgram>>();
  return [shared, command, limits]() -> std::unique_ptr<Solver> {
    if (!*shared) *shared = std::make_shared<ExternalProgram>(command, limits);
    return std::make_unique<ExternalSolver>(*shared);
  };
}

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
  std::istringstream words(command.command);
  for (std::string word; words >> word;) {
    std::erase_if(word, [](char c) { return c == '\'' || c == '"'; });
    const fs::path file = fs::path(command.folder) / word;
    if (is_file(file)) known += '|' + content_key(read_whole_file(file));
  }
  return content_key(known);
}

}  // namespace ballast
