#pragma once
// The keys of a scene file, each once: name, the member that keeps it, type, unit, range, default
// and meaning. Scenes are read and validated by these tables, and docs/manual/scenes.md is written
// from them. The default is the member's own initial value.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "problems/scene/key_kind.hpp"
#include "problems/scene/scene.hpp"

namespace ballast {

enum class Presence {
  optional,  ///< absent: the member's default
  required,
  /// Absent: not read, and not in the resolved text. A scene.toml from before the key was there
  /// keeps its bytes, and so its run keeps its key.
  only_where_given
};

/// What a key's value is, and where a Spec keeps it.
template <class Spec>
class KeyValue {
 public:
  virtual ~KeyValue() = default;
  /// The member is the fallback unless the key is required. Throws SceneFileError.
  virtual void read(TomlTable& table, const char* key, bool is_required, Spec& spec) const = 0;
  virtual std::string unit() const = 0;
  virtual std::string default_text(const Spec& defaults) const = 0;
  virtual std::string expected() const = 0;
};

/// A value of one of the kinds, in a member of Spec.
template <class Kind, class Spec>
class KeptValue final : public KeyValue<Spec> {
 public:
  using Member = typename Kind::Value Spec::*;
  KeptValue(Kind kind, Member member) : kind_(std::move(kind)), member_(member) {}
  void read(TomlTable& table, const char* key, bool is_required, Spec& spec) const override {
    std::optional fallback(spec.*member_);
    if (is_required) fallback.reset();
    spec.*member_ = kind_.read(table, key, fallback);
  }
  std::string unit() const override { return kind_.unit; }
  std::string default_text(const Spec& defaults) const override {
    return kind_.default_text(defaults.*member_);
  }
  std::string expected() const override { return kind_.expected(); }

 private:
  Kind kind_;
  Member member_;
};

template <class Spec>
struct SceneKey {
  const char* name;
  std::shared_ptr<const KeyValue<Spec>> value;
  const char* meaning;
  Presence presence = Presence::optional;
  const char* default_words = nullptr;  ///< for the docs, where the default is not the member's
};

/// The keys of one table of a scene file.
template <class Spec>
using SceneKeys = std::vector<SceneKey<Spec>>;

// Words for the rows of the tables: number(&Spec::member, range, unit) and its like.
template <class Kind, class Spec>
std::shared_ptr<const KeyValue<Spec>> kept_value(Kind kind, typename Kind::Value Spec::*member) {
  return std::make_shared<KeptValue<Kind, Spec>>(std::move(kind), member);
}

template <class Spec>
std::shared_ptr<const KeyValue<Spec>> number(double Spec::*member, const NumberRange& range,
                                             const char* unit = "") {
  return kept_value(NumberKind{range, unit}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> whole(int Spec::*member, int low,
                                            int high = WholeKind::no_limit) {
  return kept_value(WholeKind{low, high}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> seed(std::uint64_t Spec::*member) {
  return kept_value(SeedKind{}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> flag(bool Spec::*member) {
  return kept_value(FlagKind{}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> text(std::string Spec::*member) {
  return kept_value(TextKind{}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> choice(std::string Spec::*member,
                                             std::vector<const char*> words) {
  return kept_value(ChoiceKind{std::move(words)}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> vector(Vec3 Spec::*member, const char* unit = "") {
  return kept_value(VectorKind{unit}, member);
}
template <class Spec>
std::shared_ptr<const KeyValue<Spec>> texts(std::vector<std::string> Spec::*member) {
  return kept_value(TextsKind{}, member);
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

const SceneKeys<Scene>& head_keys();     ///< [scene]
const SceneKeys<Scene>& contact_keys();  ///< [contact]
const SceneKeys<GravityText>& gravity_keys();
const SceneKeys<SolverSpec>& solver_keys();
const SceneKeys<SleepSpec>& sleep_keys();
const SceneKeys<CorrectionSpec>& correction_keys();
const SceneKeys<DetectionSettings>& detection_keys();
const SceneKeys<RecordSpec>& record_keys();

const SceneKeys<GrainsText>& grains_keys();
const SceneKeys<SizeClass>& distribution_keys();  ///< [[grains.distribution]]
const SceneKeys<GrainShapeSettings>& grain_shape_keys();
const SceneKeys<BoxSpec>& box_keys();
const SceneKeys<DepositSpec>& deposit_keys();
const SceneKeys<DriveSpec>& drive_keys();
const SceneKeys<ControlVolumeSpec>& control_volume_keys();

const SceneKeys<WallText>& wall_keys();
const SceneKeys<WallSpec>& prescribed_wall_keys();
const SceneKeys<WallSpec>& driven_wall_keys();
const SceneKeys<HarmonicLoad>& load_keys();
const SceneKeys<BodyText>& body_keys();
/// What a body of this shape ("box", "sphere", "grain" or "mesh") has besides.
const SceneKeys<ShapeText>& shape_keys(const std::string& shape);
const SceneKeys<OrientationText>& orientation_keys();
const SceneKeys<ForceSpec>& force_keys();

/// Reads a whole table's keys. Throws SceneFileError; keys that are not in `keys` are found by
/// TomlTable::finish.
template <class Spec>
void read_keys(TomlTable& table, const SceneKeys<Spec>& keys, Spec& spec) {
  for (const SceneKey<Spec>& key : keys) {
    table.know(key.name);
    if (key.presence != Presence::only_where_given || table.has(key.name))
      key.value->read(table, key.name, key.presence == Presence::required, spec);
  }
}

}  // namespace ballast
