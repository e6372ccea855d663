// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/solid_group.hpp"

#include <algorithm>
#include <limits>

#include "components/materials/lane_math.hpp"
#include "components/mechanics/stress_power.hpp"

namespace tenon {

template <int N, int P>
SolidGroup<N, P>::SolidGroup(std::size_t block, const ElementBlock& elements, std::span<const Vec3> coordinates,
                             const MaterialDescription& description, const BulkViscosity& viscosity, bool averaged)
    : ElementGroup(block, elements, description, P),
      table_(elements.kind),
      viscosity_(viscosity),
      averaged_(averaged),
      needs_measures_(model().needs_deformation_gradient() || model().needs_volume_ratio() ||
                      model().needs_added_heat()),
      connectivity_(batches()),
      reference_volume_(batches()),
      viscosity_used_(model().needs_added_heat() ? batches() : 0),
      moduli_(model().variable_stiffness() ? batches() : 0),
      nodal_(averaged ? coordinates.size() : 0),
      volume_ratio_(averaged && needs_measures_ ? batches() : 0),
      expansion_(averaged && !dead.empty() ? batches() : 0),
      mean_(expansion_.size()) {
  const Elasticity& elasticity = model().elasticity();
  for (int l = 0; l < lanes; ++l)
    constant_moduli_[0][l] = elasticity.lame_lambda(), constant_moduli_[1][l] = elasticity.shear_modulus();
  for (Batch<2>& moduli : moduli_) moduli = constant_moduli_;
  for (Batch<1>& ratio : volume_ratio_) std::fill(ratio[0], ratio[0] + lanes, 1.0);
  for (LocalIndex e = 0; e < static_cast<LocalIndex>(batches()) * lanes; ++e) {
    for (int i = 0; i < N; ++i) connectivity_[static_cast<std::size_t>(e / lanes)].node[i][e % lanes] = node(e, i);
    value_of(reference_volume_, e) = volume(std::min(e, size() - 1), coordinates);
    value_of(mass, e) = description.density * value_of(reference_volume_, e);
  }
}

template <int N, int P>
void SolidGroup<N, P>::erode(const ErosionOptions& options) {
  ElementGroup::erode(options);
  if (averaged_) expansion_.resize(batches()), mean_.resize(batches());
}

template <int N, int P>
std::string_view SolidGroup<N, P>::formulation() const {
  if (averaged_) return N == 4 ? "tet4, nodal dilatation" : "wedge6, nodal dilatation";
  if constexpr (P == 1) return "tet4";
  return N == 8 ? "hex8, full" : N == 6 ? "wedge6" : "pyramid5";
}

template <int N, int P>
double SolidGroup<N, P>::volume(LocalIndex element, std::span<const Vec3> positions) const {
  NodeVectors<double, N> x;
  const std::span<const LocalIndex> nodes = elements().nodes(element);
  const Vec3 origin = positions[static_cast<std::size_t>(nodes[0])];
  for (int i = 0; i < N; ++i) {
    const Vec3 at = positions[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])] - origin;
    x.at[i] = {at[0], at[1], at[2]};
  }
  return solid_geometry<double, N, P>(table_, x).volume;
}

// Strain and rotation of the step at each point, from the geometry half way.
template <int N, int P>
void SolidGroup<N, P>::deform(std::size_t b, int lane, const NodeArrays& nodes, double dt, Work& work) {
  Vectors x = gather<N>(nodes.position, connectivity_[b], lane);
  const Vectors v = gather<N>(nodes.velocity, connectivity_[b], lane);
  const Pack back = broadcast<Pack>(0.5 * dt);
  for (int a = 0; a < N; ++a) x.at[a] = x.at[a] - back * v.at[a];
  const Geometry g = solid_geometry<Pack, N, P>(table_, x);
  const Pack rate = averaged_ ? nodal_mean(b, lane) / dt : divergence(v, g.mean);
  for (int p = 0; p < P; ++p) {
    const StepDeformation<Pack> step = step_deformation(with_trace(gradient_of(v, g.gradient[p]), rate), dt);
    store_tensor(step.strain_increment, work.strain[p], lane);
    points.rotate(b, p, step.rotation, lane);
  }
  const Pack now = load(temperature[b][0] + lane);
  store(work.temperature_increment[0] + lane, now - load(temperature_used[b][0] + lane));
  store(temperature_used[b][0] + lane, now);
}

