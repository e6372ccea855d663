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

// In differences of nodes, so that a uniform motion is exactly zero in all modes but the mean. The modes of a
// quadrilateral are formed before the values are turned into packs: fewer of these then.
template <typename S>
TENON_KERNEL ShellModes<Pack> ShellGroup<S>::gather(const double* values, const Connectivity& c, int lane) {
  const auto row = [&](int node, int l) {
    return load(values + 3 * static_cast<std::ptrdiff_t>(c.node[node][lane + l]));
  };
  if constexpr (S::nodes == 4) {
    Pack mean[4], xi[4], eta[4], hourglass[4];
    const Pack quarter = broadcast<Pack>(0.25);
#pragma GCC unroll 4
    for (int l = 0; l < 4; ++l) {
      const Pack a = row(0, l), b = row(1, l), d = row(2, l), e = row(3, l);
      const Pack up = d - a, down = e - b;
      mean[l] = quarter * ((a + b) + (d + e));
      xi[l] = quarter * (up - down), eta[l] = quarter * (up + down), hourglass[l] = quarter * ((a - b) + (d - e));
    }
    transpose(mean[0], mean[1], mean[2], mean[3]), transpose(xi[0], xi[1], xi[2], xi[3]);
    transpose(eta[0], eta[1], eta[2], eta[3]), transpose(hourglass[0], hourglass[1], hourglass[2], hourglass[3]);
    return {{mean[0], mean[1], mean[2]},
            {xi[0], xi[1], xi[2]},
            {eta[0], eta[1], eta[2]},
            {hourglass[0], hourglass[1], hourglass[2]}};
  }
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
[[gnu::noinline, gnu::noclone]] void ShellGroup<S>::place(const double* position, const Connectivity& c, int lane,
                                                          Work& work) {
  const ShellModes<Pack> x = gather(position, c, lane);
  const Pack values[9] = {x.xi.x,  x.xi.y,        x.xi.z,        x.eta.x,      x.eta.y,
                          x.eta.z, x.hourglass.x, x.hourglass.y, x.hourglass.z};
#pragma GCC unroll 9
  for (int i = 0; i < 9; ++i) store(work.place[i] + lane, values[i]);
}
template <typename S>
TENON_KERNEL ShellModes<Pack> ShellGroup<S>::placed(const Work& work, int lane) {
  const auto at = [&](int i) { return load(work.place[i] + lane); };
  using V = Vector<Pack>;
  return {V{}, V{at(0), at(1), at(2)}, V{at(3), at(4), at(5)}, V{at(6), at(7), at(8)}};
}

template <typename S>
TENON_KERNEL void ShellGroup<S>::store_rows(const ShellModes<Pack>& f, const Tensor<Pack>& axes, Rows rows) {
  const auto global = [&](const Vector<Pack>& a) { return a.x * axes.x + a.y * axes.y + a.z * axes.z; };
  Vector<Pack> shares[4];
  S::share({global(f.mean), global(f.xi), global(f.eta), global(f.hourglass)}, shares);
#pragma GCC unroll 4
  for (int i = 0; i < S::nodes; ++i) {
    Pack a = shares[i].x, b = shares[i].y, c = shares[i].z, d = Pack{};
    transpose(a, b, c, d);
    store(rows[0][i], a), store(rows[1][i], b), store(rows[2][i], c), store(rows[3][i], d);
  }
}

// Element after element: the canonical order.
template <typename S>
TENON_KERNEL void ShellGroup<S>::scatter(const double (*force)[S::nodes][pack_width],
                                         const double (*moment)[S::nodes][pack_width], const Connectivity& c, int count,
                                         const NodeArrays& nodes) {
  for (int l = 0; l < count; ++l) {
#pragma GCC unroll 4
    for (int i = 0; i < S::nodes; ++i) {
      const std::ptrdiff_t at = 4 * static_cast<std::ptrdiff_t>(c.node[i][l]);
      store(nodes.force + at, load(nodes.force + at) + load(force[l][i]));
      store(nodes.moment + at, load(nodes.moment + at) + load(moment[l][i]));
    }
  }
}

template <typename S>
GroupStep ShellGroup<S>::advance(const NodeArrays& nodes, double dt) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Batch<1> least, where;
  for (int l = 0; l < lanes; ++l) least[0][l] = infinity, where[0][l] = 0;
  position_ = reinterpret_cast<const Vec3*>(nodes.position);
  for (std::size_t b = 0; b < batches(); ++b) advance_batch(b, nodes, dt, least, where);
  GroupStep result{infinity, no_index};
  for (int l = 0; l < lanes && batches() > 0; ++l) {
    const LocalIndex element = std::min(static_cast<LocalIndex>(where[0][l]) * lanes + l, size() - 1);
    const bool first = least[0][l] < result.step || (least[0][l] == result.step && element < result.element);
    if (first) result = {least[0][l], element};
  }
  return result;
}

