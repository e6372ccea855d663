// SPDX-License-Identifier: BSD-3-Clause
// What a poor numbering of the mesh costs, with and without renumbering at load.
#pragma once

namespace tenon::bench {

/// Registers one benchmark: three bodies of the same mesh step in turn, in the generator's order, shuffled and then
/// renumbered as at load, and left shuffled. Counters are medians of the ratios of processor time, turn by turn.
void register_numbering();

}  // namespace tenon::bench
