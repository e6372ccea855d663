// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/energy_ledger.hpp"

#include <algorithm>
#include <cmath>

namespace tenon {

std::vector<LedgerRow> EnergyLedger::reduce() {
  std::vector<LedgerRow> rows;
  std::vector<ExactSum> sums;
  std::vector<EnergyTerm> terms;
  for (Component* component : components_) {
    terms.clear();
    component->energies(terms);
    for (const EnergyTerm& term : terms) {
      rows.push_back({component->name(), term.row, term.role, 0.0});
      sums.push_back(term.local);
    }
  }
  std::vector<double> values(sums.size());
  comm_.sum(sums, values);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].value = values[i];
  return rows;
}

void EnergyLedger::start() {
  accounts_.assign(components_.size(), {});
  const std::vector<LedgerRow> rows = reduce();
  for (std::size_t c = 0; c < components_.size(); ++c)
    for (const LedgerRow& row : rows) {
      if (row.component != components_[c]->name()) continue;
      if (row.role == EnergyTerm::Role::stored) accounts_[c].initial += row.value;
      if (row.role == EnergyTerm::Role::supplied) accounts_[c].initial -= row.value;
    }
}

LedgerSnapshot EnergyLedger::take() {
  LedgerSnapshot snapshot{reduce(), std::vector<double>(components_.size()), 0};
  for (std::size_t c = 0; c < components_.size(); ++c) {
    double residual = -accounts_[c].initial, size = std::abs(accounts_[c].initial);
    for (const LedgerRow& row : snapshot.rows) {
      if (row.component != components_[c]->name() || row.role == EnergyTerm::Role::memo) continue;
      residual += row.role == EnergyTerm::Role::stored ? row.value : -row.value;
      size += std::abs(row.value);
    }
    accounts_[c].scale = std::max(accounts_[c].scale, size);
    snapshot.residual[c] = residual;
    if (accounts_[c].scale > 0) snapshot.error = std::max(snapshot.error, std::abs(residual) / accounts_[c].scale);
  }
  return snapshot;
}

std::vector<std::string> EnergyLedger::columns() {
  std::vector<EnergyTerm> terms;
  std::vector<std::pair<std::string, std::string>> rows;
  for (Component* component : components_) {
    terms.clear();
    component->energies(terms);
    for (const EnergyTerm& term : terms) rows.emplace_back(component->name(), term.row);
  }
  std::vector<std::string> names;
  for (const auto& [component, row] : rows) {
    const auto same = std::count_if(rows.begin(), rows.end(), [&row = row](const auto& r) { return r.second == row; });
    names.push_back(same > 1 ? component + "." + row : row);
  }
  return names;
}

void EnergyLedger::save(CheckpointWriter& file) const {
  for (std::size_t c = 0; c < components_.size(); ++c) {
    file.scalar(components_[c]->name() + ".ledger_initial", accounts_[c].initial);
    file.scalar(components_[c]->name() + ".ledger_scale", accounts_[c].scale);
  }
}

void EnergyLedger::load(const CheckpointReader& file) {
  accounts_.assign(components_.size(), {});
  for (std::size_t c = 0; c < components_.size(); ++c) {
    accounts_[c].initial = file.scalar(components_[c]->name() + ".ledger_initial");
    accounts_[c].scale = file.scalar(components_[c]->name() + ".ledger_scale");
  }
}

}  // namespace tenon
