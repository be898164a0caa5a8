// The keys of [[wall]] and [[body]].

#include "problems/scene/scene_keys.hpp"

namespace ballast {

const SceneKeys<WallText> wall_keys{
    {"name", text(&WallText::name), "unique among walls and bodies", Presence::optional,
     "wall_0, wall_1, ..."},
    {"normal", vector(&WallText::normal), "any length but 0; points to the side where bodies are",
     Presence::required},
    {"offset", number(&WallText::offset, any_number, "m"), "of the plane normal·x = offset"},
    {"friction", number(&WallText::friction, friction_range), "μ of contacts with this wall"},
    {"motion", choice(&WallText::motion, {"fixed", "prescribed", "driven"}),
     "prescribed and driven walls have the keys below"},
};

const SceneKeys<WallSpec> prescribed_wall_keys{
    {"amplitude", vector(&WallSpec::amplitude, "m"),
     "prescribed only: the wall is displaced by amplitude · (1 − cos 2πνt), a vector",
     Presence::required},
    {"frequency", number(&WallSpec::frequency, not_negative, "Hz"), "prescribed only: ν",
     Presence::required},
};

const SceneKeys<WallSpec> driven_wall_keys{
    {"mass", number(&WallSpec::mass, positive, "kg"),
     "driven only: the wall moves along its normal", Presence::required},
};

const SceneKeys<HarmonicLoad> load_keys{
    {"f_max", number(&HarmonicLoad::f_max, not_negative, "N"),
     "driven only: compressive force along +normal, as f(t) above", Presence::required},
    {"f_min", number(&HarmonicLoad::f_min, not_negative, "N"), "driven only: at most `load.f_max`"},
    {"frequency", number(&HarmonicLoad::frequency, not_negative, "Hz"), "driven only: ν",
     Presence::required},
};

const SceneKeys<BodyText> body_keys{
    {"name", text(&BodyText::name), "unique among walls and bodies", Presence::optional,
     "body_0, body_1, ..."},
    {"shape", choice(&BodyText::shape, {"box", "sphere", "grain", "mesh"}),
     "each has keys of its own, below", Presence::required},
    {"locked", texts(&BodyText::locked),
     "any of \"x\", \"y\", \"z\" (translations along the world's axes) and \"rotation\" (all "
     "three)"},
    {"mass", number(&BodyText::mass, positive, "kg"), "or `density`", Presence::only_where_given,
     ""},
    {"density", number(&BodyText::density, positive, "kg/m^3"),
     "one of `density` and `mass` is required unless the body is locked in everything",
     Presence::only_where_given, ""},
    {"position", vector(&BodyText::position, "m"),
     "where the shape's origin goes: the centre of mass, for a mesh the file's origin"},
    {"velocity", vector(&BodyText::velocity, "m/s"), "of the centre of mass"},
    {"spin", vector(&BodyText::spin, "rad/s"), "angular velocity, world frame"},
};

const SceneKeys<ShapeText>& shape_keys(const std::string& shape) {
  static const SceneKeys<ShapeText> box{
      {"size", vector(&ShapeText::size, "m"), "box: three full side lengths > 0",
       Presence::required},
  };
  static const SceneKeys<ShapeText> sphere{
      {"radius", number(&ShapeText::radius, positive, "m"),
       "sphere: circumradius of the polyhedron", Presence::required},
      {"subdivisions", whole(&ShapeText::subdivisions, 0, 5), "sphere: 20 · 4ⁿ faces"},
  };
  static const SceneKeys<ShapeText> grain{
      {"radius", number(&ShapeText::radius, positive, "m"),
       "grain: largest distance centre of mass – vertex", Presence::required},
      {"seed", seed(&ShapeText::seed), "grain: of its shape"},
  };
  static const SceneKeys<ShapeText> mesh{
      {"file", text(&ShapeText::file),
       "mesh: OBJ or STL of a closed convex body, relative to the scene file", Presence::required},
      {"scale", number(&ShapeText::scale, positive, "m per unit of the file"),
       "mesh: 0.001 for a file in millimetres"},
      {"hull", flag(&ShapeText::hull),
       "mesh: take the convex hull of the vertices instead of insisting on convexity"},
  };
  if (shape == "box") return box;
  if (shape == "sphere") return sphere;
  return shape == "mesh" ? mesh : grain;
}

const SceneKeys<OrientationText> orientation_keys{
    {"axis", vector(&OrientationText::axis),
     "of the rotation from the shape's frame; any length but 0"},
    {"angle_degrees", number(&OrientationText::angle_degrees, any_number, "degrees"),
     "about the axis, right-handed"},
};

const SceneKeys<ForceSpec> force_keys{
    {"constant", vector(&ForceSpec::constant, "N"),
     "force on the centre of mass, world frame: constant + amplitude · cos(2π · frequency · t + "
     "phase)"},
    {"amplitude", vector(&ForceSpec::amplitude, "N"), "its swinging part"},
    {"frequency", number(&ForceSpec::frequency, not_negative, "Hz"), "of the swinging part"},
    {"phase", number(&ForceSpec::phase, any_number, "rad"), "of the swinging part"},
};

}  // namespace ballast
