#include "geometry/shape/filled_dents.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "geometry/shape/point_sets.hpp"

namespace ballast {
namespace {

class DentFiller {
 public:
  /// The mesh must outlive this.
  explicit DentFiller(const Polyhedron& mesh) : centre_(mesh.vertex(0)), mesh_(mesh) {
    double size = 0.0;
    for (const Vec3& p : mesh.vertices()) size = std::max(size, (p - centre_).norm());
    inside_ = mean(mesh.vertices()) - centre_;
    blur_ = 1e-12 * size;  // a thousandth of what a Polyhedron takes for flat
    cut_into_triangles();
  }

  /// Whether no edge is bent inward any more.
  bool fill() {
    for (int f = 0; f < count(); ++f)
      for (int k = 0; k < 3; ++k)
        if (corner(f, k) < corner(f, k + 1) && is_bent_inward(f, k)) ask(f, k);
    do {
      while (!asked_.empty()) {
        if (work_ > most_work * triangles_.size()) return false;
        const Edge edge = asked_.back();
        asked_.pop_back();
        if (!is_bent_inward(edge) || step(edge.triangle, side_of(edge))) continue;
        stuck_.push_back(edge);
      }
    } while (take_out_corners());
    return stuck_.empty();
  }

  Loops loops() const {
    Loops loops;
    for (const Triangle& t : triangles_)
      if (t.corner[0] >= 0) loops.push_back({t.corner.begin(), t.corner.end()});
    return loops;
  }

 private:
  /// across[k]: the triangle across corner k -> k + 1. Corners of one that is gone are -1.
  struct Triangle {
    std::array<int, 3> corner, across;
  };
  /// An edge of a triangle that may be gone.
  struct Edge {
    int triangle, from, to;
  };

  /// Each face into a fan about its first corner.
  void cut_into_triangles() {
    std::vector<int> first{0};
    for (int f = 0; f < mesh_.face_count(); ++f)
      first.push_back(first.back() + static_cast<int>(mesh_.face(f).size()) - 2);
    // The triangle of face f at its side k.
    const auto at_side = [&](int f, int k) {
      const auto i = static_cast<size_t>(f);
      return std::clamp(first[i] + k - 1, first[i], first[i + 1] - 1);
    };
    for (int f = 0; f < mesh_.face_count(); ++f) {
      const std::span<const int> loop = mesh_.face(f), across = mesh_.face_neighbours(f);
      const int last = static_cast<int>(loop.size()) - 1;
      const auto beyond = [&](int k) {
        const int g = across[static_cast<size_t>(k)];
        const std::span<const int> other = mesh_.face(g);
        const int from = loop[static_cast<size_t>(k == last ? 0 : k + 1)];
        return at_side(
            g, static_cast<int>(std::find(other.begin(), other.end(), from) - other.begin()));
      };
      for (int k = 1; k < last; ++k) {
        const int self = at_side(f, k);
        triangles_.push_back(
            {{loop[0], loop[static_cast<size_t>(k)], loop[static_cast<size_t>(k) + 1]},
             {k == 1 ? beyond(0) : self - 1, beyond(k), k + 1 == last ? beyond(last) : self + 1}});
      }
    }
  }

  int count() const { return static_cast<int>(triangles_.size()); }
  Triangle& at(int f) { return triangles_[static_cast<size_t>(f)]; }
  const Triangle& at(int f) const { return triangles_[static_cast<size_t>(f)]; }
  int corner(int f, int k) const { return at(f).corner[static_cast<size_t>(k % 3)]; }
  int across(int f, int k) const { return at(f).across[static_cast<size_t>(k % 3)]; }
  /// From one of the corners, so that far meshes lose no digits.
  Vec3 point(int v) const { return mesh_.vertex(v) - centre_; }
  void ask(int f, int k) { asked_.push_back({f, corner(f, k), corner(f, k + 1)}); }

  /// k of the side from -> to of triangle f; -1: it has none.
  int side_of(int f, int from, int to) const {
    for (int k = 0; k < 3; ++k)
      if (corner(f, k) == from && corner(f, k + 1) == to) return k;
    return -1;
  }
  int side_of(const Edge& e) const { return side_of(e.triangle, e.from, e.to); }
  /// The same of the triangle across, which runs the other way.
  int side_across(int f, int k) const {
    return side_of(across(f, k), corner(f, k + 1), corner(f, k));
  }

