// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/contact_ties.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace tenon::thermal {

LocalIndex ContactTies::row(LocalIndex column) const {
  const auto rows = matrix_->row_of_node();
  return static_cast<std::size_t>(column) < rows.size() ? rows[static_cast<std::size_t>(column)] : no_index;
}

// The diagonal of the elements and the films, and which nodes lie across; collective.
void ContactTies::find_base(const HeatSystem& system, const ContactConductance& contact) {
  constexpr double least = 1e-14;  // share of the diagonal, should the rest be lost in round-off
  base_.assign(matrix_->width(), 0.0);
  across_.assign(matrix_->width(), 0.0);
  const auto rows = matrix_->row_of_node();
  for (std::size_t n = 0; n < rows.size(); ++n)
    if (rows[n] != no_index) base_[n] = system.diagonal[static_cast<std::size_t>(rows[n])];
  for (const std::size_t p : contact.order()) {
    const ContactPatch patch = contact.patch(p);
    for (std::size_t i = 0; i < patch.columns.size(); ++i) {
      const auto n = static_cast<std::size_t>(patch.columns[i]);
      if (row(patch.columns[i]) == no_index) continue;
      base_[n] -= system.factor * patch.weight * patch.coefficients[i] * patch.coefficients[i];
      if (patch.columns[i] != patch.node) across_[n] = 1;
    }
  }
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (rows[n] == no_index) continue;
    const auto r = static_cast<std::size_t>(rows[n]);
    base_[n] = system.inverse_diagonal[r] > 0 ? std::max(base_[n], least * system.diagonal[r]) : 0;
  }
  matrix_->halo().forward(std::span<const double>(base_), std::span(base_));
  matrix_->halo().forward(std::span<const double>(across_), std::span(across_));
}

// Of all patches here; collective.
std::vector<ContactTies::Role> ContactTies::find_roles(const HeatSystem& system,
                                                       const ContactConductance& contact) const {
  std::map<LocalIndex, std::pair<double, std::size_t>> strongest;
  std::map<LocalIndex, double> sum;
  for (std::size_t p = 0; p < contact.owned_patches(); ++p) {
    const ContactPatch patch = contact.patch(p);
    const auto n = static_cast<std::size_t>(patch.node);
    sum[patch.node] += patch.weight;
    if (across_[n] > 0 || !(base_[n] > 0) || !(system.factor * patch.weight > base_[n])) continue;
    const auto [place, is_first] = strongest.try_emplace(patch.node, patch.weight, p);
    if (!is_first && patch.weight > place->second.first) place->second = {patch.weight, p};
  }
  std::vector<Role> roles(contact.patches());
  for (std::size_t p = 0; p < contact.owned_patches(); ++p) {
    const ContactPatch patch = contact.patch(p);
    const auto found = strongest.find(patch.node);
    if (found == strongest.end()) continue;
    roles[p] = {found->second.second == p, true, sum[patch.node] - found->second.first};
  }
  contact.plan().forward(std::span<const Role>(roles), std::span(roles).subspan(contact.owned_patches()));
  return roles;
}

// Adds to a bound of P^T A P, as far as A is bounded by its diagonal: c c^T is not above diag(|c_a| sum |c|).
void ContactTies::add_diagonal(double factor, const ContactPatch& patch, const Role& role) {
  double sizes = 0;
  for (std::size_t i = 0; i < patch.columns.size(); ++i)
    if (patch.columns[i] != patch.node) sizes += std::abs(patch.coefficients[i]);
  const double base = base_[static_cast<std::size_t>(patch.node)];
  const bool own = !role.follows && base > 0;  // b moves by itself
  for (std::size_t i = 0; i < patch.columns.size(); ++i) {
    const LocalIndex r = row(patch.columns[i]);
    if (r == no_index) continue;
    const double size = std::abs(patch.coefficients[i]);
    double& diagonal = diagonal_[static_cast<std::size_t>(r)];
    if (patch.columns[i] == patch.node)
      diagonal += own ? factor * patch.weight * (1 + sizes) : 0;
    else if (role.tied)
      diagonal += size * (sizes * base + factor * 2 * greatest_weight * role.other);
    else if (role.follows)
      diagonal += factor * patch.weight * size * 2 * greatest_weight;
    else
      diagonal += factor * patch.weight * size * (sizes + (own ? 1 : 0));
  }
}

void ContactTies::add_tie(const ContactPatch& patch) {
  const std::size_t first = nodes_.size();
  for (std::size_t i = 0; i < patch.columns.size(); ++i) {
    if (patch.columns[i] == patch.node || !(base_[static_cast<std::size_t>(patch.columns[i])] > 0)) continue;
    nodes_.push_back(patch.columns[i]);
    weights_.push_back(-patch.coefficients[i]);
  }
  ties_.push_back({patch.node, first, nodes_.size()});
}

void ContactTies::build(const HeatSystem& system, const ContactConductance& contact) {
  matrix_ = &system.matrix;
  find_base(system, contact);
  const std::vector<Role> roles = find_roles(system, contact);
  ties_.clear(), nodes_.clear(), weights_.clear();
  diagonal_.assign(system.diagonal.size(), 0.0);
  for (const std::size_t p : contact.order()) {
    add_diagonal(system.factor, contact.patch(p), roles[p]);
    if (roles[p].tied) add_tie(contact.patch(p));
  }
  const auto rows = matrix_->row_of_node();
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (rows[n] == no_index) continue;
    double& diagonal = diagonal_[static_cast<std::size_t>(rows[n])];
    diagonal = across_[n] > 0 && base_[n] > 0 ? diagonal + base_[n] : 0;
  }
  work_.assign(matrix_->width(), 0.0);
  change_.assign(matrix_->width(), 0.0);
  any_ = contact.any_of_all_ranks(!ties_.empty());
}

void ContactTies::smooth(double bound, std::span<const double> rest, std::span<double> z) {
  const auto rows = matrix_->row_of_node();
  for (std::size_t n = 0; n < rows.size(); ++n)
    if (rows[n] != no_index) work_[n] = rest[static_cast<std::size_t>(rows[n])];
  matrix_->halo().forward(std::span<const double>(work_), std::span(work_));
  for (std::size_t n = 0; n < rows.size(); ++n) change_[n] = rows[n] != no_index ? work_[n] : 0;
  for (const Tie& tie : ties_)
    for (std::size_t i = tie.first; i < tie.last; ++i)
      if (row(nodes_[i]) != no_index)
        change_[static_cast<std::size_t>(nodes_[i])] += weights_[i] * work_[static_cast<std::size_t>(tie.node)];
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (rows[n] == no_index) continue;
    const double diagonal = diagonal_[static_cast<std::size_t>(rows[n])];
    change_[n] = diagonal > 0 ? change_[n] / (bound * diagonal) : 0;
    z[n] += change_[n];
  }
  matrix_->halo().forward(std::span<const double>(change_), std::span(change_));
  each_tie([&](LocalIndex b, LocalIndex a, double weight) {
    z[static_cast<std::size_t>(b)] += weight * change_[static_cast<std::size_t>(a)];
  });
  matrix_->halo().forward(std::span<const double>(z), z);
}

std::int64_t ContactTies::memory() const {
  const std::size_t values =
      base_.size() + across_.size() + diagonal_.size() + weights_.size() + work_.size() + change_.size();
  return static_cast<std::int64_t>(values * sizeof(double) + ties_.size() * sizeof(Tie) +
                                   nodes_.size() * sizeof(LocalIndex));
}

}  // namespace tenon::thermal
