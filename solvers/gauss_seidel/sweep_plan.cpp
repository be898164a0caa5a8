#include "solvers/gauss_seidel/sweep_plan.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace ballast {
namespace {

/// The numbers 0, 1, ... in the order of their keys: those of key k are sorted[begin[k]] to before
/// sorted[begin[k + 1]], ascending. Keys are 0 .. count - 1.
void sort_by_key(const std::vector<int>& keys, int count, std::vector<int>& begin,
                 std::vector<int>& sorted) {
  begin.assign(count + 1, 0);
  for (const int key : keys) ++begin[key + 1];
  for (int key = 0; key < count; ++key) begin[key + 1] += begin[key];
  sorted.resize(keys.size());
  for (size_t i = 0; i < keys.size(); ++i) sorted[begin[keys[i]]++] = static_cast<int>(i);
  // Each begin has been moved to its key's end, where the next key begins.
  std::shift_right(begin.begin(), begin.end(), 1);
  begin[0] = 0;
}

}  // namespace

void SweepPlan::prepare(const FrictionProblem& problem) {
  opening_.resize(problem.contact_count());
  // To find the slabs is a walk from body to body.
  run_ranges(
      team_, problem.contact_count(), /*together=*/128,
      [&](int begin, int end) { find_openings(problem, begin, end); },
      [&] { find_slabs(problem.dynamics); });
  order(problem);
  share_slabs();
}

void SweepPlan::find_slabs(const DynamicsForm& dynamics) {
  slab_.assign(dynamics.body_count(), 0);
  slabs_ = 1;
  const int wanted = dynamics.body_count() / slab_bodies;
  if (wanted > 1) {
    weigh(dynamics);
    sort_by_neighbours(dynamics);
    // Slabs of a large box must be thicker than is wanted, and not too few for a team.
    const int least = std::min(wanted, least_slabs);
    int slabs = wanted;
    while (slabs >= least && !cut_in_order(dynamics, slabs)) slabs = slabs * 3 / 4;
    if (slabs < least) {
      find_levels(dynamics);
      cut_levels(wanted);
    }
  }
  sort_by_key(slab_, slabs_, body_begin_, bodies_);
}

/// Every body weighs its contacts.
void SweepPlan::weigh(const DynamicsForm& dynamics) {
  weight_.assign(dynamics.body_count(), 0);
  total_weight_ = 0;
  for (size_t c = 0; c < dynamics.body_a.size(); ++c)
    for (const int body : {dynamics.body_a[c], dynamics.body_b[c]})
      if (body >= 0) {
        ++weight_[body];
        ++total_weight_;
      }
}

/// Queues the bodies by the mean number of themselves and of those that they touch: so those that
/// have strayed from where they were numbered come to their neighbours.
void SweepPlan::sort_by_neighbours(const DynamicsForm& dynamics) {
  const int bodies = dynamics.body_count();
  number_sum_.resize(bodies);
  std::iota(number_sum_.begin(), number_sum_.end(), 0L);
  count_.assign(bodies, 1);
  for (size_t c = 0; c < dynamics.body_a.size(); ++c) {
    const int a = dynamics.body_a[c], b = dynamics.body_b[c];
    if (a < 0 || b < 0) continue;
    number_sum_[a] += b;
    number_sum_[b] += a;
    ++count_[a];
    ++count_[b];
  }
  key_.resize(bodies);
  for (int b = 0; b < bodies; ++b) key_[b] = static_cast<int>(number_sum_[b] / count_[b]);
  sort_by_key(key_, bodies, count_, queue_);
}

/// Slabs of about equally many contacts, each a range of the queue. Returns false where they are no
/// slabs: more than an eighth of the contacts for each cut would be in interfaces, or two
/// interfaces share a body.
bool SweepPlan::cut_in_order(const DynamicsForm& dynamics, int wanted) {
  long passed = 0, crossing = 0;
  for (const int body : queue_) {
    // bodies without contacts may come after the last contact
    slab_[body] =
        std::min(wanted - 1, static_cast<int>(passed * wanted / std::max(1L, total_weight_)));
    passed += weight_[body];
  }
  slabs_ = wanted;
  meets_.assign(dynamics.body_count(), 0);
  for (size_t c = 0; c < dynamics.body_a.size(); ++c) {
    const int a = dynamics.body_a[c], b = dynamics.body_b[c];
    if (a < 0 || b < 0 || slab_[a] == slab_[b]) continue;
    const auto [low, high] = slab_[a] < slab_[b] ? std::pair(a, b) : std::pair(b, a);
    ++crossing;
    meets_[low] |= 2;
    meets_[high] |= 1;
    if (slab_[high] != slab_[low] + 1 || meets_[low] == 3 || meets_[high] == 3) return false;
  }
  return crossing * 8 <= static_cast<long>(dynamics.body_a.size()) * (wanted - 1);
}

