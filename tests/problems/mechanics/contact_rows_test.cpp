// The rows of H, computed in lanes, against the same products contact by contact.

#include "problems/mechanics/contact_rows.hpp"

#include <cmath>
#include <random>

#include "problems/mechanics/assemble.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

Vec3 in_place(const double (&numbers)[3][ContactRows::size], int k) {
  return Vec3(numbers[0][k], numbers[1][k], numbers[2][k]);
}

/// Also compares the sign of a zero.
bool same_bits(const Vec3& x, const Vec3& y) {
  for (int i = 0; i < 3; ++i)
    if (x[i] != y[i] || std::signbit(x[i]) != std::signbit(y[i])) return false;
  return true;
}

}  // namespace

TEST_CASE("contact rows have the bits of Eigen's products, contact by contact") {
  std::mt19937 random(3);
  std::normal_distribution<double> number;
  const auto vector = [&] { return Vec3(number(random), number(random), number(random)); };
  for (int round = 0; round < 200; ++round) {
    ContactRows block{};
    Vec3 normal[ContactRows::size], arm[2][ContactRows::size];
    Mat3 rotation[2][ContactRows::size];
    for (int k = 0; k < ContactRows::size; ++k) {
      // Along an axis with zeros of both signs, between two axes, and in any direction.
      normal[k] = vector().normalized();
      if (round % 4 == 1) normal[k] = (k % 2 ? -1.0 : 1.0) * Vec3::Unit(k % 3);
      if (round % 4 == 1)
        for (int i = 0; i < 3; ++i)
          if (normal[k][i] == 0.0) normal[k][i] = std::copysign(0.0, number(random));
      if (round % 4 == 2) normal[k] = (Vec3::Unit(k % 3) - Vec3::Unit((k + 1) % 3)).normalized();
      for (int i = 0; i < 3; ++i) block.normal[i][k] = normal[k][i];
      for (int side = 0; side < 2; ++side) {
        arm[side][k] = vector();
        rotation[side][k] = Eigen::Quaterniond(vector().normalized().x(), number(random),
                                               number(random), number(random))
                                .normalized()
                                .toRotationMatrix();
        for (int i = 0; i < 3; ++i) {
          block.arm[side][i][k] = arm[side][k][i];
          for (int j = 0; j < 3; ++j) block.rotation[side][i][j][k] = rotation[side][k](i, j);
        }
      }
    }
    find_rows(block);
    for (int k = 0; k < ContactRows::size; ++k) {
      INFO("round " << round << ", normal " << normal[k].transpose());
      const Mat3 frame = contact_frame(normal[k]);
      for (int t = 0; t < 2; ++t)
        CHECK(same_bits(in_place(block.tangent[t], k), frame.row(t + 1).transpose()));
      const Mat3 axes = Mat3::Identity();
      for (int row = 0; row < 3; ++row)
        for (int d = 0; d < 3; ++d) {
          const double along = frame.row(row).dot(axes.col(d)), found = block.line[row][d][k];
          CHECK((found == along && std::signbit(found) == std::signbit(along)));
        }
      for (int side = 0; side < 2; ++side) {
        const double sign = side == 0 ? -1.0 : 1.0;
        const Vec3 lever = sign * (rotation[side][k].transpose() * arm[side][k]);
        const Mat3 directions = rotation[side][k].transpose() * frame.transpose();
        for (int row = 0; row < 3; ++row)
          CHECK(same_bits(in_place(block.turn[side][row], k),
                          lever.cross(Vec3(directions.col(row)))));
      }
    }
  }
}
