#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "experiments/view/view.hpp"
#include "platform/atomic_file.hpp"
#include "platform/deflate.hpp"

namespace ballast {
namespace {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::uint16_t>;
using Bytes = std::vector<std::uint8_t>;
using Floats = std::vector<float>;

/// The bytes of numbers: all lowest bytes, then all second bytes and so on, because the bytes of
/// neighbours are alike.
template <class Number>
std::string text_of(const std::vector<Number>& values) {
  std::string bytes(sizeof(Number) * values.size(), '\0');
  for (size_t k = 0; k < values.size(); ++k)
    for (size_t b = 0; b < sizeof(Number); ++b)
      bytes[b * values.size() + k] = reinterpret_cast<const char*>(&values[k])[b];
  return bytes;
}

/// A history holds frames of equally many columns, values[frame * columns + column]. Its bytes are
/// the differences in time of every column, one column after the other, as zigzag numbers (0, -1,
/// 1, -2, ...): mostly zeros, which deflate packs well. With `order` 2 they are differences of
/// differences, with 1 differences. They are modulo 2^16 or 2^8, so nothing overflows.
template <class Word>
std::string history_of(const std::vector<Word>& values, size_t columns, int order) {
  std::vector<Word> codes;
  const size_t frames = columns ? values.size() / columns : 0;
  for (size_t c = 0; c < columns; ++c) {
    Word value = 0, slope = 0;
    for (size_t f = 0; f < frames; ++f) {
      const Word next = values[f * columns + c], difference = static_cast<Word>(next - value),
                 change = static_cast<Word>(difference - (order == 2 ? slope : 0));
      value = next;
      slope = difference;
      codes.push_back(static_cast<Word>(change << 1 ^ -(change >> (8 * sizeof(Word) - 1))));
    }
  }
  return text_of(codes);
}

/// The place of `value` in [low, low + span] in all bits of a Word; an empty span gives 0.
template <class Word>
Word place_in(double value, double low, double span) {
  const double share = span > 0.0 ? std::clamp((value - low) / span, 0.0, 1.0) : 0.0;
  return static_cast<Word>(std::lround(share * std::numeric_limits<Word>::max()));
}

/// Maps -1 .. 1 to 8 bits; 0 is 128.
std::uint8_t signed_byte(double value) {
  return static_cast<std::uint8_t>(128 + std::lround(127.0 * std::clamp(value, -1.0, 1.0)));
}

/// The bytes that the parts of a replay from `first_part` on take in the page.
size_t page_bytes(const page::Replay& replay, size_t first_part = 0) {
  size_t bytes = 0;
  for (size_t k = first_part; k < replay.parts.size(); ++k)
    bytes += deflated(replay.parts[k].second).size() * 4 / 3;
  return bytes;
}

/// Every `stride`-th of `count`, and the last.
std::vector<size_t> thinned(size_t count, size_t stride) {
  std::vector<size_t> kept;
  for (size_t k = 0; k < count; k += stride) kept.push_back(k);
  if (!kept.empty() && kept.back() + 1 < count) kept.push_back(count - 1);
  return kept;
}

/// A body's convex parts as one set of corners and faces, in its own frame.
struct DrawnShape {
  std::vector<Vec3> corners;
  std::vector<std::vector<int>> faces;

