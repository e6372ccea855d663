// SPDX-License-Identifier: BSD-3-Clause
// Where the energy of a run is, row by row, and how exactly the rows close.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/simulation/interaction.hpp"

namespace tenon {

/// One row of the ledger at one time, J.
struct LedgerRow {
  std::string component, row;
  EnergyTerm::Role role;
  double value;
};

/// The ledger of all components and interactions at one time. For each of them: sum(stored) - initial = sum(supplied) +
/// residual.
struct LedgerSnapshot {
  std::vector<LedgerRow> rows;
  std::vector<double> residual;  ///< per component, then per interaction, J
  double error = 0;              ///< greatest |residual| / scale over all of them, 1
};

/// Sums the rows of all components with one exact reduction. The scale of a component is the greatest sum of |rows| so
/// far; of an interaction that of the greatest component.
class EnergyLedger {
 public:
  EnergyLedger(const Communicator& comm, const std::vector<Component*>& components,
               const std::vector<Interaction*>& interactions = {});

  /// Collective. Takes the present stored totals as the initial ones.
  void start();
  /// Collective.
  LedgerSnapshot take();

  /// Row names in a fixed order; the component's name stands before a row that several components have.
  std::vector<std::string> columns();

  /// Collective.
  void save(CheckpointWriter& file) const;
  void load(const CheckpointReader& file);

 private:
  struct Account {
    std::string name;
    std::function<void(std::vector<EnergyTerm>&)> energies;
    bool between = false;  ///< an interaction: what it passes on is measured by what its parties have
    double initial = 0, scale = 0;
  };
  std::vector<LedgerRow> reduce();
  Communicator comm_;
  std::vector<Account> accounts_;
};

}  // namespace tenon
