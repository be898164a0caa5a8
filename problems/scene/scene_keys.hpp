#pragma once
// The keys of a scene file, each once: name, where its value is kept, type, unit, range, default
// and meaning. Scenes are read and validated by these tables; a test compares them with
// docs/manual/scenes.md. The type and the default are those of what keeps the value.

#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "problems/scene/scene.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {

/// Of every friction coefficient.
inline constexpr NumberRange friction_range{"a number from 0 to 1e4 (which holds as a bond would)",
                                            0.0, largest_friction, true, true};

enum class Presence {
  optional,  ///< absent: the default
  required,
  /// Absent, or what it is by default: not in the resolved text. A scene.toml from before the key
  /// was there keeps its bytes, and so its run keeps its key.
  only_where_given
};

struct SceneKey {
  const char* name;
  ValuePlace place;  ///< lives as long as what the table was made for
  ValueRule rule;
  const char* meaning;
  Presence presence = Presence::optional;
  const char* default_words = nullptr;  ///< for the docs, where the default is not the kept one
};
/// The keys of one table of a scene file.
using SceneKeys = std::vector<SceneKey>;

// What a file says where a Scene keeps it in another form.
struct GravityText {
  double magnitude = 9.81;  ///< [m/s^2]
  Vec3 direction = Vec3(0, 0, -1);
};
struct GrainsText {
  std::string size = "radius";
  std::vector<std::string> meshes;
};
struct ShapeText {
  std::string kind;
  std::vector<std::string> locked;
  double density = 0.0;  ///< [kg/m^3]; 0: not given
  Vec3 size = Vec3::Zero();
  double radius = 0.0;
  int subdivisions = 3;
  std::uint64_t seed = 1;
  std::string file;
  double scale = 1.0;
  bool hull = false;
};
struct OrientationText {
  Vec3 axis = Vec3::UnitZ();
  double angle_degrees = 0.0;
};

SceneKeys head_keys(Scene& scene);     ///< [scene]
SceneKeys contact_keys(Scene& scene);  ///< [contact]
SceneKeys gravity_keys(GravityText& gravity);
SceneKeys solver_keys(SolverSpec& solver);
SceneKeys correction_keys(CorrectionSpec& correction);
SceneKeys detection_keys(DetectionSettings& detection);
SceneKeys record_keys(RecordSpec& record);

SceneKeys grains_keys(GrainsSpec& grains, GrainsText& text);
SceneKeys distribution_keys(SizeClass& size_class);  ///< [[grains.distribution]]
SceneKeys grain_shape_keys(GrainShapeSettings& shape);
SceneKeys box_keys(BoxSpec& box);
SceneKeys deposit_keys(DepositSpec& deposit);
SceneKeys drive_keys(DriveSpec& drive);
SceneKeys control_volume_keys(ControlVolumeSpec& volume);

/// `motion`: "fixed", "prescribed" or "driven"; each has keys of its own besides.
SceneKeys wall_keys(WallSpec& wall, std::string& motion);
SceneKeys prescribed_wall_keys(WallSpec& wall);
SceneKeys driven_wall_keys(WallSpec& wall);
SceneKeys load_keys(HarmonicLoad& load);
SceneKeys body_keys(BodySpec& body, ShapeText& shape);
/// What a body of this shape ("box", "sphere", "grain" or "mesh") has besides.
SceneKeys shape_keys(const std::string& kind, ShapeText& shape);
SceneKeys orientation_keys(OrientationText& orientation);
SceneKeys force_keys(ForceSpec& force);

/// Reads a whole table's keys. Throws SceneFileError; keys that are not in `keys` are found by
/// TomlTable::finish.
void read_keys(TomlTable& table, const SceneKeys& keys);

}  // namespace ballast
