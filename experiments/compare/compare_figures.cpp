#include "experiments/compare/compare_figures.hpp"

#include <iterator>

namespace ballast {

Curve backend_curve(size_t k, const std::string& title) {
  constexpr Ink inks[] = {Ink::blue,   Ink::vermilion, Ink::green, Ink::orange,
                          Ink::purple, Ink::sky,       Ink::black, Ink::grey};
  constexpr size_t count = std::size(inks);
  Curve curve;
  curve.title = plain_text(title);
  curve.ink = inks[k % count];
  curve.dashed = (k / count) % 2 == 1;
  curve.width = k < 2 * count ? 1.8 : 0.9;
  return curve;
}

void add_marked_line(const std::vector<std::pair<double, double>>& points, Curve curve,
                     Panel& panel) {
  for (const auto& [x, y] : points) {
    curve.x.push_back(x);
    curve.y.push_back(y);
  }
  panel.curves.push_back(curve);
  curve.title.clear();
  curve.mark = Mark::points;
  panel.curves.push_back(std::move(curve));
}

}  // namespace ballast
