#include "experiments/view/pack_view.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "experiments/view/quantised.hpp"
#include "platform/deflate.hpp"

namespace ballast {
namespace {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::uint16_t>;
using Bytes = std::vector<std::uint8_t>;

std::string text_of(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

/// What a replay of these bytes takes in the page.
size_t page_bytes(const page::Replay& replay, size_t first_part = 0) {
  size_t bytes = 0;
  for (size_t k = first_part; k < replay.parts.size(); ++k)
    bytes += deflated(replay.parts[k].second).size() * 4 / 3;
  return bytes;
}

/// Corners, and faces as loops of corner numbers; all vertices over the largest coordinate.
void pack_shapes(const ViewData& view, Json& head, page::Replay& replay) {
  double scale = 0.0;
  for (const auto& shape : view.system.shapes)
    for (const Vec3& vertex : shape->vertices())
      scale = std::max(scale, vertex.lpNorm<Eigen::Infinity>());
  Words sizes, loops, corners, vertices;
  std::map<const Polyhedron*, size_t> place;
  for (const auto& shape : view.system.shapes) {
    place.emplace(shape.get(), place.size());
    sizes.push_back(static_cast<std::uint16_t>(shape->vertex_count()));
    sizes.push_back(static_cast<std::uint16_t>(shape->face_count()));
    for (int f = 0; f < shape->face_count(); ++f) {
      const auto loop = shape->face(f);
      loops.push_back(static_cast<std::uint16_t>(loop.size()));
      for (const int v : loop) corners.push_back(static_cast<std::uint16_t>(v));
    }
    for (const Vec3& vertex : shape->vertices())
      for (const double entry : vertex)
        vertices.push_back(static_cast<std::uint16_t>(std::lround(entry / scale * 32767.0)));
  }
  head["scale"] = scale;
  head["shapes"] = sizes.size() / 2;
  Json shape_of = Json::array();
  std::vector<double> grains;
  for (int b = 0; b < view.system.grain_count; ++b) {
    const RigidBody& body = view.system.bodies[static_cast<size_t>(b)];
    shape_of.push_back(place.at(body.shape.polyhedron));
    grains.insert(grains.end(), {body.mass, body.volume});
  }
  head["shape_of"] = shape_of;
  replay.parts.emplace_back("shape_sizes", word_bytes(sizes));
  replay.parts.emplace_back("face_sizes", word_bytes(loops));
  replay.parts.emplace_back("face_corners", word_bytes(corners));
  replay.parts.emplace_back("vertices", word_bytes(vertices));
  replay.parts.emplace_back("grains", float_bytes(grains));
}

/// Where grains are and how fast, at the frames of these numbers.
void pack_poses(const ViewData& view, const std::vector<size_t>& chosen, Json& head,
                page::Replay& replay) {
  const auto grains = static_cast<size_t>(view.system.grain_count);
  Vec3 low = Vec3::Constant(1e300), high = -low;
  double fastest = 0.0;
  for (const size_t f : chosen)
    for (size_t g = 0; g < grains; ++g) {
      low = low.cwiseMin(view.frames[f].pose[g].position);
      high = high.cwiseMax(view.frames[f].pose[g].position);
      fastest = std::max(fastest, view.frames[f].velocity[g].lpNorm<Eigen::Infinity>());
    }
  if (grains == 0) low = high = Vec3::Zero();
  Words positions, rotations;
  Bytes left_out, velocities;
  std::vector<int> before(grains, -1);
  Json times = Json::array(), steps = Json::array();
  for (const size_t f : chosen) {
    const PoseFrame& frame = view.frames[f];
    times.push_back(frame.time);
    steps.push_back(frame.step);
    for (size_t g = 0; g < grains; ++g) {
      for (int k = 0; k < 3; ++k) {
        positions.push_back(in_16_bits(frame.pose[g].position[k], low[k], high[k] - low[k]));
        velocities.push_back(signed_root(fastest > 0.0 ? frame.velocity[g][k] / fastest : 0.0));
      }
      const SmallestThree rotation = smallest_three(frame.pose[g].rotation, before[g]);
      before[g] = rotation.left_out;
      rotations.insert(rotations.end(), rotation.kept.begin(), rotation.kept.end());
      left_out.push_back(rotation.left_out);
    }
  }
  head["times"] = times;
  head["steps"] = steps;
  head["low"] = {low.x(), low.y(), low.z()};
  head["span"] = {high.x() - low.x(), high.y() - low.y(), high.z() - low.z()};
  head["fastest"] = fastest;
  head["largest_kept"] = largest_kept;
  replay.parts.emplace_back("positions", history_bytes(positions, 3 * grains, 2));
  replay.parts.emplace_back("rotations", history_bytes(rotations, 3 * grains, 1));
  replay.parts.emplace_back("left_out", history_bytes(left_out, grains));
  replay.parts.emplace_back("velocities", history_bytes(velocities, 3 * grains));
}

void pack_walls(const ViewData& view, const std::vector<size_t>& chosen, Json& head,
                page::Replay& replay) {
  Json walls = Json::array();
  std::vector<double> values;
  for (size_t b = static_cast<size_t>(view.system.grain_count); b < view.system.bodies.size();
       ++b) {
    const RigidBody& body = view.system.bodies[b];
    const Vec3 normal = view.frames[chosen.front()].pose[b].rotation * body.shape.plane.normal;
    walls.push_back({{"name", body.name},
                     {"normal", {normal.x(), normal.y(), normal.z()}},
                     {"driven", static_cast<int>(b) == view.driven_wall}});
    for (const size_t f : chosen)
      for (const Vec3& part : {view.frames[f].pose[b].position, view.frames[f].velocity[b]})
        values.insert(values.end(), part.begin(), part.end());
  }
  head["walls"] = walls;
  replay.parts.emplace_back("walls", float_bytes(values));
}

/// The contacts of every `stride`-th of the chosen frames. A contact's place is given from the
/// centre of grain a, over that grain's circumradius.
void pack_contacts(const ViewData& view, const std::vector<size_t>& chosen, size_t stride,
                   Json& head, page::Replay& replay) {
  float largest = 0.0f;
  Words body_a, body_b, forces;
  std::vector<float> normal_forces;
  std::array<Bytes, 3> places;
  std::array<Bytes, 2> normals;
  Bytes mobilised;
  Json frames = Json::array(), counts = Json::array();
  for (const size_t k : thinned(chosen.size(), stride)) {
    const size_t f = chosen[k];
    const std::vector<FrameContact> contacts = view.contacts(f);
    // before its first step a run knows no forces: those of the next frame stand for them
    if (view.frames[f].step == 0 && contacts.empty()) continue;
    frames.push_back(k);
    counts.push_back(contacts.size());
    int last = 0;
    for (FrameContact contact : contacts) {
      // a is a grain, so that the place can follow it
      if (contact.body_a >= view.system.grain_count) {
        std::swap(contact.body_a, contact.body_b);
        contact.normal = -contact.normal;
        contact.force = -contact.force;
      }
      const auto a = static_cast<size_t>(contact.body_a);
      const RigidBody& body = view.system.bodies[a];
      const double reach = body.is_wall() ? 1.0 : body.shape.polyhedron->circumradius();
      body_a.push_back(static_cast<std::uint16_t>(contact.body_a - last));
      body_b.push_back(static_cast<std::uint16_t>(contact.body_b - contact.body_a));
      last = contact.body_a;
      const Vec3 place =
          (contact.position.cast<double>() - view.frames[f].pose[a].position) / (1.02 * reach);
      for (int i = 0; i < 3; ++i)
        places[static_cast<size_t>(i)].push_back(
            static_cast<std::uint8_t>(128 + std::lround(127.0 * std::clamp(place[i], -1.0, 1.0))));
      const auto direction = octahedral(contact.normal.cast<double>());
      for (size_t i = 0; i < 2; ++i) normals[i].push_back(direction[i]);
      const float force = contact.force.dot(contact.normal);
      const float tangential = (contact.force - force * contact.normal).norm();
      largest = std::max(largest, force);
      normal_forces.push_back(force);
      const double bound = view.friction * force;
      mobilised.push_back(static_cast<std::uint8_t>(
          bound > 0.0 ? std::lround(255.0 * std::min(tangential / bound, 1.0)) : 0));
    }
  }
  for (const float force : normal_forces) {
    const double share = largest > 0.0f ? std::max(force, 0.0f) / largest : 0.0;
    forces.push_back(static_cast<std::uint16_t>(std::lround(4095.0 * std::sqrt(share))));
  }
  head["contact_frames"] = frames;
  head["contact_counts"] = counts;
  head["largest_force"] = largest;
  body_a.insert(body_a.end(), body_b.begin(), body_b.end());
  replay.parts.emplace_back("contact_bodies", word_bytes(body_a));
  replay.parts.emplace_back("contact_places",
                            text_of(places[0]) + text_of(places[1]) + text_of(places[2]));
  replay.parts.emplace_back("contact_normals", text_of(normals[0]) + text_of(normals[1]));
  replay.parts.emplace_back("contact_forces", word_bytes(forces));
  replay.parts.emplace_back("contact_mobilised", text_of(mobilised));
}

void pack_series(const ViewData& view, Json& head, page::Replay& replay) {
  std::vector<double> values = view.series_time;
  Json series = Json::array(), plots = Json::array();
  for (const ViewSeries& one : view.series) {
    series.push_back({{"name", one.name},
                      {"symbol", one.symbol},
                      {"meaning", one.meaning},
                      {"unit", one.unit},
                      {"ink", one.ink}});
    values.insert(values.end(), one.values.begin(), one.values.end());
  }
  for (const ViewPlot& plot : view.plots)
    plots.push_back({{"title", plot.title}, {"over", plot.over}, {"series", plot.series}});
  head["rows"] = view.series_time.size();
  head["series"] = series;
  head["plots"] = plots;
  replay.parts.emplace_back("series", float_bytes(values));
}

/// Errors in 255 steps of their logarithm, from 1e-9 to 1e2.
void pack_errors(const ViewData& view, Json& head, page::Replay& replay) {
  Bytes bytes;
  Json errors = Json::array();
  for (const ViewErrors& one : view.errors) {
    errors.push_back({{"backend", one.backend}, {"iterations", one.iterations}, {"rms", one.rms}});
    for (const auto& budget : one.error)
      for (const double error : budget)
        bytes.push_back(static_cast<std::uint8_t>(
            std::lround(255.0 * std::clamp((std::log10(error) + 9.0) / 11.0, 0.0, 1.0))));
  }
  head["errors"] = errors;
  if (!bytes.empty()) replay.parts.emplace_back("errors", text_of(bytes));
}

}  // namespace

std::vector<size_t> thinned(size_t count, size_t stride) {
  std::vector<size_t> kept;
  for (size_t k = 0; k < count; k += stride) kept.push_back(k);
  if (!kept.empty() && kept.back() + 1 < count) kept.push_back(count - 1);
  return kept;
}

page::Replay pack_view(const ViewData& view, size_t most_bytes) {
  if (view.frames.empty()) throw std::invalid_argument("a replay without a frame");
  Json head{
      {"title", view.title}, {"grains", view.system.grain_count}, {"friction", view.friction}};
  page::Replay replay;
  pack_shapes(view, head, replay);
  pack_series(view, head, replay);
  pack_errors(view, head, replay);
  const size_t still_parts = replay.parts.size(), still_bytes = page_bytes(replay);
  const bool has_contacts = static_cast<bool>(view.contacts);
  // poses may take two thirds of what is left, where there are contacts too
  const size_t room = most_bytes > still_bytes ? most_bytes - still_bytes : 0,
               pose_room = has_contacts ? room / 3 * 2 : room;
  std::vector<size_t> chosen;
  for (size_t stride = 1;; stride *= 2) {
    chosen = thinned(view.frames.size(), stride);
    replay.parts.resize(still_parts);
    pack_poses(view, chosen, head, replay);
    pack_walls(view, chosen, head, replay);
    if (chosen.size() <= 2 || page_bytes(replay, still_parts) <= pose_room) break;
  }
  const size_t pose_parts = replay.parts.size(), pose_bytes = page_bytes(replay, still_parts);
  for (size_t stride = 1; has_contacts; stride *= 2) {
    replay.parts.resize(pose_parts);
    pack_contacts(view, chosen, stride, head, replay);
    if (stride >= chosen.size() || pose_bytes + page_bytes(replay, pose_parts) <= room) break;
  }
  replay.head = head.dump();
  return replay;
}

}  // namespace ballast