/// Levels from a body at the rim: the last one that a first search reached.
void SweepPlan::find_levels(const DynamicsForm& dynamics) {
  const int bodies = dynamics.body_count(), contacts = static_cast<int>(dynamics.body_a.size());
  // The graph of bodies as lists of neighbours: the ends of contacts by their bodies, each then
  // replaced by the contact's other end. Of the contacts of a pair that follow each other one does.
  ends_.clear();
  ends_.reserve(2 * contacts);
  for (int c = 0; c < contacts; ++c) {
    const int a = dynamics.body_a[c], b = dynamics.body_b[c];
    if (a < 0 || b < 0 || (c > 0 && a == dynamics.body_a[c - 1] && b == dynamics.body_b[c - 1]))
      continue;
    ends_.insert(ends_.end(), {a, b});
  }
  sort_by_key(ends_, bodies, neighbour_begin_, neighbour_);
  for (int& end : neighbour_) end = ends_[end ^ 1];
  // Component by component: a search to its rim, and the levels from there.
  level_.assign(bodies, -1);
  queue_.clear();
  queue_.reserve(bodies);
  levels_ = 0;
  for (int root = 0; root < bodies; ++root) {
    if (level_[root] >= 0) continue;
    const size_t first = queue_.size();
    breadth_first(root, 0);
    const int rim = queue_.back();
    for (size_t i = first; i < queue_.size(); ++i) level_[queue_[i]] = -1;
    queue_.resize(first);
    levels_ = breadth_first(rim, levels_) + 1;
  }
}

/// Appends the component of `root` to the queue, numbers it from `level` on, and returns its last
/// level.
int SweepPlan::breadth_first(int root, int level) {
  size_t next = queue_.size();
  queue_.push_back(root);
  level_[root] = level;
  for (; next < queue_.size(); ++next) {
    const int body = queue_[next];
    for (int k = neighbour_begin_[body]; k < neighbour_begin_[body + 1]; ++k) {
      if (level_[neighbour_[k]] >= 0) continue;
      level_[neighbour_[k]] = level_[body] + 1;
      queue_.push_back(neighbour_[k]);
    }
  }
  return level_[queue_.back()];
}

/// Slabs of about equally many contacts, cut anywhere in the breadth-first order, but three levels
/// thick where there are more than two: then the interfaces on a slab's two sides share no body.
void SweepPlan::cut_levels(int wanted) {
  // Levels of the search, cut into slabs; interiors are contacts within a slab, and
  // interface k joins slabs k and k + 1:
  //
  //     levels   0 1 2 | 3 4 5 | 6 7 8
  //     slabs      0       1       2
  //     interfaces     0       1
  // A contact joins bodies of one level or of two that follow each other. A cut within level l is
  // thus crossed by contacts of bodies on the levels l - 1, l and l + 1 only.
  slabs_ = 1;
  long passed = 0;   // of the slab
  int last_cut = 0;  // level
  for (const int body : queue_) {
    const bool thick = level_[body] - last_cut >= 3 && levels_ - 1 - level_[body] >= 3;
    if (passed * wanted >= total_weight_ && slabs_ < wanted && (thick || wanted == 2)) {
      ++slabs_;
      last_cut = level_[body] + 1;
      passed = 0;
    }
    slab_[body] = slabs_ - 1;
    passed += weight_[body];
  }
}

/// How fast each contact opens without impulses, or how fast its gap would have to be closed: the
/// smaller; zero where it closes or has no gap.
void SweepPlan::find_openings(const FrictionProblem& problem, int begin, int end) {
  const DynamicsForm& dynamics = problem.dynamics;
  for (int c = begin; c < end; ++c) {
    const double gap = dynamics.bias[problem.row_begin[c]];
    opening_[c] = 0.0;
    if (!(gap > 0.0)) continue;
    double free = gap;
    for_normal_row(problem, c, [&](int dof, double h) { free += h * dynamics.v_free[dof]; });
    opening_[c] = std::clamp(free, 0.0, gap);
  }
}

