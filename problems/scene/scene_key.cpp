#include "problems/scene/scene_key.hpp"

#include "platform/pack.hpp"
#include "platform/text.hpp"

namespace ballast {

std::string mesh_key(const Polyhedron& mesh) {
  Packer packer;
  packer.list(mesh.vertices(), [&](const Vec3& vertex) { packer.fixed(vertex); });
  for (int f = 0; f < mesh.face_count(); ++f) packer.list(mesh.face(f));
  return content_key(packer.bytes());
}

std::string scene_key(const Scene& scene, const std::string& resolved_text) {
  // The text names meshes by their files. Their contents belong to the key, too: a mesh that
  // is edited makes another scene.
  std::string text = resolved_text;
  for (const BodySpec& body : scene.bodies)
    if (!body.mesh_key.empty()) text += "mesh " + body.mesh_key + '\n';
  if (scene.grains)
    for (const Polyhedron& mesh : scene.grains->meshes) text += "mesh " + mesh_key(mesh) + '\n';
  return content_key(text);
}

}  // namespace ballast
