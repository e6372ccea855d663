// SPDX-License-Identifier: BSD-3-Clause
// Fields from one distributed mesh to another by the rendezvous algorithm (Plimpton, Hendrickson, Stewart 2004).
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/comm/exchange_plan.hpp"
#include "framework/fields/field.hpp"
#include "framework/mesh/mesh.hpp"
#include "transfer/point_cloud.hpp"

namespace tenon::transfer {

/// How a field is carried over.
enum class Method {
  automatic,             ///< point values are interpolated, densities and totals conserved
  interpolate,           ///< shape functions of the source element that holds the point: second order, linear-exact
  nearest_projection,    ///< the same on the source's surface, at the foot of the perpendicular
  conserve,              ///< the transpose of interpolation: sums are kept, node by node
  project,               ///< L2 projection: second order, integrals are kept
  moving_least_squares,  ///< linear-exact fit to the source's nearest points: from points without a mesh
  copy                   ///< the same items on both sides, bit for bit; interpolation finds that by itself
};

/// What a target point outside the source mesh receives.
enum class OutsidePolicy {
  nearest,      ///< the value at the nearest point of the source
  extrapolate,  ///< the nearest element's shape functions evaluated outside it (linear-exact)
  value,        ///< a given value
  error         ///< refuse: Error(geometry) naming count, greatest distance and place
};

struct TransferOptions {
  Method method = Method::automatic;  ///< automatic: point values are interpolated, densities and totals conserved
  OutsidePolicy outside = OutsidePolicy::nearest;
  double outside_value = 0;
  /// A point farther from the source than this is refused under every policy but `value` (m; infinity: never).
  double greatest_distance = std::numeric_limits<double>::infinity();
  /// Points nearer than this fraction of an element's size count as inside.
  double tolerance = 1e-9;
  /// Of project: keeps every value between the least and the greatest of the source values around it.
  bool bounded = false;
  /// Of moving_least_squares, and of what is conserved onto points: how many points each fit looks at.
  int neighbours = 20;
  /// update() will be called often: keeps what makes it cheap (the decomposition, the tree, each point's element).
  bool moving = false;
};

/// One side: a mesh or a cloud of points, where it stands now, and where the field lives. `coordinates` are of all
/// local nodes, or of the points of the cloud; they must stay valid, and unchanged, as long as the map is used or until
/// update() gives others; with TransferOptions::moving, only during the call.
struct Grid {
  const Mesh* mesh = nullptr;
  std::span<const Vec3> coordinates;
  Location location = Location::node;    ///< node or element (a value per element, at its centre); particle of a cloud
  const PointCloud* cloud = nullptr;     ///< instead of a mesh
  std::vector<std::string> blocks = {};  ///< of a source: the blocks that points are sought in; empty: all
  std::string sides = {};  ///< of a source of nearest_projection: the side set that points are projected to; empty: the
                           ///< surface elements, or the skin of a mesh of solids
};

/// What became of a target item.
enum class PointStatus : std::uint8_t {
  inside,        ///< in an element
  nearest,       ///< outside: has the value of the nearest point
  extrapolated,  ///< outside: linear-exact
  value          ///< outside: has the given value
};

/// What a map or an application of it did, the same on every rank.
struct TransferReport {
  GlobalId targets = 0;          ///< target points in all (quadrature points of the source for `conserve`)
  GlobalId outside = 0;          ///< of them outside the source (target mesh for `conserve`)
  double greatest_distance = 0;  ///< of those, m
  Vec3 farthest{};               ///< where
  double source_integral = 0;    ///< of the first component: sum of a total, integral of others
  double target_integral = 0;
  double mismatch = 0;        ///< |target - source| / scale of the integral of |f|
  double error_estimate = 0;  ///< estimated greatest error, unit of the field (not of totals, nor from points: 0)
  GlobalId skipped = 0;       ///< elements without volume, in which no point was sought
  /// Of project, at the last application; the worst of all components.
  double spread = 0;     ///< integral that was spread to make up for the rest, over the integral of |f|
  GlobalId clipped = 0;  ///< values that were brought back within their bounds
  double unplaced = 0;   ///< integral that found no room within the bounds, over the integral of |f|
};

/// How much a report may cost.
enum class Thoroughness {
  full,    ///< the error estimate looks at every target: a few microseconds each
  sampled  ///< at about a thousand of them, chosen by their ids
};

/// One field of several that share a map and travel in one message per neighbour.
struct TransferItem {
  std::span<const double> source;
  std::span<double> target;
  int components = 1;
};

/// A map between two meshes, or clouds of points, with decompositions of their own, over the same communicator. By
/// interpolation each target
/// point takes the shape functions of the source element that contains it (the smallest global id on shared faces).
/// Totals: each source element's amount is spread by quadrature points over the shape functions of the target element
/// that contains each (the transpose of interpolation): sums are kept to round-off; a node's total goes by the point at
/// the node. Weights of spread amounts are balanced with the volumes on both sides, so that what is uniform arrives
/// uniform where the meshes cover each other. Densities: as totals of density x volume, divided by the target's nodal
/// volume (nodal densities are fields, so they are spread from the elements around the node). Volumes are those of the
/// coordinates that the map was built for. Element values are constant over their element. Bitwise the same on any
/// ranks.
///
/// Pairings, unless another method is asked for by name: point values are interpolated (onto the nearest surface from
/// surfaces, by moving least squares from clouds); totals and densities are conserved. Point values and densities can
/// also be projected (see Projection): second order, and the integral of the whole source is kept. What makes no sense
/// is refused: to interpolate a total, to conserve a point value, to transfer a flux, OutsidePolicy::value where
/// amounts would vanish, densities of clouds. Sides that match (ids and places; volumes, too, where integrals count)
/// are copied. Only interpolation and nearest_projection follow motion incrementally; the others are rebuilt.
class GridTransfer {
 public:
  /// Collective. Builds the map. The meshes must outlive it. Throws Error(usage) for a pairing that makes no sense
  /// (say, `interpolate` of a total), Error(geometry) under OutsidePolicy::error, for an inverted element of the mesh
  /// that points are sought in, and for coordinates that are not finite.
  GridTransfer(const Grid& source, const Grid& target, const FieldDescription& field, const TransferOptions& options,
               std::string name);
  ~GridTransfer();
  GridTransfer(GridTransfer&&) noexcept;
  GridTransfer& operator=(GridTransfer&&) noexcept;