void SweepPlan::order(const FrictionProblem& problem) {
  const DynamicsForm& dynamics = problem.dynamics;
  const int contacts = problem.contact_count(), parts = 2 * slabs_ - 1;
  // The part: of a slab, or (slabs_ + k) between the slabs k and k + 1; friction before one row;
  // then those first that close; then the contact's turn among those of its body
  constexpr int turns = 8, levels = 1 + gap_octaves, keys = levels * turns;
  // A key for every contact: contacts of a key keep their order.
  rank_.assign(dynamics.body_count() + 1, 0);
  key_.resize(contacts);
  const double widest = contacts > 0 ? *std::ranges::max_element(opening_) : 0.0;
  for (int c = 0; c < contacts; ++c) {
    const int a = dynamics.body_a[c], b = dynamics.body_b[c];
    const int first = a >= 0 ? a : b, second = b >= 0 ? b : a;
    int part = 0, turn = 0;
    if (first >= 0) {
      const int slab_a = slab_[first], slab_b = slab_[second];
      part = slab_a == slab_b ? slab_a : slabs_ + std::min(slab_a, slab_b);
      // By turns from all bodies: contacts that follow each other seldom share one, and do not
      // wait for each other's velocities.
      turn = rank_[first]++ % turns;
    }
    // 0: it closes; else the octave of its opening, the higher the wider.
    int level = 0;
    if (opening_[c] > 0.0) level = std::max(0, gap_octaves + std::ilogb(opening_[c] / widest));
    key_[c] = ((part * 2 + (problem.contact_rows(c) == 1)) * levels + level) * turns + turn;
  }
  sort_by_key(key_, parts * 2 * keys, count_, contacts_);
  parts_.clear();
  for (int k = 0; k < parts; ++k)
    parts_.push_back(
        {count_[k * 2 * keys], count_[(k * 2 + 1) * keys], count_[(k + 1) * 2 * keys]});
}

/// Some ranges for each member, so that others can do what one that is late has not begun.
void SweepPlan::share_slabs() {
  constexpr int ranges_of_member = 4;
  const int members = std::min(size_of(team_), slabs_),
            ranges = members > 1 ? ranges_of_member * size_of(team_) : 1;
  const auto contacts_of = [](const Part& part) {
    return static_cast<long>(part.end - part.begin);
  };
  // A slab goes with the interface behind it.
  const long total = static_cast<long>(contacts_.size());
  long passed = 0;
  edges_.assign(1, 0);
  for (int slab = 0; slab < slabs_; ++slab) {
    const long its =
        contacts_of(parts_[slab]) + (slab + 1 < slabs_ ? contacts_of(parts_[slabs_ + slab]) : 0);
    // slabs without contacts may come last
    const long range = std::min(ranges - 1L, (2 * passed + its) * ranges / std::max(1L, 2 * total));
    while (static_cast<long>(edges_.size()) <= range) edges_.push_back(slab);
    passed += its;
  }
  edges_.resize(ranges + 1, slabs_);
}

void ContactGroups::make(std::span<const int> contacts, std::span<const int> body_a,
                         std::span<const int> body_b, int bodies) {
  lanes_.clear();
  fill_.clear();
  next_.clear();
  last_.assign(bodies, -1);
  for (size_t i = 0; i < contacts.size(); ++i) {
    const int a = body_a[i], b = body_b[i];
    // After both bodies' last groups.
    const int group =
        first_with_room(std::max(a >= 0 ? last_[a] + 1 : 0, b >= 0 ? last_[b] + 1 : 0));
    lanes_[static_cast<size_t>(group) * group_lanes + fill_[group]] = contacts[i];
    if (++fill_[group] == group_lanes) next_[group] = group + 1;
    if (a >= 0) last_[a] = group;
    if (b >= 0) last_[b] = group;
  }
}

/// Full groups point onwards; what was walked past is pointed at the end of the walk.
int ContactGroups::first_with_room(int group) {
  // A union-find on groups: next_ leads towards one with room, and is shortened where it was
  // walked, so that a look-up takes nearly constant time however many groups are full.
  int end = group;
  while (end < count() && next_[end] != end) end = next_[end];
  if (end == count()) {
    lanes_.insert(lanes_.end(), group_lanes, -1);
    next_.push_back(end);
    fill_.push_back(0);
  }
  while (group != end) {
    const int onwards = next_[group];
    next_[group] = end;
    group = onwards;
  }
  return end;
}

}  // namespace ballast
