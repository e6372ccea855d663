// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/nodal_conditions.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon {

namespace {

using Kind = PrescribedMotion::Kind;

Vec3 unit(const Vec3& a) {
  return (1 / norm(a)) * a;
}

Vec3 times(const std::array<double, 9>& a, const Vec3& x) {
  return {a[0] * x[0] + a[1] * x[1] + a[2] * x[2], a[3] * x[0] + a[4] * x[1] + a[5] * x[2],
          a[6] * x[0] + a[7] * x[1] + a[8] * x[2]};
}

/// R - 1 of the rotation by `angle` about the unit vector n (Rodrigues).
std::array<double, 9> rotation_minus_one(const Vec3& n, double angle) {
  const double s = std::sin(angle), half = std::sin(0.5 * angle), c = 2 * half * half;  // c = 1 - cos
  return {c * (n[0] * n[0] - 1),      c * n[0] * n[1] - s * n[2], c * n[0] * n[2] + s * n[1],
          c * n[0] * n[1] + s * n[2], c * (n[1] * n[1] - 1),      c * n[1] * n[2] - s * n[0],
          c * n[0] * n[2] - s * n[1], c * n[1] * n[2] + s * n[0], c * (n[2] * n[2] - 1)};
}

bool stands_still(const PrescribedMotion& m) {
  return m.kind == Kind::fixed || m.kind == Kind::symmetry || (m.kind == Kind::wall && m.factor.is_constant());
}

/// Owned nodes of one or more sets, ascending.
std::vector<LocalIndex> owned_nodes(const Mesh& mesh, const std::vector<std::string>& sets, const std::string& label) {
  std::vector<LocalIndex> nodes;
  for (const std::string& name : sets) {
    const NodeSet* set = mesh.find_node_set(name);
    if (!set) throw Error(ExitCode::usage, fmt::format("{}: the mesh has no node set '{}'", label, name));
    for (const LocalIndex n : set->nodes)
      if (mesh.owns_node(n)) nodes.push_back(n);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

double extent(const Mesh& mesh) {
  double values[6];
  for (int c = 0; c < 3; ++c) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& x : mesh.coordinates) {
      low = std::min(low, x[static_cast<std::size_t>(c)]);
      high = std::max(high, x[static_cast<std::size_t>(c)]);
    }
    values[c] = -low, values[c + 3] = high;
  }
  mesh.comm.max(std::span(values));
  return std::hypot(values[0] + values[3], values[1] + values[4], values[2] + values[5]);
}

std::string node_at(const Mesh& mesh, LocalIndex n) {
  const Vec3& x = mesh.coordinates[static_cast<std::size_t>(n)];
  return fmt::format("node {} at ({:.6g}, {:.6g}, {:.6g})", mesh.node_labels[static_cast<std::size_t>(n)], x[0], x[1],
                     x[2]);
}

}  // namespace

