// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact_geometry/polynomial_roots.hpp"

#include <cmath>

namespace tenon::contact {
namespace {

constexpr int n = quintic_coefficients - 1;
using Bernstein = std::array<double, n + 1>;

struct Piece {
  Bernstein b;
  double low, high;
};

Bernstein to_bernstein(const std::array<double, n + 1>& c) {
  constexpr double choose[n + 1][n + 1] = {{1, 0, 0, 0, 0, 0}, {1, 1, 0, 0, 0, 0}, {1, 2, 1, 0, 0, 0},
                                           {1, 3, 3, 1, 0, 0}, {1, 4, 6, 4, 1, 0}, {1, 5, 10, 10, 5, 1}};
  Bernstein b{};
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= j; ++i) b[j] += choose[j][i] / choose[n][i] * c[i];
  return b;
}

int sign_changes(const Bernstein& b) {
  int changes = 0;
  double last = 0;
  for (const double v : b) {
    if (v == 0) continue;
    if (last != 0 && (v > 0) != (last > 0)) ++changes;
    last = v;
  }
  return changes;
}

/// De Casteljau at the middle.
void halve(const Piece& whole, Piece& first, Piece& second) {
  Bernstein b = whole.b;
  const double middle = 0.5 * (whole.low + whole.high);
  for (int level = 0; level <= n; ++level) {
    first.b[level] = b[0];
    second.b[n - level] = b[n - level];
    for (int i = 0; i < n - level; ++i) b[i] = 0.5 * (b[i] + b[i + 1]);
  }
  first.low = whole.low;
  first.high = second.low = middle;
  second.high = whole.high;
}

}  // namespace

int roots_in_unit_interval(const std::array<double, n + 1>& c, std::array<double, n>& roots) {
  constexpr int deepest = 40;
  std::array<Piece, deepest + 2> stack;
  int pending = 0, found = 0;
  stack[pending++] = {to_bernstein(c), 0.0, 1.0};
  while (pending > 0 && found < n) {
    const Piece piece = stack[--pending];
    const int changes = sign_changes(piece.b);
    if (changes == 0) {
      // A root at the very end of the interval changes no sign inside it.
      if (piece.b[0] == 0 && (found == 0 || roots[found - 1] != piece.low)) roots[found++] = piece.low;
      continue;
    }
    if (piece.high - piece.low < 0x1p-36) {
      roots[found++] = 0.5 * (piece.low + piece.high);
      continue;
    }
    Piece first, second;
    halve(piece, first, second);
    stack[pending++] = second;
    stack[pending++] = first;
  }
  return found;
}

}  // namespace tenon::contact
