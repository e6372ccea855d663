// SPDX-License-Identifier: BSD-3-Clause
// What the cases of contact have in common: bodies side by side in one mesh, runs of mechanics with contact, their
// momenta, ledgers and histories.
#pragma once

#include <array>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "components/contact/contact.hpp"
#include "framework/simulation/contact_party.hpp"
#include "framework/simulation/simulation.hpp"
#include "mechanics_case.hpp"

namespace tenon::testing {

/// A change of place.
using Placing = std::function<Vec3(const Vec3&)>;

inline Placing shifted(const Vec3& by) {
  return [by](const Vec3& x) { return x + by; };
}

/// Right-handed rotation about an axis through the origin (Rodrigues), rad.
inline Placing rotated(const Vec3& axis, double angle) {
  const Vec3 k = (1 / norm(axis)) * axis;
  const double c = std::cos(angle), s = std::sin(angle);
  return [k, c, s](const Vec3& x) { return c * x + s * cross(k, x) + ((1 - c) * dot(k, x)) * k; };
}

inline MeshData placed(MeshData mesh, const Placing& placing) {
  for (Vec3& x : mesh.coordinates) x = placing(x);
  return mesh;
}

/// Bodies that share no nodes, each with one block of its name; sets become "<name>_<set>".
inline MeshData beside(std::vector<std::pair<std::string, MeshData>> bodies) {
  MeshData all;
  all.source = "bodies of a contact case";
  std::int64_t label = 0, sets = 0;
  for (auto& [name, body] : bodies) {
    const auto first_node = static_cast<GlobalId>(all.coordinates.size());
    const auto first_element = static_cast<GlobalId>(all.elements());
    all.coordinates.insert(all.coordinates.end(), body.coordinates.begin(), body.coordinates.end());
    for (BlockData& block : body.blocks) {
      block.name = name;
      block.label = static_cast<std::int64_t>(all.blocks.size()) + 1;
      for (GlobalId& n : block.connectivity) n += first_node;
      for (std::int64_t& l : block.labels) l = ++label;
      all.blocks.push_back(std::move(block));
    }
    for (NodeSetData& set : body.node_sets) {
      for (GlobalId& n : set.nodes) n += first_node;
      all.node_sets.push_back({name + "_" + set.name, ++sets, std::move(set.nodes)});
    }
    for (SideSetData& set : body.side_sets) {
      for (SideData& side : set.sides) side.element += first_element;
      all.side_sets.push_back({name + "_" + set.name, ++sets, std::move(set.sides)});
    }
  }
  for (std::size_t n = 0; n < all.coordinates.size(); ++n) all.node_labels.push_back(static_cast<std::int64_t>(n) + 1);
  return all;
}

inline MeshData brick(const Vec3& low, const Vec3& high, std::array<int, 3> elements) {
  BoxShape shape;
  shape.low = low, shape.high = high, shape.elements = elements;
  return generate(shape);
}

inline RigidSurface rigid_plane(const std::string& name, const Vec3& point, const Vec3& normal) {
  RigidSurface plane;
  plane.name = name, plane.point = point, plane.direction = normal;
  return plane;
}

inline InitialVelocity moving(const std::string& block, const Vec3& velocity) {
  return {block, "", velocity, {}, {}};
}

inline MechanicsOptions::Block of_material(const std::string& block, const MaterialDescription& material) {
  MechanicsOptions::Block b;
  b.name = block, b.material = material;
  return b;
}

inline BodyForce gravity(const Vec3& g) {
  BodyForce force;
  for (std::size_t c = 0; c < 3; ++c) force.acceleration[c] = SpaceTimeFunction::constant(g[c]);
  force.label = "gravity";
  return force;
}

/// One mesh of bodies with contact between all of them.
struct ContactScene {
  MeshData mesh;
  MechanicsOptions mechanics;
  ContactOptions contact;
  double end = 1;  ///< s
};

class ContactRun {
 public:
  /// Collective over `comm`. `checkpoint` continues an earlier run.
  explicit ContactRun(const ContactScene& scene, const Communicator& comm = communicator(),
                      const std::string& checkpoint = "")
      : simulation_(comm, log_, 0, scene.end) {
    MeshData data = scene.mesh;
    body_ = static_cast<Mechanics*>(
        &simulation_.add(std::make_unique<Mechanics>("body", distribute(comm, std::move(data), {}), scene.mechanics)));
    contact_ = static_cast<Contact*>(
        &simulation_.add(std::make_unique<Contact>("contact", comm, std::vector<Component*>{body_}, scene.contact)));
    if (checkpoint.empty()) {
      simulation_.initialize();
    } else {
      const CheckpointReader reader(comm, checkpoint);
      simulation_.initialize(&reader);
    }
    follow_blocks();
    start_ = momentum();
  }