// Deformation gradients with the volume ratio of the element, or that by averaged strains, at every point.
template <int N, int P>
void SolidGroup<N, P>::measure(std::size_t b, int lane, const NodeArrays& nodes, Work& work) {
  const Vectors x = gather<N>(nodes.position, connectivity_[b], lane);
  const Pack inverse_volume = 1.0 / load(reference_volume_[b][0] + lane);
  Pack ratio = solid_geometry<Pack, N, P>(table_, x).volume * inverse_volume;
  if (averaged_) {
    const Pack strain = nodal_mean(b, lane);
    ratio = load(volume_ratio_[b][0] + lane);
    for (int l = 0; l < pack_width; ++l) ratio[l] *= exp_of(strain[l]);
    store(volume_ratio_[b][0] + lane, ratio);
  }
  store(work.volume_ratio[0] + lane, ratio);
  if (nodes.reference) {
    const Vectors start = gather<N>(nodes.reference, connectivity_[b], lane);
    const Geometry g = solid_geometry<Pack, N, P>(table_, start);
    for (int p = 0; p < P; ++p) {
      const Tensor<Pack> f = gradient_of(x, g.gradient[p]);
      const Pack quotient = ratio / dot(f.x, cross(f.y, f.z));
      Pack root;
      for (int l = 0; l < pack_width; ++l) root[l] = std::cbrt(quotient[l]);
      const Pack values[9] = {f.x.x, f.x.y, f.x.z, f.y.x, f.y.y, f.y.z, f.z.x, f.z.y, f.z.z};
      for (int i = 0; i < 9; ++i) store(work.gradient[p][i] + lane, root * values[i]);
    }
  }
  if (viscosity_used_.empty()) return;
  const Pack all = load(viscosity_energy[b][0] + lane);
  store(work.added_heat[0] + lane, (all - load(viscosity_used_[b][0] + lane)) * inverse_volume);
  store(viscosity_used_[b][0] + lane, all);
}

template <int N, int P>
void SolidGroup<N, P>::update(std::size_t b, const NodeArrays& nodes, double dt) {
  if (!doomed.empty()) settle(b);
  Work work;
  for (int h = 0; h < halves; ++h) deform(b, h * pack_width, nodes, dt, work);
  for (int h = 0; h < halves && needs_measures_; ++h) measure(b, h * pack_width, nodes, work);
  Batch<1> shares[P], done{};
  for (int h = 0; h < halves; ++h) {
    const Geometry g = solid_geometry<Pack, N, P>(table_, gather<N>(nodes.position, connectivity_[b], h * pack_width));
    for (int p = 0; p < P; ++p) store(shares[p][0] + h * pack_width, g.share[p]);
  }
  for (int p = 0; p < P; ++p) {
    UpdateInput input{work.strain[p], temperature[b], work.temperature_increment, dt};
    if (needs_measures_)
      input.deformation_gradient = &work.gradient[p], input.volume_ratio = &work.volume_ratio,
      input.added_heat = &work.added_heat;
    if (!dead.empty()) work.before[p] = points.stress(b, p);
    model().update(input, points.stress(b, p), points.history(b, p), work.plastic_work);
    for (int l = 0; l < lanes; ++l) done[0][l] += work.plastic_work[0][l] * shares[p][0][l];
    if (moduli_.empty()) continue;
    Batch<2> now;
    model().stiffness(input, points.stress(b, p), points.history(b, p), now);
    for (int i = 0; i < 2; ++i)
      for (int l = 0; l < lanes; ++l) moduli_[b][i][l] = p == 0 ? now[i][l] : std::max(moduli_[b][i][l], now[i][l]);
  }
  for (int l = 0; l < lanes && model().plastic(); ++l) {
    if (!dead.empty() && dead[b][0][l] != 0) continue;
    plastic_work[b][0][l] += done[0][l];
    temperature[b][0][l] += heating * done[0][l] / mass[b][0][l];
  }
  if (!dead.empty()) bury(b, work, shares);
}

