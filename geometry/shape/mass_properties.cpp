#include "geometry/shape/mass_properties.hpp"

#include <Eigen/Eigenvalues>
#include <utility>

namespace ballast {

namespace {

/// Largest off-diagonal entry over the largest entry: 0 when the axes are principal.
double off_diagonal(const Mat3& inertia) {
  const double off =
      std::max({std::abs(inertia(0, 1)), std::abs(inertia(0, 2)), std::abs(inertia(1, 2))});
  return off / inertia.diagonal().cwiseAbs().maxCoeff();
}

}  // namespace

Mat3 principal_axes(const Mat3& inertia) {
  if (off_diagonal(inertia) <= 1e-12) return Mat3::Identity();
  Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(inertia).eigenvectors();
  for (int k = 0; k < 2; ++k) {
    // The sign of each axis is free: its largest component is made positive.
    Eigen::Index largest;
    axes.col(k).cwiseAbs().maxCoeff(&largest);
    if (axes(largest, k) < 0.0) axes.col(k) *= -1.0;
  }
  // Eigenvectors may come as a reflection: the third is made from the other two.
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

/// Sums over tetrahedra from one inner point to a fan of each face. A tetrahedron (0, a, b, c) with
/// d = det(a, b, c) has the volume d/6, the first moment d/24 (a+b+c) and the second moment
/// d/120 (a a' + b b' + c c' + (a+b+c)(a+b+c)').
MassProperties mass_properties(const Polyhedron& polyhedron) {
  // The sums are about a point inside, not the origin: for a mesh far from its origin the
  // tetrahedra would be large, nearly cancel, and leave few digits.
  const Vec3 reference = mean(polyhedron.vertices());

  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (int f = 0; f < polyhedron.face_count(); ++f) {
    const std::span<const int> loop = polyhedron.face(f);
    const Vec3 a = polyhedron.vertex(loop[0]) - reference;
    for (size_t k = 2; k < loop.size(); ++k) {
      const Vec3 b = polyhedron.vertex(loop[k - 1]) - reference;
      const Vec3 c = polyhedron.vertex(loop[k]) - reference;
      const double d = a.dot(b.cross(c));
      const Vec3 sum = a + b + c;
      volume += d / 6.0;
      first += d / 24.0 * sum;
      second += d / 120.0 *
                (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }
  }
  const Vec3 centre = first / volume;
  // The sums are about the reference point. Steiner's theorem takes the second moment to the centre
  // of mass, S = S_ref - V c c', and the inertia of unit density is tr(S) 1 - S: on its diagonal
  // y^2 + z^2, z^2 + x^2, x^2 + y^2, off it -xy, -yz, -zx.
  const Mat3 about_centre = second - volume * centre * centre.transpose();
  return {volume, reference + centre, about_centre.trace() * Mat3::Identity() - about_centre};
}

PrincipalShape to_principal_frame(const Polyhedron& polyhedron) {
  MassProperties properties = mass_properties(polyhedron);
  Mat3 axes = principal_axes(properties.inertia);
  Vec3 origin = properties.centre;
  Polyhedron shape = polyhedron.in_frame(axes, origin);
  properties = mass_properties(shape);

  // The coordinates of a mesh far from its origin are rounded to that distance, and so are its
  // centre and axes. The moved shape is near its origin: one correction here removes the error.
  if (properties.centre.norm() > 1e-15 * shape.circumradius() ||
      off_diagonal(properties.inertia) > 1e-12) {
    const Mat3 correction = principal_axes(properties.inertia);
    shape = shape.in_frame(correction, properties.centre);
    origin += axes * properties.centre;
    axes = axes * correction;
    properties = mass_properties(shape);
  }
  // x = origin + axes x' takes a point x' of the body frame to the frame of the given polyhedron.
  return {std::move(shape), properties.volume, properties.inertia.diagonal(),
          Pose{origin, Quat(axes).normalized()}};
}

}  // namespace ballast
