// WideSweep::prepare(): makes the groups, their records and the free velocities of a problem.

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include "solvers/gauss_seidel/wide_sweep.hpp"

namespace ballast {
namespace {

/// The least mean share of filled lanes. With fewer, groups cost more than contacts one by one.
constexpr double least_fill = 0.4;

constexpr int row_bytes = sizeof(BodyRow<double>);

/// The number of unused elements between those of two parts, so that no page holds elements of
/// both: threads share no cache line, and no thread writes what a processor prefetches beyond the
/// end of another thread's part.
template <typename Element>
constexpr int elements_apart() {
  constexpr int page = 4096;  // bytes
  return page / sizeof(Element);
}

/// Rounds all numbers of an array, however many indices it has.
template <typename From, typename To, size_t Count>
void cast_all(const From (&from)[Count], To (&to)[Count]) {
  for (size_t i = 0; i < Count; ++i)
    if constexpr (std::is_array_v<From>)
      cast_all(from[i], to[i]);
    else
      to[i] = static_cast<To>(from[i]);
}

template <typename Double, typename Single>
void cast_group(const Double& k, Single& s) {
  cast_all(k.bias, s.bias);
  cast_all(k.inverse_mass, s.inverse_mass);
  cast_all(k.line, s.line);
  cast_all(k.turn, s.turn);
  // Byte offsets of body rows are half as large in single precision.
  for (int side = 0; side < 2; ++side)
    for (int lane = 0; lane < group_lanes; ++lane) s.body[side][lane] = k.body[side][lane] / 2;
  if constexpr (requires { k.mu; }) {
    cast_all(k.s2, s.s2);
    cast_all(k.inverse_s2, s.inverse_s2);
    cast_all(k.c1, s.c1);
    cast_all(k.c2, s.c2);
    cast_all(k.mu, s.mu);
    cast_all(k.inverse_mu, s.inverse_mu);
  }
  if constexpr (requires { k.wall; }) {
    cast_all(k.wall, s.wall);
    s.wall_body = k.wall_body / 2;
  }
}

/// Returns whether `mass` (column-major) is diag(m, m, m, 3 x 3).
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
  place_bodies(problem.dynamics);
  if (!group_contacts(problem.dynamics)) return false;
  factor_masses(problem.dynamics, roots_);
  exact_made_ = false;
  if (!make_records<float>(problem)) return false;
  free_bodies(problem.dynamics);
  return true;
}

/// Makes the records in double, which only few solves need.
void WideSweep::need_exact() {
  if (std::exchange(exact_made_, true)) return;
  for_each_kind(
      [](auto& exact) {
        exact.groups.resize(exact.frames.size());
        exact.impulses.resize(exact.frames.size());
      },
      exact_);
  make_records<double>(*problem_);
}

/// Finds the driven walls. Returns whether all other bodies are grains.
bool WideSweep::sort_bodies(const DynamicsForm& dynamics) {
  const int bodies = dynamics.body_count();
  is_wall_.resize(bodies);
  for (int b = 0; b < bodies; ++b) {
    const int dofs = dynamics.body_dofs(b);
    is_wall_[b] = dofs == 1;
    if (!is_wall_[b] && (dofs != 6 || !is_grain_mass(&dynamics.mass[dynamics.mass_begin[b]])))
      return false;
  }
  return true;
}

/// False: however contacts are grouped, too many lanes stay empty. Contacts of one grain never
/// share a group, so there are at least as many groups as any grain has contacts.
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

/// Gives consecutive rows to the bodies of a slab, first to those with contacts in an interface.
/// Each part has its own zero velocity for sides that do not move: threads share no cache line.
void WideSweep::place_bodies(const DynamicsForm& dynamics) {
  parts_.assign(plan_.parts().size(), {});
  is_shared_.assign(is_wall_.size(), 0);
  for (const SweepPlan::Part& part : std::span(plan_.parts()).subspan(plan_.slabs()))
    for (int i = part.begin; i < part.end; ++i) {
      const int c = plan_.contacts()[i];
      is_shared_[dynamics.body_a[c]] = is_shared_[dynamics.body_b[c]] = 1;
    }
  row_of_body_.resize(is_wall_.size());
  const int apart = size_of(plan_.team()) > 1 ? elements_apart<BodyRow<float>>() : 0;
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

/// Groups the contacts in the order of the plan. Every thread groups its share of the parts.
bool WideSweep::group_contacts(const DynamicsForm& dynamics) {
  const int count = static_cast<int>(parts_.size());
  if (groupings_.size() < parts_.size()) groupings_.resize(parts_.size());
  for_parts_by_slab([&](int k) { parts_[k].is_vectorisable = group_part(dynamics, k); });
  contacts_ = 0;
  int groups = 0, walls = 0;
  struct {
    int friction = 0, one_row = 0, wall = 0;
  } end;  // of each kind's groups
  for (int k = 0; k < count; ++k) {
    Part& part = parts_[k];
    if (!part.is_vectorisable) return false;
    for_each_kind(
        [this]<typename Group>(const Kind<Group>&, Range& range, int& last) {
          range.begin = last;
          last += range.count;
          // between this part's groups and the next one's
          if (range.count > 0 && plan_.slabs() > 1 && size_of(plan_.team()) > 1)
            last += elements_apart<GroupImpulses<float, Group::rows>>();
        },
        exact_, part, end);
    contacts_ += groupings_[k].contacts;
    walls += groupings_[k].on_walls;
    groups += part.friction.count + part.one_row.count;
  }
  for_each_kind(
      [](auto& exact, auto& single, int last) {
        exact.frames.resize(last);
        single.groups.resize(last);
        single.impulses.resize(last);
        single.seen.resize(last);
        single.awake.resize(last);
      },
      exact_, single_, end);
  return contacts_ - walls >= least_fill * group_lanes * groups;
}

/// Makes the groups of a part. False: a contact with friction is on a driven wall, or a contact is
/// between two driven walls.
bool WideSweep::group_part(const DynamicsForm& dynamics, int number) {
  const SweepPlan::Part& part = plan_.parts()[number];
  Part& made = parts_[number];
  Grouping& grouping = groupings_[number];
  const std::span<const int> order = plan_.contacts();
  // Grains are numbered from the part's first row on. An interface lies between two consecutive
  // slabs.
  const Part* slab = &parts_[number < plan_.slabs() ? number : number - plan_.slabs()];
  const Part* last = number < plan_.slabs() ? slab : slab + 1;
  const int first = slab->bodies.begin, rows = last->bodies.begin + last->bodies.count - first;
  const auto is_wall = [&](int body) { return body >= 0 && is_wall_[body]; };
  const auto row = [&](int body) {
    return body < 0 || is_wall_[body] ? -1 : row_of_body_[body] - first;
  };
  // A thread's scratch space.
  thread_local ContactGroups groups;
  thread_local std::vector<int> chosen, rows_a, rows_b, walls;
  const auto group = [&](int begin, int end, int wall, std::vector<int>& lanes) {
    for (std::vector<int>* list : {&chosen, &rows_a, &rows_b}) list->clear();
    for (const int c : order.subspan(begin, end - begin)) {
      const int a = dynamics.body_a[c], b = dynamics.body_b[c];
      if ((a < 0 && b < 0) || (is_wall(a) ? a : is_wall(b) ? b : -1) != wall) continue;
      chosen.push_back(c);
      rows_a.push_back(row(a));
      rows_b.push_back(row(b));
    }
    groups.make(chosen, rows_a, rows_b, rows);
    for (int g = 0; g < groups.count(); ++g)
      lanes.insert(lanes.end(), groups.lanes(g).begin(), groups.lanes(g).end());
    grouping.contacts += static_cast<int>(chosen.size());
    return groups.count();
  };
  for_each_kind([](auto& lanes) { lanes.clear(); }, grouping);
  grouping.wall_of_group.clear();
  grouping.contacts = 0;
  walls.clear();
  // The driven walls, in the order in which they appear.
  for (int i = part.begin; i < part.end; ++i) {
    const int a = dynamics.body_a[order[i]], b = dynamics.body_b[order[i]];
    if (!is_wall(a) && !is_wall(b)) continue;
    if (i < part.friction_end || (is_wall(a) && is_wall(b))) return false;
    const int wall = is_wall(a) ? a : b;
    if (std::ranges::find(walls, wall) == walls.end()) walls.push_back(wall);
  }
  made.friction.count = group(part.begin, part.friction_end, -1, grouping.friction);
  made.one_row.count = group(part.friction_end, part.end, -1, grouping.one_row);
  const int before = grouping.contacts;
  for (const int wall : walls) {
    const int added = group(part.friction_end, part.end, wall, grouping.wall);
    grouping.wall_of_group.insert(grouping.wall_of_group.end(), added, wall);
    made.wall.count += added;
  }
  grouping.on_walls = grouping.contacts - before;
  return true;
}

/// Makes the frames, and the records in double or single precision; every thread those of its share
/// of the parts.
template <typename Number>
bool WideSweep::make_records(const FrictionProblem& problem) {
  constexpr bool is_double = sizeof(Number) == 8;
  for_parts_by_slab([&](int number) {
    Part& part = parts_[number];
    const Grouping& grouping = groupings_[number];
    for_each_kind(
        [&](auto& exact, auto& single, const auto& lanes, const Range& range, const auto& loops) {
          std::decay_t<decltype(exact.groups[0])> here;
          for (int g = 0; g < range.count; ++g) {
            const int at = range.begin + g;
            auto& k = is_double ? exact.groups[at] : here;
            const bool made = make_group(problem, lanes.data() + g * group_lanes, part.nowhere, k,
                                         exact.frames[at], loops);
            part.is_vectorisable = part.is_vectorisable && made;
            if constexpr (requires { k.wall; })
              k.wall_body = row_of_body_[grouping.wall_of_group[g]] * row_bytes;
            if (!is_double) cast_group(k, single.groups[at]);
          }
        },
        exact_, single_, grouping, part, kernels_->exact);
  });
  return std::ranges::all_of(parts_, &Part::is_vectorisable);
}

/// Makes the record of the contacts in `lanes`. False: there is a contact of another kind.
template <typename Group>
bool WideSweep::make_group(const FrictionProblem& problem, const int* lanes, int nowhere, Group& k,
                           GroupFrame& f, const ExactLoops<Group>& loops) const {
  std::memset(&k, 0, sizeof k);
  std::memset(&f, 0, sizeof f);
  std::copy_n(lanes, group_lanes, f.contact);
  for (auto& side : k.body) std::fill_n(side, group_lanes, nowhere * row_bytes);
  std::fill_n(f.bias[0], group_lanes, 1.0);  // open
  bool made = true;
  for (int lane = 0; lane < group_lanes; ++lane)
    if (lanes[lane] >= 0 && !fill_lane(problem, k, f, lane)) made = false;
  loops.make_principal(k, f);
  std::copy_n(&f.bias[0][0], Group::rows * group_lanes, &k.bias[0][0]);
  for (int lane = 0; lane < group_lanes; ++lane)  // 0: nothing moves it along its normal
    if (lanes[lane] >= 0 && !(f.lambda_max[lane] > 0.0)) made = false;
  return made;
}

/// Writes rows, bias and mu as the problem gives them, in the bodies' variables. False: the two
/// sides' linear parts are not opposite.
template <typename Group>
bool WideSweep::fill_lane(const FrictionProblem& problem, Group& k, GroupFrame& f, int lane) const {
  constexpr int rows = Group::rows;
  const DynamicsForm& dynamics = problem.dynamics;
  const int c = f.contact[lane];
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  const int bodies[2] = {dynamics.body_a[c], dynamics.body_b[c]};
  const double* linear[2] = {};
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
    root.scaled_columns<rows>(block, [&k, s, lane](int j, const double* column) {
      if (j < 3) return;
      for (int i = 0; i < rows; ++i) k.turn[s][i][j - 3][lane] = column[i];
    });
    linear[s] = block;
    block += rows * 6;
  }
  // Both sides have the same linear rows with opposite signs: they are stored once, as for b.
  const double sign = linear[1] ? 1.0 : -1.0, *line = linear[1] ? linear[1] : linear[0];
  int unlike = 0;
  for (int j = 0; line && j < 3; ++j)
    for (int i = 0; i < rows; ++i) {
      k.line[i][j][lane] = sign * line[j * rows + i];
      unlike += linear[0] && linear[1] && linear[0][j * rows + i] != -line[j * rows + i];
    }
  for (int i = 0; i < rows; ++i) f.bias[i][lane] = dynamics.bias[problem.row_begin[c] + i];
  f.mu[lane] = problem.friction[c];
  return unlike == 0;
}

void WideSweep::free_bodies(const DynamicsForm& dynamics) {
  free_.assign(rows_, {});
  exact_.bodies.assign(rows_, {});
  run_each(plan_.team(), dynamics.body_count(), /*together=*/64, [&](int b) {
    // Grains keep their velocity v [m/s]; only the angular velocity is multiplied by L^T.
    double* w = free_[row_of_body_[b]].w;
    const double* v = dynamics.v_free.data() + dynamics.dof_begin[b];
    std::copy_n(v, dynamics.body_dofs(b), w);
    roots_[b].multiply_upper(dynamics.mass.data() + dynamics.mass_begin[b], w);
    if (!is_wall_[b]) std::copy_n(v, 3, w);
  });
}

}  // namespace ballast
