// SPDX-License-Identifier: BSD-3-Clause
// Laws that update all layers in one call, against the material layer by layer.
#include "components/materials/layer_law.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "components/materials/material.hpp"
#include "components/materials/material_model.hpp"

namespace tenon {
namespace {

constexpr std::size_t layers = 5;

MaterialDescription metal(double nu, double yield, double hardening) {
  MaterialDescription d;
  d.name = "metal", d.density = 7850, d.elastic = Elasticity{210e9, nu, 1.2e-5};
  if (yield > 0) d.plasticity = LinearHardeningParameters{yield, hardening};
  return d;
}

struct Points {
  std::array<Batch<6>, layers> stress{};
  std::array<Batch<1>, layers> eqps{};
};

const std::vector<double> place{-0.9, -0.5, 0, 0.5, 0.9}, weight{0.1, 0.2, 0.4, 0.2, 0.1};
std::vector<double> bending() {
  std::vector<double> shares;
  double sum = 0;
  for (std::size_t p = 0; p < layers; ++p) sum += weight[p] * place[p] * place[p];
  for (std::size_t p = 0; p < layers; ++p) shares.push_back(weight[p] * place[p] * place[p] / sum);
  return shares;
}

void fill(std::mt19937& random, double size, Batch<8>& strain, Batch<1>& heat) {
  std::normal_distribution<double> u(0, size);
  for (int l = 0; l < lanes; ++l) {
    for (int i = 0; i < 8; ++i) strain[i][l] = u(random);
    heat[0][l] = 1e3 * u(random);
  }
}

/// One step of the material itself; gives the thinning and the plastic work.
std::array<Batch<1>, 2> step_by_layers(const MaterialModel& model, const Batch<8>& strain, const Batch<1>& heat,
                                       Points& points) {
  std::array<Batch<1>, 2> sums{};
  for (std::size_t p = 0; p < layers; ++p) {
    Batch<6> e{};
    Batch<1> temperature{}, work{}, thinning{};
    for (int l = 0; l < lanes; ++l) {
      const auto at = [&](int i) { return strain[i][l] + place[p] * strain[i + 3][l]; };
      e[0][l] = at(0), e[1][l] = at(1), e[3][l] = 0.5 * at(2), e[4][l] = 0.5 * strain[7][l];
      e[5][l] = 0.5 * strain[6][l];
    }
    model.update_plane_stress({e, temperature, heat, 1e-6}, points.stress[p], &points.eqps[p], work, thinning);
    for (int l = 0; l < lanes; ++l)
      sums[0][0][l] += weight[p] * thinning[0][l], sums[1][0][l] += weight[p] * work[0][l];
  }
  return sums;
}

TEST(LayerLaw, AgreesWithTheMaterial) {
  for (const double nu : {0.0, 0.3, 0.49})
    for (const double yield : {0.0, 400e6})
      for (const double hardening : {0.0, 1e9, 200e9})
        for (const double size : {1e-4, 1e-3, 3e-2}) {
          const MaterialDescription d = metal(nu, yield, hardening);
          const auto law = make_layer_law(d);
          const auto model = make_material_model(d);
          ASSERT_TRUE(law);
          std::mt19937 random(5);
          Points a, b;
          const std::vector<double> shares = bending();
          for (int step = 0; step < 20; ++step) {
            Batch<8> strain;
            Batch<1> heat;
            fill(random, size, strain, heat);
            const auto sums = step_by_layers(*model, strain, heat, a);
            LayerOutput output;
            law->update({strain, heat, place, weight, shares}, b.stress.data(), b.eqps.data(), output);
            for (int l = 0; l < lanes; ++l) {
              const double scale = 1e-11 * 210e9 * size * (step + 1);
              for (std::size_t p = 0; p < layers; ++p) {
                for (int i = 0; i < 6; ++i) EXPECT_NEAR(b.stress[p][i][l], a.stress[p][i][l], scale);
                EXPECT_NEAR(b.eqps[p][0][l], a.eqps[p][0][l], 1e-11 * size * (step + 1));
              }
              EXPECT_NEAR(output.thinning[0][l], sums[0][0][l], 1e-11 * size * (step + 1));
              EXPECT_NEAR(output.plastic_work[0][l], sums[1][0][l], 1e-10 * (sums[1][0][l] + 210e9 * size * size));
              EXPECT_LE(output.squash[0][l], 1);
              EXPECT_GT(output.squash[0][l], 0);
            }
          }
        }
}

// What a point gets must not depend on its neighbours, nor on its place in the batch.
TEST(LayerLaw, PointsDoNotSeeEachOther) {
  const auto law = make_layer_law(metal(0.3, 400e6, 1e9));
  const std::vector<double> shares = bending();
  std::mt19937 random(8);
  for (const double size : {1e-3, 1e-2}) {
    Batch<8> strain;
    Batch<1> heat;
    fill(random, size, strain, heat);
    for (int l = 0; l < lanes; l += 3)
      for (int i = 0; i < 8; ++i) strain[i][l] *= 1e-3;  // some elastic
    Points all;
    LayerOutput output;
    law->update({strain, heat, place, weight, shares}, all.stress.data(), all.eqps.data(), output);
    for (int l = 0; l < lanes; ++l) {
      Batch<8> alone;
      Batch<1> alone_heat;
      for (int k = 0; k < lanes; ++k) {
        for (int i = 0; i < 8; ++i) alone[i][k] = strain[i][l];
        alone_heat[0][k] = heat[0][l];
      }
      Points one;
      LayerOutput its;
      law->update({alone, alone_heat, place, weight, shares}, one.stress.data(), one.eqps.data(), its);
      for (const int k : {0, 7}) {
        for (std::size_t p = 0; p < layers; ++p) {
          for (int i = 0; i < 6; ++i) EXPECT_EQ(one.stress[p][i][k], all.stress[p][i][l]);
          EXPECT_EQ(one.eqps[p][0][k], all.eqps[p][0][l]);
        }
        EXPECT_EQ(its.thinning[0][k], output.thinning[0][l]);
        EXPECT_EQ(its.plastic_work[0][k], output.plastic_work[0][l]);
        EXPECT_EQ(its.squash[0][k], output.squash[0][l]);
        EXPECT_EQ(its.bend[0][k], output.bend[0][l]);
      }
    }
  }
}

TEST(LayerLaw, OnlyWhereItIsTheSameLaw) {
  MaterialDescription d = metal(0.3, 400e6, 1e9);
  d.failure.emplace().plastic_strain = 0.1;
  EXPECT_FALSE(make_layer_law(d));
  d = metal(0.3, 0, 0);
  d.plasticity = VoceHardeningParameters{};
  EXPECT_FALSE(make_layer_law(d));
}

}  // namespace
}  // namespace tenon
