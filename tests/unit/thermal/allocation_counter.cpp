// SPDX-License-Identifier: BSD-3-Clause
// Counts every allocation of the program that links this. A file of its own, so that no call is inlined.
#include "allocation_counter.hpp"

#include <cstdlib>
#include <new>

namespace {
std::int64_t counted = 0;
}

std::int64_t tenon::testing::allocations() {
  return counted;
}

void* operator new(std::size_t bytes) {
  ++counted;
  if (void* p = std::malloc(bytes)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
