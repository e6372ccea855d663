// SPDX-License-Identifier: BSD-3-Clause
// The order in which nodes and elements stand in memory: neighbours near each other, whatever the file's order.
#pragma once

#include <cstdint>
#include <string>

#include "framework/mesh/mesh_data.hpp"

namespace tenon {

/// `automatic` renumbers along a Hilbert curve where that pays; `shuffled` puts all in a random order, always the same,
/// to try what a poor numbering costs.
enum class Numbering { automatic, file, hilbert, shuffled };

/// How often a group of eight nodes is fetched on a walk through the elements, if a cache holds the 1024 groups
/// fetched last (8192 nodes, under a megabyte of a component's nodal state); per group. 1 is perfect, as it is for
/// meshes that fit; a large mesh in random order comes to tens.
double fetches_per_group(const MeshData& mesh);

struct NumberingReport {
  bool renumbered = false;
  double before = 0, after = 0;  ///< fetches_per_group
};

/// Puts the nodes of a mesh and the elements of each of its blocks in another order; connectivity and sets go along,
/// and labels stay those of the file, so messages and output name the same nodes and elements. The order depends on the
/// mesh alone, so a restart finds it again. Elements stand along the Hilbert curve of their centres [Ski04], nodes in
/// the order in which the elements first use them, nodes without elements last.
NumberingReport renumber(MeshData& mesh, Numbering numbering);

/// "nodes and elements renumbered along a Hilbert curve ..."; empty if nothing was done.
std::string described(const NumberingReport& report);

}  // namespace tenon
