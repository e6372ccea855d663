// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/heat_content.hpp"

#include <algorithm>

namespace tenon::thermal {
namespace {

constexpr double round_off = 1e-9;  // of the melting interval: a temperature so near to its end stands at the end

}  // namespace

double Enthalpy::operator()(double temperature) const {
  const double sensible = specific_heat.integral(temperature);
  if (latent_heat == 0) return sensible;
  return sensible + latent_heat * std::clamp((temperature - solidus) / (liquidus - solidus), 0.0, 1.0);
}

double Enthalpy::slope(double temperature, bool above) const {
  const double sensible = specific_heat(temperature);
  if (latent_heat == 0) return sensible;
  const double width = liquidus - solidus, edge = (above ? -round_off : round_off) * width;
  const bool melting = above ? temperature >= solidus + edge && temperature < liquidus + edge
                             : temperature > solidus + edge && temperature <= liquidus + edge;
  return melting ? sensible + latent_heat / width : sensible;
}

double Enthalpy::stop(double from, double to) const {
  if (latent_heat == 0) return to;
  const double edge = round_off * (liquidus - solidus);
  if (to > from) {
    if (from < solidus - edge && to > solidus) return solidus;
    if (from < liquidus - edge && to > liquidus) return liquidus;
  } else {
    if (from > liquidus + edge && to < liquidus) return liquidus;
    if (from > solidus + edge && to < solidus) return solidus;
  }
  return to;
}

HeatContent::HeatContent(std::vector<Enthalpy> of_block, std::vector<LocalIndex> offsets, std::vector<Share> shares)
    : of_block_(std::move(of_block)), offsets_(std::move(offsets)), shares_(std::move(shares)) {
  linear_ = std::ranges::all_of(of_block_, &Enthalpy::is_linear);
}

double HeatContent::difference(std::size_t row, double from, double to) const {
  double sum = 0;
  for (const Share& s : shares(row)) {
    const Enthalpy& h = of_block_[static_cast<std::size_t>(s.block)];
    sum += s.mass * (h(to) - h(from));
  }
  return sum;
}

double HeatContent::slope(std::size_t row, double temperature, bool above) const {
  double sum = 0;
  for (const Share& s : shares(row))
    sum += s.mass * of_block_[static_cast<std::size_t>(s.block)].slope(temperature, above);
  return sum;
}

double HeatContent::stop(std::size_t row, double from, double to) const {
  double reached = to;
  for (const Share& s : shares(row)) {
    const double own = of_block_[static_cast<std::size_t>(s.block)].stop(from, to);
    reached = to > from ? std::min(reached, own) : std::max(reached, own);
  }
  return reached;
}

std::int64_t HeatContent::memory() const {
  return static_cast<std::int64_t>(offsets_.capacity() * sizeof(LocalIndex) + shares_.capacity() * sizeof(Share));
}

}  // namespace tenon::thermal
