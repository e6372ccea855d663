// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact/buried.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "framework/mesh/shape_functions.hpp"

namespace tenon::contact {

namespace {

// Of an element's half width: what is less deep is a matter of the surfaces.
constexpr double inset = 0.01;
// Of the size of a shell: nearer middles coincide. And the sine of the angle between the two.
constexpr double coincident = 1e-6;

/// A point that may be inside somewhere: a node, or the middle of an element.
struct Point {
  Vec3 place;
  std::array<GlobalId, max_linear_nodes> nodes;  // over all parties: itself, or corners; then no_id
  std::int32_t surface;
};

/// An owned solid element.
struct Solid {
  std::size_t party, block;
  LocalIndex element;
  std::int32_t surface;
};

struct ShellFace {
  Vec3 centre, normal;
  std::array<GlobalId, 4> nodes;
  double size;
  std::int32_t surface;
};

std::vector<Vec3> corners_of(const ContactSurfaces& surfaces, const Solid& solid) {
  const ContactParty& party = *surfaces.parties()[solid.party];
  std::vector<Vec3> x;
  for (const LocalIndex n : party.contact_mesh().blocks[solid.block].nodes(solid.element))
    x.push_back(party.contact_positions()[static_cast<std::size_t>(n)]);
  return x;
}

Vec3 mean_of(std::span<const Vec3> x) {
  Vec3 sum{};
  for (const Vec3& a : x) sum = sum + a;
  return (1 / static_cast<double>(x.size())) * sum;
}

std::vector<Solid> solids_of(const Communicator& comm, const ContactSurfaces& surfaces) {
  std::vector<Solid> solids;
  for (std::size_t p = 0; p < surfaces.parties().size(); ++p) {
    const Mesh& mesh = surfaces.parties()[p]->contact_mesh();
    const std::vector<std::string> names = surfaces.parties()[p]->surface_names();
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
      const ElementBlock& block = mesh.blocks[b];
      const auto name = std::ranges::find(names, block.name);
      if (topology(block.kind).dimension != 3 || name == names.end()) continue;
      const std::int32_t surface = surfaces.first_surface(p) + static_cast<std::int32_t>(name - names.begin());
      for (const LocalIndex e : owned_elements(block, comm.rank())) solids.push_back({p, b, e, surface});
    }
  }
  return solids;
}

std::vector<Point> points_of(const ContactSurfaces& surfaces, std::span<const Solid> solids,
                             std::span<const char> known) {
  constexpr std::array<GlobalId, max_linear_nodes> none{no_id, no_id, no_id, no_id, no_id, no_id, no_id, no_id};
  std::vector<Point> points;
  std::vector<std::vector<std::int32_t>> shows;  // by party and local node
  for (const ContactParty* party : surfaces.parties())
    shows.emplace_back(static_cast<std::size_t>(party->contact_mesh().nodes()));
  for (std::size_t n = 0; n < surfaces.nodes().size(); ++n) {
    const SurfaceNode& node = surfaces.nodes()[n];
    const auto p = static_cast<std::size_t>(node.party), i = static_cast<std::size_t>(node.node);
    shows[p][i] = 1;
    if (!known.empty() && known[n] != 0) continue;
    points.push_back({surfaces.parties()[p]->contact_positions()[i], none, node.surface});
    points.back().nodes[0] = node.id;
  }
  for (std::size_t p = 0; p < shows.size(); ++p)
    surfaces.parties()[p]->contact_mesh().node_halo.forward<std::int32_t>(shows[p], shows[p]);
  // Of elements, those at a surface are enough: what is inside another body as a whole is so with its surface.
  for (const Solid& solid : solids) {
    const ElementBlock& block = surfaces.parties()[solid.party]->contact_mesh().blocks[solid.block];
    const std::span<const LocalIndex> nodes = block.nodes(solid.element);
    const auto is_at_surface = [&](LocalIndex n) { return shows[solid.party][static_cast<std::size_t>(n)] != 0; };
    if (std::ranges::none_of(nodes, is_at_surface)) continue;
    points.push_back({mean_of(corners_of(surfaces, solid)), none, solid.surface});
    for (std::size_t k = 0; k < static_cast<std::size_t>(corner_count(block.kind)); ++k)
      points.back().nodes[k] = surfaces.node_id(solid.party, nodes[k]);
  }
  return points;
}

bool is_inside(ElementKind kind, std::span<const Vec3> x, const Vec3& place) {
  const InverseMap at = inverse_map(kind, x, place);
  if (!at.converged || overshoot(kind, at.xi) > 0) return false;
  const Vec3 middle = inverse_map(kind, x, mean_of(x)).xi;
  return overshoot(kind, middle + (1 / (1 - inset)) * (at.xi - middle)) <= 0;
}

void add_inside(const Communicator& comm, const ContactSurfaces& surfaces, SearchDecomposition how,
                std::span<const char> known, const Allowed& allowed, std::vector<Buried>& result) {
  const std::vector<Solid> solids = solids_of(comm, surfaces);
  const std::vector<Point> points = points_of(surfaces, solids, known);
  std::vector<Box> of_points(points.size()), of_solids(solids.size());
  for (std::size_t i = 0; i < points.size(); ++i) of_points[i].add(points[i].place);
  for (std::size_t s = 0; s < solids.size(); ++s)
    of_solids[s] = element_box(surfaces.parties()[solids[s].party]->contact_mesh().blocks[solids[s].block].kind,
                               corners_of(surfaces, solids[s]));
  BoxPairSearch search(comm, how, "contact inside");
  std::vector<BoxPair> pairs;
  search.find(of_points, of_solids, pairs);

  // The ranks of the elements look at the points.
  std::vector<int> to;
  for (const BoxPair& pair : pairs) to.push_back(pair.second.rank);
  const ExchangePlan plan = ExchangePlan::to_ranks(comm, to, "contact inside");
  std::vector<BoxPair> here(static_cast<std::size_t>(plan.received()));
  plan.forward<BoxPair>(pairs, here);
  std::vector<int> owner(here.size());
  std::vector<LocalIndex> index(here.size()), into(here.size());
  for (std::size_t i = 0; i < here.size(); ++i)
    owner[i] = here[i].first.rank, index[i] = here[i].first.index, into[i] = static_cast<LocalIndex>(i);
  std::vector<Point> asked(here.size());
  ExchangePlan::from_owners(comm, owner, index, into, "contact inside").forward<Point>(points, asked);
  for (std::size_t i = 0; i < here.size(); ++i) {
    const Solid& solid = solids[static_cast<std::size_t>(here[i].second.index)];
    const ElementBlock& block = surfaces.parties()[solid.party]->contact_mesh().blocks[solid.block];
    const Point& point = asked[i];
    if (allowed(point.surface, solid.surface)) continue;
    const auto is_shared = [&](LocalIndex n) {
      return std::ranges::find(point.nodes, surfaces.node_id(solid.party, n)) != point.nodes.end();
    };
    if (std::ranges::any_of(block.nodes(solid.element), is_shared)) continue;
    if (is_inside(block.kind, corners_of(surfaces, solid), point.place))
      result.push_back({std::min(point.surface, solid.surface), std::max(point.surface, solid.surface), point.place});
  }
}

std::vector<ShellFace> shells_of(const ContactSurfaces& surfaces) {
  std::vector<ShellFace> shells;
  for (const SurfaceFace& face : surfaces.faces()) {
    if (!face.two_sided) continue;
    const std::span<const Vec3> place = surfaces.parties()[static_cast<std::size_t>(face.party)]->contact_positions();
    ShellFace shell{{}, {}, {no_id, no_id, no_id, no_id}, 0, face.surface};
    std::array<Vec3, 4> x{};
    for (int k = 0; k < face.count(); ++k) {
      const auto i = static_cast<std::size_t>(k);
      x[i] = place[static_cast<std::size_t>(face.nodes[i])];
      shell.nodes[i] = face.corners[i].id;
    }
    shell.centre = mean_of(std::span(x).first(static_cast<std::size_t>(face.count())));
    shell.normal = face.count() == 3 ? cross(x[1] - x[0], x[2] - x[0]) : cross(x[2] - x[0], x[3] - x[1]);
    shell.size = std::sqrt(norm(shell.normal));
    shells.push_back(shell);
  }
  return shells;
}

bool coincide(const ShellFace& a, const ShellFace& b) {
  for (const GlobalId n : a.nodes)
    if (n != no_id && std::ranges::find(b.nodes, n) != b.nodes.end()) return false;
  const double least = std::min(a.size, b.size);
  return norm(a.centre - b.centre) <= coincident * least &&
         norm(cross(a.normal, b.normal)) <= coincident * norm(a.normal) * norm(b.normal);
}

void add_coincident_shells(const Communicator& comm, const ContactSurfaces& surfaces, SearchDecomposition how,
                           const Allowed& allowed, std::vector<Buried>& result) {
  const std::vector<ShellFace> shells = shells_of(surfaces);
  if (!comm.any(!shells.empty())) return;
  std::vector<Box> boxes(shells.size());
  for (std::size_t s = 0; s < shells.size(); ++s)
    boxes[s].add(shells[s].centre), boxes[s].inflate(coincident * shells[s].size);
  BoxPairSearch search(comm, how, "contact coincident");
  std::vector<BoxPair> pairs;
  search.find_within(boxes, pairs);
  std::array<std::vector<ShellFace>, 2> sides;
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<int> owner(pairs.size());
    std::vector<LocalIndex> index(pairs.size()), into(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const ItemHandle& handle = side == 0 ? pairs[i].first : pairs[i].second;
      owner[i] = handle.rank, index[i] = handle.index, into[i] = static_cast<LocalIndex>(i);
    }
    sides[side].resize(pairs.size());
    ExchangePlan::from_owners(comm, owner, index, into, "contact coincident").forward<ShellFace>(shells, sides[side]);
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const ShellFace &a = sides[0][i], &b = sides[1][i];
    if (!allowed(a.surface, b.surface) && coincide(a, b))
      result.push_back({std::min(a.surface, b.surface), std::max(a.surface, b.surface), std::min(a.centre, b.centre)});
  }
}

}  // namespace

std::vector<Buried> find_buried(const Communicator& comm, const ContactSurfaces& surfaces, SearchDecomposition how,
                                std::span<const char> known, const Allowed& allowed) {
  std::vector<Buried> mine;
  add_inside(comm, surfaces, how, known, allowed, mine);
  add_coincident_shells(comm, surfaces, how, allowed, mine);
  std::vector<Buried> all = comm.gather<Buried>(mine);
  std::ranges::sort(all, {}, [](const Buried& b) { return std::tuple(b.first, b.second, b.place); });
  return all;
}

}  // namespace tenon::contact
