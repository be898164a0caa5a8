#include "experiments/page/plot.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// Margins to the left and right of the panels' boxes [pixels].
constexpr double left_margin = 98.0, right_margin = 22.0;

/// The range that an axis must show.
struct Extent {
  bool is_log = false;
  double low = 1e300, high = -1e300;

  /// Extends the range by a value that the axis can show: finite, and positive if logarithmic.
  void add(double value) {
    if (!std::isfinite(value) || (is_log && value <= 0.0)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool is_empty() const { return low > high; }
  /// Extends the range by `margin` times its span to both sides.
  void pad(double margin) {
    if (is_log) {
      // a constant gets a factor of two to both sides
      const double more = high > low ? margin * std::log(high / low) : std::log(2.0);
      low *= std::exp(-more);
      high *= std::exp(more);
      return;
    }
    // a constant gets room above and below; so do values that agree in all digits of an axis
    const double size = std::max(std::abs(low), std::abs(high));
    const bool is_constant = high - low <= std::max(1e-6 * size, 1e-100);
    const double span = is_constant ? std::max(size * 0.1, 1e-9) : high - low;
    if (is_constant) {
      low -= 0.5 * span;
      high += 0.5 * span;
    }
    low -= margin * span;
    high += margin * span;
  }
};

/// The ticks at 1 to 9 times every power of ten within the extent, drawn without numbers.
std::vector<double> minor_log_ticks(const Extent& extent) {
  std::vector<double> ticks;
  for (double decade = std::floor(std::log10(extent.low)); std::pow(10.0, decade) < extent.high;
       ++decade)
    for (int digit = 1; digit < 10; ++digit) {
      const double tick = digit * std::pow(10.0, decade);
      if (tick >= extent.low * (1.0 - 1e-9) && tick <= extent.high * (1.0 + 1e-9))
        ticks.push_back(tick);
    }
  return ticks;
}

/// The extent of all curves, error bars and reference lines of a panel, padded; the panel's own
/// limits replace it where given. Throws std::invalid_argument when there is nothing to show.
Extent y_extent(const Panel& panel) {
  Extent extent{panel.log_y};
  for (const Curve& curve : panel.curves)
    for (size_t k = 0; k < curve.y.size(); ++k) {
      if (!std::isfinite(curve.x[k])) continue;
      const double bar = curve.y_error.empty() ? 0.0 : curve.y_error[k];
      extent.add(curve.y[k] - bar);
      extent.add(curve.y[k] + bar);
      if (!curve.y_low.empty()) extent.add(curve.y_low[k]);
    }
  if (extent.is_empty())
    throw std::invalid_argument("nothing to draw for " + plain_words(panel.y_label));
  for (const ReferenceLine& line : panel.lines)
    if (!line.vertical) extent.add(line.value);
  extent.pad(0.06);
  if (panel.y_min) extent.low = *panel.y_min;
  if (panel.y_max) extent.high = *panel.y_max;
  return extent;
}

Extent x_extent(const Panel& panel) {
  Extent extent{panel.log_x};
  for (const Curve& curve : panel.curves)
    for (double x : curve.x) extent.add(x);
  if (extent.is_empty())
    throw std::invalid_argument("nothing to draw along " + plain_words(panel.x_label));
  if (!panel.x_min || !panel.x_max) extent.pad(0.03);
  if (panel.x_min) extent.low = *panel.x_min;
  if (panel.x_max) extent.high = *panel.x_max;
  return extent;
}

/// A panel's part of the figure in gnuplot's units: shares of the height, counted from below. Keys
/// and labels lie within it.
struct PanelPlace {
  double origin, size;
  bool shows_x;  ///< numbers and label below the x axis
};

/// The places of the panels from the top down. There is room for numbers and x label below the last
/// panel, or below each when the x labels differ.
std::vector<PanelPlace> panel_places(const Figure& figure) {
  const std::vector<Panel>& panels = figure.panels;
  const bool is_shared = std::ranges::all_of(
      panels, [&](const Panel& panel) { return panel.x_label == panels[0].x_label; });
  const double labels = is_shared && panels.size() > 1 ? 44.0 / figure.height : 0.0,
               size = (1.0 - labels) / static_cast<double>(panels.size());
  std::vector<PanelPlace> places;
  for (double top = 1.0; places.size() + 1 < panels.size(); top -= size)
    places.push_back({top - size, size, !is_shared});
  places.push_back({0.0, size + labels, true});
  return places;
}

/// The text in gnuplot's enhanced notation, {/:Italic f}_{max}, in single quotes: there gnuplot
/// expands nothing, while in double quotes it would run commands between backquotes.
std::string quoted(const page::Text& text) {
  std::string label;
  for (const page::Span& span : text.spans) {
    std::string words;
    for (const char c : one_line(span.text, ' ')) {
      if (c == '\'') words += c;
      if (std::string_view("^_@&~{}\\").find(c) != std::string_view::npos) words += '\\';
      words += c;
    }
    if (span.styles & page::symbol) words = "{/:Italic " + words + '}';
    if (span.styles & page::strong) words = "{/:Bold " + words + '}';
    if (span.styles & page::subscript) words = "_{" + words + '}';
    if (span.styles & page::superscript) words = "^{" + words + '}';
    label += words;
  }
  return '\'' + label + '\'';
}

std::string script_number(double value) {
  return std::isfinite(value) ? printed("%.7g", value) : "NaN";
}

std::string plot_command(const std::string& block, const Curve& curve) {
  constexpr const char* dashes[] = {"", " dt (8,5)", " dt (4,3)", " dt (1.5,3)"};
  constexpr int shapes[] = {7, 9, 5, 13};  // gnuplot's numbers, in the order of MarkShape
  const int shape = shapes[static_cast<size_t>(curve.shape)];
  std::string text = block;
  const double transparency = 255.0 * (1.0 - std::clamp(curve.opacity, 0.0, 1.0));
  const std::string rgb = rgb_of(curve.ink) + 1,
                    ink = transparency < 0.5
                              ? "'#" + rgb + "'"
                              : printed("'#%02lx", std::lround(transparency)) + rgb + "'";
  if (curve.mark == Mark::area)
    text += " using 1:2:3 with filledcurves fs solid noborder fc rgb " + ink;
  else if (curve.mark == Mark::points)
    text += printed(" using %s pt %d ps %.3g lc rgb %s",
                    curve.y_error.empty() ? "1:2 with points" : "1:2:3 with yerrorbars", shape,
                    0.35 * curve.width, ink.c_str());
  else
    text += printed(" using 1:2 with %s lc rgb %s lw %.3g%s",
                    curve.mark == Mark::line ? "lines" : "linespoints pt 7 ps 0.6", ink.c_str(),
                    curve.width, dashes[std::clamp(curve.dash, 0, 3)]);
  return text + (curve.title.empty() ? " notitle" : " title " + quoted(curve.title));
}

std::string reference(const ReferenceLine& line) {
  const std::string v = script_number(line.value), ink = rgb_of(line.ink);
  std::string text = line.vertical
                         ? "set arrow from first " + v + ", graph 0 to first " + v + ", graph 1"
                         : "set arrow from graph 0, first " + v + " to graph 1, first " + v;
  text += " nohead front lw 1.2 dt (3,4) lc rgb '" + ink + "'\n";
  if (line.label.empty()) return text;
  text += "set label " + quoted(line.label) +
          (line.vertical ? " at first " + v + ", graph 0.95 left offset character 0.5, 0"
                         : " at graph 0.995, first " + v + " right offset character 0, 0.5");
  return text + " front font ',13' tc rgb '" + rgb_of(Ink::black) + "'\n";
}

/// The ticks of a logarithmic axis ('x' or 'y'): with numbers at `numbered`, small ones between. If
/// `numbered` is empty: numbers at 1, 2, 5 of every decade, from 3 decades on at powers of ten.
std::string log_axis(char axis, const Extent& extent, std::vector<double> numbered) {
  if (numbered.empty()) {
    numbered = minor_log_ticks(extent);
    // the first digit of a tick decides; over at most half a decade all ticks have numbers
    const double decades = std::log10(extent.high / extent.low);
    std::erase_if(numbered, [&](double tick) {
      const long digit = std::lround(tick / std::pow(10.0, std::floor(std::log10(tick * 1.0001))));
      return decades >= 3.0 ? digit != 1 : decades > 0.5 && digit != 1 && digit != 2 && digit != 5;
    });
  }
  std::string list;
  for (const double tick : numbered) add_to_list(list, script_number(tick));
  for (const double tick : minor_log_ticks(extent))
    add_to_list(list, "'' " + script_number(tick) + " 1");
  const bool has_powers_only = extent.high / extent.low >= 1e3;
  return printed("set logscale %c\nset format %c '%s'\nset %ctics (", axis, axis,
                 has_powers_only ? "10^{%L}" : "%g", axis) +
         list + ")\n";
}

std::string panel_commands(const Panel& panel, const PanelPlace& place, const std::string& blocks,
                           char letter) {
  const Extent x = x_extent(panel), y = y_extent(panel);
  std::string text =
      "unset arrow\nunset label\nunset logscale\nset format x '%g'\nset format y '%g'\n"
      "set bmargin -1\nset xtics autofreq\nset ytics autofreq\n";
  text += printed("set size 1,%.5f\nset origin 0,%.5f\n", place.size, place.origin);
  text += "set xrange [" + script_number(x.low) + ':' + script_number(x.high) + "]\nset yrange [" +
          script_number(y.low) + ':' + script_number(y.high) + "]\n";
  if (panel.log_x) text += log_axis('x', x, panel.x_ticks);
  if (panel.log_y) text += log_axis('y', y, {});
  text += "set tics font ',15'\n";
  text += place.shows_x ? "set xlabel " + quoted(panel.x_label) + " offset 0,0.3\n"
                        : "set xlabel ''\nset format x ''\nset bmargin 0.6\n";
  text += "set ylabel " + quoted(panel.y_label) + '\n';
  for (const ReferenceLine& line : panel.lines) text += reference(line);
  if (letter) text += printed("set label '(%c)' at graph 0, graph 1 left offset 0, 0.5\n", letter);
  std::string curves;
  for (size_t c = 0; c < panel.curves.size(); ++c)
    curves += (curves.empty() ? "" : ", \\\n     ") +
              plot_command(blocks + std::to_string(c), panel.curves[c]);
  return text + "plot " + curves + '\n';
}

std::string why(const ProgramResult& child, double seconds) {
  if (child.status == 127) return "gnuplot " + child.errors;  // "cannot be started: ..."
  if (child.timed_out)
    return "gnuplot was ended after " + std::to_string(std::lround(seconds)) + " s";
  return "gnuplot failed (" + std::to_string(child.status) +
         "): " + one_line(child.errors, ' ').substr(0, 500);
}

}  // namespace

const char* rgb_of(Ink ink) {
  // in the order of Ink
  constexpr const char* colours[] = {"#1a1a1a", "#0072b2", "#d55e00", "#009e73", "#e69f00",
                                     "#56b4e9", "#cc79a7", "#767676", "#b8b8b8"};
  return colours[static_cast<size_t>(ink)];
}

std::string gnuplot_script(const Figure& figure) {
  std::string text =
      "# " + figure.name + ": gnuplot " + figure.name + ".gnuplot > " + figure.name + ".svg\n";
  for (size_t p = 0; p < figure.panels.size(); ++p)
    for (size_t c = 0; c < figure.panels[p].curves.size(); ++c) {
      const Curve& curve = figure.panels[p].curves[c];
      text += printed("$p%zuc%zu << EOD\n", p, c);
      for (size_t k = 0; k < curve.x.size(); ++k) {
        text += script_number(curve.x[k]) + ' ' + script_number(curve.y[k]);
        for (const std::vector<double>* more : {&curve.y_low, &curve.y_error})
          if (!more->empty()) text += ' ' + script_number((*more)[k]);
        text += '\n';
      }
      text += "EOD\n";
    }
  text += "set encoding utf8\nset minussign\n";
  std::string id = figure.name;  // gnuplot takes no hyphen here
  std::replace(id.begin(), id.end(), '-', '_');
  text += printed(
      "set terminal svg size %d,%d dynamic enhanced rounded font 'sans-serif,15' name '%s'\n",
      figure.width, figure.height, id.c_str());
  text += "set border 3 lw 1 lc rgb '#767676'\nset tics nomirror out scale 0.6 tc rgb '#1a1a1a'\n";
  text += "set grid lw 0.6 lt 1 lc rgb '#e0e0e0'\n";
  text += printed("set lmargin at screen %.5f\nset rmargin at screen %.5f\n",
                  left_margin / figure.width, 1.0 - right_margin / figure.width);
  text += "set key above right horizontal samplen 1.6 spacing 1.0\nset multiplot\n";
  const std::vector<PanelPlace> places = panel_places(figure);
  for (size_t p = 0; p < figure.panels.size(); ++p)
    text += panel_commands(figure.panels[p], places[p], "$p" + std::to_string(p) + "c",
                           figure.has_letters ? static_cast<char>('a' + p) : '\0');
  return text + "unset multiplot\n";
}

std::string gnuplot_version() {
  const ProgramResult child = run_program("gnuplot", {"--version"}, 10.0);
  return child.succeeded() ? child.output.substr(0, child.output.find('\n')) : std::string();
}

std::string render_svg(const Figure& figure, const fs::path& folder, double seconds) {
  const std::string name = "figure " + figure.name + ": ";
  const fs::path svg = folder / (figure.name + ".svg"),
                 commands = folder / (figure.name + ".gnuplot");
  std::error_code ignored;
  fs::remove(svg, ignored);
  std::string script;
  try {
    script = gnuplot_script(figure);
  } catch (const std::invalid_argument& error) {
    throw Error(name + error.what());
  }
  create_folder(fs::absolute(folder));
  write_whole_file(commands, script);
  // absolute: gnuplot would not take a name that begins with "-" or "<" for a file
  ProgramResult child = run_program("gnuplot", {"-d", fs::absolute(commands).string()}, seconds);
  if (!child.succeeded()) throw Error(name + why(child, seconds));
  if (child.output.find("</svg>") == std::string::npos)
    throw Error(name + "gnuplot's SVG is incomplete");
  write_whole_file(svg, child.output);
  return std::move(child.output);
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
    size_t least = begin, most = begin;  // the first sample if none is finite
    for (size_t k = begin; k < end; ++k) {
      if (!std::isfinite(y[k])) continue;
      if (!std::isfinite(y[least]) || y[k] < y[least]) least = k;
      if (!std::isfinite(y[most]) || y[k] > y[most]) most = k;
    }
    keep(std::min(least, most));
    if (least != most) keep(std::max(least, most));
  }
  x = std::move(thin_x);
  y = std::move(thin_y);
}

}  // namespace ballast
