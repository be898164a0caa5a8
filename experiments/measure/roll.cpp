#include "experiments/measure/roll.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {
namespace {

bool is_between(double x, double lo, double hi) { return x >= lo && x <= hi; }

}  // namespace

std::vector<Displacement> period_displacements(std::span<const MotionState> frames,
                                               std::span<const WallPeriod> periods, double h,
                                               size_t grains) {
  const auto frame_at = [&](double time) {
    return std::find_if(frames.begin(), frames.end(), [&](const MotionState& frame) {
      return std::abs(frame.time - time) < 0.6 * h;
    });
  };
  std::vector<Displacement> all;
  for (const WallPeriod& period : periods) {
    const auto begin = frame_at(period.begin), end = frame_at(period.end);
    if (begin == frames.end() || end == frames.end()) continue;
    for (size_t b = 0; b < grains; ++b) {
      const Vec3 &from = begin->pose[b].position, &to = end->pose[b].position;
      all.push_back({0.5 * (from + to), to - from});
    }
  }
  return all;
}

double Roll::roundness() const {
  double weakest = not_known, strongest = 0.0;
  for (const double side : along) {
    const double with = circulation < 0.0 ? -side : side;
    weakest = std::fmin(weakest, with);
    strongest = std::max(strongest, std::abs(side));
  }
  return std::isnan(circulation) || !(strongest > 0.0) ? not_known : weakest / strongest;
}

Roll roll_of(std::span<const Displacement> displacements, const XzRectangle& r, double reach) {
  std::array<double, 4> sum{}, count{};
  const auto add = [&](size_t side, bool is_near, double along) {
    if (!is_near) return;
    sum[side] += along;
    count[side] += 1.0;
  };
  // a grain near a corner counts for both sides
  for (const Displacement& d : displacements) {
    const double x = d.place.x(), z = d.place.z();
    const bool in_x = is_between(x, r.x_lo, r.x_hi), in_z = is_between(z, r.z_lo, r.z_hi);
    add(0, in_x && std::abs(z - r.z_hi) <= reach, d.move.x());
    add(1, in_z && std::abs(x - r.x_hi) <= reach, -d.move.z());
    add(2, in_x && std::abs(z - r.z_lo) <= reach, -d.move.x());
    add(3, in_z && std::abs(x - r.x_lo) <= reach, d.move.z());
  }
  Roll roll;
  if (*std::min_element(count.begin(), count.end()) == 0.0) return roll;
  for (size_t side = 0; side < 4; ++side) roll.along[side] = sum[side] / count[side];
  roll.circulation = (roll.along[0] + roll.along[2]) * (r.x_hi - r.x_lo) +
                     (roll.along[1] + roll.along[3]) * (r.z_hi - r.z_lo);
  return roll;
}

std::vector<Displacement> cell_means(std::span<const Displacement> displacements,
                                     const XzRectangle& r, int columns, int rows) {
  const size_t cells = static_cast<size_t>(columns) * static_cast<size_t>(rows);
  std::vector<Vec3> sum(cells, Vec3::Zero());
  std::vector<double> count(cells, 0.0);
  const double width = (r.x_hi - r.x_lo) / columns, height = (r.z_hi - r.z_lo) / rows;
  for (const Displacement& d : displacements) {
    const double column = std::floor((d.place.x() - r.x_lo) / width),
                 row = std::floor((d.place.z() - r.z_lo) / height);
    if (!is_between(column, 0, columns - 1) || !is_between(row, 0, rows - 1)) continue;
    const size_t cell = static_cast<size_t>(row * columns + column);
    sum[cell] += d.move;
    count[cell] += 1.0;
  }
  std::vector<Displacement> means;
  for (size_t cell = 0; cell < cells; ++cell) {
    if (count[cell] == 0.0) continue;
    const size_t in_row = static_cast<size_t>(columns), below = cell / in_row;
    const double column = static_cast<double>(cell % in_row), row = static_cast<double>(below);
    means.push_back({Vec3(r.x_lo + (column + 0.5) * width, 0.0, r.z_lo + (row + 0.5) * height),
                     sum[cell] / count[cell]});
  }
  return means;
}

}  // namespace ballast
