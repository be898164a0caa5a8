#include "geometry/shape/convex_hull.hpp"

#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <sstream>
#include <utility>

namespace ballast {

namespace {

// Lengths below are relative to half the largest extent.

/// Points closer than this are one point.
constexpr double kWeld = 1e-9;
/// Thinner sets are flat: they would not outlive the tolerances that follow.
constexpr double kFlat = 1e-8;
/// qhull's own error bound, option 'E': it merges facets that are coplanar within a few of these. A
/// tenth of Polyhedron's tolerance, as a merged facet is flat only to several of them. The second
/// is for the rare sets whose detail is of just the first's size, where qhull's merging goes too
/// far or gives up: they are resolved instead.
constexpr double kMerge[] = {1e-10, 1e-14};
/// Corners of faces that rise less than this over the chord of their neighbours are dropped: they
/// would make needles, whose planes mean nothing. Above Polyhedron's tolerance of 1e-9 of a size
/// that is at most 2 sqrt(3) half-extents.
constexpr double kCorner = 4e-9;

using Loops = std::vector<std::vector<int>>;

/// A message stream in memory: qhull writes its complaints there instead of to stderr.
class Messages {
 public:
  Messages() : file_(open_memstream(&text_, &length_)) {
    if (!file_) throw std::bad_alloc();
  }
  ~Messages() {
    std::fclose(file_);
    std::free(text_);
  }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;
  FILE* file() { return file_; }
  std::string first_line() {
    std::fflush(file_);
    const std::string all(text_, length_);
    return all.substr(0, all.find('\n', all.find_first_not_of('\n')));
  }

 private:
  char* text_ = nullptr;
  size_t length_ = 0;
  FILE* file_;
};

/// One qhull run and its memory.
class QhullRun {
 public:
  QhullRun(std::vector<double>& coordinates, double merge) {
    qh_zero(&qh_, messages_.file());
    std::ostringstream command;
    command << "qhull Pp E" << merge;  // Pp: no warnings about precision
    std::string text = command.str();  // qhull wants it writable
    const int code =
        qh_new_qhull(&qh_, 3, static_cast<int>(coordinates.size() / 3), coordinates.data(), False,
                     text.data(), nullptr, messages_.file());
    if (code != qh_ERRnone) {
      const std::string reason = messages_.first_line();
      release();
      throw InvalidPolyhedron(reason);
    }
  }
  ~QhullRun() { release(); }
  QhullRun(const QhullRun&) = delete;
  QhullRun& operator=(const QhullRun&) = delete;

  /// Vertex loops of the merged facets, in qhull's order of facets; orientation and starting vertex
  /// as they come.
  Loops loops() {
    Loops result;
    qhT* qh = &qh_;  // the name that qhull's macros expect
    facetT* facet;
    FORALLfacets { result.push_back(loop(facet)); }
    return result;
  }

 private:
  void release() {
    qh_freeqhull(&qh_, !qh_ALL);
    int blocks, bytes;
    qh_memfreeshort(&qh_, &blocks, &bytes);
  }

  std::vector<int> loop(facetT* facet) {
    qhT* qh = &qh_;
    std::vector<int> vertices;
    vertexT *vertex, **vertexp;
    FOREACHvertex_(facet->vertices) vertices.push_back(qh_pointid(qh, vertex->point));
    if (facet->simplicial) return vertices;
    // a merged facet's vertices are unordered: chain its ridges, which are its edges in 3-d
    std::vector<std::pair<int, int>> links;
    ridgeT *ridge, **ridgep;
    FOREACHridge_(facet->ridges) {
      links.emplace_back(qh_pointid(qh, SETfirstt_(ridge->vertices, vertexT)->point),
                         qh_pointid(qh, SETsecondt_(ridge->vertices, vertexT)->point));
    }
    std::vector<int> chain{links.front().first};
    for (int at = links.front().second; at != chain.front();) {
      chain.push_back(at);
      const auto next = std::find_if(links.begin(), links.end(), [&](const auto& link) {
        const int previous = chain[chain.size() - 2];
        return (link.first == at && link.second != previous) ||
               (link.second == at && link.first != previous);
      });
      if (next == links.end() || chain.size() > links.size()) {
        throw InvalidPolyhedron("a face of the hull is no simple loop");
      }
      at = next->first == at ? next->second : next->first;
    }
    return chain;
  }

