#pragma once
// Newton's method on the regularised law of all contacts (regular_step): every contact's status
// is guessed from the iterate, and the equations that belong to the statuses are solved exactly.

#include <vector>

#include "solvers/parts/body_matrix.hpp"
#include "solvers/parts/one_contact.hpp"
#include "solvers/parts/unit_mass_contacts.hpp"

namespace ballast {

/// dr = source - gain du: what the linearised law makes of a change of the contact's velocity.
struct RegularStep {
  Eigen::Vector3d source = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gain = Eigen::Matrix3d::Zero();
  ContactStatus status = ContactStatus::open;
};

struct RegularContact {
  double friction = 0.0;
  double lambda_max = 0.0;  ///< of W_cc, > 0 [1/kg]
  double epsilon = 0.0;     ///< > 0, as a part of lambda_max
  bool half_line = false;   ///< no tangential impulse
};

/// Coulomb's law of one contact, regularised, and linearised for a Newton step that knows statuses:
///
///   u~ = u + epsilon_c (r - centre),   epsilon_c = epsilon lambda_max(W_cc)
///
/// Near the centre it is a law with compliance epsilon_c, and solvable whatever W's rank; where r
/// is the centre it is the law itself. The status comes from z = r - u~ / lambda_max, the contact's
/// natural scale: with 1 / epsilon_c in its place hundreds of contacts would change at once. Alart,
/// Curnier 1991, with the disc mu r_N for the tangential impulse.
/// `r`: the impulse; `u`: u~ there.
RegularStep regular_step(const RegularContact& contact, const Eigen::Vector3d& r,
                         const Eigen::Vector3d& u);

/// Impulses and the body velocities that they give. Linear in each other: an iterate and a step of
/// it are combined alike.
struct NewtonIterate {
  ContactColumns r;
  Eigen::VectorXd x;
};

class RegularNewton {
 public:
  /// `problem` has the dynamics form and outlives the use.
  void prepare(const FrictionProblem& problem);
  const UnitMassContacts& contacts() const { return contacts_; }
  /// FrontLu::use_team
  void use_team(WorkerTeam* team) { matrix_.use_team(team); }

  /// The iterate with x from r.
  NewtonIterate iterate(const Impulses& r) const;
  /// Every impulse into its cone, x from r afresh. Returns the judge's error [m/s].
  double settle(NewtonIterate& at) const;

  /// From here on the law is regularised by `epsilon` around `centre`, and no status is known.
  void set_centre(const ContactColumns& centre, double epsilon);
  /// Natural map of the regularised law [m/s], rms over contacts; the law's own error where `at` is
  /// the centre.
  double residual(const NewtonIterate& at) const;
  /// Every contact's status at `at`, and its law linearised for it. Returns how many contacts had
  /// another status when they were last linearised around this centre; 0 the first time.
  int linearise(const NewtonIterate& at);
  /// One factorisation: the full step from where the law was linearised. It may raise the residual
  /// a hundredfold where statuses change. False: the matrix is singular or the step not finite.
  bool step(NewtonIterate& change);

 private:
  Eigen::Vector3d velocity(const NewtonIterate& at, int c) const;
  void improve(Eigen::VectorXd& x);

  UnitMassContacts contacts_;
  BodyMatrix matrix_;
  ContactColumns centre_;
  double epsilon_ = 1e-3;
  std::vector<Eigen::Matrix3d> gain_;
  ContactColumns source_;
  std::vector<ContactStatus> status_;
  bool has_status_ = false;
  Eigen::VectorXd right_, rest_;
};

}  // namespace ballast
