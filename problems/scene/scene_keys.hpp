#pragma once
// The keys of a scene file, each once: name, the member that keeps it, type, unit, range, default
// and meaning. Scenes are read and validated by these tables, and docs/manual/scenes.md is written
// from them. The default is the member's own initial value.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "problems/scene/scene.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {

/// Of every friction coefficient.
inline constexpr NumberRange friction_range{"a number from 0 to 1e4 (which holds as a bond would)",
                                            0.0, largest_friction, true, true};

enum class Presence {
  optional,  ///< absent: the member's default
  required,
  /// Absent, or what it is by default: not in the resolved text. A scene.toml from before the key
  /// was there keeps its bytes, and so its run keeps its key.
  only_where_given
};

/// Where a Spec keeps a key's value, and what is asked of it.
template <class Spec>
struct KeyValue {
  std::variant<double Spec::*, int Spec::*, std::uint64_t Spec::*, bool Spec::*,
               std::string Spec::*, Vec3 Spec::*, std::vector<std::string> Spec::*>
      member;
  ValueRule rule;

  ValuePlace in(Spec& spec) const {
    return std::visit([&](auto place) -> ValuePlace { return &(spec.*place); }, member);
  }
};

template <class Spec>
struct SceneKey {
  const char* name;
  KeyValue<Spec> value;
  const char* meaning;
  Presence presence = Presence::optional;
  const char* default_words = nullptr;  ///< for the docs, where the default is not the member's
};

/// The keys of one table of a scene file.
template <class Spec>
using SceneKeys = std::vector<SceneKey<Spec>>;

// Words for the rows of the tables: number(&Spec::member, range, unit) and its like.
template <class Spec>
KeyValue<Spec> number(double Spec::*member, const NumberRange& range, const char* unit = "") {
  return {member, {.range = range, .unit = unit}};
}
template <class Spec>
KeyValue<Spec> whole(int Spec::*member, int low, int high = 1'000'000'000) {
  return {member, {.low = low, .high = high}};
}
template <class Spec>
KeyValue<Spec> seed(std::uint64_t Spec::*member) {
  return {member, {}};
}
template <class Spec>
KeyValue<Spec> flag(bool Spec::*member) {
  return {member, {}};
}
template <class Spec>
KeyValue<Spec> text(std::string Spec::*member) {
  return {member, {}};
}
template <class Spec>
KeyValue<Spec> choice(std::string Spec::*member, std::vector<const char*> words) {
  return {member, {.words = std::move(words)}};
}
template <class Spec>
KeyValue<Spec> vector(Vec3 Spec::*member, const char* unit = "") {
  return {member, {.unit = unit}};
}
template <class Spec>
KeyValue<Spec> texts(std::vector<std::string> Spec::*member) {
  return {member, {}};
}

// What a file says where a Scene keeps it in another form.
struct GravityText {
  double magnitude = 9.81;  ///< [m/s^2]
  Vec3 direction = Vec3(0, 0, -1);
};
struct GrainsText {
  int count = 0;
  std::uint64_t seed = 1;
  double density = GrainsSpec{}.density;  ///< [kg/m^3]
  std::string size = "radius";
  std::vector<std::string> meshes;
};
struct WallText {
  std::string name;
  Vec3 normal = Vec3::Zero();
  double offset = 0.0, friction = 0.0;  ///< of normal.x = offset, the normal as given
  std::string motion = "fixed";
};
struct ShapeText {
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
struct BodyText {
  std::string name, shape;
  std::vector<std::string> locked;
  double density = 0.0, mass = 0.0;                                            ///< 0: not given
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero();  ///< world frame
};

extern const SceneKeys<Scene> head_keys;     ///< [scene]
extern const SceneKeys<Scene> contact_keys;  ///< [contact]
extern const SceneKeys<GravityText> gravity_keys;
extern const SceneKeys<SolverSpec> solver_keys;
extern const SceneKeys<SleepSpec> sleep_keys;
extern const SceneKeys<CorrectionSpec> correction_keys;
extern const SceneKeys<DetectionSettings> detection_keys;
extern const SceneKeys<RecordSpec> record_keys;

extern const SceneKeys<GrainsText> grains_keys;
extern const SceneKeys<SizeClass> distribution_keys;  ///< [[grains.distribution]]
extern const SceneKeys<GrainShapeSettings> grain_shape_keys;
extern const SceneKeys<BoxSpec> box_keys;
extern const SceneKeys<DepositSpec> deposit_keys;
extern const SceneKeys<DriveSpec> drive_keys;
extern const SceneKeys<ControlVolumeSpec> control_volume_keys;

extern const SceneKeys<WallText> wall_keys;
extern const SceneKeys<WallSpec> prescribed_wall_keys;
extern const SceneKeys<WallSpec> driven_wall_keys;
extern const SceneKeys<HarmonicLoad> load_keys;
extern const SceneKeys<BodyText> body_keys;
/// What a body of this shape ("box", "sphere", "grain" or "mesh") has besides.
const SceneKeys<ShapeText>& shape_keys(const std::string& shape);
extern const SceneKeys<OrientationText> orientation_keys;
extern const SceneKeys<ForceSpec> force_keys;

/// Reads a whole table's keys. Throws SceneFileError; keys that are not in `keys` are found by
/// TomlTable::finish.
template <class Spec>
void read_keys(TomlTable& table, const SceneKeys<Spec>& keys, Spec& spec) {
  for (const SceneKey<Spec>& key : keys) {
    table.know(key.name);
    const bool is_quiet = key.presence == Presence::only_where_given;
    if (is_quiet && !table.has(key.name)) continue;
    const ValuePlace place = key.value.in(spec);
    const std::string by_default = kept_text(place);
    table.read(key.name, key.value.rule, key.presence == Presence::required, place);
    if (is_quiet && kept_text(place) == by_default) table.leave_unsaid(key.name);
  }
}

/// A section whose keys are all in one table; `check(table, spec)` says what its keys must be to
/// each other.
template <class Spec, class Check>
Spec read_section(TomlTable table, const SceneKeys<Spec>& keys, const Check& check) {
  Spec spec;
  read_keys(table, keys, spec);
  check(table, spec);
  table.finish();
  return spec;
}
template <class Spec>
Spec read_section(TomlTable table, const SceneKeys<Spec>& keys) {
  return read_section(std::move(table), keys, [](const TomlTable&, const Spec&) {});
}

}  // namespace ballast