  Vec3 area_of(int a, int b, int c) const {
    return (point(b) - point(a)).cross(point(c) - point(a));
  }
  Vec3 area_of(int f) const { return area_of(corner(f, 0), corner(f, 1), corner(f, 2)); }

  bool is_bent_inward(const Edge& e) const {
    const int k = side_of(e);
    return k >= 0 && is_bent_inward(e.triangle, k);
  }
  /// Whether the triangle across has its third corner in front of f's plane.
  bool is_bent_inward(int f, int k) const {
    const int third = corner(across(f, k), side_across(f, k) + 2);
    const Vec3 area = area_of(f);
    return area.dot(point(third) - point(corner(f, k))) > blur_ * area.norm();
  }

  /// Where the ends a and b of side k of f lie beside the other diagonal of its two triangles, from
  /// the third corner c of f to d across. Seen from outside c lies to the left of a -> b: a below 0
  /// and b above say that the diagonal passes between them, and may become the edge. Else a lies
  /// between b, c and d, or b does.
  std::pair<double, double> beside_diagonal(int f, int k) const {
    const int g = across(f, k), c = corner(f, k + 2), d = corner(g, side_across(f, k) + 2);
    const Vec3 view = area_of(f) + area_of(g), diagonal = point(d) - point(c);
    const auto side = [&](int v) { return view.dot(diagonal.cross(point(v) - point(c))); };
    return {side(corner(f, k)), side(corner(f, k + 1))};
  }

  /// Fills the dent at side k of f, if a step there does.
  bool step(int f, int k) {
    ++work_;
    const auto [a, b] = beside_diagonal(f, k);
    const int g = across(f, k), m = side_across(f, k);
    if (a < 0.0 && b > 0.0) {
      if (is_edge(f, corner(f, k + 2), g, corner(g, m + 2))) return false;
      turn(f, k);
      return true;
    }
    return a < 0.0 ? has_three(g, m) && take_out(g, m) : has_three(f, k) && take_out(f, k);
  }

  /// Whether corners v of triangle t and w of u are joined by an edge: around both by turns, as one
  /// of them may have very many.
  bool is_edge(int t, int v, int u, int w) const {
    const int first_t = t, first_u = u;
    do {
      const int k = place_of(t, v), m = place_of(u, w);
      if (corner(t, k + 1) == w || corner(u, m + 1) == v) return true;
      t = across(t, k + 2);
      u = across(u, m + 2);
      ++work_;
    } while (t != first_t && u != first_u);
    return false;
  }
  int place_of(int t, int v) const { return corner(t, 0) == v ? 0 : corner(t, 1) == v ? 1 : 2; }
  /// Whether no more than three triangles meet at corner k of f.
  bool has_three(int f, int k) const {
    return across(across(f, k), side_across(f, k) + 1) == across(f, k + 2);
  }

  /// Where no step is left at a stuck edge, one of its ends lies behind three others, so within the
  /// hull: it goes. Whether any went.
  bool take_out_corners() {
    const size_t before = stuck_.size();
    std::erase_if(stuck_, [&](const Edge& edge) {
      if (!is_bent_inward(edge)) return true;
      const int k = side_of(edge);
      const auto [a, b] = beside_diagonal(edge.triangle, k);
      if (a < 0.0 && b > 0.0) return false;
      return take_out(edge.triangle, a < 0.0 ? (k + 1) % 3 : k);
    });
    return stuck_.size() < before && !asked_.empty();
  }

  /// a b c and b a d become c a d and d b c.
  void turn(int f, int k) {
    const int g = across(f, k), m = side_across(f, k);
    const int a = corner(f, k), b = corner(f, k + 1), c = corner(f, k + 2), d = corner(g, m + 2);
    const int over_bc = across(f, k + 1), over_ca = across(f, k + 2);
    const int over_ad = across(g, m + 1), over_db = across(g, m + 2);
    at(f) = {{c, a, d}, {over_ca, over_ad, g}};
    at(g) = {{d, b, c}, {over_db, over_bc, f}};
    relink(over_ad, d, a, f);
    relink(over_bc, c, b, g);
    for (const int t : {f, g})
      for (int s = 0; s < 2; ++s) ask(t, s);
  }