// Elements that have failed carry nothing from this step on: they die before their mean stress could reach a node, so
// that forces follow from the state alone, as a restart needs it. The work of the stress is that of the forces: of
// averaged elements that of the deviator only.
template <int N, int P>
void SolidGroup<N, P>::bury(std::size_t b, const Work& work, const Batch<1>* shares) {
  Batch<1> failed;
  find_gone(b, failed);
  for (int p = 0; p < P; ++p) {
    Batch<6>& now = points.stress(b, p);
    for (int l = 0; l < lanes; ++l)
      for (int i = 0; i < 6 && failed[0][l] != 0; ++i) now[i][l] = 0;
    if (averaged_)
      add_deviatoric_power(work.before[p], now, work.strain[p], shares[p], dead[b], internal_energy[b]);
    else
      add_stress_power(work.before[p], now, work.strain[p], shares[p], dead[b], internal_energy[b]);
  }
  for (int l = 0; l < lanes && averaged_; ++l)
    if (dead[b][0][l] == 0) internal_energy[b][0][l] += 0.5 * mean_[b][0][l] * expansion_[b][0][l];
  for (int l = 0; l < lanes; ++l)
    if (failed[0][l] != 0) die(b, l);
}

// omega^2 <= N/m (kappa V |mean gradient|^2 + 2 mu sum over points of their share of the greatest eigenvalue of G):
// see frequency_squared_bound, point by point.
template <int N, int P>
void SolidGroup<N, P>::resist(std::size_t b, int lane, const NodeArrays& nodes, double dt,
                              double (*rows)[N][pack_width], Batch<1>& step, Batch<1>& wave_step) {
  const Vectors x = gather<N>(nodes.position, connectivity_[b], lane);
  const Vectors v = gather<N>(nodes.velocity, connectivity_[b], lane);
  const Geometry g = solid_geometry<Pack, N, P>(table_, x);
  SymmetricTensor<Pack> deviator[P];
  Pack mean{}, shear_sum{}, greatest{};
  for (int p = 0; p < P; ++p) {
    SymmetricTensor<Pack> s = load_tensor(points.stress(b, p), lane);
    const Pack m = (1.0 / 3.0) * trace(s);
    mean = mean + m * g.share[p];
    s.xx = s.xx - m, s.yy = s.yy - m, s.zz = s.zz - m;
    deviator[p] = s;
    SymmetricTensor<Pack> products{};
    for (int a = 0; a < N; ++a) {
      const Vector<Pack>& d = g.gradient[p][a];
      products.xx += d.x * d.x, products.yy += d.y * d.y, products.zz += d.z * d.z;
      products.xy += d.x * d.y, products.yz += d.y * d.z, products.zx += d.z * d.x;
    }
    const Pack eigenvalue = greatest_eigenvalue_bound(products);
    shear_sum = shear_sum + g.share[p] * eigenvalue;
    greatest = greater_of(greatest, eigenvalue);
  }
  mean = averaged_ ? nodal_mean(b, lane) : mean / g.volume;
  if (!mean_.empty()) {
    const Pack gone = load(dead[b][0] + lane), work = 0.5 * mean * load(expansion_[b][0] + lane);
    double* energy = internal_energy[b][0] + lane;
    if (dt > 0) store(energy, load(energy) + (gone == 0.0 ? work : Pack{}));
    store(mean_[b][0] + lane, gone == 0.0 ? mean : Pack{});
  }
  Pack squares{};
  for (int a = 0; a < N; ++a) squares = squares + dot(g.mean[a], g.mean[a]);

  const Batch<2>& m = moduli_.empty() ? constant_moduli_ : moduli_[b];
  const Moduli<Pack> moduli{load(m[0] + lane), load(m[1] + lane)};
  const Pack weight = load(mass[b][0] + lane);
  const ElementScale<Pack> scale =
      element_scale(ElementReference<Pack>{weight, broadcast<Pack>(1.0), broadcast<Pack>(1.0)}, g.volume,
                    g.volume * g.volume * squares, moduli);
  const Pack rate = divergence(v, g.mean);
  const Pack intensity = viscosity_.intensity(scale, rate), viscous = viscosity_.stress(scale, intensity, rate);
  Vectors f;
  solid_forces(g, deviator, mean + viscous, f);
  store_rows(f, rows);

  const Pack bulk = moduli.lambda + (2.0 / 3.0) * moduli.shear;
  const Pack frequency = static_cast<double>(N) * (bulk * g.volume * squares + 2.0 * moduli.shear * shear_sum) / weight;
  const Pack damping = (N / 8.0) * viscosity_.damping(intensity), stable = damped_step(frequency, damping, Pack{});
  const Pack wave = wave_frequency_squared(g.volume * g.volume * greatest, moduli, (8.0 / N) * weight, g.volume);
  store(wave_step[0] + lane, damped_step(wave, damping, Pack{}));
  const Tensor<Pack> l = gradient_of(v, g.mean);
  const SymmetricTensor<Pack> d{
      l.x.x, l.y.y, l.z.z, 0.5 * (l.x.y + l.y.x), 0.5 * (l.y.z + l.z.y), 0.5 * (l.z.x + l.x.z)};
  const Pack bad = broadcast<Pack>(exploding_element), inverted = broadcast<Pack>(inverted_element);
  const Pack checked = (dt * dt) * squared_norm(d) < greatest_strain * greatest_strain ? stable : bad;
  store(step[0] + lane, g.least > 0.0 ? checked : (g.least <= 0.0 ? inverted : bad));
  if (dt == 0) return;
  const Pack gone = dead.empty() ? Pack{} : load(dead[b][0] + lane);
  const Pack energy = gone == 0.0 ? dt * (viscous * rate * g.volume) : Pack{};
  const Pack upright = g.least > 0.0 ? energy : Pack{};  // forces of others do not act
  store(viscosity_energy[b][0] + lane, load(viscosity_energy[b][0] + lane) + upright);
}

