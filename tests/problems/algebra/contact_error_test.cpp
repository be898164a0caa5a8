#include "problems/algebra/contact_error.hpp"

#include <limits>

#include "platform/random.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/friction_cone.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/made_problems.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

/// Every measure by the definitions in the header, contact by contact, with the bits of the judge
/// where it does not divide its work (up to 64 contacts). `lambda`: 1/rho of each contact.
ContactError one_by_one(const FrictionProblem& p, const Impulses& r, const Eigen::VectorXd& u,
                        const Eigen::VectorXd& q, const std::vector<double>& lambda) {
  ContactError e;
  double needed = 0.0, largest = 0.0;
  int counted = 0;
  double free_square = 0.0, impulse_square = 0.0, velocity_square = 0.0;
  e.min_normal_velocity = std::numeric_limits<double>::infinity();
  for (int c = 0; c < p.contact_count(); ++c) {
    const int first = p.row_begin[c], rows = p.contact_rows(c);
    Eigen::Vector3d rc = Eigen::Vector3d::Zero(), uc = rc, qc = rc;
    rc.head(rows) = r.segment(first, rows);
    uc.head(rows) = u.segment(first, rows);
    qc.head(rows) = q.segment(first, rows);
    const double mu = p.friction[c], rho = lambda[c] > 0.0 ? 1.0 / lambda[c] : 0.0;
    const double approach = std::max(0.0, -uc[0]);
    const Eigen::Vector3d modified = modified_velocity(uc, mu);
    const double beyond = (rc - project_cone(rc, mu)).norm(), work = std::abs(rc.dot(modified));
    const double against = rc.norm() + rho * modified.norm();
    const double unbalanced = against > 0.0 ? work / against : 0.0;
    if (lambda[c] > 0.0) {
      const double value = ContactJudge::scaled_natural_map(rc, uc, mu, lambda[c]);
      e.natural_map_rms += value * value;
      if (e.worst_contact < 0 || value > e.natural_map_max) {
        e.natural_map_max = value;
        e.worst_contact = c;
      }
      needed = std::max(needed, rho * qc.norm());
      ++counted;
    } else {
      e.immovable_approach = std::max(e.immovable_approach, approach);
    }
    e.fclib += natural_map(rc, uc, mu, 1.0).squaredNorm();
    e.approach_rms += approach * approach;
    e.cone_rms += (lambda[c] * beyond) * (lambda[c] * beyond);
    e.complementarity_rms += unbalanced * unbalanced;
    e.cone_violation = std::max(e.cone_violation, beyond);
    e.complementarity = std::max(e.complementarity, work);
    e.min_normal_velocity = std::min(e.min_normal_velocity, uc[0]);
    largest = std::max(largest, rc.norm());
    free_square += qc.squaredNorm();
    impulse_square += rc.squaredNorm();
    velocity_square += uc.squaredNorm();
    e.power += rc.dot(uc);
  }
  e.natural_map_rms = std::sqrt(e.natural_map_rms / counted);
  for (double* mean : {&e.approach_rms, &e.cone_rms, &e.complementarity_rms})
    *mean = std::sqrt(*mean / p.contact_count());
  if (p.has_dynamics && largest > 1e6 * needed) {
    const Eigen::VectorXd momenta = oracle::dense_mass(p) * p.dynamics.v_free;
    for (int b = 0; b < p.dynamics.body_count(); ++b)
      needed = std::max(needed,
                        momenta.segment(p.dynamics.dof_begin[b], p.dynamics.body_dofs(b)).norm());
  }
  e.growth = largest / needed;
  e.fclib =
      std::sqrt(e.fclib) / std::sqrt(std::max({free_square, impulse_square, velocity_square}));
  if (p.has_dynamics) {
    Eigen::VectorXd v, impulse;
    body_velocity(p.dynamics, p.row_begin, r, v);
    contact_to_body_impulse(p.dynamics, p.row_begin, r, impulse);
    e.power = impulse.dot(v);  // r . (u - bias)
  }
  e.velocity_scale = std::sqrt(free_square) / std::sqrt(static_cast<double>(q.size()));
  return e;
}

