// SPDX-License-Identifier: BSD-3-Clause
// The element loops of shells. One of the few files that are compiled with contraction to fused multiply-adds; nothing
// that other files compute as well belongs here, and the two halves of a batch go through the same instructions: every
// function of a half stands alone, neither inlined nor cloned (see hex8_group.cpp).
#include "components/mechanics/shell4_group.hpp"

#include <cmath>
#include <limits>

#include "components/mechanics/stable_step.hpp"
#include "components/mechanics/stress_power.hpp"

namespace tenon {

namespace {

template <typename R>
TENON_KERNEL ShellModes<R> turned(const Tensor<R>& axes, const ShellModes<R>& a) {
  return {axes * a.mean, axes * a.xi, axes * a.eta, axes * a.hourglass};
}
template <typename R>
TENON_KERNEL ShellModes<R> moved(const ShellModes<R>& x, const ShellModes<R>& v, double time) {
  const R t = broadcast<R>(time);
  return {x.mean, x.xi + t * v.xi, x.eta + t * v.eta, x.hourglass + t * v.hourglass};
}
/// Register by register: faster than what the compiler makes of an assignment.
TENON_KERNEL void copy(const Batch<6>& from, Batch<6>& to) {
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i)
    for (int lane = 0; lane < lanes; lane += pack_width) store(to[i] + lane, load(from[i] + lane));
}
template <int N>
TENON_KERNEL void clear(Batch<N>& rows) {
#pragma GCC unroll 10
  for (int i = 0; i < N; ++i)
    for (int lane = 0; lane < lanes; lane += pack_width) store(rows[i] + lane, Pack{});
}
TENON_KERNEL void add(Batch<1>& to, int lane, const Pack& value) {
  store(to[0] + lane, load(to[0] + lane) + value);
}

}  // namespace

// Relative to node 0, so that a uniform motion is exactly zero in all modes but the mean.
template <typename S>
TENON_KERNEL ShellModes<Pack> ShellGroup<S>::gather(const double* values, const Connectivity& c, int lane) {
  const auto row = [&](int node, int l) {
    return load(values + 3 * static_cast<std::ptrdiff_t>(c.node[node][lane + l]));
  };
  const Pack r[4] = {row(0, 0), row(0, 1), row(0, 2), row(0, 3)};
  Vector<Pack> p[4];
  p[3] = Vector<Pack>{};
#pragma GCC unroll 4
  for (int i = 0; i < S::nodes; ++i) {
    const Pack zero{};
    Pack a = row(i, 0) - (i > 0 ? r[0] : zero), b = row(i, 1) - (i > 0 ? r[1] : zero);
    Pack d = row(i, 2) - (i > 0 ? r[2] : zero), e = row(i, 3) - (i > 0 ? r[3] : zero);
    transpose(a, b, d, e);
    p[i] = {a, b, d};
  }
  return S::template modes<Pack>(p[0], p[1], p[2], p[3]);
}

template <typename S>
TENON_KERNEL void ShellGroup<S>::store_rows(const ShellModes<Pack>& f, const Tensor<Pack>& axes, Rows rows) {
  const auto global = [&](const Vector<Pack>& a) { return a.x * axes.x + a.y * axes.y + a.z * axes.z; };
  const ShellModes<Pack> g{global(f.mean), global(f.xi), global(f.eta), global(f.hourglass)};
#pragma GCC unroll 4
  for (int i = 0; i < S::nodes; ++i) {
    const Vector<Pack> n = S::share(g, i);
    Pack a = n.x, b = n.y, c = n.z, d = Pack{};
    transpose(a, b, c, d);
    store(rows[0][i], a), store(rows[1][i], b), store(rows[2][i], c), store(rows[3][i], d);
  }
}

// Element after element: the canonical order.
template <typename S>
TENON_KERNEL void ShellGroup<S>::scatter(const double (*rows)[S::nodes][pack_width], const Connectivity& c, int count,
                                         double* to) {
  for (int l = 0; l < count; ++l) {
#pragma GCC unroll 4
    for (int i = 0; i < S::nodes; ++i) {
      double* at = to + 4 * static_cast<std::ptrdiff_t>(c.node[i][l]);
      store(at, load(at) + load(rows[l][i]));
    }
  }
}

