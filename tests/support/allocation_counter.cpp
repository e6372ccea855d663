// SPDX-License-Identifier: BSD-3-Clause
// Counts every allocation of the program that links this. A library of its own, so that no call is inlined.
#include "allocation_counter.hpp"

#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

std::int64_t made = 0;

void* counted(std::size_t bytes, std::size_t alignment) noexcept {
  ++made;
  return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

void* counted_or_thrown(std::size_t bytes, std::size_t alignment) {
  if (void* place = counted(bytes, alignment)) return place;
  throw std::bad_alloc();
}

}  // namespace

std::int64_t tenon::testing::allocations() {
  return made;
}

void* operator new(std::size_t bytes) {
  return counted_or_thrown(bytes, alignof(std::max_align_t));
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted_or_thrown(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return counted(bytes, alignof(std::max_align_t));
}
void operator delete(void* place) noexcept {
  std::free(place);
}
void operator delete(void* place, std::size_t) noexcept {
  std::free(place);
}
void operator delete(void* place, std::align_val_t) noexcept {
  std::free(place);
}
void operator delete(void* place, std::size_t, std::align_val_t) noexcept {
  std::free(place);
}