/// Every measure from dense matrices.
ContactError dense_error(const FrictionProblem& p, const Impulses& r) {
  const Eigen::MatrixXd w = oracle::dense_delassus(p);
  const Eigen::VectorXd q = oracle::dense_q(p);
  std::vector<double> lambda;
  for (int c = 0; c < p.contact_count(); ++c) {
    const int first = p.row_begin[c], rows = p.contact_rows(c);
    const Eigen::MatrixXd block = w.block(first, first, rows, rows);
    lambda.push_back(oracle::eigenvalues(block).maxCoeff());
  }
  return one_by_one(p, r, w * r + q, q, lambda);
}

/// Every measure, with the relative difference that two ways of computing it may have.
const std::pair<double ContactError::*, double> measures[] = {
    {&ContactError::natural_map_rms, 1e-7},
    {&ContactError::natural_map_max, 1e-7},
    {&ContactError::fclib, 1e-10},
    {&ContactError::cone_violation, 1e-10},
    {&ContactError::min_normal_velocity, 1e-10},
    {&ContactError::complementarity, 1e-10},
    {&ContactError::approach_rms, 1e-9},
    {&ContactError::cone_rms, 1e-7},
    {&ContactError::complementarity_rms, 1e-7},
    {&ContactError::immovable_approach, 1e-12},
    {&ContactError::growth, 1e-7},
    {&ContactError::power, 1e-9},
    {&ContactError::velocity_scale, 1e-12}};

void check_same(const ContactError& a, const ContactError& b) {
  for (const auto& [measure, epsilon] : measures)
    CHECK(a.*measure == Approx(b.*measure).epsilon(epsilon));
  CHECK(a.worst_contact == b.worst_contact);
}

Impulses random_impulses(int rows, std::uint64_t seed, double size = 1.0) {
  Random random(seed);
  Impulses r(rows);
  for (double& x : r) x = size * random.uniform(-1, 1);
  return r;
}

}  // namespace

TEST_CASE("the judge agrees with dense matrices") {
  const FrictionProblem problems[] = {oracle::mixed_problem(), make_known_solution({}).problem};
  for (const FrictionProblem& problem : problems) {
    const Impulses r = random_impulses(problem.row_count(), 31);
    const ContactError error = contact_error(problem, r);
    check_same(error, dense_error(problem, r));
    CHECK(error.finite);

    ContactError from_w = contact_error(only_delassus(problem), r);
    CHECK(from_w.power ==
          Approx(error.power + r.dot(problem.dynamics.bias)));  // W and q contain no bias
    from_w.power = error.power;
    from_w.growth = error.growth;  // nor momenta
    check_same(from_w, error);
  }
}

TEST_CASE("Siconos' measure alone is the judge's") {
  const FrictionProblem problems[] = {oracle::mixed_problem(), make_known_solution({}).problem};
  for (const FrictionProblem& bodies : problems)
    for (const FrictionProblem& problem : {bodies, only_delassus(bodies)}) {
      const int rows = problem.row_count();
      ContactJudge judge;
      double free_norm = -1.0;
      for (const Impulses& r : {random_impulses(rows, 5), Impulses(Impulses::Zero(rows)),
                                random_impulses(rows, 6, 1e-3)}) {
        const double measure = judge.fclib(problem, r, free_norm);
        CHECK(measure == Approx(contact_error(problem, r).fclib).epsilon(1e-13));
      }
      Impulses broken = random_impulses(rows, 7);
      broken[1] = std::numeric_limits<double>::quiet_NaN();
      CHECK(judge.fclib(problem, broken, free_norm) == std::numeric_limits<double>::infinity());
    }
}

TEST_CASE("a team judges with the bits of one thread") {
  const FrictionProblem problem = make_known_solution({.contacts = 700}).problem;
  const Impulses r = random_impulses(problem.row_count(), 32);
  const ContactError alone = contact_error(problem, r);
  for (const int threads : {1, 2, 5}) {
    WorkerTeam team;
    team.resize(threads);
    ContactJudge judge;
    judge.use_team(&team);
    const ContactError error = judge.judge(problem, r);
    for (const auto& [measure, epsilon] : measures) CHECK(error.*measure == alone.*measure);
    CHECK(error.worst_contact == alone.worst_contact);
  }
  check_same(alone, dense_error(problem, r));  // the judge divides its work
}