namespace {

/// Asks for the cache lines of an object that will be read and written.
template <typename T>
TENON_KERNEL void fetch_lines(const T& object) {
  const char* from = reinterpret_cast<const char*>(&object);
  for (std::size_t i = 0; i < sizeof object; i += 64) __builtin_prefetch(from + i, 1);
}

}  // namespace

template <typename S>
void ShellGroup<S>::fetch(std::size_t b) const {
  for (int p = 0; p < points.points(); ++p) {
    const Batch<6>& s = points.stress(b, p);
    for (const int i : {0, 1, 3, 4, 5}) __builtin_prefetch(s[i], 1);
  }
  const Batch<1>* history = points.history(b, 0);
  for (int i = 0; i < points.points() * model().state_size(); ++i) __builtin_prefetch(history[i][0], 1);
  fetch_lines(varying_[b]), fetch_lines(reference_[b]), fetch_lines(connectivity_[b]);
  for (const ElementValues* v : {&thickness_, &stretching_, &slowness_, &mass, &temperature, &temperature_used,
                                 &plastic_work, &hourglass_energy, &viscosity_energy})
    __builtin_prefetch((*v)[b][0], 1);
}

template <typename S>
void ShellGroup<S>::advance_batch(std::size_t b, const NodeArrays& nodes, double dt, Batch<1>& least, Batch<1>& where) {
  if (b + 1 < batches()) fetch(b + 1);
  if (dt > 0 && !doomed.empty()) settle(b);
  Work work;
  for (int lane = 0; lane < lanes; lane += pack_width) place(nodes.position, connectivity_[b], lane, work);
  if (dt > 0) {
    Batch<1> temperature_increment;
    for (int lane = 0; lane < lanes; lane += pack_width) deform(b, lane, nodes, dt, work, temperature_increment);
    update_material(b, dt, temperature_increment, work);
  } else {
    clear(work.strain), clear(work.variation);
  }
  for (int lane = 0; lane < lanes; lane += pack_width) add_layers(b, lane, work);
  alignas(64) double force[lanes][S::nodes][pack_width], moment[lanes][S::nodes][pack_width];
  Batch<1> step;
  for (int lane = 0; lane < lanes; lane += pack_width)
    store(step[0] + lane, resist(b, lane, dt, work, force + lane, moment + lane));
  if (!dead.empty()) bury(b, force, moment, step);
  for (int lane = 0; lane < lanes; lane += pack_width) {
    const Pack now = load(step[0] + lane), before = load(least[0] + lane);
    store(least[0] + lane, now < before ? now : before);
    store(where[0] + lane, now < before ? broadcast<Pack>(static_cast<double>(b)) : load(where[0] + lane));
  }
  if (!steps.empty()) steps[b] = step;
  scatter(force, moment, connectivity_[b], count(b), nodes);
}

