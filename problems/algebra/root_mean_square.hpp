#pragma once
// The mean over contacts in which the judge and the solvers' own errors are stated.

#include <cmath>

namespace ballast {

/// Root of the mean square of the values added so far, in their unit; 0 before the first. The bits
/// depend on the order in which values are added.
class RootMeanSquare {
 public:
  void add(double value) { add_square(value * value); }
  /// A value whose square is at hand [its unit squared].
  void add_square(double square) {
    sum_ += square;
    ++count_;
  }
  /// All values of a part that was summed on its own.
  void add(const RootMeanSquare& part) {
    sum_ += part.sum_;
    count_ += part.count_;
  }
  double value() const { return count_ > 0 ? std::sqrt(sum_ / count_) : 0.0; }

 private:
  double sum_ = 0.0;
  int count_ = 0;
};

}  // namespace ballast