NodalConditions::NodalConditions(const Mesh& mesh, const std::vector<PrescribedMotion>& motions,
                                 const std::vector<RigidWall>& walls)
    : mesh_(mesh),
      motions_(motions),
      walls_(walls),
      prepared_(motions.size()),
      rotations_(mesh, motions),
      wall_distance_(walls.size()) {
  std::optional<Error> error;
  const double tolerance = 1e-6 * extent(mesh);
  std::vector<std::int32_t> index(static_cast<std::size_t>(mesh.nodes()), -1);
  for (std::size_t m = 0; m < motions_.size(); ++m) {
    PrescribedMotion& motion = motions_[m];
    motion.axis = unit(motion.axis), motion.normal = unit(motion.normal);
    has_bonded_walls_ = has_bonded_walls_ || motion.kind == Kind::wall;
    for (const LocalIndex n : owned_nodes(mesh, motion.node_sets, motion.label)) {
      const auto i = static_cast<std::size_t>(n);
      const double off = dot(motion.normal, mesh.coordinates[i] - motion.centre);
      if (motion.kind == Kind::wall && std::abs(off) > tolerance && !error)
        error = Error(ExitCode::usage,
                      fmt::format("{}: {} is {:.3g} m off the plane of the wall that it is bonded to; move the wall's "
                                  "point onto the node set",
                                  motion.label, node_at(mesh, n), off));
      if (index[i] < 0) {
        index[i] = static_cast<std::int32_t>(constrained_.size());
        constrained_.push_back({n, 0, {}});
      }
      constrain(static_cast<std::int32_t>(m), constrained_[static_cast<std::size_t>(index[i])], error);
    }
  }
  for (RigidWall& wall : walls_) {
    wall.normal = unit(wall.normal);
    const double start = dot(wall.normal, wall.point);
    const auto check = [&](LocalIndex n) {
      const double gap = dot(wall.normal, mesh.coordinates[static_cast<std::size_t>(n)]) - start;
      if (gap < -tolerance && !error)
        error = Error(ExitCode::usage,
                      fmt::format("{}: {} starts {:.3g} m behind the wall; the normal must point to the body's side",
                                  wall.label, node_at(mesh, n), -gap));
    };
    const std::vector<LocalIndex> nodes =
        wall.node_sets.empty() ? mesh.owned_nodes : owned_nodes(mesh, wall.node_sets, wall.label);
    std::for_each(nodes.begin(), nodes.end(), check);
  }
  mesh.comm.throw_if_any(error);
  find_walls(mesh, walls);
  for (Standing& s : standing_) s.constrained = index[static_cast<std::size_t>(s.node)];
  if (has_motions()) boundary_work_.resize(static_cast<std::size_t>(mesh.nodes()));
  if (has_walls()) wall_work_.resize(static_cast<std::size_t>(mesh.nodes()));
}

void NodalConditions::find_walls(const Mesh& mesh, const std::vector<RigidWall>& walls) {
  std::vector<std::pair<LocalIndex, std::int32_t>> pairs;
  for (std::size_t w = 0; w < walls.size(); ++w)
    for (const LocalIndex n :
         walls[w].node_sets.empty() ? mesh.owned_nodes : owned_nodes(mesh, walls[w].node_sets, walls[w].label))
      pairs.emplace_back(n, static_cast<std::int32_t>(w));
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [node, wall] : pairs) {
    if (standing_.empty() || standing_.back().node != node)
      standing_.push_back({node, -1, static_cast<std::int32_t>(standing_walls_.size()), 0});
    standing_walls_.push_back(wall);
    ++standing_.back().walls;
  }
}

std::int64_t NodalConditions::leave_out_of_walls(const std::vector<bool>& bound) {
  std::optional<Error> error;
  std::int64_t left_out = 0;
  std::vector<std::int64_t> kept(walls_.size());
  std::vector<Standing> standing;
  for (const Standing& entry : standing_) {
    const auto n = static_cast<std::size_t>(entry.node);
    for (std::int32_t i = entry.first_wall; i < entry.first_wall + entry.walls; ++i) {
      const auto w = static_cast<std::size_t>(standing_walls_[static_cast<std::size_t>(i)]);
      kept[w] += bound[n] ? 0 : 1;
      if (bound[n] && !walls_[w].node_sets.empty() && !error)
        error = Error(ExitCode::usage,
                      fmt::format("{}: {} is tied or belongs to a rigid body, whose motion no wall can stop; take it "
                                  "out of the node sets",
                                  walls_[w].label, node_at(mesh_, entry.node)));
    }
    if (bound[n])
      ++left_out;
    else
      standing.push_back(entry);
  }
  mesh_.comm.throw_if_any(error);
  left_out = mesh_.comm.sum(left_out);
  if (left_out == 0) return 0;
  mesh_.comm.sum(std::span(kept));
  for (std::size_t w = 0; w < walls_.size(); ++w)
    if (kept[w] == 0)
      throw Error(ExitCode::usage,
                  fmt::format("{}: all of its nodes are tied or belong to rigid bodies, whose motion no wall can stop; "
                              "expected a wall with other nodes (prescribe the motion of the body instead)",
                              walls_[w].label));
  standing_ = std::move(standing);
  return left_out;
}

void NodalConditions::constrain(std::int32_t motion, Constrained& entry, std::optional<Error>& error) const {
  const PrescribedMotion& m = motions_[static_cast<std::size_t>(motion)];
  if (m.kind == Kind::symmetry || m.kind == Kind::wall) return add_row(m.normal, motion, entry, error);
  for (std::size_t c = 0; c < 3; ++c) {
    Vec3 axis{};
    axis[c] = 1;
    if (m.components[c] || m.kind == Kind::rotation) add_row(axis, motion, entry, error);
  }
}