  Mechanics& body() { return *body_; }
  Contact& contact() { return *contact_; }
  Simulation& simulation() { return simulation_; }
  double time() const { return simulation_.time(); }
  bool done() const { return simulation_.done(); }

  void step() {
    simulation_.step();
    const auto [linear, angular] = contact_->momentum_errors();
    momentum_residual_ = std::max(momentum_residual_, linear);
    angular_residual_ = std::max(angular_residual_, angular);
  }
  /// Steps to `end`, or to the end of the run; `look` after each step.
  void run(
      double end, const std::function<void()>& look = [] {}) {
    while (!done() && time() < end) step(), look();
  }

  /// Sum of m v of the nodes of a block (of all without a name), kg m/s.
  Vec3 momentum(const std::string& block = "") const {
    return sum_of(block, [](double m, const Vec3&, const Vec3& v) { return m * v; });
  }
  /// Sum of x x m v about the origin, kg m^2/s. Of positions at either end of the step: v x v = 0.
  Vec3 angular_momentum() const {
    return sum_of("", [](double m, const Vec3& x, const Vec3& v) { return m * cross(x, v); });
  }
  Vec3 centre(const std::string& block) const {
    return (1 / mass(block)) * sum_of(block, [](double m, const Vec3& x, const Vec3&) { return m * x; });
  }
  Vec3 velocity(const std::string& block) const { return (1 / mass(block)) * momentum(block); }
  double mass(const std::string& block) const {
    return sum_of(block, [](double m, const Vec3&, const Vec3&) { return Vec3{m, 0, 0}; })[0];
  }
  /// Sum of m |v|, kg m/s: the scale of what is lost of momentum.
  double size_of_momentum() const {
    return sum_of("", [](double m, const Vec3&, const Vec3& v) { return Vec3{m * norm(v), 0, 0}; })[0];
  }
  double size_of_angular_momentum() const {
    return sum_of("", [](double m, const Vec3& x, const Vec3& v) { return Vec3{m * norm(x) * norm(v), 0, 0}; })[0];
  }
  /// Least (-1) or greatest (+1) coordinate along a direction of the nodes of a block, m.
  double reach(const std::string& block, const Vec3& direction, int sign) const {
    double far = -1e300;
    const int wanted = number(block);
    for (std::size_t n = 0; n < block_of_.size(); ++n)
      if (block_of_[n] == wanted) far = std::max(far, sign * dot(direction, body_->current_coordinates()[n]));
    return sign * comm().max(far);
  }
  /// Present place of the node that stood nearest to `place`, m; ties go to the smallest id.
  Vec3 now_at(const std::string& block, const Vec3& place) const {
    double best = 1e300;
    GlobalId id = 0;
    Vec3 mine{};
    for (const LocalIndex n : body_->mesh().owned_nodes) {
      const auto i = static_cast<std::size_t>(n);
      const double d = norm(body_->mesh().coordinates[i] - place);
      if (block_of_[i] == number(block) && d < best)
        best = d, id = body_->mesh().node_ids[i], mine = body_->current_coordinates()[i];
    }
    const double least = comm().min(best);
    const GlobalId winner = comm().min(best == least ? id : std::numeric_limits<GlobalId>::max());
    Vec3 place_now{};
    const bool is_mine = best == least && id == winner;
    for (std::size_t c = 0; c < 3; ++c) {
      ExactSum sum;
      if (is_mine) sum.add(mine[c]);
      place_now[c] = comm().sum(sum);
    }
    return place_now;
  }