  Messages messages_;
  qhT qh_;
};

/// Throws on NaN and on too few points; returns the points moved to their box's centre and scaled
/// to half-extent 1, so that qhull's tolerances are relative.
std::vector<Vec3> normalised(std::span<const Vec3> points) {
  if (points.size() < 4)
    throw InvalidPolyhedron("no convex hull: at least 4 points are needed, got " +
                            std::to_string(points.size()));
  Vec3 low = points[0], high = points[0];
  for (size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite())
      throw InvalidPolyhedron("no convex hull: point " + std::to_string(i) +
                              " has a coordinate that is NaN or infinite");
    low = low.cwiseMin(points[i]);
    high = high.cwiseMax(points[i]);
  }
  const double half = 0.5 * (high - low).maxCoeff();
  if (!(half > 0.0)) throw InvalidPolyhedron("no convex hull: all points coincide");
  if (!std::isfinite(half * half * half))
    throw InvalidPolyhedron("no convex hull: the volume overflows");
  std::vector<Vec3> scaled;
  for (const Vec3& p : points) scaled.push_back((p - 0.5 * (low + high)) / half);
  return scaled;
}

/// Throws when the points lie on a line or in a plane: thickness below kFlat.
void check_spatial(const std::vector<Vec3>& points) {
  const auto farthest = [&](auto distance) {
    return *std::max_element(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
      return distance(a) < distance(b);
    });
  };
  const Vec3 a = farthest([&](const Vec3& p) { return (p - points[0]).norm(); });
  const Vec3 along = (farthest([&](const Vec3& p) { return (p - a).norm(); }) - a).normalized();
  const auto from_line = [&](const Vec3& p) { return (p - a - along * along.dot(p - a)).norm(); };
  const Vec3 c = farthest(from_line);
  if (!(from_line(c) > kFlat))
    throw InvalidPolyhedron("no convex hull: all points lie on one line");
  const Vec3 normal = along.cross(c - a).normalized();
  const auto from_plane = [&](const Vec3& p) { return std::abs(normal.dot(p - a)); };
  if (!(from_plane(farthest(from_plane)) > kFlat))
    throw InvalidPolyhedron("no convex hull: all points lie in one plane");
}

/// Ascending indices of the points, without those within kWeld of one that stays (the smaller index
/// stays). A sweep along a direction in which no usual set has many equal heights.
std::vector<int> distinct(const std::vector<Vec3>& points) {
  const Vec3 direction = Vec3(0.5321, 0.6173, 0.5794).normalized();
  std::vector<std::pair<double, int>> order;
  for (size_t i = 0; i < points.size(); ++i)
    order.emplace_back(direction.dot(points[i]), static_cast<int>(i));
  std::sort(order.begin(), order.end());
  std::vector<bool> dropped(points.size(), false);
  for (size_t i = 0; i < order.size(); ++i) {
    for (size_t j = i + 1; j < order.size() && order[j].first - order[i].first <= 2.0 * kWeld;
         ++j) {
      const int a = order[i].second, b = order[j].second;
      if ((points[a] - points[b]).norm() <= kWeld) dropped[std::max(a, b)] = true;
    }
  }
  std::vector<int> kept;
  for (size_t i = 0; i < points.size(); ++i) {
    if (!dropped[i]) kept.push_back(static_cast<int>(i));
  }
  return kept;
}

Vec3 area_vector(const std::vector<int>& loop, const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (size_t k = 2; k < loop.size(); ++k)
    sum += (points[loop[k - 1]] - points[loop[0]]).cross(points[loop[k]] - points[loop[0]]);
  return sum;
}