TEST_CASE("the judge leaves the bodies' velocities, with contacts and without: then no error") {
  FrictionProblem problem = make_known_solution({}).problem;
  const Impulses r = Impulses::Constant(problem.row_count(), 0.5);
  ContactJudge judge;
  judge.judge(problem, r);
  Eigen::VectorXd v;
  body_velocity(problem.dynamics, problem.row_begin, r, v);
  CHECK(judge.body_velocity() == v);
  Eigen::VectorXd p;
  contact_to_body_impulse(problem.dynamics, problem.row_begin, r, p);
  CHECK(judge.body_impulse() == p);
  problem.row_begin = problem.dynamics.h_begin = {0};
  problem.friction.clear();
  problem.dynamics.body_a.clear();
  problem.dynamics.body_b.clear();
  problem.dynamics.h.clear();
  problem.dynamics.bias.resize(0);
  problem.validate();
  const ContactError error = judge.judge(problem, Impulses());
  CHECK(judge.body_velocity() == problem.dynamics.v_free);
  CHECK((error.natural_map_rms == 0.0 && error.worst_contact == -1 && error.finite));
}

TEST_CASE("impulses that are not numbers make every measure infinite") {
  const FrictionProblem problem = oracle::mixed_problem();
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Impulses r = Impulses::Zero(problem.row_count());
    r[4] = bad;
    const ContactError error = contact_error(problem, r);
    CHECK_FALSE(error.finite);
    CHECK(error.natural_map_rms == std::numeric_limits<double>::infinity());
    CHECK(error.fclib == std::numeric_limits<double>::infinity());
  }
  CHECK_THROWS_AS(contact_error(problem, Impulses::Zero(3)), InvalidProblem);
}

TEST_CASE("up to mu = sqrt(15) the natural map bounds the other parts of the law") {
  Random random(33);
  for (int k = 0; k < 20000; ++k) {
    const double mu = random.uniform(0.0, std::sqrt(15.0));
    Eigen::Matrix3d a;
    for (double& x : a.reshaped()) x = random.uniform(-1, 1);
    const Eigen::Vector3d q(random.uniform(-1, 1), random.uniform(-1, 1), 0.0);
    const FrictionProblem problem = stored_problem({mu}, a * a.transpose(), q);
    Impulses r(3);
    for (double& x : r) x = random.uniform(-1, 1) * random.log_uniform(1e-3, 1e3);
    const ContactError error = contact_error(problem, r);
    const double bound = ContactError::bound_factor * error.natural_map_rms * (1.0 + 1e-6);
    REQUIRE(error.approach_rms <= bound);
    REQUIRE(error.cone_rms <= bound);
    REQUIRE(error.complementarity_rms <= bound);
    REQUIRE(error.within(error.natural_map_rms * (1.0 + 1e-6)));
  }
}

TEST_CASE("the largest eigenvalue agrees with an iterative solver") {
  Random random(32);
  for (int k = 0; k < 200000; ++k) {
    const double scale = random.log_uniform(1e-30, 1e30);
    Eigen::Matrix3d a;
    for (double& x : a.reshaped()) x = random.uniform(-1, 1);
    if (k % 3 == 0) a.col(2) = a.col(1);                         // singular
    if (k % 3 == 1) a = Eigen::Matrix3d::Identity() + 1e-9 * a;  // nearly multiple
    const Eigen::Matrix3d block = scale * a * a.transpose();
    const double expected = oracle::eigenvalues(block)[2];
    REQUIRE(std::abs(largest_eigenvalue(block) - expected) <= 5e-8 * expected);
    if (k % 3 == 0) REQUIRE(std::abs(largest_eigenvalue(block) - expected) <= 1e-10 * expected);
  }
  CHECK(largest_eigenvalue(Eigen::Matrix3d::Zero()) == 0.0);
  for (const double hair : {1e-200, 1e-150, 1e-120, 1e-105, 1e-60}) {
    Eigen::Matrix3d nearly = Eigen::Matrix3d::Identity();
    nearly(0, 1) = nearly(1, 0) = hair;
    CHECK(largest_eigenvalue(nearly) == 1.0);
  }
  CHECK(largest_eigenvalue(Eigen::Vector3d(3, 0, 0).asDiagonal().toDenseMatrix()) == 3.0);
  CHECK(largest_eigenvalue(Eigen::Vector3d(1, 5, 5).asDiagonal().toDenseMatrix()) == 5.0);
}

