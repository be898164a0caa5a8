// gnuplot_script and plain_text: a Figure as gnuplot's commands.

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/page/plot_layout.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

/// In single quotes gnuplot expands nothing (double quotes would run what is between backquotes).
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : one_line(text, ' ')) {
    if (c == '\'') result += '\'';
    result += c;
  }
  return result + '\'';
}

std::string script_number(double value) {
  return std::isfinite(value) ? printed("%.7g", value) : "NaN";
}

std::string data_block(const std::string& name, const Curve& curve) {
  std::string text = name + " << EOD\n";
  for (size_t k = 0; k < curve.x.size(); ++k) {
    text += script_number(curve.x[k]) + ' ' + script_number(curve.y[k]);
    if (!curve.y_low.empty()) text += ' ' + script_number(curve.y_low[k]);
    if (!curve.y_error.empty()) text += ' ' + script_number(curve.y_error[k]);
    text += '\n';
  }
  return text + "EOD\n";
}

std::string colour(Ink ink, double opacity) {
  const int transparency =
      static_cast<int>(std::lround(255.0 * (1.0 - std::clamp(opacity, 0.0, 1.0))));
  if (transparency == 0) return std::string("'") + rgb_of(ink) + "'";
  return printed("'#%02x%s'", transparency, rgb_of(ink) + 1);
}

std::string plot_command(const std::string& block, const Curve& curve) {
  constexpr const char* dashes[] = {" dt (8,5)", " dt (4,3)", " dt (1.5,3)"};
  constexpr int shapes[] = {7, 9, 5, 13};  // gnuplot's numbers, in the order of MarkShape
  const int shape = shapes[static_cast<size_t>(curve.shape)];
  std::string text = block;
  const std::string ink = colour(curve.ink, curve.opacity);
  switch (curve.mark) {
    case Mark::line:
      text += printed(" using 1:2 with lines lc rgb %s lw %.3g%s", ink.c_str(), curve.width,
                      curve.dashed ? dashes[std::clamp(curve.fineness, 0, 2)] : "");
      break;
    case Mark::points:
      text += curve.y_error.empty()
                  ? printed(" using 1:2 with points pt %d ps %.3g lc rgb %s", shape,
                            0.35 * curve.width, ink.c_str())
                  : printed(" using 1:2:3 with yerrorbars pt %d ps %.3g lc rgb %s", shape,
                            0.35 * curve.width, ink.c_str());
      break;
    case Mark::area:
      text += printed(" using 1:2:3 with filledcurves fs solid noborder fc rgb %s", ink.c_str());
      break;
  }
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

void check(const Figure& figure) {
  const auto require = [&](bool is_good, const char* what) {
    if (!is_good) throw std::invalid_argument("figure " + figure.name + ": " + what);
  };
  const bool is_plain = !figure.name.empty() &&
                        std::all_of(figure.name.begin(), figure.name.end(), [](unsigned char c) {
                          return std::isalnum(c) || c == '_' || c == '-';
                        });
  require(is_plain, "its name must be of letters, digits, _ and -");
  require(!figure.panels.empty(), "no panel");
  for (const Panel& panel : figure.panels)
    for (const Curve& curve : panel.curves) {
      require(curve.x.size() == curve.y.size(), "as many x as y");
      require(curve.y_error.empty() || curve.y_error.size() == curve.y.size(),
              "as many error bars as points");
      require((curve.mark == Mark::area) == !curve.y_low.empty(),
              "an area, and only it, has lower bounds");
      require(curve.y_low.empty() || curve.y_low.size() == curve.y.size(),
              "as many lower bounds as y");
    }
}

/// The ticks of a logarithmic axis ('x' or 'y'): with numbers at `numbered`, small ones between.
std::string log_axis(char axis, const Extent& extent, std::vector<double> numbered) {
  if (numbered.empty()) numbered = log_ticks(extent);
  std::string list;
  for (const double tick : numbered) list += (list.empty() ? "" : ", ") + script_number(tick);
  for (const double tick : minor_log_ticks(extent)) list += ", '' " + script_number(tick) + " 1";
  const bool has_powers_only = extent.high / extent.low >= 1e3;
  return printed("set logscale %c\nset format %c '%s'\nset %ctics (", axis, axis,
                 has_powers_only ? "10^{%L}" : "%g", axis) +
         list + ")\n";
}

std::string panel_commands(const Figure& figure, const Panel& panel, const PanelPlace& place,
                           const std::string& blocks, char letter) {
  const Extent x = x_extent(panel), y = y_extent(panel);
  std::string text =
      "unset arrow\nunset label\nunset logscale\nset format x '%g'\nset format y '%g'\n"
      "set xtics autofreq\nset ytics autofreq\n";
  const double right = place.right / figure.width;
  text += printed("set lmargin at screen %.5f\nset rmargin at screen %.5f\n",
                  place.left / figure.width, right);
  text += printed("set tmargin at screen %.5f\nset bmargin at screen %.5f\n",
                  place.top / figure.height, place.bottom / figure.height);
  text += "set xrange [" + script_number(x.low) + ':' + script_number(x.high) + "]\nset yrange [" +
          script_number(y.low) + ':' + script_number(y.high) + "]\n";
  if (panel.log_x) text += log_axis('x', x, panel.x_ticks);
  if (panel.log_y) text += log_axis('y', y, {});
  text += printed("set tics font ',%d'\n", panel.is_inset ? 12 : 15);
  text += place.shows_x ? "set xlabel " + quoted(panel.x_label) + " offset 0,0.3\n"
                        : "set xlabel ''\nset format x ''\n";
  text += "set ylabel " + quoted(panel.y_label) + '\n';
  // above the box, to the right
  text += printed(
      "set key at screen %.5f, screen %.5f right center horizontal maxcols %d samplen 1.6 spacing "
      "1.0\n",
      right, (place.top + 5.0 + 0.5 * key_row * place.key.rows) / figure.height, place.key.columns);
  for (const ReferenceLine& line : panel.lines) text += reference(line);
  if (letter) text += printed("set label '(%c)' at graph 0, graph 1 left offset 0, 0.7\n", letter);
  std::string curves;
  for (size_t c = 0; c < panel.curves.size(); ++c)
    curves += (curves.empty() ? "" : ", \\\n     ") +
              plot_command(blocks + std::to_string(c), panel.curves[c]);
  return text + "plot " + curves + '\n';
}

}  // namespace

