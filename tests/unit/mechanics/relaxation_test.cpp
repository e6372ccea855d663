// SPDX-License-Identifier: BSD-3-Clause
// What the physical hourglass form takes for plastic flow: nothing that is elastic.
#include "components/mechanics/stress_power.hpp"
#include "constraints_case.hpp"

namespace tenon::testing {
namespace {

FoamParameters foam() {
  return {{{0, 0.2e6}, {0.6, 0.5e6}, {0.8, 50e6}}, 1e9};
}

/// A point under uniaxial compression to 1 - V/V0 = `crushed` in small steps, then one step of shear.
struct LockedFoam {
  std::shared_ptr<const MaterialModel> model;
  Batch<6> strain{}, stress{}, before{};
  Batch<1> temperature{}, heating{}, ratio{}, work{}, trial{}, relaxation{};
  std::vector<Batch<1>> history;

  explicit LockedFoam(double crushed) {
    MaterialDescription m = elastic_material(10e6, 0.1, 100);
    m.whole_law = foam();
    model = make_material_model(m);
    history.assign(static_cast<std::size_t>(model->state_size()), Batch<1>{});
    constexpr int steps = 2000;
    double v = 1;
    for (int s = 0; s < steps; ++s) {
      const double next = 1 - crushed * (s + 1) / steps;
      step(0, std::log(next / v), next);
      v = next;
    }
  }
  void step(int component, double increment, double volume_ratio) {
    for (int l = 0; l < lanes; ++l) {
      for (int i = 0; i < 6; ++i) strain[i][l] = i == component ? increment : 0;
      ratio[0][l] = volume_ratio;
    }
    UpdateInput input{strain, temperature, heating, 1e-6};
    input.volume_ratio = &ratio;
    before = stress;
    model->update(input, stress, history.data(), work);
    model->trial_shear(input, trial);
    relaxation_of(before, strain, stress, trial.v[0], relaxation);
  }
};

TEST(Relaxation, OnlyLawsThatFlowHaveAny) {
  const auto flows = [](const MaterialDescription& m) { return make_material_model(m)->flows(); };
  EXPECT_FALSE(flows(steel()));
  EXPECT_TRUE(flows(copper()));
  MaterialDescription m = elastic_material(10e6, 0.1, 100);
  m.whole_law = foam();
  EXPECT_TRUE(flows(m));
  m.whole_law = MooneyRivlinParameters{1e6, 0, 50e6};
  EXPECT_FALSE(flows(m));
  m.whole_law = OrthotropicParameters{1e9, 20e9, 20e9, 0, 0, 0, 1e9, 1e9, 1e9, {1, 0, 0}, {0, 1, 0}};
  EXPECT_FALSE(flows(m));
}

TEST(Relaxation, LockedFoamUnloadsElastically) {
  LockedFoam f(0.75);
  EXPECT_LT(f.relaxation[0][0], 1);  // it is being crushed
  f.step(0, 1e-5, 0.25 * std::exp(1e-5));
  f.step(0, 1e-5, 0.25 * std::exp(2e-5));
  EXPECT_GT(f.trial[0][0], 1.5 * f.model->elasticity().shear_modulus());  // locked
  for (int l = 0; l < lanes; ++l) EXPECT_EQ(f.relaxation[0][l], 1);
  f.step(3, 1e-6, 0.25 * std::exp(2e-5));
  for (int l = 0; l < lanes; ++l) EXPECT_EQ(f.relaxation[0][l], 1);
}

// One element of rubber is bent and stretched, and back: what the hourglass stresses took they give again.
TEST(Relaxation, RubberGivesTheWorkOfBendingBack) {
  MaterialDescription m = elastic_material(6e6, 0.49, 1100);
  m.elastic.reset();
  m.whole_law = MooneyRivlinParameters{0.8e6, 0.2e6, 50e6};
  MechanicsOptions o;
  o.hourglass.form = HourglassOptions::Form::physical;
  o.viscosity = {0, 0};
  PrescribedMotion bend = motion(PrescribedMotion::Kind::rotation, {"x_max"});
  bend.axis = {0, 1, 0}, bend.centre = {1, 0, -1};
  const double end = 4;
  bend.factor = TimeFunction::sine(0.3, end, -0.5 * std::numbers::pi, 0.3);  // from 0 to 0.6 and back
  o.motions = {motion(PrescribedMotion::Kind::fixed, {"x_min"}), bend};
  const auto b = body(shared_mesh(on_root(BoxShape{})), m, o);
  b->initialize();
  double greatest = 0;
  while (b->time() < end) {
    b->advance(std::min(std::min(b->time_step(), 2e-3), end - b->time()));
    greatest = std::max(greatest, energy_rows(*b).at("hourglass_energy"));
  }
  EXPECT_GT(greatest, 1e3);
  EXPECT_LT(std::abs(energy_rows(*b).at("hourglass_energy")), 0.01 * greatest);
}

TEST(Relaxation, OrthotropicBodiesAreToldThatPhysicalHourglassIsIsotropic) {
  MaterialDescription m;
  m.name = "wood", m.density = 700;
  m.whole_law = OrthotropicParameters{1e9, 20e9, 20e9, 0, 0, 0, 1e9, 1e9, 1e9, {1, 0, 0}, {0, 1, 0}};
  MechanicsOptions o;
  o.hourglass.form = HourglassOptions::Form::physical;
  try {
    body(shared_mesh(on_root(BoxShape{})), m, o);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("use formulation: full"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tenon::testing
