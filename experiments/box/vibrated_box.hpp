#pragma once
// The paper's protocol (sec. 2): grains rain into the box, the lid comes down, is raised and fixed,
// and wall x_max is driven.

#include <string>
#include <vector>

#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// The stages of the protocol; each is a MechanicalSystem of the same bodies with other walls.
enum class BoxStage { rain, press, settle, drive };
const char* name_of(BoxStage stage);

/// Bodies of the box in fixed order: grains 0 .. count-1, then these walls.
enum BoxWall { wall_floor, wall_lid, wall_x_min, wall_x_max, wall_y_min, wall_y_max };
constexpr int box_wall_count = 6;

/// The grains of a scene, generated or read from its meshes, at rest in a loose rain without
/// overlap above the floor; of a tiled box copies of a tile's.
struct Rain {
  std::vector<BodySpec> grains;
  double height = 0.0;  ///< of the rain [m]
};
Rain make_rain(const Scene& scene);

// A large box begins as copies of a tile's packing (deposit.tiles_x and tiles_y): it costs the
// deposit of a small box, and the rest of the copies.

/// One of the scene's tiles: a box of its own.
Scene tile_of(const Scene& scene);
/// nx by ny tiles of this box in one: grains.count, box.length and box.width grow with them.
Scene tiled_scene(const Scene& tile, int nx, int ny);
/// Where each tile's corner is, along x first [m].
std::vector<Vec3> tile_corners(const Scene& scene);
/// Copies of the grains of a tile in the order of the corners; they share the shapes.
Rain tiled_rain(const Scene& scene, const Rain& tile);
/// Puts copies of the tile's grains into a state of the tiled box, whose walls stay as they are.
/// Copies do not overlap, because each lay between its walls. Where those stood, a seam of a
/// grain's width is loose.
void place_copies(const Scene& scene, const MotionState& tile, MotionState& state);

/// The system of one stage. `lid`: height of the lid's plane at the start of the stage [m].
/// `start`, where it is given: grains as they are in the rain, and the walls, all at rest.
MechanicalSystem box_system(const Scene& scene, const Rain& rain, BoxStage stage, double lid,
                            MotionState* start = nullptr);

/// Gravity while depositing [m/s^2]: deposit.gravity, else the scene's.
Vec3 deposit_gravity(const Scene& scene);

/// Key of everything a packing depends on: grains and what was in the user's meshes, box, deposit,
/// lid, correction, format version. Not of the drive, its solver, step or friction: runs that
/// differ in these alone start from the same packing.
std::string packing_key(const Scene& scene);

/// Where the solid fraction is taken: from the floor to the packing's top before the lid was
/// raised, clear of the driven wall.
ControlVolume box_control_volume(const Scene& scene, double top);

/// rms speed of the grains [m/s], and the highest vertex [m].
double grain_rms_velocity(const MechanicalSystem& system, const MotionState& state);
double packing_top(const MechanicalSystem& system, const MotionState& state);

}  // namespace ballast
