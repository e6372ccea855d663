// SPDX-License-Identifier: BSD-3-Clause
// A steady step takes no memory from the heap.
#include <atomic>
#include <cstdlib>
#include <new>

#include "mechanics_case.hpp"

namespace {
std::atomic<long> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  void* p = alignment > alignof(std::max_align_t)
                ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                : std::malloc(size == 0 ? 1 : size);
  if (!p) throw std::bad_alloc();
  return p;
}
}  // namespace

void* operator new(std::size_t size) {
  return counted(size, 0);
}
void* operator new[](std::size_t size) {
  return counted(size, 0);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete[](void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
void operator delete[](void* p, std::size_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
void operator delete[](void* p, std::align_val_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

namespace tenon::testing {
namespace {

TEST(Allocation, NoneInASteadyStep) {
  MechanicsOptions options;
  options.heat = HeatMode::adiabatic;
  options.initial_velocities.push_back({"", "", {-150, 20, 0}, {}, {}});
  options.walls.push_back({{0, 0, 0}, {1, 0, 0}, TimeFunction::constant(0), {}, "wall"});
  PrescribedMotion turn = motion(PrescribedMotion::Kind::rotation, {"x_max"});
  turn.factor = TimeFunction::table({{0, 0}, {1, 1}});
  options.motions = {turn};
  BoxShape box;
  box.elements = {6, 4, 4};
  const auto m = body(shared_mesh(on_root(box)), copper(), options);
  m->initialize();
  for (int s = 0; s < 3; ++s) m->advance(m->time_step());
  const long before = allocations;
  for (int s = 0; s < 20; ++s) m->advance(m->time_step());
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace tenon::testing