template <int N, int P>
void SolidGroup<N, P>::silence(std::size_t b, double (*rows)[N][pack_width], Batch<1>& step) {
  for (int l = 0; l < lanes; ++l) {
    if (dead[b][0][l] == 0) continue;
    for (int i = 0; i < N; ++i) std::fill(rows[l][i], rows[l][i] + pack_width, 0.0);
    step[0][l] = std::numeric_limits<double>::infinity();
  }
  if (doomed.empty()) return;
  Batch<1> inverted;
  doom(b, step, inverted);
  for (int l = 0; l < lanes; ++l)
    for (int i = 0; i < N && inverted[0][l] != 0; ++i) std::fill(rows[l][i], rows[l][i] + pack_width, 0.0);
}

template <int N, int P>
GroupStep SolidGroup<N, P>::advance(const NodeArrays& nodes, double dt) {
  GroupStep least{std::numeric_limits<double>::infinity(), no_index};
  for (std::size_t b = 0; b < batches(); ++b) {
    if (dt > 0 && !averaged_) update(b, nodes, dt);
    alignas(64) double rows[lanes][N][pack_width];
    Batch<1> step, wave_step;
    for (int h = 0; h < halves; ++h) resist(b, h * pack_width, nodes, dt, rows + h * pack_width, step, wave_step);
    if (!dead.empty()) silence(b, rows, step);
    if (!steps.empty()) steps[b] = step;
    if (follows()) follow(b, step, wave_step, least.shrink);
    for (int l = 0; l < count(b); ++l)
      if (step[0][l] < least.step) least = {step[0][l], static_cast<LocalIndex>(b) * lanes + l, least.shrink};
    scatter(rows, b, nodes.force);
  }
  return least;
}

template <int N, int P>
void SolidGroup<N, P>::store_rows(const Vectors& f, double (*rows)[N][pack_width]) const {
  for (int i = 0; i < N; ++i) {
    Pack a = f.at[i].x, b = f.at[i].y, c = f.at[i].z, d = Pack{};
    transpose(a, b, c, d);
    store(rows[0][i], a), store(rows[1][i], b), store(rows[2][i], c), store(rows[3][i], d);
  }
}