template <typename S>
GroupStep ShellGroup<S>::advance(const NodeArrays& nodes, double dt) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Batch<1> least, where;
  for (int l = 0; l < lanes; ++l) least[0][l] = infinity, where[0][l] = 0;
  for (std::size_t b = 0; b < batches(); ++b) advance_batch(b, nodes, dt, least, where);
  GroupStep result{infinity, no_index};
  for (int l = 0; l < lanes && batches() > 0; ++l) {
    const LocalIndex element = std::min(static_cast<LocalIndex>(where[0][l]) * lanes + l, size() - 1);
    const bool first = least[0][l] < result.step || (least[0][l] == result.step && element < result.element);
    if (first) result = {least[0][l], element};
  }
  return result;
}

template <typename S>
void ShellGroup<S>::advance_batch(std::size_t b, const NodeArrays& nodes, double dt, Batch<1>& least, Batch<1>& where) {
  Work work;
  clear(work.resultant), clear(work.thinning), clear(work.plastic), clear(work.squash), clear(work.bend);
  if (!(dt > 0)) clear(work.increment), clear(work.variation);
  if (dt > 0) {
    Batch<1> temperature_increment;
    for (int lane = 0; lane < lanes; lane += pack_width) deform(b, lane, nodes, dt, work, temperature_increment);
    update_layers(b, dt, temperature_increment, work);
  }
  for (int p = 0; p < points.points(); ++p)
    for (int lane = 0; lane < lanes; lane += pack_width) add_layer(b, lane, p, work);
  alignas(64) double force[lanes][S::nodes][pack_width], moment[lanes][S::nodes][pack_width];
  Batch<1> step;
  for (int lane = 0; lane < lanes; lane += pack_width)
    store(step[0] + lane, resist(b, lane, nodes, dt, work, force + lane, moment + lane));
  if (!dead.empty()) bury(b, force, moment, step);
  for (int lane = 0; lane < lanes; lane += pack_width) {
    const Pack now = load(step[0] + lane), before = load(least[0] + lane);
    store(least[0] + lane, now < before ? now : before);
    store(where[0] + lane, now < before ? broadcast<Pack>(static_cast<double>(b)) : load(where[0] + lane));
  }
  if (!steps.empty()) steps[b] = step;
  scatter(force, connectivity_[b], count(b), nodes.force);
  scatter(moment, connectivity_[b], count(b), nodes.moment);
}

// In the geometry half a step back, where a rigid rotation by any angle strains nothing [HW80].
template <typename S>
[[gnu::noinline, gnu::noclone]] void ShellGroup<S>::deform(std::size_t b, int lane, const NodeArrays& nodes, double dt,
                                                           Work& work, Batch<1>& temperature_increment) {
  const ShellModes<Pack> v = gather(nodes.velocity, connectivity_[b], lane);
  const ShellModes<Pack> x = moved(gather(nodes.position, connectivity_[b], lane), v, -0.5 * dt);
  const ShellGeometry<Pack> g = shell_geometry<S>(x, reference(b, lane));
  const ShellModes<Pack> w = gather(nodes.spin, connectivity_[b], lane);
  const ShellRates<Pack> r = shell_rates<S>(g, turned(g.axes, v), turned(g.axes, w));
  const Pack share = load(shear_share_[b][0] + lane);
  for (int i = 0; i < 3; ++i) {
    store(work.increment[i] + lane, dt * r.membrane[i]);
    store(work.increment[3 + i] + lane, dt * r.curvature[i]);
  }
  for (int i = 0; i < 2; ++i) store(work.increment[6 + i] + lane, dt * share * r.shear[i]);
  const Pack out = offset(load(thickness_[b][0] + lane));
  for (int i = 0; i < S::hourglasses; ++i) {
    // Membrane strain is that of the middle surface.
    const Pack strain = S::nodes == 4 && i < 2 ? r.hourglass[i] + out * r.hourglass[i + 2] : r.hourglass[i];
    store(work.variation[i] + lane, dt * strain);
  }
  for (int i = 0; i < S::drills; ++i) store(work.variation[S::hourglasses + i] + lane, dt * r.drill[i]);
  const Pack now = load(temperature[b][0] + lane);
  store(temperature_increment[0] + lane, now - load(temperature_used[b][0] + lane));
  store(temperature_used[b][0] + lane, now);
}

