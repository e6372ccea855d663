// SPDX-License-Identifier: BSD-3-Clause
#include "components/sph/home_exchange.hpp"

#include <algorithm>
#include <utility>

namespace tenon {

HomeExchange::HomeExchange(const Mesh& mesh, const ParticleData& particles, std::string name)
    : mesh_(mesh), particles_(particles), name_(std::move(name)) {}

void HomeExchange::follow(std::int64_t version) {
  if (version == version_) return;
  version_ = version;
  plan_ = ExchangePlan::to_ranks(mesh_.comm, std::span<const int>(particles_.home_rank), name_ + " home");
  node_.resize(static_cast<std::size_t>(plan_.received()));
  plan_.forward(std::span<const LocalIndex>(particles_.home_node), std::span(node_));
}

void HomeExchange::to_nodes(std::int64_t version, std::span<const double> particles, std::span<double> nodes,
                            int components) {
  follow(version);
  const auto n = static_cast<std::size_t>(components);
  room_.resize(node_.size() * n);
  plan_.forward(particles, std::span(room_), components);
  for (std::size_t i = 0; i < node_.size(); ++i)
    std::copy_n(&room_[i * n], n, &nodes[static_cast<std::size_t>(node_[i]) * n]);
}

void HomeExchange::to_particles(std::int64_t version, std::span<const double> nodes, std::span<double> particles,
                                int components) {
  follow(version);
  const auto n = static_cast<std::size_t>(components);
  room_.resize(node_.size() * n);
  for (std::size_t i = 0; i < node_.size(); ++i)
    std::copy_n(&nodes[static_cast<std::size_t>(node_[i]) * n], n, &room_[i * n]);
  plan_.reverse(std::span<const double>(room_), particles, components);
}

}  // namespace tenon