template <int N, int P>
void SolidGroup<N, P>::scatter(const double (*rows)[N][pack_width], std::size_t b, double* force) const {
  for (int l = 0; l < count(b); ++l)
    for (int i = 0; i < N; ++i) {
      double* to = force + 4 * static_cast<std::ptrdiff_t>(connectivity_[b].node[i][l]);
      store(to, load(to) + load(rows[l][i]));
    }
}

template <int N, int P>
void SolidGroup<N, P>::add_product(const NodeArrays& nodes, const double* u, double stiffness, double damping,
                                   ForceRow* out) const {
  for (std::size_t b = 0; b < batches(); ++b) {
    alignas(64) double rows[lanes][N][pack_width];
    const Batch<2>& m = moduli_.empty() ? constant_moduli_ : moduli_[b];
    for (int lane = 0; lane < lanes; lane += pack_width) {
      const Vectors v = gather<N>(nodes.velocity, connectivity_[b], lane), w = gather<N>(u, connectivity_[b], lane);
      const Geometry g = solid_geometry<Pack, N, P>(table_, gather<N>(nodes.position, connectivity_[b], lane));
      const Moduli<Pack> moduli{load(m[0] + lane), load(m[1] + lane)};
      Pack squares{};
      for (int a = 0; a < N; ++a) squares = squares + dot(g.mean[a], g.mean[a]);
      const ElementScale<Pack> scale =
          element_scale(ElementReference<Pack>{load(mass[b][0] + lane), broadcast<Pack>(1.0), broadcast<Pack>(1.0)},
                        g.volume, g.volume * g.volume * squares, moduli);
      const Pack volumetric = divergence(w, g.mean), twice = (2.0 * stiffness) * moduli.shear;
      const Pack bulk = stiffness * (moduli.lambda + (2.0 / 3.0) * moduli.shear);
      const Pack mean =
          bulk * volumetric +
          damping * viscosity_.stress(scale, viscosity_.intensity(scale, divergence(v, g.mean)), volumetric);
      SymmetricTensor<Pack> deviator[P];
      for (int p = 0; p < P; ++p) {
        const Tensor<Pack> e = with_trace(gradient_of(w, g.gradient[p]), Pack{});
        deviator[p] = {twice * e.x.x,
                       twice * e.y.y,
                       twice * e.z.z,
                       (0.5 * twice) * (e.x.y + e.y.x),
                       (0.5 * twice) * (e.y.z + e.z.y),
                       (0.5 * twice) * (e.z.x + e.x.z)};
      }
      Vectors f;
      solid_forces(g, deviator, mean, f);
      store_rows(f, rows + lane);
    }
    for (int l = 0; l < lanes && !dead.empty(); ++l)
      for (int i = 0; i < N && dead[b][0][l] != 0; ++i) std::fill(rows[l][i], rows[l][i] + pack_width, 0.0);
    scatter(rows, b, out->v);
  }
}

// Averages at nodes.

template <int N, int P>
void SolidGroup<N, P>::prepare(int pass, const NodeArrays& nodes, double dt) {
  if (pass == 0) return sum_dilatation(nodes, dt);
  for (std::size_t b = 0; b < batches() && dt > 0; ++b) update(b, nodes, dt);
  sum_pressure(nodes);
}

template <int N, int P>
void SolidGroup<N, P>::add_to_nodes(std::size_t b, const Batch<3>& values) {
  for (int l = 0; l < count(b); ++l) {
    const LocalIndex e = static_cast<LocalIndex>(b) * lanes + l;
    if (!alive(e)) continue;
    for (int i = 0; i < N; ++i) {
      Vec3& at = nodal_[static_cast<std::size_t>(connectivity_[b].node[i][l])];
      at = at + (1.0 / N) * Vec3{values[0][l], values[1][l], values[2][l]};
    }
  }
}