template <typename S>
void ShellGroup<S>::update_layers(std::size_t b, double dt, const Batch<1>& temperature_increment, Work& work) {
  const bool plastic = model().plastic();
  Batch<2> greatest{};
  for (int p = 0; p < points.points(); ++p) {
    Batch<6> strain;
    for (int lane = 0; lane < lanes; lane += pack_width) layer_strain(b, lane, p, work, strain);
    const UpdateInput input{strain, temperature[b], temperature_increment, dt};
    Batch<6>& now = points.stress(b, p);
    Batch<6> before;
    if (plastic || !dead.empty()) copy(now, before);
    Batch<1> done{}, thinning, relaxation;
    model().update_plane_stress(input, now, points.history(b, p), done, thinning);
    for (int l = 0; l < lanes; ++l) strain[2][l] = thinning[0][l], relaxation[0][l] = 1;
    if (!moduli_.empty()) {
      Batch<2> m;
      model().stiffness(input, now, points.history(b, p), m);
      for (int i = 0; i < 2; ++i)
        for (int l = 0; l < lanes; ++l) greatest[i][l] = m[i][l] > greatest[i][l] ? m[i][l] : greatest[i][l];
    }
    if (plastic) relaxation_of(before, strain, now, moduli_.empty() ? constant_moduli_ : moduli_[b], relaxation);
    if (!dead.empty()) add_energy(b, p, before, strain), drop_failed_layers(b, p);
    for (int lane = 0; lane < lanes; lane += pack_width) add_flow(lane, p, thinning, done, relaxation, work);
  }
  if (!moduli_.empty()) moduli_[b] = greatest;
  for (int lane = 0; lane < lanes; lane += pack_width) {
    const Pack t = load(thickness_[b][0] + lane);
    store(thickness_[b][0] + lane, t + t * load(work.thinning[0] + lane));
  }
}

template <typename S>
[[gnu::noinline, gnu::noclone]] void ShellGroup<S>::layer_strain(std::size_t b, int lane, int point, const Work& work,
                                                                 Batch<6>& strain) const {
  const Pack t = load(thickness_[b][0] + lane);
  const Pack z = (0.5 * rule_.place[static_cast<std::size_t>(point)]) * t + offset(t);
  const auto at = [&](int i) { return load(work.increment[i] + lane); };
  store(strain[0] + lane, at(0) + z * at(3));
  store(strain[1] + lane, at(1) + z * at(4));
  store(strain[2] + lane, Pack{});
  store(strain[3] + lane, 0.5 * (at(2) + z * at(5)));
  store(strain[4] + lane, 0.5 * at(7));
  store(strain[5] + lane, 0.5 * at(6));
}

template <typename S>
[[gnu::noinline, gnu::noclone]] void ShellGroup<S>::add_flow(int lane, int point, const Batch<1>& thinning,
                                                             const Batch<1>& plastic, const Batch<1>& relaxation,
                                                             Work& work) const {
  const double place = rule_.place[static_cast<std::size_t>(point)];
  const double weight = rule_.weight[static_cast<std::size_t>(point)];
  const Pack r = load(relaxation[0] + lane);
  add(work.thinning, lane, weight * load(thinning[0] + lane));
  add(work.plastic, lane, weight * load(plastic[0] + lane));
  add(work.squash, lane, weight * r);
  if (second_moment_ > 0) add(work.bend, lane, (0.25 * weight * place * place / second_moment_) * r);
}

/// Adds the layer's forces and moments per length.
template <typename S>
[[gnu::noinline, gnu::noclone]] void ShellGroup<S>::add_layer(std::size_t b, int lane, int point, Work& work) const {
  const Pack t = load(thickness_[b][0] + lane);
  const Pack w = rule_.weight[static_cast<std::size_t>(point)] * t;
  const Pack z = w * ((0.5 * rule_.place[static_cast<std::size_t>(point)]) * t + offset(t));
  const Batch<6>& s = points.stress(b, point);
  const Pack xx = load(s[0] + lane), yy = load(s[1] + lane), xy = load(s[3] + lane);
  const auto to = [&](int i, const Pack& value) {
    store(work.resultant[i] + lane, load(work.resultant[i] + lane) + value);
  };
  to(0, w * xx), to(1, w * yy), to(2, w * xy), to(3, z * xx), to(4, z * yy), to(5, z * xy);
  to(6, (5.0 / 6.0) * w * load(s[5] + lane)), to(7, (5.0 / 6.0) * w * load(s[4] + lane));
}

/// Energy within the layers, which a failing element leaves behind: as `add_stress_power`, shear as corrected.
template <typename S>
void ShellGroup<S>::add_energy(std::size_t b, int point, const Batch<6>& before, const Batch<6>& strain) {
  const Batch<6>& now = points.stress(b, point);
  for (int l = 0; l < lanes; ++l) {
    const auto power = [&](int i) { return (before[i][l] + now[i][l]) * strain[i][l]; };
    const double shear = (5.0 / 3.0) * (power(4) + power(5)) / shear_share_[b][0][l];
    const double volume = value_of(mass, static_cast<LocalIndex>(b) * lanes + l) / material().density;
    const double work =
        0.5 * volume * rule_.weight[static_cast<std::size_t>(point)] * (power(0) + power(1) + 2 * power(3) + shear);
    internal_energy[b][0][l] += dead[b][0][l] == 0 ? work : 0.0;
  }
}

