// What WideSweep makes of a problem before its first sweep: groups, their records, free velocities.

#include <algorithm>

#include "problems/algebra/delassus.hpp"
#include "solvers/gauss_seidel/wide_sweep.hpp"

namespace ballast {
namespace {

/// Groups with fewer contacts on average cost more than contacts one by one.
constexpr double least_fill = 0.4;

constexpr int row_bytes = sizeof(BodyRow<double>);

/// Unused elements between those of two parts, so that no page holds elements of both: threads
/// share no line, and what a processor fetches ahead of the end of a part is not written by
/// another.
template <typename Element>
constexpr int elements_apart() {
  constexpr int page = 4096;  // bytes
  return page / sizeof(Element);
}

/// diag(m, m, m, 3 x 3), column-major.
bool is_grain_mass(const double* mass) {
  if (!(mass[0] == mass[7] && mass[0] == mass[14])) return false;
  for (int j = 0; j < 3; ++j)
    for (int i = j + 1; i < 6; ++i)
      if (mass[j * 6 + i] != 0.0) return false;
  return true;
}

}  // namespace

bool WideSweep::prepare(const FrictionProblem& problem) {
  if (!sort_bodies(problem.dynamics) || !may_fill_lanes(problem.dynamics)) return false;
  if (!group_contacts(problem)) return false;
  factor_masses(problem.dynamics, roots_);
  bool made = true;
  for_kinds(
      [&](auto& kind, const auto& loops) { made = made && make_records(problem, kind, loops); },
      exact_, kernels_->exact);
  if (made) free_bodies(problem.dynamics);
  single_made_ = false;
  return made;
}

/// Grains and driven walls, or not.
bool WideSweep::sort_bodies(const DynamicsForm& dynamics) {
  const int bodies = dynamics.body_count();
  is_wall_.resize(bodies);
  for (int b = 0; b < bodies; ++b) {
    is_wall_[b] = dynamics.body_dofs(b) == 1;
    if (is_wall_[b]) continue;
    if (dynamics.body_dofs(b) != 6 || !is_grain_mass(&dynamics.mass[dynamics.mass_begin[b]]))
      return false;
  }
  return true;
}

/// False: however contacts are grouped, too many lanes stay empty. Contacts of one grain never
/// share a group, so there are as many groups as some grain has contacts, at least.
bool WideSweep::may_fill_lanes(const DynamicsForm& dynamics) {
  contacts_of_body_.assign(is_wall_.size(), 0);
  int contacts = 0, most = 0;
  for (size_t c = 0; c < dynamics.body_a.size(); ++c) {
    const int a = dynamics.body_a[c], b = dynamics.body_b[c];
    if ((a >= 0 && is_wall_[a]) || (b >= 0 && is_wall_[b]) || (a < 0 && b < 0)) continue;
    ++contacts;
    if (a >= 0) most = std::max(most, ++contacts_of_body_[a]);
    if (b >= 0) most = std::max(most, ++contacts_of_body_[b]);
  }
  return contacts >= least_fill * group_lanes * most;
}

/// The rows of a slab's bodies follow each other, those that interfaces meet first; and so that
/// threads share no line, each part has a zero velocity of its own for what does not move.
void WideSweep::place_bodies(const DynamicsForm& dynamics) {
  is_shared_.assign(is_wall_.size(), 0);
  for (const SweepPlan::Part& part : std::span(plan_.parts()).subspan(plan_.slabs()))
    for (int i = part.begin; i < part.end; ++i) {
      const int c = plan_.contacts()[i];
      is_shared_[dynamics.body_a[c]] = is_shared_[dynamics.body_b[c]] = 1;
    }
  row_of_body_.resize(is_wall_.size());
  const int apart = size_of(team_) > 1 ? elements_apart<BodyRow<float>>() : 0;
  rows_ = 0;
  for (int slab = 0; slab < plan_.slabs(); ++slab) {
    Part& part = parts_[slab];
    part.bodies.begin = rows_;
    for (const char shared : {1, 0}) {
      for (const int body : plan_.bodies(slab))
        if (is_shared_[body] == shared) row_of_body_[body] = rows_++;
      if (shared) part.shared = rows_ - part.bodies.begin;
    }
    part.bodies.count = rows_ - part.bodies.begin;
    part.nowhere = rows_++;
    rows_ += apart;
  }
  for (Part& part : std::span(parts_).subspan(plan_.slabs())) {
    part.nowhere = rows_++;
    rows_ += apart;
  }
}

/// In the order of the plan, part by part.
bool WideSweep::group_contacts(const FrictionProblem& problem) {
  const DynamicsForm& dynamics = problem.dynamics;
  for_kinds(
      [](auto& kind) {
        kind.groups.clear();
        kind.frames.clear();
      },
      exact_);
  // Of each contact, the grains: walls are no conflict, and go by themselves.
  const auto grains = [&](const std::vector<int>& given, std::vector<int>& kept) {
    kept.assign(given.begin(), given.end());
    for (int& body : kept)
      if (body >= 0 && is_wall_[body]) body = -1;
  };
  grains(dynamics.body_a, grain_a_);
  grains(dynamics.body_b, grain_b_);
  contacts_ = 0;
  parts_.assign(plan_.parts().size(), {});
  place_bodies(dynamics);
  for (size_t k = 0; k < parts_.size(); ++k)
    if (!group_part(problem, plan_.parts()[k], parts_[k])) return false;
  for_kinds([](auto& kind) { kind.impulses.resize(kind.groups.size()); }, exact_);
  int groups = 0;
  for (const Part& part : parts_) groups += part.friction.count + part.one_row.count;
  size_t walls = 0;
  for (const GroupFrame& f : exact_.wall.frames)
    walls += group_lanes - std::count(f.contact, f.contact + group_lanes, -1);
  return contacts_ - walls >= least_fill * group_lanes * groups;
}

bool WideSweep::group_part(const FrictionProblem& problem, const SweepPlan::Part& part,
                           Part& made) {
  const DynamicsForm& dynamics = problem.dynamics;
  const std::vector<int>& order = plan_.contacts();
  const auto moves = [&](int c) { return dynamics.body_a[c] >= 0 || dynamics.body_b[c] >= 0; };
  const auto is_wall = [&](int body) { return body >= 0 && is_wall_[body]; };
  const auto wall_of = [&](int c) {
    for (const int body : {dynamics.body_a[c], dynamics.body_b[c]})
      if (is_wall(body)) return body;
    return -1;
  };
  const int nowhere = made.nowhere;
  // With friction, and not on a wall with an unknown.
  chosen_.clear();
  for (int i = part.begin; i < part.friction_end; ++i) {
    if (!moves(order[i])) continue;
    if (wall_of(order[i]) >= 0) return false;
    chosen_.push_back(order[i]);
  }
  made.friction = add_groups(exact_.friction, nowhere);
  // One row without a wall, then wall after wall.
  chosen_.clear();
  walls_.clear();
  for (int i = part.friction_end; i < part.end; ++i) {
    if (!moves(order[i])) continue;
    const int wall = wall_of(order[i]);
    if (wall >= 0 && is_wall(dynamics.body_a[order[i]]) && is_wall(dynamics.body_b[order[i]]))
      return false;
    if (wall < 0)
      chosen_.push_back(order[i]);
    else if (std::find(walls_.begin(), walls_.end(), wall) == walls_.end())
      walls_.push_back(wall);
  }
  made.one_row = add_groups(exact_.one_row, nowhere);
  made.wall.begin = static_cast<int>(exact_.wall.groups.size());
  for (const int wall : walls_) {
    chosen_.clear();
    for (int i = part.friction_end; i < part.end; ++i)
      if (moves(order[i]) && wall_of(order[i]) == wall) chosen_.push_back(order[i]);
    const Range added = add_groups(exact_.wall, nowhere);
    for (int g = added.begin; g < added.begin + added.count; ++g)
      exact_.wall.groups[g].wall_body = row_of_body_[wall] * row_bytes;
    made.wall.count += added.count;
  }
  // Between this part's groups and the next one's.
  if (plan_.slabs() > 1 && size_of(team_) > 1)
    for_kinds(
        [this]<typename Group>(Kind<Group>& kind) {
          add_empty_groups(kind, elements_apart<GroupImpulses<float, Group::rows>>());
        },
        exact_);
  return true;
}

template <typename Group>
void WideSweep::add_empty_groups(Kind<Group>& kind, int count) {
  GroupFrame empty = {};
  std::fill_n(empty.contact, group_lanes, -1);
  kind.groups.resize(kind.groups.size() + count);
  kind.frames.resize(kind.frames.size() + count, empty);
}

/// Groups of the contacts in chosen_, empty but for the contacts' numbers.
template <typename Group>
WideSweep::Range WideSweep::add_groups(Kind<Group>& kind, int nowhere) {
  grouping_.make(chosen_, grain_a_, grain_b_, static_cast<int>(is_wall_.size()));
  const Range range{static_cast<int>(kind.groups.size()), grouping_.count()};
  contacts_ += static_cast<int>(chosen_.size());
  add_empty_groups(kind, range.count);
  for (int g = 0; g < range.count; ++g) {
    Group& k = kind.groups[range.begin + g];
    std::copy_n(grouping_.lanes(g).begin(), group_lanes, kind.frames[range.begin + g].contact);
    for (auto& side : k.body) std::fill_n(side, group_lanes, nowhere * row_bytes);
    std::fill_n(k.bias[0], group_lanes, 1.0);  // open
  }
  return range;
}

/// Every thread makes its share: records do not depend on each other.
template <typename Group>
bool WideSweep::make_records(const FrictionProblem& problem, Kind<Group>& kind,
                             const ExactLoops<Group>& loops) {
  std::vector<char> made(size_of(team_), 1);
  run_parts(team_, size_of(team_), [&](int member) {
    const size_t begin = kind.groups.size() * member / size_of(team_),
                 end = kind.groups.size() * (member + 1) / size_of(team_);
    for (size_t g = begin; g < end; ++g) {
      Group& k = kind.groups[g];
      GroupFrame& f = kind.frames[g];
      for (int lane = 0; lane < group_lanes; ++lane)
        if (f.contact[lane] >= 0 && !fill_lane(problem, k, f, lane)) made[member] = 0;
      loops.make_principal(&k, &f, 1);
      for (int lane = 0; lane < group_lanes; ++lane)  // nothing moves it along its normal?
        if (f.contact[lane] >= 0 && !(f.lambda_max[lane] > 0.0)) made[member] = 0;
    }
  });
  return std::find(made.begin(), made.end(), 0) == made.end();
}

/// Rows and bias as the problem gives them, in the bodies' variables. False: the two sides' linear
/// parts are not opposite.
template <typename Group>
bool WideSweep::fill_lane(const FrictionProblem& problem, Group& k, GroupFrame& f, int lane) const {
  constexpr int rows = Group::rows;
  const DynamicsForm& dynamics = problem.dynamics;
  const int c = f.contact[lane];
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  const int bodies[2] = {dynamics.body_a[c], dynamics.body_b[c]};
  bool opposite = true, found = false;
  for (int s = 0; s < 2; ++s) {
    const int body = bodies[s];
    if (body < 0) continue;
    const MassRoot& root = roots_[body];
    if constexpr (requires { k.wall; })
      if (is_wall_[body]) {
        k.wall[lane] = block[0] * root.inverse[0];
        block += 1;
        continue;
      }
    k.body[s][lane] = row_of_body_[body] * row_bytes;
    k.inverse_mass[s][lane] = root.inverse[0] * root.inverse[0];
    // Both sides see the same linear rows with opposite signs: they are stored once, as b has them.
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < rows; ++i) {
        const double entry = s == 0 ? -block[j * rows + i] : block[j * rows + i];
        opposite = opposite && !(found && entry != k.line[i][j][lane]);
        k.line[i][j][lane] = entry;
      }
    root.scaled_columns<rows>(block, [&k, s, lane](int j, const double* column) {
      if (j < 3) return;
      for (int i = 0; i < rows; ++i) k.turn[s][i][j - 3][lane] = column[i];
    });
    block += rows * 6;
    found = true;
  }
  for (int i = 0; i < rows; ++i) k.bias[i][lane] = dynamics.bias[problem.row_begin[c] + i];
  f.mu[lane] = problem.friction[c];
  return opposite;
}

void WideSweep::free_bodies(const DynamicsForm& dynamics) {
  const int bodies = dynamics.body_count();
  free_.assign(rows_, {});
  exact_.bodies.assign(rows_, {});
  for (int b = 0; b < bodies; ++b) {
    // Grains keep their velocity v [m/s] in a group's coordinates; L^T is taken of the spin alone.
    double* w = free_[row_of_body_[b]].w;
    const double* v = dynamics.v_free.data() + dynamics.dof_begin[b];
    std::copy_n(v, dynamics.body_dofs(b), w);
    roots_[b].multiply_upper(dynamics.mass.data() + dynamics.mass_begin[b], w);
    if (!is_wall_[b]) std::copy_n(v, 3, w);
  }
}

}  // namespace ballast
