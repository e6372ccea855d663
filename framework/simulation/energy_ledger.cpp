// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/energy_ledger.hpp"

#include <algorithm>
#include <cmath>

namespace tenon {

EnergyLedger::EnergyLedger(const Communicator& comm, const std::vector<Component*>& components,
                           const std::vector<Interaction*>& interactions)
    : comm_(comm) {
  for (Component* component : components)
    accounts_.push_back(
        {component->name(), [component](std::vector<EnergyTerm>& terms) { component->energies(terms); }, false});
  for (Interaction* interaction : interactions)
    accounts_.push_back(
        {interaction->name(), [interaction](std::vector<EnergyTerm>& terms) { interaction->energies(terms); }, true});
}

std::vector<LedgerRow> EnergyLedger::reduce() {
  std::vector<LedgerRow> rows;
  std::vector<ExactSum> sums;
  std::vector<EnergyTerm> terms;
  for (const Account& account : accounts_) {
    terms.clear();
    account.energies(terms);
    for (const EnergyTerm& term : terms) {
      rows.push_back({account.name, term.row, term.role, 0.0});
      sums.push_back(term.local);
    }
  }
  std::vector<double> values(sums.size());
  comm_.sum(sums, values);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].value = values[i];
  return rows;
}

void EnergyLedger::start() {
  const std::vector<LedgerRow> rows = reduce();
  for (Account& account : accounts_) {
    account.initial = account.scale = 0;
    for (const LedgerRow& row : rows) {
      if (row.component != account.name) continue;
      if (row.role == EnergyTerm::Role::stored) account.initial += row.value;
      if (row.role == EnergyTerm::Role::supplied) account.initial -= row.value;
    }
  }
}

LedgerSnapshot EnergyLedger::take() {
  LedgerSnapshot snapshot{reduce(), {}, 0};
  double greatest = 0;
  for (Account& account : accounts_) {
    double residual = -account.initial, size = std::abs(account.initial);
    for (const LedgerRow& row : snapshot.rows) {
      if (row.component != account.name || row.role == EnergyTerm::Role::memo) continue;
      residual += row.role == EnergyTerm::Role::stored ? row.value : -row.value;
      size += std::abs(row.value);
    }
    account.scale = std::max({account.scale, size, account.between ? greatest : 0.0});
    greatest = std::max(greatest, account.scale);
    snapshot.residual.push_back(residual);
    if (account.scale > 0) snapshot.error = std::max(snapshot.error, std::abs(residual) / account.scale);
  }
  return snapshot;
}

std::vector<std::string> EnergyLedger::columns() {
  std::vector<EnergyTerm> terms;
  std::vector<std::pair<std::string, std::string>> rows;
  for (const Account& account : accounts_) {
    terms.clear();
    account.energies(terms);
    for (const EnergyTerm& term : terms) rows.emplace_back(account.name, term.row);
  }
  std::vector<std::string> names;
  for (const auto& [component, row] : rows) {
    const auto same = std::count_if(rows.begin(), rows.end(), [&row = row](const auto& r) { return r.second == row; });
    names.push_back(same > 1 ? component + "." + row : row);
  }
  return names;
}

void EnergyLedger::save(CheckpointWriter& file) const {
  for (const Account& account : accounts_) {
    file.scalar(account.name + ".ledger_initial", account.initial);
    file.scalar(account.name + ".ledger_scale", account.scale);
  }
}

void EnergyLedger::load(const CheckpointReader& file) {
  for (Account& account : accounts_) {
    account.initial = file.scalar(account.name + ".ledger_initial");
    account.scale = file.scalar(account.name + ".ledger_scale");
  }
}

}  // namespace tenon
