// SPDX-License-Identifier: BSD-3-Clause
// Particles: shared out by bisection with their neighbours as weights, copies of those near a part, and the way to and
// from the homes where they meet contact.
#include <algorithm>

#include "apps/tenon/scaling_parts.hpp"
#include "components/sph/sph.hpp"

namespace tenon {

namespace {

struct ParticleParts {
  std::vector<int> part;
  Traffic ghosts{1};  ///< one byte of each ghost
  std::vector<double> local;
};

/// What a static decomposition does: parts stay, with the boxes of their particles around them.
void divide_at_home(const std::vector<Vec3>& places, double reach, const MeshParts& home,
                    const std::vector<LocalIndex>& node, ParticleParts& result) {
  std::vector<Box> bounds(static_cast<std::size_t>(home.parts));
  for (std::size_t i = 0; i < places.size(); ++i) {
    result.part[i] = home.node_part[static_cast<std::size_t>(node[i])];
    bounds[static_cast<std::size_t>(result.part[i])].add(places[i]);
  }
  const BoxTree tree(bounds);
  std::vector<int> found;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Box box{places[i], places[i]};
    box.inflate(reach);
    found.clear();
    tree.overlapping(box, found);
    for (const int r : found) result.ghosts.add(result.part[i], r, 1);
    for (const int r : found) result.local[static_cast<std::size_t>(r)] += r != result.part[i];
  }
}

ParticleParts divide(const std::vector<Vec3>& places, const std::vector<double>& weights, double reach,
                     const MeshParts& home, const std::vector<LocalIndex>& node, SearchDecomposition decomposition) {
  const int parts = home.parts;
  ParticleParts result;
  result.part.assign(places.size(), 0);
  result.local.assign(static_cast<std::size_t>(parts), 0);
  result.ghosts = Traffic(parts);
  std::vector<int> found;
  const auto add_ghosts = [&](auto&& ranks_of) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      Box box{places[i], places[i]};
      box.inflate(reach);
      found.clear();
      ranks_of(box);
      for (const int r : found) result.ghosts.add(result.part[i], r, 1);
      for (const int r : found) result.local[static_cast<std::size_t>(r)] += r != result.part[i];
    }
  };
  const Communicator alone = Communicator::self();
  if (decomposition == SearchDecomposition::rcb) {
    Rcb rcb(alone, parts);
    result.part = rcb.partition(places, weights);
    if (parts > 1) add_ghosts([&](const Box& box) { rcb.ranks_overlapping(box, found); });
  } else if (decomposition == SearchDecomposition::slices) {
    SearchParts slices(alone, parts);
    slices.cut(decomposition, places, weights);
    for (std::size_t i = 0; i < places.size(); ++i) {
      slices.ranks_meeting({places[i], places[i]}, found);
      if (!found.empty()) result.part[i] = found.front();
    }
    add_ghosts([&](const Box& box) { slices.ranks_meeting(box, found); });
  } else {
    divide_at_home(places, reach, home, node, result);
  }
  for (const int p : result.part) result.local[static_cast<std::size_t>(p)] += 1;
  return result;
}

}  // namespace

std::vector<PhaseLoad> particle_loads(Sph& sph, const MeshParts& home, const ScalingTrial& scaling, bool in_contact) {
  const Trial& trial = scaling.trial;
  const ParticleData& data = sph.particles();
  const ParticleDecomposition& decomposition = sph.decomposition();
  const std::size_t count = data.owned();
  std::vector<Vec3> places(count);
  std::vector<double> weights(count);
  std::vector<LocalIndex> node(data.home_node.begin(), data.home_node.begin() + static_cast<std::ptrdiff_t>(count));
  double all = 0;
  for (std::size_t i = 0; i < count; ++i) {
    places[i] = data.reference.vec(i);
    weights[i] = ParticleDecomposition::pairs_of_a_particle + static_cast<double>(decomposition.lists().of(i).size());
    all += weights[i];
  }
  const ParticleParts parts = divide(places, weights, decomposition.ghost_reach(), home, node, scaling.decomposition);
  std::vector<double> work(static_cast<std::size_t>(home.parts)), owned(work.size());
  for (std::size_t i = 0; i < count; ++i) {
    work[static_cast<std::size_t>(parts.part[i])] += weights[i];
    owned[static_cast<std::size_t>(parts.part[i])] += 1;
  }
  const auto load_of = [&](const std::string& phase, const std::vector<double>& of_parts, double whole) {
    PhaseLoad load;
    load.phase = sph.name() + ": " + phase, load.group = "particles";
    load.seconds = trial.phase(load.phase);
    load.whole = whole, load.work = of_parts;
    return load;
  };
  const auto particles = static_cast<double>(count);
  std::vector<PhaseLoad> loads{load_of("forces", work, all), load_of("update", owned, particles),
                               load_of("order and lists", parts.local, particles),
                               load_of("exchange", parts.local, particles)};
  const double refreshes = trial.count(sph.name() + ": refreshes"), values = trial.count(sph.name() + ": refreshed");
  if (refreshes > 0) parts.ghosts.book(loads[3], refreshes, 8 * values / refreshes);
  loads[0].reductions = 1;  // the stable step
  loads[2].reductions = 1;  // whether skins are used up
  if (!in_contact) return loads;
  // Places, velocities and former velocities go home in one message while anything is near a surface; velocities that
  // contact changed return.
  Traffic home_way(home.parts), back(home.parts);
  for (std::size_t i = 0; i < count; ++i) {
    const int at = parts.part[i], lives = home.node_part[static_cast<std::size_t>(node[i])];
    home_way.add(at, lives, 72), back.add(lives, at, 24);
  }
  loads.push_back(load_of("home", owned, particles));
  home_way.book(loads.back(), trial.count(sph.name() + ": home"));
  back.book(loads.back(), trial.count(sph.name() + ": back"));
  return loads;
}

}  // namespace tenon
