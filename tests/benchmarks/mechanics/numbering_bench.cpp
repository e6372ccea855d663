// SPDX-License-Identifier: BSD-3-Clause
#include "numbering_bench.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>

#include "bench_bodies.hpp"

namespace tenon::bench {

namespace {

constexpr int turns = 15, steps_a_turn = 4;

std::unique_ptr<Mechanics> numbered(const Case& c, std::initializer_list<Numbering> orders) {
  MeshData mesh = make_mesh(c.kind);
  for (const Numbering order : orders) renumber(mesh, order);
  return make_body(distributed(std::move(mesh)), c);
}

double seconds_of(Mechanics& body) {
  const std::clock_t start = std::clock();
  take_steps(body, steps_a_turn);
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

void numbering(benchmark::State& state, const Case& c) {
  const auto file = numbered(c, {Numbering::file});
  const auto renumbered = numbered(c, {Numbering::shuffled, Numbering::automatic});
  const auto shuffled = numbered(c, {Numbering::shuffled});
  std::vector<double> ratio_renumbered, ratio_shuffled;
  for ([[maybe_unused]] auto _ : state) {
    const double base = seconds_of(*file);
    ratio_renumbered.push_back(seconds_of(*renumbered) / base);
    ratio_shuffled.push_back(seconds_of(*shuffled) / base);
  }
  state.counters["renumbered_over_file"] = median(ratio_renumbered);
  state.counters["shuffled_over_file"] = median(ratio_shuffled);
}

}  // namespace

void register_numbering() {
  const Case cases[] = {{"numbering/hex8/elastic", Kind::hex8, Law::elastic},
                        {"numbering/hex8/j2", Kind::hex8, Law::j2}};
  for (const Case& c : cases)
    benchmark::RegisterBenchmark(c.name.c_str(), [c](benchmark::State& state) { numbering(state, c); })
        ->Iterations(turns)
        ->Unit(benchmark::kMillisecond);
}

}  // namespace tenon::bench
