// SPDX-License-Identifier: BSD-3-Clause
// Shells before the first step, and what others ask of them.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "components/mechanics/shell4_group.hpp"

namespace tenon {

namespace {

template <typename S>
ShellModes<double> modes_at(std::span<const LocalIndex> nodes, const Vec3* x) {
  Vector<double> p[4]{};
  const Vec3& origin = x[nodes[0]];
  for (std::size_t i = 1; i < static_cast<std::size_t>(S::nodes); ++i) {
    const Vec3 d = x[nodes[i]] - origin;
    p[i] = {d[0], d[1], d[2]};
  }
  return S::template modes<double>({origin[0], origin[1], origin[2]}, p[1], p[2], p[3]);
}

template <typename S>
double shell_area(const ShellModes<double>& x) {
  const Vector<double> n = cross(x.xi, x.eta);
  return S::area * std::sqrt(dot(n, n));
}

double offset_share(const ShellSection& section) {
  if (section.reference == ShellSection::Reference::top) return -0.5;
  return section.reference == ShellSection::Reference::bottom ? 0.5 : 0.0;
}

}  // namespace

template <typename S>
ShellGroup<S>::ShellGroup(std::size_t block, const ElementBlock& elements, std::span<const Vec3> coordinates,
                          const MaterialDescription& description, const ShellSection& section, int layers,
                          const BulkViscosity& viscosity)
    : ElementGroup(block, elements, description, layers),
      rule_(through_thickness(section.rule, layers)),
      bending_(rule_.place.size()),
      law_(make_layer_law(description)),
      second_moment_(rule_.second_moment()),
      offset_share_(offset_share(section)),
      offset_(section.reference == ShellSection::Reference::at ? section.offset : 0.0),
      viscosity_(viscosity),
      connectivity_(batches()),
      reference_(batches()),
      slowness_(batches()),
      shear_share_(batches()),
      thickness_(batches()),
      reference_volume_(dead.size()),
      stretching_(batches()),
      varying_(batches()),
      position_(coordinates.data()),
      moduli_(model().variable_stiffness() ? batches() : 0) {
  const Elasticity& elasticity = model().elasticity();
  for (int l = 0; l < lanes; ++l)
    constant_moduli_[0][l] = elasticity.lame_lambda(), constant_moduli_[1][l] = elasticity.shear_modulus();
  plane_moduli_ = plane_moduli(elasticity.lame_lambda(), elasticity.shear_modulus());
  for (std::size_t p = 0; p < bending_.size() && second_moment_ > 0; ++p)
    bending_[p] = 0.25 * rule_.weight[p] * rule_.place[p] * rule_.place[p] / second_moment_;
  for (LocalIndex e = 0; e < static_cast<LocalIndex>(batches()) * lanes; ++e) {
    for (int i = 0; i < S::nodes; ++i)
      connectivity_[static_cast<std::size_t>(e / lanes)].node[i][e % lanes] = node(e, i);
    set_reference(e, coordinates, section);
  }
  for (Batch<2>& moduli : moduli_) moduli = constant_moduli_;
  // What turns with the material starts in the axes of the body.
  for (std::size_t b = 0; b < batches(); ++b) {
    Batch<9> axes;
    for (int l = 0; l < lanes; ++l) {
      const LocalIndex element = std::min(static_cast<LocalIndex>(b) * lanes + l, size() - 1);
      const Tensor<double> a = provisional_axes(modes_at<S>(elements.nodes(element), coordinates.data()));
      const double rows[9] = {a.x.x, a.x.y, a.x.z, a.y.x, a.y.y, a.y.z, a.z.x, a.z.y, a.z.z};
      for (int i = 0; i < 9; ++i) axes[i][l] = rows[i];
    }
    for (int p = 0; p < layers; ++p)
      for (int lane = 0; lane < lanes; lane += pack_width) {
        const auto row = [&](int i) { return load(axes[i] + lane); };
        points.rotate_history(points.history(b, p),
                              {{row(0), row(1), row(2)}, {row(3), row(4), row(5)}, {row(6), row(7), row(8)}}, lane);
      }
  }
}

template <typename S>
void ShellGroup<S>::set_reference(LocalIndex element, std::span<const Vec3> coordinates, const ShellSection& section) {
  const std::span<const LocalIndex> nodes = elements().nodes(std::min(element, size() - 1));
  const ShellModes<double> x = modes_at<S>(nodes, coordinates.data());
  const Tensor<double> axes = provisional_axes(x);
  const auto b = static_cast<std::size_t>(element / lanes);
  const int l = element % lanes;
  const double start[4] = {dot(axes.x, x.xi), dot(axes.y, x.xi), dot(axes.x, x.eta), dot(axes.y, x.eta)};
  for (int i = 0; i < 4; ++i) reference_[b][i][l] = start[i];
  Vec3 centre{};
  for (const LocalIndex n : nodes) centre = centre + (1.0 / S::nodes) * coordinates[static_cast<std::size_t>(n)];
  const double area = shell_area<S>(x);
  const double t = section.thickness_field ? section.thickness_field(centre) : section.thickness;
  thickness_[b][0][l] = t;
  if (!reference_volume_.empty()) reference_volume_[b][0][l] = area * t;
  value_of(mass, element) = t > 0 ? material().density * area * t : 0.0;  // none is reported by the component
  // Thin triangles would lock in shear: [LSV93] takes t^2/(t^2 + 0.1 h^2) of it, h^2 twice the area.
  shear_share_[b][0][l] = S::nodes == 4 ? 1.0 : 1 / (1 + 0.2 * area / (t * t));
  slowness_[b][0][l] = 1 / rotary_inertia(area, std::max(second_moment_, 1.0 / 12) * t * t, offset_share_ * t + offset_,
                                          model().elasticity().poissons_ratio);
}

template <typename S>
void ShellGroup<S>::add_masses(const NodalMasses& masses) const {
  ElementGroup::add_masses(masses);
  for (LocalIndex e = 0; e < size(); ++e) {
    const double share = value_of(mass, e) / (S::nodes * value_of(slowness_, e));
    for (const LocalIndex n : elements().nodes(e)) masses.inertia[static_cast<std::size_t>(n)] += share;
  }
}

template <typename S>
double ShellGroup<S>::volume(LocalIndex element, std::span<const Vec3> positions) const {
  return shell_area<S>(modes_at<S>(elements().nodes(element), positions.data())) * thickness(element);
}

/// Component of the stress s, given in the element's own axes, in the axes of the body.
template <typename S>
double ShellGroup<S>::in_body_axes(LocalIndex element, const double (&s)[6], int component) const {
  constexpr int first[6] = {0, 1, 2, 0, 1, 2}, second[6] = {0, 1, 2, 1, 2, 0};
  constexpr int index[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  const Batch<4>& r = reference_[static_cast<std::size_t>(element / lanes)];
  const int l = element % lanes;
  const ShellModes<double> x = modes_at<S>(elements().nodes(element), position_);
  const Tensor<double> a = shell_geometry<S>(x, ShellReference<double>{r[0][l], r[1][l], r[2][l], r[3][l]}).axes;
  const double axes[3][3] = {{a.x.x, a.x.y, a.x.z}, {a.y.x, a.y.y, a.y.z}, {a.z.x, a.z.y, a.z.z}};
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) sum += axes[i][first[component]] * s[index[i][k]] * axes[k][second[component]];
  return sum;
}

template <typename S>
double ShellGroup<S>::stress(LocalIndex element, int component) const {
  double mean[6]{};
  const auto b = static_cast<std::size_t>(element / lanes);
  for (int p = 0; p < points.points(); ++p)
    for (int i = 0; i < 6; ++i)
      mean[i] += rule_.weight[static_cast<std::size_t>(p)] * points.stress(b, p)[i][element % lanes];
  return in_body_axes(element, mean, component);
}

template <typename S>
double ShellGroup<S>::face_stress(LocalIndex element, int component, bool top) const {
  double outer[6];
  const auto b = static_cast<std::size_t>(element / lanes);
  for (int i = 0; i < 6; ++i) outer[i] = points.stress(b, top ? points.points() - 1 : 0)[i][element % lanes];
  return in_body_axes(element, outer, component);
}

// Only the way layer by layer knows the energy within.
template <typename S>
void ShellGroup<S>::erode(const ErosionOptions& options) {
  ElementGroup::erode(options);
  law_.reset();
  if (!reference_volume_.empty()) return;
  reference_volume_ = mass;
  for (Batch<1>& volume : reference_volume_)
    for (int l = 0; l < lanes; ++l) volume[0][l] /= material().density;
}

template <typename S>
std::vector<StateArray> ShellGroup<S>::state() {
  std::vector<StateArray> arrays = ElementGroup::state();
  arrays.push_back({"thickness", 1, thickness_.data()});
  arrays.push_back({"stretching", 1, stretching_.data()});
  arrays.push_back({"varying_stress", varying, reinterpret_cast<Batch<1>*>(varying_.data())});
  if (!moduli_.empty()) arrays.push_back({"moduli", 2, reinterpret_cast<Batch<1>*>(moduli_.data())});
  return arrays;
}

template <typename S>
std::int64_t ShellGroup<S>::memory() const {
  const std::size_t batch = sizeof(Connectivity) + sizeof(Batch<4>) + 4 * sizeof(Batch<1>) + sizeof(Batch<varying>);
  return ElementGroup::memory() + static_cast<std::int64_t>(batches() * batch + moduli_.size() * sizeof(Batch<2>));
}

template class ShellGroup<QuadShell>;
template class ShellGroup<TriShell>;

std::unique_ptr<ElementGroup> make_shell_group(std::size_t block, const ElementBlock& elements,
                                               std::span<const Vec3> coordinates, const MaterialDescription& material,
                                               const ShellSection& section, const BulkViscosity& viscosity) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ExitCode::usage, fmt::format("block '{}' consists of shells: {}", elements.name, why));
  };
  if (!section.given()) refuse("give it a thickness (shell: {thickness: ...} of the block)");
  const std::shared_ptr<const MaterialModel> model = make_material_model(material);
  if (model->needs_deformation_gradient() || model->needs_volume_ratio() || model->needs_added_heat())
    refuse(
        fmt::format("material '{}' finds its stress from the volume or from the deformation gradient, which shells "
                    "do not have; take an elastic or plastic material",
                    material.name));
  const int points = section.points > 0 ? section.points : (model->plastic() ? 5 : 3);
  const int least = section.rule == ShellSection::Rule::lobatto ? 3 : 1;
  if (points < least || points > 10)
    refuse(fmt::format("{} points through the thickness; expected {} to 10", points, least));
  if (elements.kind == ElementKind::quad4)
    return std::make_unique<ShellGroup<QuadShell>>(block, elements, coordinates, material, section, points, viscosity);
  return std::make_unique<ShellGroup<TriShell>>(block, elements, coordinates, material, section, points, viscosity);
}

}  // namespace tenon