void NodalConditions::add_row(const Vec3& normal, std::int32_t motion, Constrained& entry,
                              std::optional<Error>& error) const {
  constexpr double parallel = 1e-6;
  Row row{normal, normal, {0, 0}, 1, motion};
  bool still = stands_still(motions_[static_cast<std::size_t>(motion)]);
  std::int32_t against = -1;
  for (int k = 0; k < entry.rows; ++k) {
    const double along = dot(entry.row[k].direction, normal);
    row.direction = row.direction - along * entry.row[k].direction;
    if (k < 2) row.along[k] = along;
    if (std::abs(along) <= parallel) continue;
    const bool other_still = stands_still(motions_[static_cast<std::size_t>(entry.row[k].motion)]);
    if (against < 0 || !other_still) against = entry.row[k].motion;
    still = still && other_still;
  }
  const double left = norm(row.direction);
  if (entry.rows < 3 && left > parallel) {
    row.inverse = 1 / left;
    row.direction = row.inverse * row.direction;
    entry.row[entry.rows++] = row;
  } else if (!still && !error) {
    error = Error(
        ExitCode::usage,
        fmt::format("{} and {} both prescribe the motion of {} along ({:.3g}, {:.3g}, {:.3g}); take the node "
                    "out of one of the sets, or name both sets in one condition",
                    motions_[static_cast<std::size_t>(against)].label, motions_[static_cast<std::size_t>(motion)].label,
                    node_at(mesh_, entry.node), normal[0], normal[1], normal[2]));
  }
}

NodalConditions::Prepared NodalConditions::prepare(const PrescribedMotion& m, double time, double dt) const {
  using Form = Prepared::Form;
  Prepared p{stands_still(m) ? Form::velocity : Form::place, {}, m.centre, {}};
  const double end = time + dt;
  switch (m.kind) {
    case Kind::fixed:
    case Kind::symmetry:
      break;
    case Kind::velocity:
      p.form = Form::velocity;
      for (std::size_t c = 0; c < 3; ++c) p.b[c] = m.value[c](time + 0.5 * dt);
      break;
    case Kind::acceleration:
      p.form = Form::acceleration;
      for (std::size_t c = 0; c < 3; ++c) p.b[c] = m.value[c](time);
      break;
    case Kind::displacement:
      for (std::size_t c = 0; c < 3; ++c) p.b[c] = m.value[c](end);
      break;
    case Kind::wall:
      p.b = m.factor(end) * m.normal;
      break;
    case Kind::gradient:
      for (std::size_t i = 0; i < 9; ++i) p.a[i] = m.factor(end) * m.gradient[i];
      break;
    case Kind::rotation:
      p.a = rotation_minus_one(m.axis, m.factor(end));
      break;
  }
  return p;
}

double NodalConditions::target(const Row& row, const NodalState& nodes, std::size_t n, double kick, double dt) const {
  const Prepared& p = prepared_[static_cast<std::size_t>(row.motion)];
  if (p.form == Prepared::Form::velocity) return dot(row.normal, p.b);
  if (p.form == Prepared::Form::acceleration) {
    const double* f = nodes.force[n].v;
    const Vec3 before = nodes.velocity()[n] + kick * nodes.inverse_mass[n] * Vec3{f[0], f[1], f[2]};
    return dot(row.normal, before + kick * p.b);
  }
  const Vec3& reference = mesh_.coordinates[n];
  const Vec3 displacement = p.b + times(p.a, reference - p.c);
  return dot(row.normal, (reference - nodes.position()[n]) + displacement) / dt;
}

void NodalConditions::start(std::span<Vec3> velocity, double time) {
  for (std::size_t m = 0; m < motions_.size(); ++m) prepared_[m] = prepare(motions_[m], time, 0);
  for (const Constrained& entry : constrained_) {
    Vec3& v = velocity[static_cast<std::size_t>(entry.node)];
    const Vec3 given = v;
    double along[3];
    for (int k = 0; k < entry.rows; ++k) {
      const Row& row = entry.row[k];
      const Prepared& p = prepared_[static_cast<std::size_t>(row.motion)];
      double g = dot(row.normal, p.form == Prepared::Form::velocity ? p.b : given);
      for (int j = 0; j < k; ++j) g -= row.along[j] * along[j];
      along[k] = g * row.inverse;
      v = v + (along[k] - dot(row.direction, v)) * row.direction;
    }
  }
}

