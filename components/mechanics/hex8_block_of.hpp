// SPDX-License-Identifier: BSD-3-Clause
// A block of hexahedra with its material and hourglass form: the loop over its batches.
#pragma once

#include <limits>

#include "components/mechanics/hex8_block.hpp"

namespace tenon {

template <Material M, HourglassForm H>
class Hex8BlockOf final : public Hex8Block {
 public:
  Hex8BlockOf(const ElementBlock& block, std::span<const Vec3> coordinates, const MaterialDescription& description,
              const M& material, const H& hourglass, const BulkViscosity& viscosity)
      : Hex8Block(block, coordinates, description),
        material_(material),
        parameters_{material.elasticity.lame_lambda(), material.elasticity.shear_modulus(), viscosity, hourglass},
        history_(M::state_size > 0 ? batches() : 0),
        hourglass_state_(H::state_size > 0 ? batches() : 0) {}

  BlockStep advance(const NodeArrays& nodes, double dt) override {
    Batch<1> least, where;
    for (int l = 0; l < lanes; ++l) least[0][l] = std::numeric_limits<double>::infinity(), where[0][l] = 0;
    for (std::size_t b = 0; b < batches(); ++b) advance_batch(b, nodes, dt, least, where);
    BlockStep result{std::numeric_limits<double>::infinity(), no_index};
    for (int l = 0; l < lanes; ++l) {
      const LocalIndex element = std::min(static_cast<LocalIndex>(where[0][l]) * lanes + l, size() - 1);
      const bool first = least[0][l] < result.step || (least[0][l] == result.step && element < result.element);
      if (batches() > 0 && first) result = {least[0][l], element};
    }
    return result;
  }

  int history_size() const override { return M::state_size; }
  double history(LocalIndex e, int i) const override { return history_[batch(e)][i][e % lanes]; }
  void set_history(LocalIndex e, int i, double value) override { history_[batch(e)][i][e % lanes] = value; }
  int hourglass_state_size() const override { return H::state_size; }
  double hourglass_state(LocalIndex e, int i) const override { return hourglass_state_[batch(e)][i][e % lanes]; }
  void set_hourglass_state(LocalIndex e, int i, double value) override {
    hourglass_state_[batch(e)][i][e % lanes] = value;
  }
  bool plastic() const override { return has_plasticity; }
  std::int64_t memory() const override {
    return Hex8Block::memory() + static_cast<std::int64_t>(history_.size() * sizeof(StateBatch<M>) +
                                                           hourglass_state_.size() * sizeof(HourglassBatch));
  }
  void fill_padding() override {
    Hex8Block::fill_padding();
    for (LocalIndex e = size(); e < static_cast<LocalIndex>(batches()) * lanes; ++e) {
      for (int i = 0; i < M::state_size; ++i) set_history(e, i, history(size() - 1, i));
      for (int i = 0; i < H::state_size; ++i) set_hourglass_state(e, i, hourglass_state(size() - 1, i));
    }
  }

 private:
  using HourglassBatch = Batch<(H::state_size > 0 ? H::state_size : 1)>;
  static constexpr int halves = lanes / pack_width;
  static constexpr bool has_plasticity = M::state_size > 0;
  static std::size_t batch(LocalIndex e) { return static_cast<std::size_t>(e / lanes); }

  void advance_batch(std::size_t b, const NodeArrays& nodes, double dt, Batch<1>& least, Batch<1>& where) {
    HexModes<Pack> x[halves], v[halves];
    for (int h = 0; h < halves; ++h) {
      x[h] = gather(nodes.position, connectivity[b], h * pack_width);
      v[h] = gather(nodes.velocity, connectivity[b], h * pack_width);
    }
    Batch<1> plastic_work_density;
    if (dt > 0) {
      Batch<6> strain_increment;
      Batch<1> temperature_increment;
      for (int h = 0; h < halves; ++h)
        deform(b, h * pack_width, x[h], v[h], dt, strain_increment, temperature_increment);
      const UpdateInput input{strain_increment, temperature[b], temperature_increment, dt};
      StateBatch<M> none;
      material_.update(input, stresses[b], M::state_size > 0 ? history_[b] : none, plastic_work_density);
    }
    alignas(64) double rows[lanes][8][pack_width];
    for (int h = 0; h < halves; ++h) {
      const int lane = h * pack_width;
      const Pack step = resist(b, lane, x[h], v[h], dt, plastic_work_density, rows + lane);
      const Pack before = load(least[0] + lane);
      store(least[0] + lane, step < before ? step : before);
      store(where[0] + lane, step < before ? broadcast<Pack>(static_cast<double>(b)) : load(where[0] + lane));
    }
    scatter(rows, connectivity[b], count(b), nodes.force);
  }

  // The two halves of a batch must run through the same instructions: this file is compiled with contraction to fused
  // multiply-adds, and another copy of the code (inlined, unrolled, specialised) might contract otherwise.
  [[gnu::noinline, gnu::noclone]] void deform(std::size_t b, int lane, const HexModes<Pack>& x, const HexModes<Pack>& v,
                                              double dt, Batch<6>& strain_increment, Batch<1>& temperature_increment) {
    const StepDeformation<Pack> step = step_deformation(velocity_gradient(v, mean_gradient(mid_step(x, v, dt))), dt);
    store_tensor(step.strain_increment, strain_increment, lane);
    store_tensor(rotated(step.rotation, load_tensor(stresses[b], lane)), stresses[b], lane);
    if constexpr (H::state_size > 0) parameters_.hourglass.rotate(step.rotation, hourglass_state_[b], lane);
    const Pack now = load(temperature[b][0] + lane);
    store(temperature_increment[0] + lane, now - load(temperature_used[b][0] + lane));
    store(temperature_used[b][0] + lane, now);
  }

  [[gnu::noinline, gnu::noclone]] Pack resist(std::size_t b, int lane, const HexModes<Pack>& x, const HexModes<Pack>& v,
                                              double dt, const Batch<1>& plastic_work_density,
                                              double (*rows)[8][pack_width]) {
    HourglassBatch none;
    HourglassBatch& hourglass = H::state_size > 0 ? hourglass_state_[b] : none;
    const ElementForces<Pack> f =
        element_forces(x, v, load_tensor(stresses[b], lane),
                       {load(mass[b][0] + lane), load(reference_size[b][0] + lane)}, parameters_, hourglass, lane, dt);
    store_rows(f, rows);
    if (dt > 0) add_energies(b, lane, f, plastic_work_density);
    return f.step;
  }

  void add_energies(std::size_t b, int lane, const ElementForces<Pack>& f, const Batch<1>& plastic_work_density) {
    const auto add = [&](ElementValues& to, const Pack& value) {
      store(to[b][0] + lane, load(to[b][0] + lane) + value);
    };
    add(hourglass_energy, f.hourglass_energy);
    add(viscosity_energy, f.viscosity_energy);
    if constexpr (has_plasticity) {
      const Pack work = load(plastic_work_density[0] + lane) * f.volume;
      add(plastic_work, work);
      add(temperature, heating * work / load(mass[b][0] + lane));
    }
  }

  M material_;
  HexParameters<H> parameters_;
  std::vector<StateBatch<M>> history_;
  std::vector<HourglassBatch> hourglass_state_;
};

}  // namespace tenon