/// The flattest corner of each face where it is flatter than kCorner, straight or re-entrant:
/// merging leaves such behind too. At most one per face and none beside another, as the hull of
/// what stays may well keep the neighbour.
std::vector<int> flat_corners(const Loops& loops, const std::vector<Vec3>& points) {
  std::vector<int> flat;
  const auto listed = [&](int v) { return std::find(flat.begin(), flat.end(), v) != flat.end(); };
  for (const auto& loop : loops) {
    const size_t n = loop.size();
    const Vec3 normal = area_vector(loop, points).normalized();
    double lowest = kCorner;
    int corner = -1;
    for (size_t k = 0; k < n; ++k) {
      const Vec3 in = points[loop[k]] - points[loop[(k + n - 1) % n]];
      const Vec3 out = points[loop[(k + 1) % n]] - points[loop[k]];
      const double height =
          normal.dot(in.cross(out)) / (in + out).norm();  // negative: re-entrant after merging
      if (height < lowest) {
        lowest = height;
        corner = loop[k];
      }
    }
    if (corner >= 0 && std::none_of(loop.begin(), loop.end(), listed)) flat.push_back(corner);
  }
  return flat;
}

/// Outward, starting at the smallest index, faces in ascending order: independent of how qhull
/// listed them.
void make_canonical(Loops& loops, const std::vector<Vec3>& points) {
  Vec3 inside = Vec3::Zero();
  double count = 0.0;
  for (const auto& loop : loops) {
    for (const int v : loop) inside += points[v];
    count += static_cast<double>(loop.size());
  }
  inside /= count;
  for (auto& loop : loops) {
    if (area_vector(loop, points).dot(points[loop[0]] - inside) < 0.0)
      std::reverse(loop.begin(), loop.end());
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  }
  std::sort(loops.begin(), loops.end());
}

/// Faces of the hull as canonical loops of point indices. Each round drops the corners that are too
/// flat and starts again without them: one round for almost all inputs.
Loops hull_loops(const std::vector<Vec3>& points, double merge) {
  std::vector<int> kept = distinct(points);
  while (kept.size() >= 4) {
    std::vector<double> coordinates;
    for (const int i : kept)
      coordinates.insert(coordinates.end(), points[i].begin(), points[i].end());
    Loops loops = QhullRun(coordinates, merge).loops();
    for (auto& loop : loops)
      for (int& v : loop) v = kept[v];
    make_canonical(loops, points);
    const std::vector<int> flat = flat_corners(loops, points);
    if (flat.empty()) return loops;
    std::erase_if(kept,
                  [&](int i) { return std::find(flat.begin(), flat.end(), i) != flat.end(); });
  }
  throw InvalidPolyhedron("fewer than 4 distinct corners");
}

/// The solid of these loops; vertices keep the order of the points.
Polyhedron assembled(std::span<const Vec3> points, Loops loops) {
  std::vector<int> index(points.size(), -1);
  for (const auto& loop : loops)
    for (const int v : loop) index[v] = 0;
  std::vector<Vec3> vertices;
  for (size_t i = 0; i < points.size(); ++i) {
    if (index[i] < 0) continue;
    index[i] = static_cast<int>(vertices.size());
    vertices.push_back(points[i]);
  }
  for (auto& loop : loops)
    for (int& v : loop) v = index[v];
  return Polyhedron(std::move(vertices), loops);
}

}  // namespace

Polyhedron convex_hull(std::span<const Vec3> points) {
  const std::vector<Vec3> scaled = normalised(points);
  check_spatial(scaled);
  try {
    return assembled(points, hull_loops(scaled, kMerge[0]));
  } catch (const InvalidPolyhedron&) {
    // the finer attempt below decides
  }
  try {
    return assembled(points, hull_loops(scaled, kMerge[1]));
  } catch (const InvalidPolyhedron& error) {
    throw InvalidPolyhedron(
        std::string("no convex hull: the points are almost flat or degenerate: ") + error.what());
  }
}

}  // namespace ballast
