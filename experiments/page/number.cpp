#include "experiments/page/number.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "platform/text.hpp"

namespace ballast::page {
namespace {

constexpr const char* narrow_space = "\u202f";

std::string without_trailing_zeros(std::string digits) {
  if (digits.find('.') == std::string::npos) return digits;
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return digits;
}

std::string with_minus_sign(std::string digits) {
  if (digits[0] == '-') digits.replace(0, 1, "−");
  return digits;
}

Text unknown() { return {"–", note}; }

Text number_text(double value, int digits, bool is_exact) {
  if (!std::isfinite(value)) return unknown();
  if (value == 0.0) return "0";
  // the rounded value decides, so that 999999.9 isn't printed as 1.00e+06
  std::string text = printed("%.*e", digits - 1, value);
  const size_t mark = text.find('e');
  const int exponent = std::atoi(text.c_str() + mark + 1);
  const bool has_power = exponent < -3 || exponent >= 6;
  text =
      has_power ? text.substr(0, mark) : printed("%.*f", std::max(0, digits - 1 - exponent), value);
  if (is_exact) text = without_trailing_zeros(text);
  Text result = with_minus_sign(text);
  if (has_power) {
    result += "×10";
    result += {with_minus_sign(std::to_string(exponent)), superscript};
  }
  return result;
}

Text with_unit(double value, Text digits, const char* unit) {
  if (!std::isfinite(value) || !*unit) return digits;
  return std::move(digits) + narrow_space + marked(unit);
}

}  // namespace

Text number(double value, int digits) { return number_text(value, digits, false); }

Text exact(double value, int digits) { return number_text(value, digits, true); }

Text quantity(double value, const char* unit, int digits) {
  return with_unit(value, number(value, digits), unit);
}

Text exact_quantity(double value, const char* unit, int digits) {
  return with_unit(value, exact(value, digits), unit);
}

Text with_error(double value, double error) {
  if (!std::isfinite(value) || !std::isfinite(error) || error == 0.0) return number(value);
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(error))));
  if (exponent < -6 || exponent > 5) return number(value) + " ± " + number(error, 2);
  // as many places as give the error two digits
  const int places = std::max(0, 1 - exponent);
  return with_minus_sign(printed("%.*f", places, value)) + " ± " + printed("%.*f", places, error);
}

Text percent(double relative) {
  if (!std::isfinite(relative)) return unknown();
  return (relative >= 0.0 ? "+" : "−") + number(100.0 * std::abs(relative), 2) + " %";
}

Text interval(double low, double high) { return "[" + number(low) + ", " + number(high) + "]"; }

Text verdict(double value, double bound) {
  if (std::isnan(value) || std::isnan(bound)) return {};
  return value <= bound ? Text("✓ met", good) : Text("✗ missed", bad);
}

}  // namespace ballast::page
