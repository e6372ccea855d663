// SPDX-License-Identifier: BSD-3-Clause
// Who works on which particles, whose copies he needs for it, and who is near whom.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "components/sph/particle_data.hpp"
#include "components/sph/particle_domain.hpp"
#include "framework/comm/exchange_plan.hpp"
#include "framework/decomposition/rcb.hpp"
#include "framework/search/neighbour_lists.hpp"

namespace tenon {

struct DecompositionOptions {
  double support = 2;                   ///< of the kernel, in smoothing lengths
  double skin = 0.1;                    ///< of the greatest support
  bool always_search = false;           ///< skips forced off: lists are made again in every step, with the same bits
  bool always_rebalance = false;        ///< parts are made anew with every order: for tests
  std::int64_t most_neighbours = 1500;  ///< of a particle, on average: beyond, runs stop
};

/// Eight times what a list of evenly spread particles holds, as where matter is pressed together to an eighth, but 400
/// at least. `support` and `skin` as above, `smoothing` length over spacing.
std::int64_t most_neighbours_of(double support, double smoothing, double skin, int dimension);

/// Counts for the report.
struct DecompositionCounts {
  std::int64_t renewals = 0, rebalances = 0, moved = 0;
  std::int64_t refreshes = 0, refreshed = 0;  ///< of ghosts: calls, and values of each ghost, were there any
  double imbalance = 1;                       ///< greatest over mean work of a rank, when the order was last chosen
};

/// Recursive coordinate bisection of the particles, weighted by their neighbours. When a skin is used up, particles go
/// to the rank whose part they are in, are put in canonical order (by cell and id: DESIGN.md, 1), and get ghosts and
/// lists anew; the parts themselves change only where that pays. When the order is chosen depends on the places of all
/// particles alone, so sums in list order have the same bits on any number of ranks and with any parts.
class ParticleDecomposition {
 public:
  static constexpr double pairs_of_a_particle = 20;  ///< what a particle costs without its pairs

  ParticleDecomposition(const Communicator& comm, std::string name, ParticleData& data, const ParticleDomain& domain,
                        const DecompositionOptions& options);

  /// Collective. Chooses the order anew for the present places. Throws Error(usage) where a period is too short, and
  /// Error(unstable) where pairs are too many.
  void renew();
  /// Collective. The same for the places in `reference`: of the start, and of a checkpoint.
  void arrange();
  /// Collective. Whether particles have moved, or grown, so far that pairs could be missing.
  bool used_up() const;
  /// Collective. As refresh(position...) after a drift: renews if the skin is used up. True if it did: then every kept
  /// column of ghosts is up to date as well.
  bool follow();

  /// Collective. One message per neighbour: ghosts, and images, of these columns from their owners.
  void refresh(std::span<Column* const> columns) const;

  const NeighbourLists& lists() const { return lists_; }
  const DecompositionCounts& counts() const { return counts_; }
  const DomainImages& images() const { return images_; }
  /// Changes whenever particles change places in the arrays.
  std::int64_t version() const { return version_; }
  /// m: particles nearer than this to a part have a copy there.
  double ghost_reach() const { return reach_ + skin_; }
  std::int64_t memory() const;

 private:
  double greatest_length() const;
  double imbalance_of_work() const;
  void refuse_crowds() const;
  std::vector<int> destinations();
  std::vector<int> by_present_parts() const;
  void migrate();
  void sort();
  double deepest_beyond_mirrors() const;
  void find_ghosts();
  void search(bool again);

  Communicator comm_;
  std::string name_;
  ParticleData& data_;
  DomainImages images_;
  DecompositionOptions options_;
  Rcb rcb_;
  bool has_parts_ = false;
  double reach_ = 0, skin_ = 0;  // of all: the greatest support, m
  ExchangePlan ghosts_;
  bool any_ghosts_ = false, any_images_ = false;  // on any rank; here
  NeighbourLists lists_;
  NeighbourLimits most_;
  std::vector<double> reaches_;
  std::vector<Vec3> places_;
  mutable DecompositionCounts counts_;
  std::int64_t version_ = 0;
};

}  // namespace tenon
