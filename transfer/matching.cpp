// SPDX-License-Identifier: BSD-3-Clause
// What makes a search needless: sides that are the same, and motion that both share.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "transfer/element_points.hpp"
#include "transfer/grid_transfer_impl.hpp"

namespace tenon::transfer {

std::vector<Vec3> places_of(const Partner& partner) {
  if (partner.location == Location::element) return local_points(partner.side());
  return {partner.coordinates.begin(), partner.coordinates.end()};
}

namespace {

bool same_bits(std::span<const Vec3> a, std::span<const Vec3> b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

/// Collective. Number of items over all ranks.
GlobalId global_items(const Partner& partner) {
  return partner.comm().sum(static_cast<std::int64_t>(partner.items().owned.size()));
}

/// Collective. Of all local items, m^3; none of points.
std::vector<double> volumes_of(const Partner& partner) {
  if (!partner.mesh) return std::vector<double>(partner.items().ids.size(), 0.0);
  return item_volumes(*partner.mesh, partner.coordinates, partner.location);
}

bool same_volumes(std::span<const double> a, std::span<const double> b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(std::abs(a[i] - b[i]) <= 1e-12 * std::abs(a[i]))) return false;
  return a.size() == b.size();
}

std::vector<DirectoryEntry> in_order(std::size_t count) {
  std::vector<DirectoryEntry> entries(count);
  for (std::size_t i = 0; i < count; ++i) entries[i] = {0, static_cast<LocalIndex>(i)};
  return entries;
}

}  // namespace

std::optional<std::vector<DirectoryEntry>> matching_items(const Partner& source, const Partner& target, bool volumes) {
  const Communicator& comm = target.comm();
  if (source.location != target.location || !source.choice.blocks.empty() || !source.choice.sides.empty())
    return std::nullopt;
  if (global_items(source) != global_items(target)) return std::nullopt;
  const Items &from = source.items(), &to = target.items();
  // Alone, most pairs that do not match are told apart by the first item.
  if (comm.size() == 1) {
    if (source.location != Location::element && !same_bits(source.coordinates, target.coordinates)) return std::nullopt;
    if (source.location == Location::element && !same_bits(places_of(source), places_of(target))) return std::nullopt;
    if (!std::equal(from.ids.begin(), from.ids.end(), to.ids.begin(), to.ids.end())) return std::nullopt;
    if (volumes && !same_volumes(volumes_of(source), volumes_of(target))) return std::nullopt;
    return in_order(to.ids.size());
  }
  std::vector<GlobalId> ids;
  for (const LocalIndex i : from.owned) ids.push_back(from.ids[static_cast<std::size_t>(i)]);
  std::vector<DirectoryEntry> entries = Directory(comm, ids, from.owned).find(to.ids);
  const bool known = std::all_of(entries.begin(), entries.end(), [](const DirectoryEntry& e) { return e.rank >= 0; });
  if (comm.any(!known)) return std::nullopt;
  std::vector<int> owner;
  std::vector<LocalIndex> index, into;
  for (const DirectoryEntry& entry : entries) {
    owner.push_back(entry.rank), index.push_back(entry.index);
    into.push_back(static_cast<LocalIndex>(into.size()));
  }
  const std::vector<Vec3> mine = places_of(source);
  std::vector<Vec3> theirs(entries.size());
  const ExchangePlan plan = ExchangePlan::from_owners(comm, owner, index, into, "matching items");
  plan.forward(std::span<const Vec3>(mine), std::span<Vec3>(theirs));
  if (comm.any(!same_bits(theirs, places_of(target)))) return std::nullopt;
  if (!volumes) return entries;
  const std::vector<double> here = volumes_of(source);
  std::vector<double> there(entries.size());
  plan.forward(std::span<const double>(here), std::span<double>(there));
  if (comm.any(!same_volumes(there, volumes_of(target)))) return std::nullopt;
  return entries;
}

double mean_spacing(const Partner& partner) {
  std::array<double, 6> ends;
  ends.fill(-std::numeric_limits<double>::infinity());
  for (const Vec3& x : partner.coordinates)
    for (std::size_t c = 0; c < 3; ++c) ends[c] = std::max(ends[c], -x[c]), ends[c + 3] = std::max(ends[c + 3], x[c]);
  partner.comm().max(std::span<double>(ends));
  const GlobalId count = global_items(partner);
  if (count == 0) return 0;
  const double volume = (ends[3] + ends[0]) * (ends[4] + ends[1]) * (ends[5] + ends[2]);
  return std::cbrt(volume / static_cast<double>(count));
}

namespace {

/// A rigid motion x -> rotation (x - from) + to; columns of the frames are orthonormal.
struct RigidMotion {
  std::array<Vec3, 3> frame_before, frame_now;
  Vec3 from, to;
  Vec3 operator()(const Vec3& x) const {
    const Vec3 away = x - from;
    Vec3 result = to;
    for (std::size_t k = 0; k < 3; ++k) result = result + dot(frame_before[k], away) * frame_now[k];
    return result;
  }
};

constexpr std::size_t anchors = 24;

/// Collective. Where some nodes, spread over the mesh by their numbers, were and are.
std::array<double, 6 * anchors> anchor_places(const Partner& source) {
  std::array<double, 6 * anchors> places;
  places.fill(-std::numeric_limits<double>::infinity());
  const Items& nodes = source.nodes;
  const GlobalId count = source.mesh->global_nodes;
  for (std::size_t k = 0; k < anchors; ++k) {
    const GlobalId id = (count - 1) * static_cast<GlobalId>(k) / static_cast<GlobalId>(anchors - 1);
    const auto at = std::lower_bound(nodes.ids.begin(), nodes.ids.end(), id);
    if (at == nodes.ids.end() || *at != id) continue;
    const auto i = static_cast<std::size_t>(at - nodes.ids.begin());
    for (std::size_t c = 0; c < 3; ++c)
      places[6 * k + c] = source.built[i][c], places[6 * k + 3 + c] = source.coordinates[i][c];
  }
  source.comm().max(std::span<double>(places));
  return places;
}

/// An orthonormal frame with the first axis along a, the second in the plane of a and b.
std::array<Vec3, 3> frame(const Vec3& a, const Vec3& b) {
  const Vec3 e0 = 1 / norm(a) * a;
  const Vec3 across = b - dot(e0, b) * e0;
  const Vec3 e1 = 1 / norm(across) * across;
  return {e0, e1, cross(e0, e1)};
}

/// The motion that three anchors far apart have made. None where all anchors lie on a line.
std::optional<RigidMotion> motion_of(const std::array<double, 6 * anchors>& places) {
  const auto before = [&](std::size_t k) { return Vec3{places[6 * k], places[6 * k + 1], places[6 * k + 2]}; };
  const auto now = [&](std::size_t k) { return Vec3{places[6 * k + 3], places[6 * k + 4], places[6 * k + 5]}; };
  std::size_t far = 0, wide = 0;
  for (std::size_t k = 1; k < anchors; ++k)
    if (norm(before(k) - before(0)) > norm(before(far) - before(0))) far = k;
  const Vec3 line = before(far) - before(0);
  const auto area = [&](std::size_t k) { return norm(cross(line, before(k) - before(0))); };
  for (std::size_t k = 1; k < anchors; ++k)
    if (area(k) > area(wide)) wide = k;
  if (!(area(wide) > 1e-6 * dot(line, line))) return std::nullopt;
  return RigidMotion{frame(line, before(wide) - before(0)), frame(now(far) - now(0), now(wide) - now(0)), before(0),
                     now(0)};
}

bool follows(const RigidMotion& motion, const Partner& partner, double tolerance) {
  for (std::size_t i = 0; i < partner.built.size(); ++i) {
    const Vec3 off = partner.coordinates[i] - motion(partner.built[i]);
    if (!(dot(off, off) <= tolerance * tolerance)) return false;
  }
  return true;
}

}  // namespace

bool moved_rigidly(const Partner& source, const Partner& target, double tolerance) {
  if (!source.mesh || source.mesh->global_nodes < static_cast<GlobalId>(anchors)) return false;
  const std::optional<RigidMotion> motion = motion_of(anchor_places(source));
  if (!motion) return false;  // the same on every rank
  return !source.comm().any(!follows(*motion, source, tolerance) || !follows(*motion, target, tolerance));
}

}  // namespace tenon::transfer
