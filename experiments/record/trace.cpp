#include "experiments/record/trace.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace ballast {

Trace::Trace(bool is_log) : is_log_(is_log) {
  values_.fill(std::numeric_limits<double>::quiet_NaN());
}

void Trace::add(double fraction, double value) {
  if (is_log_) value = value > 0.0 ? std::log(value) : std::nan("");
  if (!std::isfinite(value) || !(fraction >= 0.0 && fraction <= 1.0)) return;
  const size_t part = static_cast<size_t>(fraction * static_cast<double>(values_.size()));
  values_[std::min(part, values_.size() - 1)] = value;
}

Trace::Range Trace::range() const {
  Range range;
  for (const double value : values_) {
    if (std::isnan(value)) continue;
    range.least = std::min(range.least, value);
    range.most = std::max(range.most, value);
  }
  return range;
}

bool Trace::is_flat() const { return !(range().most > range().least); }

std::string Trace::text(size_t columns) const {
  constexpr const char* blocks[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const auto [least, most] = range();
  std::string text;
  for (size_t c = 0; c < columns; ++c) {
    // the last value that is known in this column's part of the run
    double shown = std::nan("");
    for (size_t k = c * values_.size() / columns; k < (c + 1) * values_.size() / columns; ++k)
      if (!std::isnan(values_[k])) shown = values_[k];
    if (std::isnan(shown)) {
      text += ' ';
    } else {
      const double height = most > least ? (shown - least) / (most - least) : 0.0;
      text += blocks[std::min<size_t>(7, static_cast<size_t>(8.0 * height))];
    }
  }
  return text;
}

bool writes_unicode() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(name);
    if (!value || !*value) continue;
    const std::string locale = value;  // the first that is set holds
    return locale.find("UTF-8") != std::string::npos || locale.find("utf8") != std::string::npos;
  }
  return false;
}

}  // namespace ballast
