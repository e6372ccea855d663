// SPDX-License-Identifier: BSD-3-Clause
// What a GridTransfer holds; shared by the files that build, apply and report.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/comm/directory.hpp"
#include "transfer/grid_transfer.hpp"
#include "transfer/projection.hpp"
#include "transfer/rows.hpp"

namespace tenon::transfer {

/// One side of the pair.
struct Partner {
  const Mesh* mesh = nullptr;  ///< or a cloud
  const PointCloud* cloud = nullptr;
  Location location = Location::node;
  ElementChoice choice;
  Items nodes, elements;                ///< elements only where the field lives on them; nodes: or points
  std::span<const Vec3> coordinates;    ///< the caller's, m
  std::uint64_t built_fingerprint = 0;  ///< of the coordinates that the map was built for
  std::vector<Vec3> built;              ///< and themselves, if it is to follow motion
  mutable std::vector<double> volumes;  ///< of the items, m^3; worked out by the first report

  const Communicator& comm() const { return mesh ? mesh->comm : cloud->comm; }
  const Items& items() const { return location == Location::element ? elements : nodes; }
  Side side() const { return {*mesh, coordinates, location, nodes, items()}; }
  const std::string& name() const { return mesh ? mesh->source : cloud->source; }
};

/// Places of all local items: nodes, points, or centres of elements.
std::vector<Vec3> places_of(const Partner& partner);

/// Points outside, the same on every rank.
struct Misses {
  GlobalId targets = 0, outside = 0, skipped = 0;
  double greatest_distance = 0;
  Vec3 farthest{};
};

/// A target item outside the source.
struct OutsideItem {
  LocalIndex item;
  PointStatus status;
  double distance;  ///< m
};

struct GridTransfer::Impl {
  std::string name;
  FieldDescription field;
  TransferOptions options;
  Method method = Method::interpolate;
  Partner source, target;
  RowMap map;
  std::unique_ptr<Projection> projection;  ///< instead of the map
  Misses misses;
  std::vector<OutsideItem> outside;
  std::int64_t built = 0, rigid = 0;
  bool broken = false;  ///< the last update has thrown
  bool copied = false;  ///< the sides match, and values are copied

  // Of interpolation that follows motion.
  Containers containers;
  std::unique_ptr<Locator> locator;
  double mean_size = 0;  ///< of the elements that points are sought in, m
  double moved = 0;      ///< since the rendezvous was made, on any rank, m

  // Scratch and counter of apply; grow to what is needed once.
  mutable std::int64_t applied = 0;
  mutable std::vector<double> gathered;
  mutable std::vector<ExchangeItem> messages;

  const Communicator& comm() const { return target.comm(); }
  void build(bool again);
  void keep_built();
  double farthest_motion(std::span<const Vec3> source_now, std::span<const Vec3> target_now);
  void interpolate(bool again);
  void project();
  void fit();
  void conserve();
  void conserve_onto_points();
  bool copy();
  void apply(std::span<const TransferItem> fields) const;
  /// Collective. Estimate of the greatest error of the values, unit of the field, from about `samples` targets (0:
  /// all).
  double error(std::span<const double> source_values, std::span<const double> target_values, int components,
               GlobalId samples) const;
};

/// Collective. Counts points outside and finds the farthest (of equals, that of the smallest id).
class MissCounter {
 public:
  void add(GlobalId id, const Vec3& point, const Placement& place) {
    add(id, point, place.distance, place.is_outside());
  }
  void add(GlobalId id, const Vec3& point, double distance, bool outside) {
    ++targets_;
    outside_ += outside;
    // Points of one item stand in canonical order, and items on one rank ascend.
    if (distance > distance_) distance_ = distance, id_ = id, point_ = point;
  }
  Misses total(const Communicator& comm, GlobalId skipped) const;

 private:
  std::int64_t targets_ = 0, outside_ = 0;
  double distance_ = 0;
  GlobalId id_ = no_id;
  Vec3 point_{};
};

/// The rows, with those of some items (ascending) replaced by others, in order.
Rows with_rows_replaced(const Rows& rows, std::span<const OutsideItem> items, const Rows& others);

/// Throws Error(geometry) if the policy or the greatest distance does not allow for those misses.
void refuse_misses(const Misses& misses, const TransferOptions& options, const std::string& name);

/// The method that a field asks for. Throws Error(usage) for what makes no sense; depends on arguments that are the
/// same on every rank.
Method choose_method(const FieldDescription& field, const Grid& source, const TransferOptions& options,
                     const std::string& name);
/// Throws Error(usage).
void check_options(const TransferOptions& options, const std::string& name);

/// Throws Error(usage): "transfer 'name': why".
[[noreturn]] void refuse(const std::string& name, const std::string& why);

/// Collective. Whether both sides have the same items at the same places (same ids), and if so where each target item's
/// source is kept. With `volumes`, these have to be the same, too (to round-off: a node's adds up over elements).
std::optional<std::vector<DirectoryEntry>> matching_items(const Partner& source, const Partner& target, bool volumes);

/// Collective. Edge of the cubes that as many items would be in the box of all, m.
double mean_spacing(const Partner& partner);

/// Collective. Whether both meshes have moved as one rigid body since their maps were built, to `tolerance` (m).
bool moved_rigidly(const Partner& source, const Partner& target, double tolerance);

}  // namespace tenon::transfer