  /// Collective. `source`: all local items of the source x components; `target`: all local items of the target, every
  /// one set (ghosts included). No allocation after the first call with that many components.
  void apply(std::span<const double> source, std::span<double> target, int components) const;

  /// Collective. Several fields at once, each as above: one message per neighbour for all of them (projections go one
  /// by one).
  void apply(std::span<const TransferItem> fields) const;

  /// Collective. Rebuilds the map where the meshes stand now, as far as their motion demands: not at all if no
  /// coordinate has changed on any rank or if all have followed one rigid motion (to 1e-10 of an element's size); with
  /// TransferOptions::moving, points that are still inside their elements are not sought again. Where elements do not
  /// overlap, the map is, bit for bit, that which a new GridTransfer would make. Returns whether it was rebuilt.
  bool update(std::span<const Vec3> source_coordinates, std::span<const Vec3> target_coordinates);

  /// Collective. Misses of the map, and integrals and error estimate of these values.
  TransferReport report(std::span<const double> source, std::span<const double> target, int components,
                        Thoroughness thoroughness = Thoroughness::full) const;
  /// Collective. What `back`, a map of the opposite direction, makes of transferred values: the greatest difference
  /// from these values, unit of the field.
  double round_trip_error(const GridTransfer& back, std::span<const double> source, int components) const;
  /// Local: bytes of the map; how often it was built and applied.
  std::int64_t memory() const;
  std::int64_t built() const;
  std::int64_t applied() const;
  /// Local: coordinates that the map was built for (TransferOptions::moving; else empty). A map that is built for
  /// these, and updated, is the same as one that has been updated all the time.
  std::span<const Vec3> built_source() const;
  std::span<const Vec3> built_target() const;
  /// Updates that a rigid common motion made needless; points that the last build or update searched for on this rank.
  std::int64_t rigid_motions() const;
  std::int64_t searched() const;
  /// Local: status, and distance from the source (m; 0 inside), of all local target items. Methods that
  /// spread amounts have all inside, as has a projection onto elements.
  void status(std::span<PointStatus> status, std::span<double> distance) const;
  /// The method that was chosen; never automatic.
  Method method() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tenon::transfer
