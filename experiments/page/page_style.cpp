// The style sheet of every page: style.css, and rules that point the colours of the figures' SVG at
// its variables, so that a figure follows the reader's light or dark ground.

#include "experiments/page/page_style.hpp"

#include <cstdlib>
#include <utility>

#include "experiments/page/plot.hpp"
#include "platform/text.hpp"

namespace ballast::page {
namespace {

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

std::string style_sheet() { return light_and_dark() + palette_rules(); }

}  // namespace ballast::page
