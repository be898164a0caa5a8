#include "experiments/paper/agreement.hpp"

#include <cmath>

#include "experiments/page/text.hpp"

namespace ballast {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double least_law_p = 0.01;

}  // namespace

const char* word_of(Agreement agreement) {
  constexpr const char* words[] = {"agrees", "partly", "DIFFERS", "reported"};
  return words[static_cast<size_t>(agreement)];
}

PaperRange PaperRange::widened() const {
  const double width = high - low;
  return std::isfinite(width) ? PaperRange{low - width, high + width} : *this;
}

PaperRange PaperRange::about(double value, double half_width) {
  return {value - half_width, value + half_width};
}
PaperRange PaperRange::exponent(double value) { return about(value, 0.1); }
PaperRange PaperRange::roughly(double value) { return about(value, 0.3 * std::abs(value)); }
PaperRange PaperRange::at_most(double value) { return {-unbounded, value}; }
PaperRange PaperRange::at_least(double value) { return {value, unbounded}; }

Found found(const SampleMean& mean) {
  const double half = mean.half_width();
  return {.value = mean.mean, .low = mean.mean - half, .high = mean.mean + half};
}

Found found(const PowerFit& fit, double law_p) {
  return {.value = fit.exponent,
          .low = fit.exponent - fit.half_width,
          .high = fit.exponent + fit.half_width,
          .law_p = law_p};
}

Found part_of(Found found) {
  found.is_whole = false;
  return found;
}

Agreement agreement_of(const PaperRange& paper, const Found& found) {
  if (!std::isfinite(found.low) || !std::isfinite(found.high)) return Agreement::reported;
  const PaperRange wide = paper.widened();
  const bool is_sharp = wide.holds(found.low) && wide.holds(found.high),
             holds = std::isnan(found.law_p) || found.law_p >= least_law_p;
  if (paper.holds(found.value) && is_sharp && holds && found.is_whole) return Agreement::agrees;
  if (wide.holds(found.value)) return Agreement::partly;
  const bool reaches = found.low <= paper.high && found.high >= paper.low;
  return reaches ? Agreement::reported : Agreement::differs;
}

page::Text words_of(const PaperRange& range) {
  if (std::isinf(range.low)) return "≤ " + page::exact(range.high);
  if (std::isinf(range.high)) return "≥ " + page::exact(range.low);
  return page::exact(range.low) + " … " + page::exact(range.high);
}

page::Text words_of(const Found& found) {
  page::Text text = page::number(found.value);
  if (std::isfinite(found.low) && std::isfinite(found.high))
    text += " " + page::interval(found.low, found.high);
  if (found.law_p < least_law_p) text += "; the law misses the points";
  if (!found.is_whole) text += "; a part of the statement";
  return text;
}

}  // namespace ballast
