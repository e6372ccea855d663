// SPDX-License-Identifier: BSD-3-Clause
// Meshes, fields and comparisons for the tests of grid transfer.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/mesh/generators.hpp"
#include "tests/support/test_communicator.hpp"
#include "transfer/grid_transfer.hpp"
#include "transfer/place.hpp"

namespace tenon::transfer::testing {

using tenon::testing::communicator;
using Function = std::function<double(const Vec3&)>;
using MeshPointer = std::shared_ptr<const Mesh>;

struct BoxOptions {
  bool tetrahedra = false;
  double distortion = 0;
  std::uint64_t seed = 1;
  Vec3 low{0, 0, 0}, high{1, 1, 1};
};
MeshData box(int n, const BoxOptions& options = {});
/// Unit cube of n^3 cells in three slabs along x: hex8, wedge6 (two per cell) and pyramid5 (six per cell). n >= 3.
MeshData mixed_box(int n);
/// Rotation by `degrees` about the axis (1,1,1) through `about`.
void rotate(MeshData& mesh, double degrees, const Vec3& about);
void shift(MeshData& mesh, const Vec3& by);

/// All elements of a whole mesh, as one rank that has everything sees them, in boxes a little larger. Ids in order.
ElementSet element_set(const MeshData& mesh);
/// The shape functions of a placement, and zeros behind them.
std::array<double, max_nodes> weights_of(const Placement& place);

MeshPointer distributed(MeshData mesh, PartitionMethod method = PartitionMethod::rcb);

/// Places of all local items: nodes, or centres of elements.
std::vector<Vec3> places(const Mesh& mesh, Location location);
std::vector<double> sampled(const Mesh& mesh, Location location, const Function& f);
/// Several functions, one component each.
std::vector<double> sampled(const Mesh& mesh, Location location, std::span<const Function> f);

struct Pair {
  MeshPointer source, target;
  Location from = Location::node, to = Location::node;
};
GridTransfer make_transfer(const Pair& pair, FieldKind kind, const TransferOptions& options = {});
/// Values at all local items of the target.
std::vector<double> transferred(const Pair& pair, FieldKind kind, const std::vector<double>& values,
                                const TransferOptions& options = {}, int components = 1);

/// Greatest |values - f| over all local items of all ranks.
double greatest_error(const Mesh& mesh, Location location, const std::vector<double>& values, const Function& f);
/// Exact sum over the owned items of all ranks.
double global_sum(const Mesh& mesh, Location location, const std::vector<double>& values);
double global_least(const Mesh& mesh, const std::vector<double>& values);
/// Of the bits of all values in global order, the same on every rank; fails the test if a ghost differs from its owner.
std::uint64_t fingerprint(const Mesh& mesh, Location location, const std::vector<double>& values, int components = 1);

/// On one rank leaves the fingerprints in a file in this folder; on more ranks expects those that one rank has left.
void expect_bits_of_one_rank(const std::string& file_name, const std::map<std::string, std::uint64_t>& fingerprints);

/// Deterministic number in [0, 1).
double random_number(std::uint64_t seed, std::uint64_t index);

}  // namespace tenon::transfer::testing
