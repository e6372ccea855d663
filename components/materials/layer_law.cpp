// SPDX-License-Identifier: BSD-3-Clause
// One of the few files that are compiled with contraction to fused multiply-adds: it runs on padded batches only, and
// the two halves of a batch go through the same instructions (`update_half`, neither inlined nor cloned).
#include "components/materials/layer_law.hpp"

#include <variant>

#include "components/materials/material.hpp"
#include "components/materials/pack.hpp"

namespace tenon {
namespace {

struct PlaneElasticity {
  explicit PlaneElasticity(const Elasticity& e)
      : expansion(e.expansion),
        shear(e.shear_modulus()),
        sum(e.youngs_modulus / (1 - e.poissons_ratio)),
        ratio(e.poissons_ratio / (1 - e.poissons_ratio)) {}
  double expansion, shear;
  double sum;    ///< of the stresses xx and yy over that of the strains
  double ratio;  ///< thinning over the sum of the strains in the plane
};

/// Stress of one layer at four points, the plane part by its sum and difference.
struct LayerStress {
  Pack sum, difference, xy, yz, zx;
};

/// Elastic stress increments: of the middle surface, and how they grow towards the top face.
struct LayerIncrement {
  LayerStress middle;
  Pack sum, difference, xy;
  Pack thinning;
};

TENON_KERNEL LayerIncrement elastic_increment(const PlaneElasticity& law, const LayerInput& input, int lane) {
  const auto row = [&](int i) { return load(input.strain[i] + lane); };
  const Pack thermal = law.expansion * load(input.temperature_increment[0] + lane);
  const Pack sum = row(0) + row(1) - 2.0 * thermal;
  const double two_g = 2 * law.shear;
  return {{law.sum * sum, two_g * (row(0) - row(1)), law.shear * row(2), law.shear * row(7), law.shear * row(6)},
          law.sum * (row(3) + row(4)),
          two_g * (row(3) - row(4)),
          law.shear * row(5),
          thermal - law.ratio * sum};
}

TENON_KERNEL LayerStress trial(const LayerIncrement& increment, double place, const Batch<6>& stress, int lane) {
  const Pack xx = load(stress[0] + lane), yy = load(stress[1] + lane);
  return {(xx + yy) + (increment.middle.sum + place * increment.sum),
          (xx - yy) + (increment.middle.difference + place * increment.difference),
          load(stress[3] + lane) + (increment.middle.xy + place * increment.xy),
          load(stress[4] + lane) + increment.middle.yz, load(stress[5] + lane) + increment.middle.zx};
}

TENON_KERNEL void store_stress(const LayerStress& s, Batch<6>& stress, int lane) {
  store(stress[0] + lane, 0.5 * (s.sum + s.difference)), store(stress[1] + lane, 0.5 * (s.sum - s.difference));
  store(stress[3] + lane, s.xy), store(stress[4] + lane, s.yz), store(stress[5] + lane, s.zx);
}

class ElasticLayers final : public LayerLaw {
 public:
  explicit ElasticLayers(const Elasticity& elasticity) : law_(elasticity) {}

  void update(const LayerInput& input, Batch<6>* stress, Batch<1>*, LayerOutput& output) const override {
    for (int lane = 0; lane < lanes; lane += pack_width) update_half(input, lane, stress, output);
  }

 private:
  [[gnu::noinline, gnu::noclone]] void update_half(const LayerInput& input, int lane, Batch<6>* stress,
                                                   LayerOutput& output) const {
    const LayerIncrement increment = elastic_increment(law_, input, lane);
    for (std::size_t p = 0; p < input.place.size(); ++p)
      store_stress(trial(increment, input.place[p], stress[p], lane), stress[p], lane);
    const Pack one = broadcast<Pack>(1.0);
    store(output.thinning[0] + lane, increment.thinning), store(output.plastic_work[0] + lane, Pack{});
    store(output.squash[0] + lane, one), store(output.bend[0] + lane, one);
  }

