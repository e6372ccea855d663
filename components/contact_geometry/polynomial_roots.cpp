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

double value(const Bernstein& b, double u) {
  const double v = 1 - u, u2 = u * u, v2 = v * v;
  return v2 * v2 * (v * b[0] + 5 * u * b[1]) + 10 * u2 * v2 * (v * b[2] + u * b[3]) +
         u2 * u2 * (5 * v * b[4] + u * b[5]);
}

/// The one root of a piece whose end values differ in sign: regula falsi, the weight of an end that stays halved.
double single_root(const Piece& piece) {
  double low = 0, high = 1, at_low = piece.b[0], at_high = piece.b[n], root = 0.5;
  for (int i = 0, last = 0; i < 60 && high - low > 1e-14; ++i) {
    root = i % 8 == 7 ? 0.5 * (low + high) : (at_high * low - at_low * high) / (at_high - at_low);
    const double at = value(piece.b, root);
    if (at == 0) break;
    if ((at > 0) == (at_low > 0)) {
      low = root;
      at_low = at;
      if (last == -1) at_high *= 0.5;
      last = -1;
    } else {
      high = root;
      at_high = at;
      if (last == 1) at_low *= 0.5;
      last = 1;
    }
  }
  return piece.low + root * (piece.high - piece.low);
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
    if (changes == 1 && piece.b[0] != 0 && piece.b[n] != 0) {
      roots[found++] = single_root(piece);
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