namespace {

/// A number of size 10^-spread to 10^spread and either sign, or sometimes 0.
double some(Random& random, double spread) {
  if (random.below(12) == 0) return 0.0;
  return random.uniform(-1, 1) * std::pow(10.0, random.uniform(-spread, spread));
}

/// A share of the judge's work: uncoupled contacts by W and q that are open, sticking or slipping,
/// with impulses that are sometimes exactly on the cone.
std::pair<FrictionProblem, Impulses> one_share(Random& random) {
  constexpr int contacts = 64;
  FrictionProblem p;
  p.has_delassus = true;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> q, r;
  for (int c = 0; c < contacts; ++c) {
    const int rows = random.below(4) == 0 ? 1 : 3, first = p.row_count();
    p.row_begin.push_back(first + rows);
    p.friction.push_back(rows == 1 ? 0.0 : random.uniform(0, random.below(5) == 0 ? 1e4 : 2.0));
    Eigen::Matrix3d root = Eigen::Matrix3d::NullaryExpr([&] { return some(random, 2.0); });
    if (random.below(5) == 0) root = root.diagonal().asDiagonal();
    if (random.below(20) == 0) root.setZero();
    const Eigen::Matrix3d w = root * root.transpose();
    for (int i = 0; i < rows; ++i) {
      for (int k = 0; k < rows; ++k) entries.emplace_back(first + i, first + k, w(i, k));
      q.push_back(some(random, 3.0));
      r.push_back(some(random, 3.0));
    }
    if (rows == 3 && random.below(3) == 0)
      r[first] = std::hypot(r[first + 1], r[first + 2]) / std::max(p.friction[c], 0.1);
  }
  p.delassus.w.resize(p.row_count(), p.row_count());
  p.delassus.w.setFromTriplets(entries.begin(), entries.end());
  p.delassus.q = Eigen::Map<Eigen::VectorXd>(q.data(), p.row_count());
  return {p, Eigen::Map<Eigen::VectorXd>(r.data(), p.row_count())};
}

}  // namespace

/// Grains with diagonal masses, as a time step has them, are evaluated in one pass over their rows.
TEST_CASE("the judge's measures are those of the contacts one by one, bit for bit") {
  Random random(77);
  std::vector<std::pair<FrictionProblem, Impulses>> asked;
  for (const FrictionProblem& problem :
       {make_pile({.contacts = 60, .mass_ratio = 50.0}), oracle::mixed_problem(),
        make_known_solution({.seed = 3}).problem})
    asked.emplace_back(problem, random_impulses(problem.row_count(), 41, 1e-2));
  for (int k = 0; k < 300; ++k) asked.push_back(one_share(random));
  int unmovable = 0;
  ContactJudge judge;  // the same judge for problems of different sizes
  for (const auto& [problem, r] : asked) {
    Eigen::VectorXd u, q;
    contact_velocity(problem, r, u);
    free_contact_velocity(problem, q);
    std::vector<Eigen::Matrix3d> blocks;
    delassus_diagonal(problem, blocks);
    std::vector<double> lambda;
    for (const Eigen::Matrix3d& block : blocks) lambda.push_back(largest_eigenvalue(block));
    const ContactError error = judge.judge(problem, r);
    const ContactError expected = one_by_one(problem, r, u, q, lambda);
    for (const auto& [measure, epsilon] : measures)
      if (measure != &ContactError::growth) REQUIRE(error.*measure == expected.*measure);
    REQUIRE(error.growth == Approx(expected.growth).epsilon(1e-14));
    REQUIRE(error.worst_contact == expected.worst_contact);
    const std::vector<double> each = errors_by_contact(problem, r);
    REQUIRE(each.size() == lambda.size());
    REQUIRE(*std::max_element(each.begin(), each.end()) == error.natural_map_max);
    REQUIRE(each[error.worst_contact] == error.natural_map_max);
    unmovable += std::count(lambda.begin(), lambda.end(), 0.0) > 0;
  }
  CHECK(unmovable > 100);
  Impulses bad = Impulses::Zero(3);
  bad[0] = std::nan("");
  CHECK(errors_by_contact(only_delassus(make_pile({.contacts = 1})), bad)[0] ==
        std::numeric_limits<double>::infinity());
}