template <int N, int P>
void SolidGroup<N, P>::sum_dilatation(const NodeArrays& nodes, double dt) {
  if (dt == 0) return;
  std::fill(nodal_.begin(), nodal_.end(), Vec3{});
  for (std::size_t b = 0; b < batches(); ++b) {
    Batch<3> values{};
    for (int lane = 0; lane < lanes; lane += pack_width) {
      Vectors x = gather<N>(nodes.position, connectivity_[b], lane);
      const Vectors v = gather<N>(nodes.velocity, connectivity_[b], lane);
      const Pack back = broadcast<Pack>(0.5 * dt);
      for (int a = 0; a < N; ++a) x.at[a] = x.at[a] - back * v.at[a];
      const Geometry g = solid_geometry<Pack, N, P>(table_, x);
      const Pack expansion = g.volume * (dt * divergence(v, g.mean));
      store(values[0] + lane, g.volume);
      store(values[1] + lane, expansion);
      if (!expansion_.empty()) store(expansion_[b][0] + lane, expansion);
    }
    add_to_nodes(b, values);
  }
}

template <int N, int P>
void SolidGroup<N, P>::sum_pressure(const NodeArrays& nodes) {
  std::fill(nodal_.begin(), nodal_.end(), Vec3{});
  for (std::size_t b = 0; b < batches(); ++b) {
    Batch<3> values{};
    for (int lane = 0; lane < lanes; lane += pack_width) {
      const Geometry g = solid_geometry<Pack, N, P>(table_, gather<N>(nodes.position, connectivity_[b], lane));
      Pack mean{};
      for (int p = 0; p < P; ++p)
        mean = mean + g.share[p] * ((1.0 / 3.0) * trace(load_tensor(points.stress(b, p), lane)));
      store(values[0] + lane, g.volume);
      store(values[1] + lane, mean);
    }
    add_to_nodes(b, values);
  }
}

// Mean over the corners of four elements of the nodal average: value 1 over value 0. A dead element may have nodes that
// no living one has.
template <int N, int P>
Pack SolidGroup<N, P>::nodal_mean(std::size_t b, int lane) const {
  Pack sum{};
  for (int l = 0; l < pack_width; ++l)
    for (int i = 0; i < N; ++i) {
      const Vec3& n = nodal_[static_cast<std::size_t>(connectivity_[b].node[i][lane + l])];
      sum[l] += n[0] > 0 ? n[1] / n[0] : 0.0;
    }
  return (1.0 / N) * sum;
}

template <int N, int P>
std::vector<StateArray> SolidGroup<N, P>::state() {
  std::vector<StateArray> arrays = ElementGroup::state();
  if (!viscosity_used_.empty()) arrays.push_back({"viscosity_used", 1, viscosity_used_.data()});
  if (!volume_ratio_.empty()) arrays.push_back({"volume_ratio", 1, volume_ratio_.data()});
  if (!moduli_.empty()) arrays.push_back({"moduli", 2, reinterpret_cast<Batch<1>*>(moduli_.data())});
  return arrays;
}

template <int N, int P>
std::int64_t SolidGroup<N, P>::memory() const {
  return ElementGroup::memory() +
         static_cast<std::int64_t>(connectivity_.size() * (sizeof(SolidConnectivity<N>) + sizeof(Batch<1>)) +
                                   viscosity_used_.size() * sizeof(Batch<1>) + moduli_.size() * sizeof(Batch<2>) +
                                   nodal_.size() * sizeof(Vec3) +
                                   (volume_ratio_.size() + 2 * mean_.size()) * sizeof(Batch<1>));
}

std::unique_ptr<ElementGroup> make_solid_group(std::size_t block, const ElementBlock& elements,
                                               std::span<const Vec3> coordinates, const MaterialDescription& material,
                                               const BulkViscosity& viscosity, bool averaged) {
  switch (elements.kind) {
    case ElementKind::tet4:
      return std::make_unique<SolidGroup<4, 1>>(block, elements, coordinates, material, viscosity, averaged);
    case ElementKind::wedge6:
      return std::make_unique<SolidGroup<6, 6>>(block, elements, coordinates, material, viscosity, averaged);
    case ElementKind::pyramid5:
      return std::make_unique<SolidGroup<5, 8>>(block, elements, coordinates, material, viscosity, false);
    default:
      return std::make_unique<SolidGroup<8, 8>>(block, elements, coordinates, material, viscosity, false);
  }
}

}  // namespace tenon
