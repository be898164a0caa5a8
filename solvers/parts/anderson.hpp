#pragma once
// Anderson acceleration of a fixed point x = G(x). Walker, Ni 2011, "Anderson acceleration for
// fixed-point iterations" (type II: the combination of past steps whose residuals cancel best).

#include <vector>

#include <Eigen/Dense>

namespace ballast {

/// Remembers differences of the last `memory` pairs (G(x), G(x) - x). Storage is kept between uses.
class Anderson {
 public:
  void reset(int memory);
  void forget() {
    count_ = 0;
    primed_ = false;
  }

  /// x := the accelerated next iterate, given x and its image G(x). The first call after forget()
  /// gives x := G(x). Residuals are compared in the leading `compared` entries (-1: all), each
  /// times its weight (empty: all 1).
  void step(Eigen::VectorXd& x, const Eigen::VectorXd& image, Eigen::Index compared = -1,
            const Eigen::VectorXd& weight = {});

 private:
  Eigen::VectorXd combine() const;

  int memory_ = 0, count_ = 0, next_ = 0;
  bool primed_ = false;
  Eigen::VectorXd last_image_, last_residual_, residual_;
  std::vector<Eigen::VectorXd> image_steps_, residual_steps_;
  Eigen::MatrixXd gram_;
};

}  // namespace ballast