namespace {

/// Makes the velocity of a node along a unit vector equal to `target` and corrects the internal work that was booked
/// with the velocity before. Returns the work of the impulse that this takes, J.
double replace_component(NodalState& nodes, std::size_t n, const Vec3& direction, double target, double kick) {
  Vec3& v = nodes.velocity()[n];
  const double* f = nodes.force[n].v;
  const double kicked = dot(direction, v), force = direction[0] * f[0] + direction[1] * f[1] + direction[2] * f[2];
  const double before = kicked + kick * nodes.inverse_mass[n] * force;
  nodes.internal_work[n] += 0.5 * kick * force * (target - kicked);
  v = (v - kicked * direction) + target * direction;  // exact along an axis, however hard the kick
  return 0.5 * nodes.mass[n] * (target - kicked) * (before + target);
}

}  // namespace

void NodalConditions::enforce(Constrained& entry, NodalState& nodes, double kick, double dt) {
  const auto n = static_cast<std::size_t>(entry.node);
  double along[3], wanted[3];  // all wanted ones first: an acceleration starts from the velocity before
  for (int k = 0; k < entry.rows; ++k) wanted[k] = target(entry.row[k], nodes, n, kick, dt);
  for (int k = 0; k < entry.rows; ++k) {
    const Row& row = entry.row[k];
    double g = wanted[k];
    for (int j = 0; j < k; ++j) g -= row.along[j] * along[j];
    along[k] = g * row.inverse;
    const double work = replace_component(nodes, n, row.direction, along[k], kick);
    const bool wall = motions_[static_cast<std::size_t>(row.motion)].kind == Kind::wall;
    (wall ? wall_work_ : boundary_work_)[n] += work;
  }
  if (entry.rows < 3) return;
  Vec3& v = nodes.velocity()[n];
  v = {};
  for (int k = 0; k < 3; ++k) v = v + along[k] * entry.row[k].direction;
}

void NodalConditions::enforce(const Standing& entry, NodalState& nodes, double kick, double dt, Stop* stop) {
  const auto n = static_cast<std::size_t>(entry.node);
  Vec3 held[3];
  int holds = -1;  // not yet looked up: most nodes are far from every wall
  for (std::int32_t i = entry.first_wall; i < entry.first_wall + entry.walls; ++i) {
    const auto w = static_cast<std::size_t>(standing_walls_[static_cast<std::size_t>(i)]);
    const Vec3& normal = walls_[w].normal;
    const Vec3& v = nodes.velocity()[n];
    const double least = (wall_distance_[w] - dot(normal, nodes.position()[n])) / dt;
    if (!(dot(normal, v) < least)) continue;
    if (holds < 0) {
      holds = 0;
      if (entry.constrained >= 0) {
        const Constrained& c = constrained_[static_cast<std::size_t>(entry.constrained)];
        for (; holds < c.rows; ++holds) held[holds] = c.row[holds].direction;
      }
    }
    Vec3 free = normal;
    for (int k = 0; k < holds; ++k) free = free - dot(held[k], normal) * held[k];
    const double size = norm(free);
    if (holds == 3 || size < 1e-6) continue;  // prescribed motion wins over the wall
    const Vec3 direction = (1 / size) * free;
    const double other = dot(normal, v) - size * dot(direction, v);
    wall_work_[n] += replace_component(nodes, n, direction, (least - other) / size, kick);
    held[holds++] = direction;
    if (stop) stop->direction[stop->count++] = direction;
  }
}

void NodalConditions::apply(NodalState& nodes, double time, double kick, double dt) {
  for (std::size_t m = 0; m < motions_.size(); ++m) prepared_[m] = prepare(motions_[m], time, dt);
  for (std::size_t w = 0; w < walls_.size(); ++w)
    wall_distance_[w] = dot(walls_[w].normal, walls_[w].point) + walls_[w].motion(time + dt);
  for (Constrained& entry : constrained_) enforce(entry, nodes, kick, dt);
  for (Stop& stop : stops_) stop.count = 0;
  for (std::size_t i = 0; i < standing_.size(); ++i)
    enforce(standing_[i], nodes, kick, dt, stops_.empty() ? nullptr : &stops_[i]);
  if (nodes.has_rotations() && !rotations_.empty()) rotations_.apply(nodes, time, kick, dt, boundary_work_);
}