// In the geometry half a step back, where a rigid rotation by any angle strains nothing [HW80].
template <typename S>
[[gnu::noinline, gnu::noclone]] void ShellGroup<S>::deform(std::size_t b, int lane, const NodeArrays& nodes, double dt,
                                                           Work& work, Batch<1>& temperature_increment) {
  const ShellModes<Pack> v = gather(nodes.velocity, connectivity_[b], lane);
  const ShellGeometry<Pack> g = shell_geometry<S>(moved(placed(work, lane), v, -0.5 * dt), reference(b, lane));
  const ShellModes<Pack> w = gather(nodes.spin, connectivity_[b], lane);
  const ShellRates<Pack> r = shell_rates<S>(g, turned(g.axes, v), turned(g.axes, w));
  const Pack t = load(thickness_[b][0] + lane), out = offset(t), half = (0.5 * dt) * t;
  for (int i = 0; i < 3; ++i) {
    store(work.strain[i] + lane, dt * (r.membrane[i] + out * r.curvature[i]));
    store(work.strain[3 + i] + lane, half * r.curvature[i]);
  }
  for (int i = 0; i < 2; ++i) {
    const Pack shear = dt * r.shear[i];
    store(work.strain[6 + i] + lane, S::nodes == 4 ? shear : load(shear_share_[b][0] + lane) * shear);
  }
  for (int i = 0; i < S::hourglasses; ++i) {
    // Membrane strain is that of the middle surface.
    const Pack strain = S::nodes == 4 && i < 2 ? r.hourglass[i] + out * r.hourglass[i + 2] : r.hourglass[i];
    store(work.variation[i] + lane, dt * strain);
  }
  for (int i = 0; i < S::drills; ++i) store(work.variation[S::hourglasses + i] + lane, dt * r.drill[i]);
  const Pack now = load(temperature[b][0] + lane), used = load(temperature_used[b][0] + lane);
  store(temperature_increment[0] + lane, now - used);
  if (any(now != used)) store(temperature_used[b][0] + lane, now);
}

template <typename S>
void ShellGroup<S>::update_material(std::size_t b, double dt, const Batch<1>& temperature_increment, Work& work) {
  if (law_) {
    Batch<1>* history = model().state_size() > 0 ? points.history(b, 0) : nullptr;
    const LayerInput input{work.strain, temperature_increment, rule_.place, rule_.weight, bending_};
    law_->update(input, &points.stress(b, 0), history, work.flow);
  } else {
    update_layers(b, dt, temperature_increment, work);
  }
  for (int lane = 0; lane < lanes; lane += pack_width) {
    const Pack t = load(thickness_[b][0] + lane);
    store(thickness_[b][0] + lane, t + t * load(work.flow.thinning[0] + lane));
  }
}

