// The style sheet of every page. Colours of figures are variables: palette_rules() points the SVG's
// colours at them, so that a figure follows the reader's light or dark ground.

#include "experiments/page/page_style.hpp"

#include <cstdlib>
#include <utility>

#include "experiments/page/plot.hpp"
#include "platform/text.hpp"

namespace ballast::page {
namespace {

constexpr const char* light_and_dark = R"css(
:root{
  color-scheme:light dark;
  --paper:#fdfdfb; --text:#1f2328; --soft:#59636e; --rule:#d6d6d0; --wash:#f3f3ee;
  --good:#00664a; --bad:#a83f00; --link:#00598c;
  --ink:#1a1a1a; --grid:#e4e4e0; --grey:#6b6b6b; --light:#b8b8b8;
  --blue:#0072b2; --vermilion:#d55e00; --green:#009e73; --orange:#e69f00; --sky:#56b4e9;
  --purple:#cc79a7; --yellow:#f0e442;
}
@media (prefers-color-scheme:dark){:root{
  --paper:#16181b; --text:#e4e4e0; --soft:#a2a8ae; --rule:#3a3d42; --wash:#1f2226;
  --good:#4fc9a0; --bad:#ff9a5c; --link:#6cb8ee;
  --ink:#e4e4e0; --grid:#2f3237; --grey:#a0a0a0; --light:#63676c;
  --blue:#4aa8e0; --vermilion:#ff8a3c; --green:#2fc795; --orange:#f0b429; --sky:#8accf2;
  --purple:#e3a0c6; --yellow:#f3ea77;
}}
@media print{:root{--paper:#fff;--wash:#fff}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--text);
  font:17px/1.55 Charter,"Bitstream Charter","Iowan Old Style",Cambria,"DejaVu Serif",Georgia,serif}
main{max-width:62rem;margin:0 auto;padding:2.5rem 1.25rem 4rem}
header{border-bottom:2px solid var(--text);padding-bottom:1rem;margin-bottom:1.75rem}
h1{font-size:2rem;line-height:1.15;margin:0 0 .5rem;font-weight:600;text-wrap:balance}
h2{font-size:1.35rem;line-height:1.2;margin:3rem 0 .9rem;font-weight:600}
p{max-width:44rem;margin:.6rem 0}
.lede{color:var(--soft);margin:.2rem 0}
a{color:var(--link)}
code,pre,td.code{font-family:ui-monospace,"DejaVu Sans Mono",Menlo,Consolas,monospace;
  font-size:.84em}
pre{background:var(--wash);padding:.8rem 1rem;overflow-x:auto;line-height:1.45;border-radius:3px}
table{border-collapse:collapse;font-size:.92rem;line-height:1.35;
  font-variant-numeric:tabular-nums lining-nums;width:100%}
th,td{text-align:left;vertical-align:baseline;padding:.34rem 1rem .34rem 0;
  border-bottom:1px solid var(--rule)}
th{font-weight:600;color:var(--soft);border-bottom:1px solid var(--text);vertical-align:bottom}
th.n,td.n{text-align:right}
td.n{white-space:nowrap}
sub,sup{line-height:0}
tr:last-child td{border-bottom:0}
td:last-child,th:last-child{padding-right:0}
.scroll{overflow-x:auto;margin:.8rem 0 1.2rem}
.facts td:first-child{color:var(--soft);width:19rem}
.note,.unknown{color:var(--soft)}
.met{color:var(--good);white-space:nowrap}
.missed{color:var(--bad);font-weight:600;white-space:nowrap}
.notices{border-left:4px solid var(--bad);background:var(--wash);padding:.6rem 1rem;margin:1.2rem 0}
.notices ul{margin:.3rem 0;padding-left:1.2rem}
nav{font-size:.95rem}
nav a{margin-right:1.1rem;white-space:nowrap}
figure{margin:1.8rem 0 2.6rem}
figure svg{display:block;width:100%;height:auto}
figure svg tspan,figure svg g{font-family:system-ui,"Segoe UI","Helvetica Neue",Arial,
  "DejaVu Sans",sans-serif}
figcaption{font-size:.95rem;line-height:1.5;color:var(--text);max-width:48rem;margin:.5rem 0 0}
figcaption b:first-child{font-weight:600}
figcaption .look{color:var(--soft)}
details{margin:1rem 0}
summary{cursor:pointer;color:var(--link)}
footer{margin-top:3rem;padding-top:.8rem;border-top:1px solid var(--rule);color:var(--soft);
  font-size:.9rem}
@media (max-width:40rem){body{font-size:16px}main{padding-top:1.2rem}
  .facts td:first-child{width:auto}}
@media print{
  body{font-size:10.5pt}main{max-width:none;padding:0}nav{display:none}
  figure,tr,.notices{break-inside:avoid}h2{break-after:avoid}
  details:not([open])>*:not(summary){display:none}
  .scroll,pre{overflow:visible}pre{white-space:pre-wrap}
}
)css";

/// Rules that turn one colour of the figures into a variable of the page.
std::string colour_rules(const std::string& rgb, const std::string& variable) {
  std::string rules;
  for (const char* property : {"stroke", "fill", "color"})
    rules += std::string("svg [") + property + "=\"" + rgb + "\"]{" + property + ":var(" +
             variable + ")}\n";
  return rules;
}

std::string attribute_form(const char* hex) {
  const long value = std::strtol(hex + 1, nullptr, 16);
  return printed("rgb(%ld,%ld,%ld)", value >> 16, (value >> 8) & 255, value & 255);
}

std::string palette_rules() {
  std::string rules = colour_rules("black", "--ink") + colour_rules("rgb(224,224,224)", "--grid");
  constexpr std::pair<Ink, const char*> inks[] = {
      {Ink::black, "--ink"},     {Ink::blue, "--blue"},     {Ink::vermilion, "--vermilion"},
      {Ink::green, "--green"},   {Ink::orange, "--orange"}, {Ink::sky, "--sky"},
      {Ink::purple, "--purple"}, {Ink::yellow, "--yellow"}, {Ink::grey, "--grey"},
      {Ink::light, "--light"}};
  for (const auto& [ink, variable] : inks)
    rules += colour_rules(attribute_form(rgb_of(ink)), variable);
  return rules;
}

}  // namespace

std::string style_sheet() { return light_and_dark + palette_rules(); }

}  // namespace ballast::page