  PlaneElasticity law_;
};

constexpr std::size_t most_layers = 10;

/// Layers of which some point flows, side by side: their iterations overlap, which takes half the time of one after the
/// other.
struct FlowingLayers {
  std::size_t size = 0;
  std::size_t layer[most_layers];
  LayerStress stress[most_layers];  ///< elastic trial
  Pack a[most_layers];              ///< sum^2 / 4
  Pack b[most_layers];              ///< the rest of its q^2
  Pack before[most_layers];         ///< flow stress at the start of the step
  Pack x[most_layers];
  PackMask open[most_layers];
};

/// The return of J2LinearHardening under plane stress (j2_plane_stress.cpp: unknown x, and what u, v, w, r, h stand
/// for), by Halley's steps from x = 0 on: with F = s0 u v - w n, P = s0 (a v^3 + r b u^3) + h n^3 and
/// K = 3 a b (r - 1)^2 s0 u v a step is -F P n^2 / (P^2 + F K / 2): one root and one division, and what it leaves is of
/// the order of its cube. No step is longer than two of Newton's.
struct LinearReturn {
  double r, h, bend;  ///< 2 G / A, 2/3 H / A, 3/2 (r - 1)^2

  /// 0 where nothing yields.
  TENON_KERNEL void first_step(FlowingLayers& f, std::size_t i) const {
    const Pack a = f.a[i], b = f.b[i], s0 = f.before[i], n2 = a + b, n = square_root(n2), excess = n - s0;
    const Pack slope = s0 * (a + r * b) + h * (n2 * n), newton = slope * slope;
    const Pack step = excess * n2 * slope / greater_of(newton - bend * (a * b) * s0 * excess, 0.5 * newton);
    f.open[i] = n2 > s0 * s0;
    f.x[i] = f.open[i] ? step : Pack{};
  }
  /// Closes the points whose step is too small for another to matter.
  TENON_KERNEL void next_step(FlowingLayers& f, std::size_t i) const {
    constexpr double last_step = 1e-5;
    const Pack a = f.a[i], b = f.b[i], s0 = f.before[i], x = f.x[i];
    const Pack u = 1.0 + x, v = 1.0 + r * x, av2 = a * (v * v), bu2 = b * (u * u);
    const Pack n2 = av2 + bu2, n = square_root(n2), uv = s0 * (u * v);
    const Pack rest = uv - (1.0 - h * x) * n;
    const Pack slope = s0 * (av2 * v + r * (bu2 * u)) + h * (n2 * n), newton = slope * slope;
    const Pack step = rest * n2 * slope / greater_of(newton + bend * (a * b) * uv * rest, 0.5 * newton);
    f.x[i] = f.open[i] ? greater_of(x - step, Pack{}) : x;
    f.open[i] = f.open[i] & (greater_of(step, -step) > last_step * u);
  }
  TENON_KERNEL void solve(FlowingLayers& f) const {
    constexpr int budget = 30;
    for (std::size_t i = 0; i < f.size; ++i) first_step(f, i);
    bool left = true;
    for (int k = 0; k < budget && left; ++k) {
      PackMask open{};
      for (std::size_t i = 0; i < f.size; ++i) next_step(f, i), open = open | f.open[i];
      left = any(open);
    }
  }
};

class LinearHardeningLayers final : public LayerLaw {
 public:
  LinearHardeningLayers(const Elasticity& elasticity, const LinearHardeningParameters& p)
      : law_(elasticity),
        yield_(p.yield_stress),
        hardening_(p.hardening_modulus),
        per_a_(3 * (1 - elasticity.poissons_ratio) / elasticity.youngs_modulus),
        plastic_((1 - law_.ratio) / 3) {
    const double r = 2 * law_.shear * per_a_;
    return_ = {r, 2 * hardening_ * per_a_ / 3, 1.5 * (r - 1) * (r - 1)};
  }

  void update(const LayerInput& input, Batch<6>* stress, Batch<1>* history, LayerOutput& output) const override {
    for (int lane = 0; lane < lanes; lane += pack_width) update_half(input, lane, stress, history, output);
  }

