// SPDX-License-Identifier: BSD-3-Clause
// What contact makes of its options before the first step.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "components/contact/contact.hpp"
#include "components/contact_geometry/closest_point.hpp"

namespace tenon {

using namespace contact;

namespace {

std::vector<ContactParty*> parties_of(const std::vector<Component*>& components) {
  std::vector<ContactParty*> parties;
  for (Component* component : components) {
    ContactParty* party = component->contact_party();
    if (!party)
      throw Error(ExitCode::usage, fmt::format("contact: component '{}' ({}) has no surface that could touch anything",
                                               component->name(), component->type()));
    parties.push_back(party);
  }
  if (parties.empty())
    throw Error(ExitCode::usage, "contact: the scene has no component that could touch anything; leave `contact` out");
  return parties;
}

std::vector<std::string> names_of(const std::vector<Component*>& components) {
  std::vector<std::string> names;
  for (const Component* component : components) names.push_back(component->name());
  return names;
}

}  // namespace

Contact::Contact(std::string name, const Communicator& comm, std::vector<Component*> parties, ContactOptions options)
    : Interaction(std::move(name)),
      comm_(comm),
      components_(std::move(parties)),
      parties_(parties_of(components_)),
      options_(std::move(options)),
      surfaces_(comm, parties_, names_of(components_)),
      search_(comm, surfaces_, options_.decomposition),
      set_(comm, surfaces_, options_.decomposition, options_.least_work),
      enforcement_(comm, set_) {
  for (const RigidSurface& surface : options_.rigid_surfaces) rigid_.emplace_back(surface);
  read_pairs();
}

Contact::~Contact() = default;

std::int32_t Contact::find_surface(const std::string& wanted) const {
  for (std::int32_t s = 0; s < surface_count_; ++s)
    if (surface_name(s) == wanted) return s;
  std::string known;
  for (std::int32_t s = 0; s < surface_count_; ++s) known += (s > 0 ? ", " : "") + surface_name(s);
  throw Error(ExitCode::usage,
              fmt::format("{}: pairs: there is no surface '{}'; there are: {}", name(), wanted, known));
}

std::string Contact::surface_name(std::int32_t surface) const {
  const std::size_t blocks = surfaces_.names().size(), s = static_cast<std::size_t>(surface);
  return s < blocks ? surfaces_.names()[s] : rigid_[s - blocks].options().name;
}

/// Whether these are particles of two components.
bool Contact::are_balls(std::int32_t first, std::int32_t second) const {
  const auto party_of = [&](std::int32_t surface) {
    for (const std::int32_t p : surfaces_.particle_parties()) {
      const auto count = static_cast<std::int32_t>(parties_[static_cast<std::size_t>(p)]->surface_names().size());
      const std::int32_t begin = surfaces_.first_surface(static_cast<std::size_t>(p));
      if (surface >= begin && surface < begin + count) return p;
    }
    return -1;
  };
  const std::int32_t a = party_of(first), b = party_of(second);
  return a >= 0 && b >= 0 && a != b;
}

void Contact::read_pairs() {
  surface_count_ = static_cast<std::int32_t>(surfaces_.names().size() + rigid_.size());
  for (std::int32_t a = 0; a < surface_count_; ++a)
    if (find_surface(surface_name(a)) != a)
      throw Error(ExitCode::usage, fmt::format("{}: a block and a rigid surface, or two of one kind, are called '{}'; "
                                               "give each a name of its own",
                                               name(), surface_name(a)));
  const auto count = static_cast<std::size_t>(surface_count_);
  rules_.assign(count * count, {false, false, options_.friction});
  const auto total = [&](std::int32_t a, std::int32_t b) {
    const auto same = [&](const PairTotals& t) { return t.first == a && t.second == b; };
    if (std::ranges::none_of(totals_, same)) totals_.push_back({a, b, {}, {}, {}});
  };
  for (const ContactPair& pair : options_.pairs) {
    const std::int32_t a = find_surface(pair.first), b = find_surface(pair.second);
    if ((pair.tied || pair.friction) && are_balls(a, b))
      throw Error(ExitCode::usage,
                  fmt::format("{}: pairs: {} and {} are particles of two components, which meet as smooth balls; leave "
                              "`{}` out, or make both bodies of one `sph` component",
                              name(), pair.first, pair.second, pair.tied ? "tied" : "friction"));
    for (const auto& [i, k] : {std::pair(a, b), std::pair(b, a)}) {
      Rule& rule = rules_[static_cast<std::size_t>(i) * count + static_cast<std::size_t>(k)];
      rule.ignore = pair.ignore, rule.tied = pair.tied;
      if (pair.friction) rule.friction = *pair.friction;
    }
    if (!pair.ignore) total(std::min(a, b), std::max(a, b));
  }
  if (surfaces_.particle_parties().size() > 1 && options_.friction.static_coefficient > 0)
    warnings_.push_back(name() + ": particles of different components slide on each other without friction");
  constexpr std::int32_t few = 3;  // more would drown the other columns of the history
  for (std::int32_t a = 0; a < surface_count_ && surface_count_ <= few; ++a)
    for (std::int32_t b = a; b < surface_count_; ++b)
      if (b < static_cast<std::int32_t>(surfaces_.names().size()) ||
          a < static_cast<std::int32_t>(surfaces_.names().size()))
        if (!rules_[static_cast<std::size_t>(a) * count + static_cast<std::size_t>(b)].ignore) total(a, b);
}

void Contact::initialize() {
  phases_ = {&phase("check"), &phase("search"), &phase("share out"),
             &phase("touch"), &phase("solve"),  &phase("exchange")};
  for (ContactParty* party : parties_) party->contact_fields();
  if (!started_)
    for (MovingSurface& surface : rigid_) surface.start(components_.front()->time());
  surfaces_.build();
  // Every rank has read all memories; each goes on with those of its own nodes.
  std::erase_if(restored_, [&](const auto& item) { return surfaces_.find_node(item.first.ids[0]) == no_index; });
  std::erase_if(restored_, [&](const auto& item) {
    if (item.first.kind != kept_overlap) return false;
    kept_[item.first.ids[0]] = item.second.energy;
    return true;
  });
  for (const SurfaceNode& node : surfaces_.nodes())  // after a restart: slip goes on where a node goes on touching
    if (parties_[static_cast<std::size_t>(node.party)]->contact_fields().slip[static_cast<std::size_t>(node.node)] !=
        Vec3{})
      filled_.push_back({node.party, node.node});
  search(components_.front()->time(), 0);
  if (!started_) settle_overlaps();
  started_ = true;
  if (!set_.any()) let_rest();
}

bool Contact::admit(PairRecord& pair) const {
  const auto count = static_cast<std::size_t>(surface_count_);
  return !rules_[static_cast<std::size_t>(pair.first_surface) * count + static_cast<std::size_t>(pair.second_surface)]
              .ignore;
}

}  // namespace tenon