template <typename S>
ShellStiffness<Pack> ShellGroup<S>::stiffness(std::size_t b, int lane, const Pack& t) const {
  const Batch<2>& m = moduli_.empty() ? constant_moduli_ : moduli_[b];
  const PlaneModuli<Pack> moduli = plane_moduli(load(m[0] + lane), load(m[1] + lane));
  return {moduli,
          t,
          second_moment_ * t * t,
          offset(t),
          (5.0 / 6.0) * load(shear_share_[b][0] + lane) * moduli.shear,
          (drilling / 12) * moduli.young * t * t * t};
}

/// Resultants of what varies over the element; returns the energy that it takes up, J. The stress of the varying
/// membrane strain is that of a bent beam, E g11 e11, which is exact for rectangles in in-plane bending. In a warped
/// element that strain couples with bending, which would lock thin ones: it is resisted by 1/(1 + (h_z/t)^2) of the
/// modulus, at least a twentieth.
template <typename S>
TENON_KERNEL Pack ShellGroup<S>::vary(std::size_t b, int lane, const ShellGeometry<Pack>& g,
                                      const ShellStiffness<Pack>& k, double dt, const Work& work,
                                      ShellResultants<Pack>& q) {
  const Pack young = k.moduli.young, one = broadcast<Pack>(1.0), volume = g.area * k.thickness;
  Pack modulus[S::hourglasses], weight[S::hourglasses], relaxation[S::hourglasses];
  const Pack squash = dt > 0 ? load(work.squash[0] + lane) : one;
  const Pack g11 = dot(g.g1, g.g1), g22 = dot(g.g2, g.g2);
  if constexpr (S::nodes == 4) {
    const Pack third = (1.0 / 3.0) * volume, warp = g.h.z / k.thickness;
    const Pack soft = greater_of(1.0 / (1.0 + warp * warp), broadcast<Pack>(0.05));
    const Pack bend = dt > 0 && second_moment_ > 0 ? load(work.bend[0] + lane) : one;
    for (int i = 0; i < 6; ++i) {
      const Pack metric = i % 2 == 0 ? g11 : g22;
      modulus[i] = i < 4 ? young * metric : k.shear_modulus;
      weight[i] = third * metric * (i < 2 ? soft : (i < 4 ? k.second_moment : one));
      relaxation[i] = i < 2 || i > 3 ? squash : bend;
    }
  } else {
    modulus[0] = triangle_shear * k.shear_modulus, relaxation[0] = squash;
    weight[0] = (1.0 / 18.0) * volume * (g11 + dot(g.g1, g.g2) + g22);
  }
  Pack energy{};
  for (int i = 0; i < S::hourglasses + S::drills; ++i) {
    const bool drill = i >= S::hourglasses;
    const Pack strain = load(work.variation[i] + lane), old = load(varying_[b][i] + lane);
    const Pack now = drill ? old + k.drilling * strain : relaxation[i] * (old + modulus[i] * strain);
    store(varying_[b][i] + lane, now);
    const Pack w = drill ? one : weight[i];
    energy = energy + (0.5 * w) * ((old + now) * strain);
    (drill ? q.drill[i - S::hourglasses] : q.hourglass[i]) = w * now;
  }
  if constexpr (S::nodes == 4)
    for (int i = 0; i < 2; ++i) q.hourglass[i + 2] = q.hourglass[i + 2] + k.offset * q.hourglass[i];
  return energy;
}