  /// A row of the ledger, J: of contact, or of mechanics.
  double row(const std::string& name) {
    std::vector<EnergyTerm> terms;
    contact_->energies(terms);
    body_->energies(terms);
    ExactSum sum;
    bool found = false;
    for (const EnergyTerm& term : terms)
      if (term.row == name && !found) sum = term.local, found = true;
    if (!found) ADD_FAILURE() << "no row " << name;
    return comm().sum(sum);
  }
  double ledger_error() { return simulation_.ledger().take().error; }

  /// A column of the history of contact.
  double history(const std::string& column) {
    for (const auto& [name, share] : contact_->amounts())
      if (name == column) return comm().sum(share);
    for (const HistoryValue& value : contact_->history_values()) {
      if (value.column != column) continue;
      if (value.reduce == HistoryValue::Reduce::max) return comm().max(value.local);
      if (value.reduce == HistoryValue::Reduce::min) return comm().min(value.local);
      ExactSum sum;
      sum.add(value.local);
      return comm().sum(sum);
    }
    ADD_FAILURE() << "no column " << column;
    return 0;
  }
  /// Force of the last step between two surfaces, N, and the impulse since the start, N s.
  Vec3 force(const std::string& pair) { return columns("contact_" + pair + "_force_"); }
  Vec3 impulse(const std::string& pair) { return columns("contact_" + pair + "_impulse_"); }

  /// Greatest residuals of linear and angular momentum of contact in any step so far, 1.
  double momentum_residual() const { return momentum_residual_; }
  double angular_residual() const { return angular_residual_; }
  /// What all steps together changed of the momentum of everything, against the sum of m |v|.
  double lost_momentum() const { return norm(momentum() - start_) / size_of_momentum(); }

  void save(const std::string& file) {
    CheckpointWriter writer(comm(), file);
    simulation_.save(writer);
    writer.finish();
  }
  const Communicator& comm() const { return simulation_.comm(); }

 private:
  int number(const std::string& block) const {
    for (std::size_t b = 0; b < body_->mesh().blocks.size(); ++b)
      if (body_->mesh().blocks[b].name == block) return static_cast<int>(b);
    return -1;
  }
  void follow_blocks() {
    const Mesh& mesh = body_->mesh();
    block_of_.assign(mesh.coordinates.size(), 0);
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
      for (const LocalIndex n : mesh.blocks[b].connectivity)
        block_of_[static_cast<std::size_t>(n)] = static_cast<int>(b);
  }
  template <typename Term>
  Vec3 sum_of(const std::string& block, Term term) const {
    std::array<ExactSum, 3> sums;
    const std::span<const Vec3> velocity = body_->contact_party()->contact_velocities();
    for (const LocalIndex n : body_->mesh().owned_nodes) {
      const auto i = static_cast<std::size_t>(n);
      if (!block.empty() && block_of_[i] != number(block)) continue;
      const Vec3 t = term(body_->nodal_mass()[i], body_->current_coordinates()[i], velocity[i]);
      for (std::size_t c = 0; c < 3; ++c) sums[c].add(t[c]);
    }
    return {comm().sum(sums[0]), comm().sum(sums[1]), comm().sum(sums[2])};
  }
  Vec3 columns(const std::string& name) { return {history(name + "x"), history(name + "y"), history(name + "z")}; }

  Log log_{false};
  Simulation simulation_;
  Mechanics* body_ = nullptr;
  Contact* contact_ = nullptr;
  std::vector<int> block_of_;
  Vec3 start_{};
  double momentum_residual_ = 0, angular_residual_ = 0;
};

/// The bars of every case with contact: momentum, angular momentum and ledger.
inline void expect_conserved(ContactRun& run, bool free_of_loads = true) {
  EXPECT_LE(run.momentum_residual(), 1e-13);
  EXPECT_LE(run.angular_residual(), 1e-13);
  EXPECT_LE(run.ledger_error(), 1e-11);
  if (free_of_loads) {
    EXPECT_LE(run.lost_momentum(), 1e-12);
  }
}

}  // namespace tenon::testing