const char* rgb_of(Ink ink) {
  // in the order of Ink
  constexpr const char* colours[] = {"#1a1a1a", "#0072b2", "#d55e00", "#009e73", "#e69f00",
                                     "#56b4e9", "#cc79a7", "#f0e442", "#767676", "#b8b8b8"};
  return colours[static_cast<size_t>(ink)];
}

std::string plain_text(const std::string& text) {
  std::string result;
  for (const char c : one_line(text, ' ')) {
    if (c == '^' || c == '_' || c == '@' || c == '&' || c == '~' || c == '{' || c == '}' ||
        c == '\\')
      result += '\\';
    result += c;
  }
  return result;
}

std::string gnuplot_script(const Figure& figure, PlotFormat format) {
  check(figure);
  std::string text =
      "# " + figure.name + ": gnuplot " + figure.name + ".gnuplot > " + figure.name + ".svg\n";
  for (size_t p = 0; p < figure.panels.size(); ++p)
    for (size_t c = 0; c < figure.panels[p].curves.size(); ++c)
      text += data_block("$p" + std::to_string(p) + "c" + std::to_string(c),
                         figure.panels[p].curves[c]);
  text += "set encoding utf8\nset minussign\n";
  std::string id = figure.name;  // gnuplot takes no hyphen here
  std::replace(id.begin(), id.end(), '-', '_');
  if (format == PlotFormat::svg)
    text += printed(
        "set terminal svg size %d,%d dynamic enhanced rounded font 'sans-serif,15' name '%s'\n",
        figure.width, figure.height, id.c_str());
  else  // a pixel is 1/96 inch, 3/4 point
    text += printed(
        "set terminal pdfcairo size %.4fin,%.4fin enhanced rounded font 'sans-serif,11.25'\n",
        figure.width / 96.0, figure.height / 96.0);
  text += "set border 3 lw 1 lc rgb '#767676'\nset tics nomirror out scale 0.6 tc rgb '#1a1a1a'\n";
  text += "set grid lw 0.6 lt 1 lc rgb '#e0e0e0'\n";
  text += "set multiplot\n";
  const std::vector<PanelPlace> places = panel_places(figure);
  char next = 'a';
  for (size_t p = 0; p < figure.panels.size(); ++p) {
    const bool is_lettered = figure.has_letters && !figure.panels[p].is_inset;
    text += panel_commands(figure, figure.panels[p], places[p], "$p" + std::to_string(p) + "c",
                           is_lettered ? next++ : '\0');
  }
  return text + "unset multiplot\n";
}

}  // namespace ballast