 private:
  [[gnu::noinline, gnu::noclone]] void update_half(const LayerInput& input, int lane, Batch<6>* stress,
                                                   Batch<1>* history, LayerOutput& output) const {
    const LayerIncrement increment = elastic_increment(law_, input, lane);
    FlowingLayers f;
    for (std::size_t layer = 0; layer < input.place.size(); ++layer) {
      const LayerStress s = trial(increment, input.place[layer], stress[layer], lane);
      const Pack a = 0.25 * (s.sum * s.sum), before = yield_ + hardening_ * load(history[layer][0] + lane);
      const Pack b = 0.75 * (s.difference * s.difference) + 3.0 * (s.xy * s.xy + (s.yz * s.yz + s.zx * s.zx));
      if (any(a + b > before * before)) {
        const std::size_t i = f.size++;
        f.layer[i] = layer, f.stress[i] = s, f.a[i] = a, f.b[i] = b, f.before[i] = before;
      } else {
        store_stress(s, stress[layer], lane);
      }
    }
    return_.solve(f);
    finish(f, input, increment.thinning, lane, stress, history, output);
  }

  // Where nothing flows, u = v = w = 1, and all is multiplied by exactly 1: as if the layer had been left out.
  TENON_KERNEL void finish(const FlowingLayers& f, const LayerInput& input, const Pack& elastic_thinning, int lane,
                           Batch<6>* stress, Batch<1>* history, LayerOutput& output) const {
    Pack contraction{}, work{}, squashed{}, bent{};
    for (std::size_t i = 0; i < f.size; ++i) {
      const std::size_t layer = f.layer[i];
      const Pack x = f.x[i], u = 1.0 + x, v = 1.0 + return_.r * x, w = 1.0 - return_.h * x;
      const Pack uv = u * v, inverse = 1.0 / (uv * w), of_sum = v * w * inverse, of_rest = u * w * inverse;
      const LayerStress& t = f.stress[i];
      const LayerStress s{of_sum * t.sum, of_rest * t.difference, of_rest * t.xy, of_rest * t.yz, of_rest * t.zx};
      store_stress(s, stress[layer], lane);
      const Pack before = f.before[i], after = before * (uv * inverse), multiplier = per_a_ * x;
      const Pack flow = (2.0 / 3.0) * multiplier * after;
      store(history[layer][0] + lane, load(history[layer][0] + lane) + flow);
      const double weight = input.weight[layer];
      contraction += weight * (multiplier * s.sum);
      work += (0.5 * weight) * ((before + after) * flow);
      // The deviator after is that of the elastic trial divided by v.
      const Pack lost = 1.0 - of_rest;
      squashed += weight * lost, bent += input.bending[layer] * lost;
    }
    // What flows in the plane does not contract elastically.
    store(output.thinning[0] + lane, elastic_thinning - plastic_ * contraction);
    store(output.plastic_work[0] + lane, work);
    store(output.squash[0] + lane, 1.0 - squashed), store(output.bend[0] + lane, 1.0 - bent);
  }

  PlaneElasticity law_;
  double yield_, hardening_;
  double per_a_;    ///< 1/A, A = E / (3 (1 - nu))
  double plastic_;  ///< (1 - lambda / (lambda + 2 G)) / 3
  LinearReturn return_{};
};

}  // namespace

std::unique_ptr<const LayerLaw> make_layer_law(const MaterialDescription& d) {
  if (!d.elastic || d.failure || d.equation_of_state || !std::holds_alternative<std::monostate>(d.whole_law)) return {};
  if (std::holds_alternative<std::monostate>(d.plasticity)) return std::make_unique<ElasticLayers>(*d.elastic);
  const auto* linear = std::get_if<LinearHardeningParameters>(&d.plasticity);
  if (!linear || linear->rate.active()) return {};
  return std::make_unique<LinearHardeningLayers>(*d.elastic, *linear);
}

}  // namespace tenon
