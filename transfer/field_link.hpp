// SPDX-License-Identifier: BSD-3-Clause
// A coupling that carries one field of one component to another through a GridTransfer.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/simulation/coupling.hpp"
#include "transfer/grid_transfer.hpp"
#include "transfer/point_cloud.hpp"
#include "transfer/time_samples.hpp"

namespace tenon::transfer {

/// Where both meshes stand when points are sought. Material bodies that move together share reference coordinates, so a
/// map built there stays right for ever; `current` finds points where the meshes are now, and the map follows as far as
/// one has moved against the other.
enum class Configuration { reference, current };

struct FieldLinkOptions {
  std::string source_field, target_field;
  TransferOptions transfer;
  Configuration configuration = Configuration::reference;
  CouplingSchedule schedule = CouplingSchedule::slower_step;
  BetweenSamples between_samples = BetweenSamples::hold;
  bool show_outside = false;  ///< frames show the status of each target item and its distance from the source
  bool full_report = false;   ///< error estimate of every target, and the error of the way forth and back
  std::vector<std::string> blocks = {};  ///< of the source mesh, in which points are sought; empty: all
  std::string side_set = {};             ///< of the source mesh, for nearest_projection
};

/// Totals are accumulated on both sides, so that history.csv shows what was sent, what arrived and what waits.
class FieldLink : public Coupling {
 public:
  /// Throws Error(usage) if a field is missing (with the nearest name), or units, components or kinds do not fit.
  FieldLink(std::string name, Component& source, Component& target, FieldLinkOptions options);

  void initialize() override;
  void run() override;
  bool runs_at_start() const override { return !total(); }
  void prepare(double time) override;
  std::vector<std::string> report() override;
  std::vector<std::pair<std::string, ExactSum>> amounts() override;
  std::vector<ExportPort> shown_on_target() override;
  void save(CheckpointWriter& file) override;
  void load(const CheckpointReader& file) override;
  std::int64_t memory() const override;

 private:
  bool linear() const { return options_.between_samples == BetweenSamples::linear; }
  bool total() const { return export_.field.kind == FieldKind::total; }
  void build();
  void follow();
  Grid grid_of(const Component& component, std::span<const Vec3> coordinates, Location location) const;
  std::string round_trip() const;
  std::vector<double> waiting() const;  // of the owned target items

  FieldLinkOptions options_;
  ExportPort export_;
  ImportPort import_;
  PointCloud source_points_, target_points_;  // what stands for meshes of particles
  std::unique_ptr<GridTransfer> map_;
  std::int64_t updates_skipped_ = 0;
  std::vector<double> source_values_, target_values_;
  std::vector<double> sent_, received_;  // running totals of the owned items, J or the like
  LinearInTime line_;                    // of a point value, where it is linear between samples
  SteadyRelease release_;                // of a total, where it is handed over evenly
  std::vector<double> prepared_values_;
  std::vector<LocalIndex> source_owned_, target_owned_;
  std::vector<Vec3> source_built_, target_built_;  // that the map of an interrupted run was built for
  bool restored_ = false;
};

/// Positions (in an array of local items) of the items that this rank owns, and their global ids.
struct OwnedItems {
  std::vector<LocalIndex> items;
  std::vector<GlobalId> ids;
  GlobalId global_count = 0;
};
OwnedItems owned_items(const Mesh& mesh, Location location);

}  // namespace tenon::transfer