template <typename S>
void ShellGroup<S>::update_layers(std::size_t b, double dt, const Batch<1>& temperature_increment, Work& work) {
  const bool plastic = model().plastic();
  clear(work.flow.thinning), clear(work.flow.plastic_work), clear(work.flow.squash), clear(work.flow.bend);
  Batch<2> greatest{};
  for (int p = 0; p < points.points(); ++p) {
    Batch<6> strain;
    for (int lane = 0; lane < lanes; lane += pack_width) layer_strain(lane, p, work, strain);
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
}

template <typename S>
[[gnu::noinline, gnu::noclone]] void ShellGroup<S>::layer_strain(int lane, int point, const Work& work,
                                                                 Batch<6>& strain) const {
  const double place = rule_.place[static_cast<std::size_t>(point)];
  const auto at = [&](int i) { return load(work.strain[i] + lane); };
  store(strain[0] + lane, at(0) + place * at(3));
  store(strain[1] + lane, at(1) + place * at(4));
  store(strain[2] + lane, Pack{});
  store(strain[3] + lane, 0.5 * (at(2) + place * at(5)));
  store(strain[4] + lane, 0.5 * at(7));
  store(strain[5] + lane, 0.5 * at(6));
}

template <typename S>
[[gnu::noinline, gnu::noclone]] void ShellGroup<S>::add_flow(int lane, int point, const Batch<1>& thinning,
                                                             const Batch<1>& plastic, const Batch<1>& relaxation,
                                                             Work& work) const {
  const double weight = rule_.weight[static_cast<std::size_t>(point)];
  const Pack r = load(relaxation[0] + lane);
  add(work.flow.thinning, lane, weight * load(thinning[0] + lane));
  add(work.flow.plastic_work, lane, weight * load(plastic[0] + lane));
  add(work.flow.squash, lane, weight * r);
  add(work.flow.bend, lane, bending_[static_cast<std::size_t>(point)] * r);
}

/// Forces and moments per length from the layers' stresses, over thickness and thickness squared/2.
template <typename S>
[[gnu::noinline, gnu::noclone]] void ShellGroup<S>::add_layers(std::size_t b, int lane, Work& work) const {
  const Batch<6>* layers = &points.stress(b, 0);
  Pack n[8]{};
  for (std::size_t p = 0; p < rule_.place.size(); ++p) {
    const Batch<6>& s = layers[p];
    const Pack weight = broadcast<Pack>(rule_.weight[p]), lever = broadcast<Pack>(rule_.weight[p] * rule_.place[p]);
    const Pack xx = load(s[0] + lane), yy = load(s[1] + lane), xy = load(s[3] + lane);
    n[0] += weight * xx, n[1] += weight * yy, n[2] += weight * xy;
    n[3] += lever * xx, n[4] += lever * yy, n[5] += lever * xy;
    n[6] += weight * load(s[5] + lane), n[7] += weight * load(s[4] + lane);
  }
#pragma GCC unroll 8
  for (int i = 0; i < 8; ++i) store(work.resultant[i] + lane, n[i]);
}

/// Energy within the layers, which a failing element leaves behind: as `add_stress_power`, shear as corrected.
template <typename S>
void ShellGroup<S>::add_energy(std::size_t b, int point, const Batch<6>& before, const Batch<6>& strain) {
  const Batch<6>& now = points.stress(b, point);
  for (int l = 0; l < lanes; ++l) {
    const auto power = [&](int i) { return (before[i][l] + now[i][l]) * strain[i][l]; };
    const double shear = (5.0 / 3.0) * (power(4) + power(5)) / shear_share_[b][0][l];
    const double work = 0.5 * reference_volume_[b][0][l] * rule_.weight[static_cast<std::size_t>(point)] *
                        (power(0) + power(1) + 2 * power(3) + shear);
    internal_energy[b][0][l] += dead[b][0][l] == 0 ? work : 0.0;
  }
}

template <typename S>
TENON_KERNEL ShellStiffness<Pack> ShellGroup<S>::stiffness(std::size_t b, int lane, const Pack& t) const {
  PlaneModuli<Pack> moduli{broadcast<Pack>(plane_moduli_.lambda), broadcast<Pack>(plane_moduli_.shear),
                           broadcast<Pack>(plane_moduli_.young)};
  if (!moduli_.empty()) moduli = plane_moduli(load(moduli_[b][0] + lane), load(moduli_[b][1] + lane));
  const Pack share = S::nodes == 4 ? broadcast<Pack>(1.0) : load(shear_share_[b][0] + lane);
  return {moduli,
          t,
          second_moment_ * t * t,
          offset(t),
          (5.0 / 6.0) * share * moduli.shear,
          (drilling / 12) * moduli.young * t * t * t,
          offset_share_ == 0 && offset_ == 0};
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
  const Pack squash = dt > 0 ? load(work.flow.squash[0] + lane) : one;
  const Pack g11 = dot(g.g1, g.g1), g22 = dot(g.g2, g.g2);
  if constexpr (S::nodes == 4) {
    const Pack third = (1.0 / 3.0) * volume, squared = k.thickness * k.thickness;
    const Pack soft = greater_of(squared / (squared + g.h.z * g.h.z), broadcast<Pack>(0.05));
    const Pack bend = dt > 0 && second_moment_ > 0 ? load(work.flow.bend[0] + lane) : one;
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
[[gnu::noinline, gnu::noclone]] Pack ShellGroup<S>::resist(std::size_t b, int lane, double dt, const Work& work,
                                                           Rows force, Rows moment) {
  const ShellGeometry<Pack> g = shell_geometry<S>(placed(work, lane), reference(b, lane));
  const Pack t = load(thickness_[b][0] + lane), m = load(mass[b][0] + lane), volume = g.area * t;
  const ShellStiffness<Pack> k = stiffness(b, lane, t);
  // Viscous pressure in the plane of the middle surface; L^2 = 2/sum |grad N|^2.
  const Pack stretch = load(work.strain[0] + lane) + load(work.strain[1] + lane);
  const Pack rate = dt > 0 ? (1.0 / dt) * stretch : load(stretching_[b][0] + lane);
  store(stretching_[b][0] + lane, rate);
  const Pack trace = shell_metric<S>(g).trace, size = (2.0 * S::nodes) / trace;
  const Pack modulus = (0.5 / S::nodes) * (k.moduli.lambda + 2.0 * k.moduli.shear);
  ElementScale<Pack> scale{};
  scale.wave_rate = square_root(modulus * trace * volume * (1.0 / m));
  const Pack intensity = viscosity_.intensity(scale, rate);
  // The step before the forces: a long chain of roots, during which the machine can work on these.
  const Pack slow = load(slowness_[b][0] + lane);
  const Pack frequency = shell_frequency_squared<S>(g, k, m, slow);
  const Pack damping = (2.0 * S::nodes) * intensity * (1.0 + k.offset * k.offset * slow);
  const Pack step = check(damped_step(frequency, damping, Pack{}), t, work, lane);

  ShellResultants<Pack> q;
  const Pack viscous = m * size * intensity * rate;
  const auto mean = [&](int i) { return load(work.resultant[i] + lane); };
  for (int i = 0; i < 3; ++i) {
    q.membrane[i] = i < 2 ? volume * mean(i) + viscous : volume * mean(i);
    q.curvature[i] = k.offset * q.membrane[i] + (0.5 * volume) * (t * mean(3 + i));
  }
  for (int i = 0; i < 2; ++i) q.shear[i] = (5.0 / 6.0) * volume * mean(6 + i);
  const Pack hourglass = vary(b, lane, g, k, dt, work, q);
  const ShellForces<Pack> f = shell_forces<S>(g, q);
  store_rows(f.force, g.axes, force);
  store_rows(f.moment, g.axes, moment);
  if (dt > 0) add_energies(b, lane, volume, hourglass, viscous * stretch, work);
  return step;
}

/// The step, or a code.
template <typename S>
TENON_KERNEL Pack ShellGroup<S>::check(const Pack& step, const Pack& t, const Work& work, int lane) const {
  Pack squared{};
  for (int i = 0; i < 8; ++i) {
    const Pack strain = load(work.strain[i] + lane);
    squared = squared + strain * strain;
  }
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
  const Pack done = load(work.flow.plastic_work[0] + lane) * volume;
  to(plastic_work, done);
  if (heating != 0) to(temperature, heating * done / load(mass[b][0] + lane));
}

// A layer that has failed carries nothing; an element dies with half of its layers.
template <typename S>
void ShellGroup<S>::drop_failed_layers(std::size_t b, int point) {
  if (model().damage() < 0) return;
  const double* damage = points.history(b, point)[model().damage()][0];
  for (int l = 0; l < lanes; ++l)
    for (int i = 0; i < 6 && damage[l] >= 1; ++i) points.stress(b, point)[i][l] = 0;
}

template <typename S>
void ShellGroup<S>::bury(std::size_t b, Rows force, Rows moment, Batch<1>& step) {
  for (int l = 0; l < lanes; ++l) {
    int failed = 0;
    for (int p = 0; p < points.points() && model().damage() >= 0; ++p)
      failed += points.history(b, p)[model().damage()][0][l] >= 1 ? 1 : 0;
    if (dead[b][0][l] == 0 && 2 * failed < points.points()) continue;
    die(b, l);
    for (int p = 0; p < points.points(); ++p)
      for (int i = 0; i < 6; ++i) points.stress(b, p)[i][l] = 0;
    for (int i = 0; i < varying; ++i) varying_[b][i][l] = 0;
    for (int i = 0; i < S::nodes; ++i)
      for (int c = 0; c < pack_width; ++c) force[l][i][c] = moment[l][i][c] = 0;
    step[0][l] = std::numeric_limits<double>::infinity();
  }
  if (doomed.empty()) return;
  Batch<1> inverted;
  doom(b, step, inverted);
  for (int l = 0; l < lanes; ++l)
    for (int i = 0; i < S::nodes && inverted[0][l] != 0; ++i)
      for (int c = 0; c < pack_width; ++c) force[l][i][c] = moment[l][i][c] = 0;
}

template class ShellGroup<QuadShell>;
template class ShellGroup<TriShell>;

}  // namespace tenon
