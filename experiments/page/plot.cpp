#include "experiments/page/plot.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// gnuplot points at its complaint with a line of "^": the sentence is the last line that says
/// something.
std::string last_line(const std::string& errors) {
  std::string line, last;
  for (const char c : errors + '\n') {
    if (c != '\n') {
      line += c;
      continue;
    }
    if (line.find_first_not_of(" ^\t\r") != std::string::npos) last = line;
    line.clear();
  }
  return last.empty() ? "no message" : last.substr(0, 300);
}

std::string why(const ProgramResult& child, double seconds) {
  if (!child.was_found) return "gnuplot cannot be started: " + child.errors;
  if (child.timed_out)
    return "gnuplot was ended after " + std::to_string(std::lround(seconds)) + " s";
  return "gnuplot failed (" + std::to_string(child.status) + "): " + last_line(child.errors);
}

/// Writes the script into `commands` and what gnuplot makes of it into `target`, and returns that.
/// `last`: without it the picture is incomplete.
std::string render(const Figure& figure, PlotFormat format, const fs::path& target,
                   const fs::path& commands, const char* last, double seconds) {
  const std::string name = "figure " + figure.name + ": ";
  std::error_code ignored;
  fs::remove(target, ignored);
  std::string script;
  try {
    script = gnuplot_script(figure, format);
  } catch (const std::invalid_argument& error) {
    throw Error(name + error.what());
  }
  create_folder(fs::absolute(target).parent_path());
  write_whole_file(commands, script);
  // absolute: a name beginning with "-" or "<" would mean something to gnuplot
  ProgramResult child = run_program("gnuplot", {"-d", fs::absolute(commands).string()}, seconds);
  if (!child.succeeded()) throw Error(name + why(child, seconds));
  if (child.output.find(last) == std::string::npos)
    throw Error(name + "gnuplot's " + (format == PlotFormat::pdf ? "PDF" : "SVG") +
                " is incomplete");
  write_whole_file(target, child.output);
  return std::move(child.output);
}

}  // namespace

std::string gnuplot_version() {
  const ProgramResult child = run_program("gnuplot", {"--version"}, 10.0);
  return child.succeeded() ? child.output.substr(0, child.output.find('\n')) : std::string();
}

void render_pdf(const Figure& figure, const fs::path& folder, double seconds) {
  const fs::path pdf = folder / (figure.name + ".pdf"), commands = pdf.string() + ".gnuplot";
  render(figure, PlotFormat::pdf, pdf, commands, "%%EOF", seconds);
  std::error_code ignored;
  fs::remove(commands, ignored);
}

std::string render_svg(const Figure& figure, const fs::path& folder, double seconds) {
  return render(figure, PlotFormat::svg, folder / (figure.name + ".svg"),
                folder / (figure.name + ".gnuplot"), "</svg>", seconds);
}

void thin_out(std::vector<double>& x, std::vector<double>& y, size_t limit) {
  const size_t count = std::min(x.size(), y.size());
  if (count <= limit || limit < 4) return;
  const size_t stretches = limit / 2;
  std::vector<double> thin_x, thin_y;
  const auto keep = [&](size_t k) {
    thin_x.push_back(x[k]);
    thin_y.push_back(y[k]);
  };
  for (size_t s = 0; s < stretches; ++s) {
    const size_t begin = s * count / stretches, end = (s + 1) * count / stretches;
    size_t least = end, most = end;
    for (size_t k = begin; k < end; ++k) {
      if (!std::isfinite(y[k])) continue;
      if (least == end || y[k] < y[least]) least = k;
      if (most == end || y[k] > y[most]) most = k;
    }
    if (least == end) {
      keep(begin);
      continue;
    }
    keep(std::min(least, most));
    if (least != most) keep(std::max(least, most));
  }
  x = std::move(thin_x);
  y = std::move(thin_y);
}

}  // namespace ballast
