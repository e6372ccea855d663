// SPDX-License-Identifier: BSD-3-Clause
// Element-steps per second of the whole step of explicit mechanics, through the real component, by element, material
// and hourglass form.
//   mechanics_bench [--benchmark_filter=REGEX ...]    on one rank, or under mpirun: then wall time, rates per rank
#include <benchmark/benchmark.h>

#include <algorithm>

#include "bench_bodies.hpp"
#include "framework/comm/communicator.hpp"
#include "numbering_bench.hpp"

namespace tenon::bench {

namespace {

constexpr int steps_each = 10, warm_up = 12, repetitions = 5;

/// The last one made, kept for the next case.
std::shared_ptr<const Mesh> mesh_of(Kind kind) {
  static std::shared_ptr<const Mesh> kept;
  static Kind of = Kind::hex8;
  const Kind shape = kind == Kind::hex8_full ? Kind::hex8 : kind;
  if (!kept || of != shape) {
    kept.reset();
    kept = distributed(Communicator::world().rank() == 0 ? make_mesh(shape) : MeshData{});
    of = shape;
  }
  return kept;
}

void steps(benchmark::State& state, const Case& c) {
  const auto body = make_body(mesh_of(c.kind), c);
  take_steps(*body, warm_up);
  const std::int64_t before = body->work_done();
  for ([[maybe_unused]] auto _ : state) take_steps(*body, 1);
  state.counters["element_steps"] =
      benchmark::Counter(static_cast<double>(body->work_done() - before), benchmark::Counter::kIsRate);
  const Mesh& mesh = body->mesh();
  const std::int64_t stored = mesh.comm.sum(std::int64_t{mesh.elements()});
  state.counters["computed_twice"] =
      static_cast<double>(stored - mesh.global_elements) / static_cast<double>(mesh.global_elements);
}

std::vector<Case> cases() {
  using Form = HourglassOptions::Form;
  std::vector<Case> all;
  const std::pair<const char*, Form> forms[] = {
      {"viscous", Form::viscous}, {"stiffness", Form::stiffness}, {"physical", Form::physical}};
  const std::pair<const char*, Law> laws[] = {
      {"elastic", Law::elastic}, {"j2", Law::j2}, {"johnson_cook", Law::johnson_cook}};
  for (const auto& [law_name, law] : laws)
    for (const auto& [form_name, form] : forms)
      all.push_back({std::string("hex8/") + law_name + "/" + form_name, Kind::hex8, law, form});
  const std::pair<const char*, Kind> kinds[] = {
      {"hex8_full", Kind::hex8_full}, {"tet4", Kind::tet4}, {"wedge6", Kind::wedge6}, {"quad4_5_layers", Kind::quad4}};
  for (const auto& [kind_name, kind] : kinds)
    for (const auto& [law_name, law] : {laws[0], laws[1]})
      all.push_back({std::string(kind_name) + "/" + law_name, kind, law, Form::viscous});
  return all;
}

class Silence final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>&) override {}
};

void run() {
  const Communicator world = Communicator::world();
  for (const Case& c : cases()) {
    auto* timed = benchmark::RegisterBenchmark(c.name.c_str(), [c](benchmark::State& state) { steps(state, c); });
    timed->Iterations(steps_each)->Repetitions(repetitions)->DisplayAggregatesOnly()->Unit(benchmark::kMillisecond);
    timed->ComputeStatistics("best",
                             [](const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); });
    if (world.size() > 1) timed->UseRealTime();
  }
  if (world.size() == 1) register_numbering();
  Silence silence;
  if (world.rank() == 0)
    benchmark::RunSpecifiedBenchmarks();
  else
    benchmark::RunSpecifiedBenchmarks(&silence);
}

}  // namespace

}  // namespace tenon::bench

int main(int argc, char** argv) {
  tenon::MpiEnvironment environment(argc, argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  tenon::bench::run();
  return 0;
}