void NodalConditions::remember_holds(std::size_t size) {
  constrained_of_.assign(size, -1), standing_of_.assign(size, -1);
  for (std::size_t i = 0; i < constrained_.size(); ++i)
    constrained_of_[static_cast<std::size_t>(constrained_[i].node)] = static_cast<std::int32_t>(i);
  for (std::size_t i = 0; i < standing_.size(); ++i)
    standing_of_[static_cast<std::size_t>(standing_[i].node)] = static_cast<std::int32_t>(i);
  stops_.resize(standing_.size());
}

NodalConditions::Holds NodalConditions::holds(LocalIndex node) const {
  Holds holds;
  const auto n = static_cast<std::size_t>(node);
  const auto add = [&](const Vec3& direction, bool wall) {
    holds.direction[holds.count] = direction, holds.wall[holds.count++] = wall;
  };
  if (constrained_of_[n] >= 0) {
    const Constrained& entry = constrained_[static_cast<std::size_t>(constrained_of_[n])];
    for (int k = 0; k < entry.rows; ++k)
      add(entry.row[k].direction, motions_[static_cast<std::size_t>(entry.row[k].motion)].kind == Kind::wall);
  }
  if (standing_of_[n] >= 0) {
    const Stop& stop = stops_[static_cast<std::size_t>(standing_of_[n])];
    for (int k = 0; k < stop.count; ++k) add(stop.direction[k], true);
  }
  return holds;
}

bool NodalConditions::stop(LocalIndex node, const NodalState& nodes, double dt, Vec3& change) {
  const auto n = static_cast<std::size_t>(node);
  if (standing_of_[n] < 0) return false;
  const auto s = static_cast<std::size_t>(standing_of_[n]);
  for (std::int32_t i = standing_[s].first_wall; i < standing_[s].first_wall + standing_[s].walls; ++i) {
    const auto w = static_cast<std::size_t>(standing_walls_[static_cast<std::size_t>(i)]);
    const Vec3& normal = walls_[w].normal;
    const double missing =
        (wall_distance_[w] - dot(normal, nodes.position()[n])) / dt - dot(normal, nodes.velocity()[n]);
    if (!(missing > 0)) continue;
    const Holds held = holds(node);
    Vec3 free = normal;
    for (int k = 0; k < held.count; ++k) free = free - dot(held.direction[k], normal) * held.direction[k];
    const double size = norm(free);
    if (held.count == 3 || size < 1e-6) continue;
    const Vec3 direction = (1 / size) * free;
    change = (missing / size) * direction;
    stops_[s].direction[stops_[s].count++] = direction;
    return true;
  }
  return false;
}

void NodalConditions::react(LocalIndex node, const Vec3& p, const Vec3& mean) {
  const Holds held = holds(node);
  for (int k = 0; k < held.count; ++k) {
    const Vec3& d = held.direction[k];
    (held.wall[k] ? wall_work_ : boundary_work_)[static_cast<std::size_t>(node)] -= dot(p, d) * dot(d, mean);
  }
}

std::vector<LocalIndex> NodalConditions::nodes() const {
  std::vector<LocalIndex> nodes;
  for (const Constrained& entry : constrained_) nodes.push_back(entry.node);
  for (const Standing& entry : standing_) nodes.push_back(entry.node);
  rotations_.add_nodes(nodes);
  return nodes;
}

std::int64_t NodalConditions::memory() const {
  return static_cast<std::int64_t>(
             constrained_.size() * sizeof(Constrained) + standing_.size() * sizeof(Standing) +
             (boundary_work_.size() + wall_work_.size()) * sizeof(double) + stops_.size() * sizeof(Stop) +
             (standing_walls_.size() + constrained_of_.size() + standing_of_.size()) * sizeof(std::int32_t)) +
         rotations_.memory();
}

}  // namespace tenon
