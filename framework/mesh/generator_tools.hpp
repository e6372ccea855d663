// SPDX-License-Identifier: BSD-3-Clause
// What the generators have in common: spacing, circles, checks of numbers, sets from marked nodes.
#pragma once

#include <string>
#include <vector>

#include "framework/mesh/mesh_data.hpp"

namespace tenon {

/// Throws Error(usage) unless `value` is at least `least`.
void require_count(const std::string& shape, const std::string& name, int value, int least);
/// Throws Error(usage) unless `value` is finite and greater than zero.
void require_positive(const std::string& shape, const std::string& name, double value);

/// intervals + 1 places from 0 to 1 (both exact), each interval `ratio` times the one before so that the last is
/// `grading` times the first.
std::vector<double> graded(int intervals, double grading);
/// low + (high - low) t, exact at both ends.
std::vector<double> between(double low, double high, const std::vector<double>& t);

/// Cosine and sine of j/n of a full turn, symmetric to the bit in all eight octants.
struct Direction {
  double cosine, sine;
};
Direction part_of_turn(int j, int n);

/// Numbers nodes and elements from 1, as their labels.
void number_from_one(MeshData& mesh);
/// A node set of the nodes where `marked`, and a side set of those sides of the skin whose nodes are all marked.
/// `skin_sides` is skin(mesh); one block only.
void add_face_sets(MeshData& mesh, const std::vector<SideData>& skin_sides, const std::string& name,
                   const std::vector<char>& marked);

/// Cuts into simplices if asked to, and refuses what came out inverted.
MeshData finish(MeshData&& mesh, bool simplices);

/// A block of hex8 from a layer of quadrilaterals (4 nodes each, positive seen from above) repeated at the heights z;
/// nodes and elements count through each layer in turn.
MeshData extrude(const std::vector<std::array<double, 2>>& layer, const std::vector<std::array<GlobalId, 4>>& quads,
                 const std::vector<double>& z);

}  // namespace tenon
