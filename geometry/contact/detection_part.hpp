#pragma once
// A part of the pairs that a detection tests, with scratch memory of its own, so that threads can
// work on several parts at the same time.

#include <span>
#include <vector>

#include "geometry/contact/axis_search.hpp"
#include "geometry/contact/broad_phase.hpp"
#include "geometry/contact/convex_elements.hpp"
#include "platform/worker_team.hpp"

namespace ballast {

/// The bodies at a detection: shapes, poses, and how far each has moved. All parts of a detection
/// read them; detect() writes them before the parts begin.
struct DetectedBodies {
  /// `elements`: says whose parts and images the bodies are; null: each is a body of its own.
  explicit DetectedBodies(std::vector<ContactShape> bodies,
                          const ConvexElements* elements = nullptr);
  DetectedBodies(const DetectedBodies&) = delete;  // `listed` points into `tables`
  DetectedBodies& operator=(const DetectedBodies&) = delete;

  /// Takes the poses and reaches of this call, which must outlive it. `team` shares the work.
  void take(std::span<const Pose> new_poses, std::span<const double> new_reach,
            std::span<const Pose> new_ahead = {}, WorkerTeam* team = nullptr);

  int count() const { return static_cast<int>(shapes.size()); }
  /// Null for a plane.
  const CollisionShape* shape(int body) const { return listed[body].shape; }

  std::vector<ContactShape> shapes;
  std::vector<char> is_fixed;
  std::vector<CollisionShape> tables;    ///< one per distinct polyhedron, in order of first use
  std::vector<BroadPhase::Body> listed;  ///< as the broad phase lists them
  std::vector<BodyBounds> bounds;        ///< of all bodies, in one place; zero for planes

  std::span<const Pose> poses;      ///< of this call
  std::span<const Pose> ahead;      ///< at the next call if nothing is met; empty: unknown
  std::vector<Mat3> rotations;      ///< R_WB at these poses
  std::span<const double> reach;    ///< of this call [m]
  std::vector<MotionBound> travel;  ///< since the first call

 private:
  std::vector<Pose> previous_;  // poses of the last call
};

/// Detects contacts of the planes and pairs whose first body a lies in a range. The contacts of
/// part 0, then those of part 1 and so on, are in the order of all contacts.
class DetectionPart {
 public:
  DetectionPart(const DetectedBodies& bodies, const DetectionSettings& settings);

  /// Sets its bodies to begin <= a < end.
  void take_range(int begin, int end) { begin_ = begin, end_ = end; }

  /// Appends the contacts of its range, sorted by (body_a, body_b, feature).
  void detect(BroadPhase& broad_phase, std::vector<ContactPoint>& contacts);

  /// The counters of the last detect().
  const DetectionCounters& counters() const { return counters_; }
  std::vector<ContactPoint> found;  ///< its contacts, for the caller's use
  size_t first_found = 0;           ///< where these begin among all contacts

 private:
  void choose_pairs(const BroadPhase& broad_phase);
  void prefetch(BroadPhase& broad_phase, size_t next) const;
  void detect_plane(int plane, std::vector<ContactPoint>& contacts);
  void detect_pair(BroadPhase& broad_phase, CandidatePair& pair,
                   std::vector<ContactPoint>& contacts);
  double separation_along(const Vec3& normal_W, int a, int b);
  void append(const CandidatePair& candidate, const PairFrame& frame, const SeparatingAxis& axis,
              std::span<const ManifoldPoint> points, std::vector<ContactPoint>& contacts);
  bool passes(const CandidatePair& candidate, ManifoldLimits& limits, SeparatingAxis& axis,
              std::vector<ContactPoint>& contacts);
  void bound_separation(CandidatePair& pair, double arm_a, double arm_b, double separation) const;
  void bound_separated(CandidatePair& pair, double distance, AxisKind kind,
                       double separation) const;
  double bound_use(const CandidatePair& pair) const;
  bool boxes_within_reach(const CandidatePair& pair, double alert) const;

  const DetectedBodies& bodies_;
  const DetectionSettings& settings_;
  int begin_ = 0, end_ = 0;
  AxisSearch search_;
  ContactManifold manifold_;
  Heights heights_;
  std::vector<int> chosen_;  // candidate pairs that must be tested
  std::vector<int> near_;    // bodies whose balls are within reach of a plane
  DetectionCounters counters_;
};

}  // namespace ballast