  explicit DrawnShape(const ContactShape& shape) {
    for (const ConvexPart& part : convex_parts(shape)) {
      const int first = static_cast<int>(corners.size());
      for (const Vec3& vertex : part.polyhedron->vertices()) corners.push_back(part.pose * vertex);
      for (int f = 0; f < part.polyhedron->face_count(); ++f) {
        std::vector<int>& face = faces.emplace_back();
        for (const int v : part.polyhedron->face(f)) face.push_back(first + v);
      }
    }
  }
};

/// Packs for each shape the numbers of corners and faces, the faces as loops of corner numbers,
/// each after its length, and the corners over the largest coordinate of all shapes.
void pack_shapes(const ViewData& view, Json& head, page::Replay& replay) {
  std::map<const Polyhedron*, size_t> place;
  std::vector<DrawnShape> shapes;
  std::vector<size_t> shape_of;
  Floats grains;
  for (int b = 0; b < view.system.grain_count; ++b) {
    const RigidBody& body = view.system.bodies[b];
    const auto [at, is_new] = place.emplace(body.shape.polyhedron, shapes.size());
    if (is_new) shapes.emplace_back(body.shape);
    shape_of.push_back(at->second);
    grains.insert(grains.end(), {static_cast<float>(body.mass), static_cast<float>(body.volume)});
  }
  double scale = 0.0;
  for (const DrawnShape& shape : shapes)
    for (const Vec3& corner : shape.corners)
      scale = std::max(scale, corner.lpNorm<Eigen::Infinity>());
  Words words;
  const auto add = [&](auto number) { words.push_back(static_cast<std::uint16_t>(number)); };
  for (const DrawnShape& shape : shapes) {
    add(shape.corners.size());
    add(shape.faces.size());
    for (const std::vector<int>& face : shape.faces) {
      add(face.size());
      for (const int v : face) add(v);
    }
    for (const Vec3& corner : shape.corners)
      for (const double entry : corner) add(std::lround(entry / scale * 32767.0));
  }
  head["scale"] = scale;
  head["shapes"] = shapes.size();
  head["shape_of"] = shape_of;
  replay.parts.emplace_back("shapes", text_of(words));
  replay.parts.emplace_back("masses", text_of(grains));
}

/// Packs positions, rotations and velocities of the grains in the chosen frames. A quaternion has
/// the sign that brings it near the one before.
void pack_poses(const ViewData& view, const std::vector<size_t>& chosen, Json& head,
                page::Replay& replay) {
  const auto grains = static_cast<size_t>(view.system.grain_count);
  Eigen::AlignedBox3d box;
  double fastest = 0.0;
  for (const size_t f : chosen)
    for (size_t g = 0; g < grains; ++g) {
      box.extend(view.frames[f].pose[g].position);
      fastest = std::max(fastest, view.frames[f].velocity[g].lpNorm<Eigen::Infinity>());
    }
  if (grains == 0) box.extend(Vec3::Zero().eval());
  const Vec3 low = box.min(), span = box.diagonal();
  Words positions, rotations;
  Bytes velocities;
  std::vector<Quat> before(grains, Quat::Identity());
  head["times"] = Json::array();
  for (const size_t f : chosen) {
    const MotionState& frame = view.frames[f];
    head["times"].push_back(frame.time);
    for (size_t g = 0; g < grains; ++g) {
      for (int k = 0; k < 3; ++k) {
        positions.push_back(place_in<std::uint16_t>(frame.pose[g].position[k], low[k], span[k]));
        // by a root, with fine steps near 0
        const double share = fastest > 0.0 ? frame.velocity[g][k] / fastest : 0.0;
        velocities.push_back(signed_byte(std::copysign(std::sqrt(std::abs(share)), share)));
      }
      Quat turn = frame.pose[g].rotation;
      if (turn.dot(before[g]) < 0.0) turn.coeffs() *= -1.0;
      before[g] = turn;
      for (const double entry : {turn.w(), turn.x(), turn.y(), turn.z()})
        rotations.push_back(place_in<std::uint16_t>(entry, -1.0, 2.0));
    }
  }
  head["low"] = {low.x(), low.y(), low.z()};
  head["span"] = {span.x(), span.y(), span.z()};
  head["fastest"] = fastest;
  replay.parts.emplace_back("positions", history_of(positions, 3 * grains, 2));
  replay.parts.emplace_back("rotations", history_of(rotations, 4 * grains, 2));
  replay.parts.emplace_back("velocities", history_of(velocities, 3 * grains, 1));
}

/// Packs how many periods each grain has passed since the first frame, counted by the least ways
/// between all frames; nothing in a world without a period.
void pack_laps(const ViewData& view, const std::vector<size_t>& chosen, Json& head,
               page::Replay& replay) {
  const Vec3& period = view.system.period.vector;
  if (!view.system.period.repeats()) return;
  const auto grains = static_cast<size_t>(view.system.grain_count);
  Words now(grains, 0), laps;  // modulo 2^16
  for (size_t f = 0; f < view.frames.size(); ++f) {
    for (size_t g = 0; f > 0 && g < grains; ++g) {
      const Vec3 way = view.frames[f].pose[g].position - view.frames[f - 1].pose[g].position;
      const long back = std::lround(way.dot(period) / period.squaredNorm());
      now[g] = static_cast<std::uint16_t>(now[g] - back);
    }
    if (std::ranges::binary_search(chosen, f)) laps.insert(laps.end(), now.begin(), now.end());
  }
  head["period"] = {period.x(), period.y(), period.z()};
  replay.parts.emplace_back("laps", history_of(laps, grains, 1));
}

void pack_walls(const ViewData& view, const std::vector<size_t>& chosen, Json& head,
                page::Replay& replay) {
  head["walls"] = Json::array();
  Floats values;
  for (auto b = static_cast<size_t>(view.system.grain_count); b < view.system.bodies.size(); ++b) {
    const RigidBody& body = view.system.bodies[b];
    const Vec3 normal = view.frames[chosen.front()].pose[b].rotation * body.shape.plane.normal;
    head["walls"].push_back({{"name", body.name},
                             {"normal", {normal.x(), normal.y(), normal.z()}},
                             {"driven", static_cast<int>(b) == view.system.first_driven_wall()}});
    for (const size_t f : chosen)
      for (const Vec3& part : {view.frames[f].pose[b].position, view.frames[f].velocity[b]})
        values.insert(values.end(), part.begin(), part.end());
  }
  replay.parts.emplace_back("walls", text_of(values));
}

/// Packs the contacts of every `stride`-th of the chosen frames: forces as roots in 12 bits, the
/// share of friction that is used, and places from grain a's centre over its circumradius.
void pack_contacts(const ViewData& view, const std::vector<size_t>& chosen, size_t stride,
                   Json& head, page::Replay& replay) {
  std::vector<std::int32_t> body_a, body_b;
  Words forces;
  std::vector<double> normal_forces;
  double largest = 0.0;
  std::array<Bytes, 3> places;
  Bytes mobilised;
  head["contact_frames"] = head["contact_counts"] = Json::array();
  for (const size_t k : thinned(chosen.size(), stride)) {
    const MotionState& frame = view.frames[chosen[k]];
    const std::vector<FrameContact> contacts = view.contacts(chosen[k]);
    // before its first step a run has no forces: the page shows those of the next frame
    if (frame.step == 0 && contacts.empty()) continue;
    head["contact_frames"].push_back(k);
    head["contact_counts"].push_back(contacts.size());
    int last = 0;
    for (const FrameContact& contact : contacts) {
      // a is a grain, so that the place can follow it; walls have the larger numbers
      const auto [a, b] = contact.body_a < view.system.grain_count
                              ? std::pair(contact.body_a, contact.body_b)
                              : std::pair(contact.body_b, contact.body_a);
      const RigidBody& body = view.system.bodies[a];
      const double reach = body.is_wall() ? 1.0 : body.shape.polyhedron->circumradius();
      body_a.push_back(a - last);
      body_b.push_back(b - a);
      last = a;
      const Vec3 arm = contact.position.cast<double>() - frame.pose[a].position,
                 place = view.system.period.nearest(arm) / (1.02 * reach);
      for (int i = 0; i < 3; ++i) places[i].push_back(signed_byte(place[i]));
      const float force = contact.force.dot(contact.normal);
      const double tangential = (contact.force - force * contact.normal).norm(),
                   bound = view.system.friction * static_cast<double>(force);
      normal_forces.push_back(force);
      largest = std::max<double>(largest, force);
      mobilised.push_back(place_in<std::uint8_t>(tangential, 0.0, bound));
    }
  }
  for (const double force : normal_forces) {
    const double share = largest > 0.0 ? std::max(force, 0.0) / largest : 0.0;
    forces.push_back(static_cast<std::uint16_t>(std::lround(4095.0 * std::sqrt(share))));
  }
  head["largest_force"] = largest;
  body_a.insert(body_a.end(), body_b.begin(), body_b.end());
  replay.parts.emplace_back("contact_bodies", text_of(body_a));
  replay.parts.emplace_back("contact_places",
                            text_of(places[0]) + text_of(places[1]) + text_of(places[2]));
  replay.parts.emplace_back("contact_forces", text_of(forces));
  replay.parts.emplace_back("contact_mobilised", text_of(mobilised));
}

void pack_series(const ViewData& view, Json& head, page::Replay& replay) {
  Floats values(view.series_time.begin(), view.series_time.end());
  head["rows"] = view.series_time.size();
  head["series"] = head["plots"] = Json::array();
  for (const ViewSeries& one : view.series) {
    head["series"].push_back(
        {{"name", one.name}, {"symbol", one.symbol}, {"unit", one.unit}, {"ink", one.ink}});
    values.insert(values.end(), one.values.begin(), one.values.end());
  }
  for (const ViewPlot& plot : view.plots)
    head["plots"].push_back({{"over", plot.over}, {"series", plot.series}});
  replay.parts.emplace_back("series", text_of(values));
}

/// Packs errors in 255 steps of their logarithm, from 1e-9 to 1e2.
void pack_errors(const ViewData& view, Json& head, page::Replay& replay) {
  Bytes bytes;
  head["errors"] = Json::array();
  for (const ViewErrors& one : view.errors) {
    head["errors"].push_back(
        {{"backend", one.backend}, {"iterations", one.iterations}, {"rms", one.rms}});
    for (const auto& budget : one.error)
      for (const double error : budget)
        bytes.push_back(place_in<std::uint8_t>(std::log10(error), -9.0, 11.0));
  }
  replay.parts.emplace_back("errors", text_of(bytes));
}

}  // namespace

page::Replay pack_view(const ViewData& view, size_t most_bytes) {
  if (view.frames.empty()) throw std::invalid_argument("a replay without a frame");
  Json head{{"grains", view.system.grain_count}};
  page::Replay replay;
  pack_shapes(view, head, replay);
  pack_series(view, head, replay);
  pack_errors(view, head, replay);
  const size_t still_parts = replay.parts.size(), still_bytes = page_bytes(replay);
  const bool has_contacts = static_cast<bool>(view.contacts);
  // with contacts, poses may take two thirds of the bytes that are left
  const size_t room = most_bytes > still_bytes ? most_bytes - still_bytes : 0,
               pose_room = has_contacts ? room / 3 * 2 : room;
  // A moving grain's pose takes at least two bytes, so far too small strides are skipped.
  size_t stride = 1;
  while (view.frames.size() / stride * view.system.grain_count * 2 > pose_room) stride *= 2;
  std::vector<size_t> chosen;
  for (;; stride *= 2) {
    chosen = thinned(view.frames.size(), stride);
    replay.parts.resize(still_parts);
    pack_poses(view, chosen, head, replay);
    pack_laps(view, chosen, head, replay);
    pack_walls(view, chosen, head, replay);
    if (chosen.size() <= 2 || page_bytes(replay, still_parts) <= pose_room) break;
  }
  const size_t pose_parts = replay.parts.size(), pose_bytes = page_bytes(replay, still_parts);
  for (size_t every = 1; has_contacts; every *= 2) {
    replay.parts.resize(pose_parts);
    pack_contacts(view, chosen, every, head, replay);
    if (every >= chosen.size() || pose_bytes + page_bytes(replay, pose_parts) <= room) break;
  }
  replay.head = head.dump();
  return replay;
}

page::Replay replay_of(const ViewData& view) {
  const bool moves = view.frames.size() > 1;
  page::Replay replay = pack_view(view);
  replay.still = still_png(view, {0}, {.width = 640, .height = 420});
  replay.caption = page::words(moves ? "view.motion" : "view.still");
  if (moves && view.system.first_driven_wall() >= 0)
    replay.caption += page::words("view.driven_wall");
  if (!view.errors.empty()) replay.caption += page::words("view.errors");
  if (!view.has_shapes) replay.caption += page::words("view.no_shapes");
  if (view.errors.empty() && moves && !view.contacts)
    replay.caption += page::words(view.has_forces_later ? "view.forces_later" : "view.no_forces");
  return replay;
}

void write_view_page(const ViewData& view, const std::filesystem::path& file) {
  page::Page page{.title = view.title};
  page.add({"motion", view.errors.empty() ? "In 3D" : "The error in space", {replay_of(view)}});
  write_whole_file(file, html_of(page));
}

}  // namespace ballast
