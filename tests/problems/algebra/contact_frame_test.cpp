#include "problems/algebra/contact_frame.hpp"

#include "tests/catch.hpp"

using namespace ballast;
using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST_CASE("The cross matrix turns a vector as the cross product does", "[contact_frame]") {
  const Vector3d x(1.0, -2.0, 0.5), y(0.25, 3.0, -1.0);
  CHECK(cross_matrix(x) * y == x.cross(y));
}

TEST_CASE("A contact frame is a rotation whose first row is the normal", "[contact_frame]") {
  const Vector3d n = Vector3d(1.0, 2.0, -2.0) / 3.0;
  const Matrix3d frame = contact_frame(n, Vector3d::UnitX());
  CHECK(Vector3d(frame.row(0)) == n);
  CHECK((frame * frame.transpose() - Matrix3d::Identity()).norm() < 1e-15);
  CHECK(frame.determinant() == Approx(1.0));
}
