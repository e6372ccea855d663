// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/sparse_matrix.hpp"

namespace tenon::thermal {
namespace {

double row_times(const SparseMatrix<float>& m, LocalIndex row, std::span<const double> x) {
  double sum = 0;
  for (std::size_t p = m.begin(row); p < m.end(row); ++p)
    sum += static_cast<double>(m.value[p]) * x[static_cast<std::size_t>(m.column[p])];
  return sum;
}

}  // namespace

void make_single(const SparseMatrix<double>& m, SparseMatrix<float>& single) {
  single.columns = m.columns;
  single.offsets = m.offsets;
  single.column = m.column;
  single.value.assign(m.value.begin(), m.value.end());
}

void residual(const SparseMatrix<float>& m, std::span<const double> x, std::span<const double> b,
              std::span<double> out) {
  for (LocalIndex r = 0; r < m.rows(); ++r)
    out[static_cast<std::size_t>(r)] = b[static_cast<std::size_t>(r)] - row_times(m, r, x);
}

void multiply(const SparseMatrix<float>& m, std::span<const double> x, std::span<double> out) {
  for (LocalIndex r = 0; r < m.rows(); ++r) out[static_cast<std::size_t>(r)] = row_times(m, r, x);
}

}  // namespace tenon::thermal
