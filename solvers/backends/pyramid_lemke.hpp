#pragma once
// Friction on a pyramid instead of a cone, as a linear complementarity problem, solved exactly by
// Lemke's pivoting. Stewart, Trinkle 1996, "An implicit time-stepping scheme for rigid body
// dynamics with inelastic collisions and Coulomb friction", eq. (15); Anitescu, Potra 1997 (where
// it is shown to be solvable).

#include <vector>

#include "solvers/seam/solver.hpp"

namespace ballast {

enum class LemkeState { running, solved, ray };

/// Complementary pivoting, dense, with the lexicographic ratio test: Cottle, Pang, Stone 1992, "The
/// linear complementarity problem", 4.4. Find z >= 0 with w = m z + q >= 0 and z . w = 0, one pivot
/// at a time. The lexicographic rule meets no basis twice, so that it ends for every m; it ends
/// with a solution when m is copositive-plus and some z >= 0 has m z + q >= 0. Memory 16 n^2 bytes,
/// a pivot costs about 4 n^2 operations.
class Lemke {
 public:
  /// Covering vector of ones. `m` is kept by reference until solution().
  void begin(const Eigen::MatrixXd& m, const Eigen::VectorXd& q);
  /// One pivot. `ray`: no solution was found this way.
  LemkeState pivot();
  LemkeState state() const { return state_; }
  /// Of a solved problem: computed afresh from the final basis, without the rounding of the pivots;
  /// negative rounding becomes zero.
  Eigen::VectorXd solution() const;

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  int leaving_row(int entering) const;
  bool lexicographically_less(int i, int j, int entering) const;
  void exchange(int row, int entering);
  int complement(int variable) const { return variable < n_ ? variable + n_ : variable - n_; }

  // Variables: w_0..w_n-1, z_0..z_n-1, the artificial one. Columns of the tableau in that order,
  // then q.
  int n_ = 0, entering_ = 0;
  LemkeState state_ = LemkeState::solved;
  Rows tableau_;
  std::vector<int> basis_;  ///< variable of each row
  const Eigen::MatrixXd* m_ = nullptr;
  Eigen::VectorXd q_;
};

struct PyramidLemkeSettings {
  /// Directions of friction per contact, even, >= 4; their hull is inside the circle.
  int sides = 8;
  /// Unknowns of the complementarity problem: sides + 2 per contact with friction, 1 without.
  static constexpr int largest = 1000;

  constexpr int unknowns_per_contact() const { return sides + 2; }  ///< with friction
  constexpr SizeLimit limit() const {
    return {largest / unknowns_per_contact(), largest / unknowns_per_contact()};
  }
};

/// Judged on Coulomb's law like every backend: with sliding contacts that do not move along one of
/// the directions it ends as `stalled`, and own_residual [m/s] says how well its own law is met. An
/// iteration is a pivot; before the last one there is no iterate, and a limit returns the start.
std::unique_ptr<Solver> make_pyramid_lemke(const PyramidLemkeSettings& settings = {});

}  // namespace ballast
