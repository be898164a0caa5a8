#include "experiments/external/external_files.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "platform/hdf5_file.hpp"
#include "platform/text.hpp"
#include "problems/files/problem_file.hpp"

namespace ballast {
namespace {

const std::string asked = "/ballast_request/", answered = "/ballast_answer/";

void add_number(Hdf5Writer& file, const std::string& name, double value) {
  file.add(name, std::vector<double>{value});
}
void add_number(Hdf5Writer& file, const std::string& name, int value) {
  file.add(name, std::vector<int>{value});
}

double read_number(const Hdf5Reader& file, const std::string& name, bool may_be_infinite = false) {
  const std::vector<double> values = file.read_doubles(name);
  if (values.size() != 1)
    file.fail(name + " has " + std::to_string(values.size()) + " entries, must have 1");
  if (std::isnan(values[0]) || (!may_be_infinite && std::isinf(values[0])))
    file.fail(name + " is not finite");
  return values[0];
}

/// Three per contact.
std::vector<double> read_impulses(const Hdf5Reader& file, const std::string& name, int contacts) {
  std::vector<double> values = file.read_doubles(name);
  if (values.size() != 3 * static_cast<std::size_t>(contacts))
    file.fail(name + " has " + std::to_string(values.size()) + " entries, " +
              std::to_string(contacts) + " contacts have " + std::to_string(3 * contacts));
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i])) file.fail(name + "[" + std::to_string(i) + "] is not finite");
  return values;
}

void require_protocol(const Hdf5Reader& file, const std::string& group) {
  if (const int version = file.read_int(group + "protocol"); version != external_protocol)
    file.fail(group + "protocol = " + std::to_string(version) + ", this program speaks " +
              std::to_string(external_protocol));
}

std::vector<HistoryPoint> read_history(const Hdf5Reader& file) {
  const std::string name = answered + "history";
  std::vector<HistoryPoint> history;
  if (!file.has(name)) return history;
  const std::vector<double> values = file.read_doubles(name);
  if (values.size() % 3 != 0)
    file.fail(name + " has " + std::to_string(values.size()) +
              " entries, must have three per point: iteration, seconds, error");
  for (std::size_t k = 0; k + 2 < values.size(); k += 3) {
    if (!(values[k] >= 0.0 && values[k] < 2e9) || !(values[k + 1] >= 0.0) ||
        std::isnan(values[k + 2]))
      file.fail(name + ": point " + std::to_string(k / 3) + " is no iteration, time and error");
    history.push_back({static_cast<int>(values[k]), values[k + 1], values[k + 2]});
  }
  return history;
}

constexpr int unsupported_status = 5, no_memory_status = 6;

}  // namespace

int ExternalAnswer::status() const {
  if (verdict == Verdict::unsupported) return unsupported_status;
  if (verdict == Verdict::out_of_memory) return no_memory_status;
  return static_cast<int>(reason);
}

bool ExternalAnswer::set_status(int status) {
  if (status < 0 || status > no_memory_status) return false;
  if (status == unsupported_status)
    verdict = Verdict::unsupported;
  else if (status == no_memory_status)
    verdict = Verdict::out_of_memory;
  else
    reason = static_cast<StopReason>(status);
  return true;
}

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
  request.start =
      own_rows(request.problem,
               as_eigen(read_impulses(file, asked + "start", request.problem.contact_count())));
  return request;
}

void write_answer(const std::filesystem::path& path, const ExternalRequest& request,
                  const ExternalAnswer& answer) {
  Hdf5Writer file(path, Hdf5Storage::plain);
  file.add_group("/ballast_answer");
  add_number(file, answered + "protocol", external_protocol);
  add_number(file, answered + "id", request.id);
  add_number(file, answered + "status", answer.status());
  add_number(file, answered + "iterations", answer.iterations);
  add_number(file, answered + "residual", answer.own_residual);
  add_number(file, answered + "seconds", answer.seconds);
  if (answer.impulses.size() == request.problem.row_count())
    file.add(answered + "r", as_vector(three_rows(request.problem, answer.impulses)));
  std::vector<double> history;
  for (const HistoryPoint& point : answer.history)
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
  const int status = file.read_int(answered + "status");
  if (!answer.set_status(status))
    file.fail(answered + "status = " + std::to_string(status) + ", expected 0 to " +
              std::to_string(no_memory_status));
  if (answer.reason == StopReason::numerical_failure) return answer;
  answer.impulses =
      own_rows(request.problem,
               as_eigen(read_impulses(file, answered + "r", request.problem.contact_count())));
  // What need not be there.
  if (file.has(answered + "iterations")) answer.iterations = file.read_int(answered + "iterations");
  if (file.has(answered + "residual"))
    answer.own_residual = read_number(file, answered + "residual", true);
  if (file.has(answered + "seconds")) answer.seconds = read_number(file, answered + "seconds");
  answer.history = read_history(file);
  return answer;
}

}  // namespace ballast
