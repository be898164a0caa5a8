#pragma once
// Where a sparse matrix has entries, remembered: the symbolic work on it is kept while the next
// matrix has the same.

#include <algorithm>
#include <vector>

#include <Eigen/Sparse>

namespace ballast {

using SparseColumns = Eigen::SparseMatrix<double, Eigen::ColMajor>;

/// Remembers a pattern; tells whether the next one is the same.
class SparsePattern {
 public:
  /// `a` compressed.
  bool is(const SparseColumns& a) const {
    return static_cast<Eigen::Index>(outer_.size()) == a.outerSize() + 1 &&
           static_cast<Eigen::Index>(inner_.size()) == a.nonZeros() &&
           std::equal(outer_.begin(), outer_.end(), a.outerIndexPtr()) &&
           std::equal(inner_.begin(), inner_.end(), a.innerIndexPtr());
  }
  void take(const SparseColumns& a) {
    outer_.assign(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1);
    inner_.assign(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros());
  }

 private:
  std::vector<int> outer_, inner_;
};

}  // namespace ballast