  /// A side of a hole: the corner that it begins at, the triangle across, and one with that corner.
  struct Side {
    int from, across, triangle;
  };

  /// Corners of a hole at most: what closes it takes as many times as many steps.
  static constexpr size_t largest_hole = 200;

  /// The triangles around corner k of f give way to others over the hole that it leaves. Whether
  /// such were found.
  bool take_out(int f, int k) {
    const int v = corner(f, k), first = f;
    std::vector<Side> hole;
    std::vector<int> gone;
    do {
      gone.push_back(f);
      hole.push_back({corner(f, k + 1), across(f, k + 1), f});
      f = across(f, k + 2);
      k = place_of(f, v);
      if (hole.size() > largest_hole) return false;
    } while (f != first);
    work_ += hole.size() * hole.size();
    const Vec3 view = point(v) - inside_;
    std::vector<Triangle> cover;
    for (std::vector<Side> left = hole; cover.size() + 2 < hole.size();) {
      const size_t ear = find_ear(left, view);
      if (ear == left.size()) return false;
      const size_t n = left.size();
      Side& before = left[(ear + n - 1) % n];
      const Side &at_ear = left[ear], &after = left[(ear + 1) % n];
      if (n > 3 && is_edge(before.triangle, before.from, after.triangle, after.from)) return false;
      cover.push_back({{before.from, at_ear.from, after.from},
                       {before.across, at_ear.across, n > 3 ? -1 : after.across}});
      before.across = gone[cover.size() - 1];
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    for (const int t : gone) at(t) = {{-1, -1, -1}, {-1, -1, -1}};
    for (size_t i = 0; i < cover.size(); ++i) at(gone[i]) = cover[i];
    for (size_t i = 0; i < cover.size(); ++i)
      for (int s = 0; s < 3; ++s) {
        if (across(gone[i], s) < 0) continue;
        relink(across(gone[i], s), corner(gone[i], s + 1), corner(gone[i], s), gone[i]);
        ask(gone[i], s);
      }
    return true;
  }

  /// A corner that the hole turns left at, seen along `view` from outside, with no other corner in
  /// the triangle with its neighbours; the number of corners where there is none.
  size_t find_ear(const std::vector<Side>& hole, const Vec3& view) const {
    const size_t n = hole.size();
    const auto turns_left = [&](int a, int b, int c) { return view.dot(area_of(a, b, c)) > 0.0; };
    for (size_t k = 0; k < n; ++k) {
      const int a = hole[(k + n - 1) % n].from, b = hole[k].from, c = hole[(k + 1) % n].from;
      if (turns_left(a, b, c) && std::none_of(hole.begin(), hole.end(), [&](const Side& other) {
            const int v = other.from;
            return v != a && v != b && v != c && turns_left(a, b, v) && turns_left(b, c, v) &&
                   turns_left(c, a, v);
          }))
        return k;
    }
    return n;
  }

  /// Across from -> to of t now lies f.
  void relink(int t, int from, int to, int f) {
    at(t).across[static_cast<size_t>(side_of(t, from, to))] = f;
  }

  Vec3 centre_, inside_;
  const Polyhedron& mesh_;
  double blur_;  ///< so high a corner counts as in the plane [m]
  std::vector<Triangle> triangles_;
  std::vector<Edge> asked_, stuck_;
  /// Triangles looked at, and how many there may be for each of the mesh: few are needed where
  /// dents are small, and qhull ends as well.
  mutable size_t work_ = 0;
  static constexpr size_t most_work = 50;
};

}  // namespace

std::optional<Loops> filled_dents(const Polyhedron& mesh) {
  DentFiller filler(mesh);
  if (!filler.fill()) return {};
  Loops loops = filler.loops();
  make_canonical(loops, mesh.vertices());
  return loops;
}

}  // namespace ballast