template <typename S>
[[gnu::noinline, gnu::noclone]] Pack ShellGroup<S>::resist(std::size_t b, int lane, const NodeArrays& nodes, double dt,
                                                           const Work& work, Rows force, Rows moment) {
  const ShellGeometry<Pack> g = shell_geometry<S>(gather(nodes.position, connectivity_[b], lane), reference(b, lane));
  const Pack t = load(thickness_[b][0] + lane), m = load(mass[b][0] + lane), volume = g.area * t;
  const ShellStiffness<Pack> k = stiffness(b, lane, t);
  ShellResultants<Pack> q{};
  for (int i = 0; i < 3; ++i) {
    q.membrane[i] = g.area * load(work.resultant[i] + lane);
    q.curvature[i] = g.area * load(work.resultant[3 + i] + lane);
  }
  for (int i = 0; i < 2; ++i) q.shear[i] = g.area * load(work.resultant[6 + i] + lane);
  const Pack hourglass = vary(b, lane, g, k, dt, work, q);

  // Viscous pressure in the plane of the middle surface; L^2 = 2/sum |grad N|^2.
  const auto at = [&](int i) { return load(work.increment[i] + lane); };
  const Pack stretch = (at(0) + at(1)) + k.offset * (at(3) + at(4));
  const Pack rate = dt > 0 ? (1.0 / dt) * stretch : load(stretching_[b][0] + lane);
  store(stretching_[b][0] + lane, rate);
  const Pack trace = shell_metric<S>(g).trace, size = (2.0 * S::nodes) / trace;
  ElementScale<Pack> scale{};
  scale.wave_rate = square_root((k.moduli.lambda + 2.0 * k.moduli.shear) * volume / (m * size));
  const Pack intensity = viscosity_.intensity(scale, rate);
  const Pack viscous = m * size * intensity * rate;
  for (int i = 0; i < 2; ++i)
    q.membrane[i] = q.membrane[i] + viscous, q.curvature[i] = q.curvature[i] + k.offset * viscous;

  const ShellForces<Pack> f = shell_forces<S>(g, q);
  store_rows(f.force, g.axes, force);
  store_rows(f.moment, g.axes, moment);
  const Vector<Pack>* rows[3] = {&g.axes.x, &g.axes.y, &g.axes.z};
  for (int i = 0; i < 3; ++i) {
    store(axes_[b][3 * i] + lane, rows[i]->x), store(axes_[b][3 * i + 1] + lane, rows[i]->y);
    store(axes_[b][3 * i + 2] + lane, rows[i]->z);
  }
  if (dt > 0) add_energies(b, lane, volume, hourglass, viscous * stretch, work);

  const Pack inertia = load(inertia_[b][0] + lane);
  const Pack frequency = shell_frequency_squared<S>(g, k, m, inertia);
  const Pack damping = (2.0 * S::nodes) * intensity * (1.0 + k.offset * k.offset / inertia);
  const Pack step = damped_step(frequency, damping, Pack{});
  Pack squared{};
  for (int i = 0; i < 8; ++i) squared = squared + (i < 3 || i > 5 ? at(i) * at(i) : t * t * (at(i) * at(i)));
  const Pack bad = broadcast<Pack>(exploding_element), inverted = broadcast<Pack>(inverted_element);
  const Pack checked = squared < greatest_strain * greatest_strain ? (step > 0.0 ? step : bad) : bad;
  return t > 0.0 ? checked : (t <= 0.0 ? inverted : bad);
}

template <typename S>
TENON_KERNEL void ShellGroup<S>::add_energies(std::size_t b, int lane, const Pack& volume, const Pack& hourglass,
                                              const Pack& viscous, const Work& work) {
  const Pack gone = dead.empty() ? broadcast<Pack>(0.0) : load(dead[b][0] + lane);
  const auto to = [&](ElementValues& values, const Pack& value) { add(values[b], lane, gone == 0.0 ? value : Pack{}); };
  to(hourglass_energy, hourglass);
  to(viscosity_energy, viscous);
  if (!model().plastic()) return;
  const Pack done = load(work.plastic[0] + lane) * volume;
  to(plastic_work, done);
  to(temperature, heating * done / load(mass[b][0] + lane));
}

// A layer that has failed carries nothing; an element dies with half of its layers.
template <typename S>
void ShellGroup<S>::drop_failed_layers(std::size_t b, int point) {
  const double* damage = points.history(b, point)[model().damage()][0];
  for (int l = 0; l < lanes; ++l)
    for (int i = 0; i < 6 && damage[l] >= 1; ++i) points.stress(b, point)[i][l] = 0;
}

template <typename S>
void ShellGroup<S>::bury(std::size_t b, Rows force, Rows moment, Batch<1>& step) {
  for (int l = 0; l < lanes; ++l) {
    int failed = 0;
    for (int p = 0; p < points.points(); ++p) failed += points.history(b, p)[model().damage()][0][l] >= 1 ? 1 : 0;
    if (2 * failed < points.points()) continue;
    dead[b][0][l] = 1;
    for (int p = 0; p < points.points(); ++p)
      for (int i = 0; i < 6; ++i) points.stress(b, p)[i][l] = 0;
    for (int i = 0; i < varying; ++i) varying_[b][i][l] = 0;
    for (int i = 0; i < S::nodes; ++i)
      for (int c = 0; c < pack_width; ++c) force[l][i][c] = moment[l][i][c] = 0;
    step[0][l] = std::numeric_limits<double>::infinity();
  }
}

template class ShellGroup<QuadShell>;
template class ShellGroup<TriShell>;

}  // namespace tenon
