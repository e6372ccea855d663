// SPDX-License-Identifier: BSD-3-Clause
// Says what display and arguments it has after ensure_display.
#include <cstdio>
#include <cstdlib>

#include "framework/base/error.hpp"
#include "framework/io/pictures.hpp"

int main(int argc, char** argv) {
  try {
    tenon::ensure_display(argc, argv);
  } catch (const tenon::Error& error) {
    std::printf("error %d: %s\n", static_cast<int>(error.code()), error.what());
    return static_cast<int>(error.code());
  }
  std::printf("display=%s", std::getenv("DISPLAY"));
  for (int i = 1; i < argc; ++i) std::printf(" [%s]", argv[i]);
  std::printf("\n");
  return 0;
}
