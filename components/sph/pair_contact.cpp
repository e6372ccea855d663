// SPDX-License-Identifier: BSD-3-Clause
#include "components/sph/pair_contact.hpp"

#include <algorithm>
#include <cmath>

#include "components/materials/material_model.hpp"

namespace tenon {

namespace {
// Particles of one body can touch where it folds: if they were so many supports apart at the start. Nearer ones may be
// near because the material between them is squeezed, to a tenth, say.
constexpr double far = 4;
}  // namespace

PairContact::PairContact(const SphContext& context, const Column& origin)
    : c_(context),
      p_(context.particles),
      origin_(origin),
      acceleration_(p_.add("contact_acceleration", ColumnKind::vector, 3, true)),
      energy_(p_.add("pair_contact_energy", ColumnKind::scalar, 1, true)) {
  const std::vector<SphBody>& bodies = c_.options.bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::size_t first = b;
    for (std::size_t a = 0; a < b && first == b; ++a)
      if (!bodies[b].bond.empty() && bodies[a].bond == bodies[b].bond) first = a;
    bond_.push_back(static_cast<std::int32_t>(first));
    modulus_.push_back(make_material_model(bodies[b].material)->elasticity().p_wave_modulus());
  }
}

// Pairs of the lists that can touch; most particles have none.
void PairContact::find_candidates(const Column* failed) {
  const double support = c_.options.kernel == SphKernelKind::quintic_spline ? 3 : 2;
  begin_.clear(), who_.clear(), candidates_.clear();
  for (std::size_t i = 0; i < p_.owned(); ++i) {
    const std::size_t before = candidates_.size();
    for (const LocalIndex candidate : c_.decomposition.lists().of(i)) {
      const auto j = static_cast<std::size_t>(candidate);
      if (bonded(p_.body[i], p_.body[j]) && !(failed && ((*failed)[i] != 0 || (*failed)[j] != 0))) {
        const Vec3 D = origin_.vec(i) - origin_.vec(j);
        const double reach = far * support * std::max(p_.length[i], p_.length[j]);
        if (dot(D, D) < reach * reach) continue;
      }
      candidates_.push_back(candidate);
    }
    if (candidates_.size() == before) continue;
    who_.push_back(static_cast<LocalIndex>(i));
    begin_.push_back(before);
  }
  begin_.push_back(candidates_.size());
}

void PairContact::compute(Column* failed, bool any_failed) {
  const bool changes = any_failed || c_.options.always_search;
  if (changes || version_ != c_.decomposition.version()) find_candidates(any_failed ? failed : nullptr);
  version_ = changes ? -1 : c_.decomposition.version();
  std::fill_n(acceleration_.data(), 3 * p_.owned(), 0.0);
  touching_ = 0;
  const int d = c_.options.dimension;
  const double smoothing = c_.options.smoothing, stiffness = c_.options.solid.contact_stiffness;
  for (std::size_t w = 0; w < who_.size(); ++w) {
    const auto i = static_cast<std::size_t>(who_[w]);
    const Vec3 x = p_.position.vec(i), X = origin_.vec(i);
    Vec3 force{};
    for (std::size_t k = begin_[w]; k < begin_[w + 1]; ++k) {
      const auto j = static_cast<std::size_t>(candidates_[k]);
      const double spacing = 0.5 * (p_.length[i] + p_.length[j]) / smoothing;
      const Vec3 between = x - p_.position.vec(j), D = X - origin_.vec(j);
      const double r2 = dot(between, between), least = std::min(spacing * spacing, dot(D, D));
      if (!(r2 < least)) continue;
      const double r = std::sqrt(r2), M = 0.5 * (modulus_[static_cast<std::size_t>(p_.body[i])] +
                                                 modulus_[static_cast<std::size_t>(p_.body[j])]);
      const double k_pair = stiffness * M * (d == 3 ? spacing : d == 2 ? 1 : 1 / spacing);
      force = force + (k_pair * (std::sqrt(least) - r) / (r + 1e-12 * spacing)) * between;
      ++touching_;
    }
    acceleration_.set(i, (1 / p_.mass[i]) * force);
  }
}

}  // namespace tenon
