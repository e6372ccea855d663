// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/auxiliary_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon::thermal {
namespace {

constexpr std::size_t slabs = 4096;
constexpr double unit = 0x1p-30;  // of the extent of the mesh, in which widths are summed: exact for 2^32 elements

struct Extent {
  Vec3 low, high;
};

Extent extent_of(const Mesh& mesh) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 6> least{infinity, infinity, infinity, infinity, infinity, infinity};  // of x and of -x
  for (const Vec3& x : mesh.coordinates)
    for (std::size_t c = 0; c < 3; ++c) {
      least[c] = std::min(least[c], x[c]);
      least[3 + c] = std::min(least[3 + c], -x[c]);
    }
  mesh.comm.min(least);
  return {{least[0], least[1], least[2]}, {-least[3], -least[4], -least[5]}};
}

/// Mean width (as a share of the extent) of the elements across an axis, slab by slab.
std::vector<double> widths(const Mesh& mesh, const Extent& extent, std::size_t axis) {
  const double low = extent.low[axis], length = extent.high[axis] - low;
  std::vector<std::int64_t> sums(2 * slabs + 2, 0);  // changes of the sum of widths, then of the count, at each slab
  const auto slab_of = [&](double x) {
    return static_cast<std::size_t>(std::clamp((x - low) / length * slabs, 0.0, slabs - 1.0));
  };
  for (const ElementBlock& block : mesh.blocks)
    for (LocalIndex e = 0; e < block.size(); ++e) {
      if (block.owners[static_cast<std::size_t>(e)] != mesh.comm.rank()) continue;
      double least = extent.high[axis], greatest = low;
      for (const LocalIndex n : block.nodes(e)) {
        const double x = mesh.coordinates[static_cast<std::size_t>(n)][axis];
        least = std::min(least, x), greatest = std::max(greatest, x);
      }
      const auto width = static_cast<std::int64_t>((greatest - least) / length / unit);
      const std::size_t first = slab_of(least), last = slab_of(greatest) + 1;
      sums[first] += width, sums[last] -= width;
      ++sums[slabs + 1 + first], --sums[slabs + 1 + last];
    }
  mesh.comm.sum(sums);
  std::vector<double> width(slabs, 0.0);
  std::int64_t sum = 0, count = 0;
  for (std::size_t s = 0; s < slabs; ++s) {
    sum += sums[s], count += sums[slabs + 1 + s];
    const double mean = count > 0 ? static_cast<double>(sum) / static_cast<double>(count) * unit : 1.0;
    width[s] = std::clamp(mean, 1.0 / slabs, 1.0);
  }
  return width;
}

/// Lines so that between two of them lie `factor` elements.
std::vector<double> lines_across(const std::vector<double>& width, double factor, double low, double high) {
  std::vector<double> cells(slabs + 1, 0.0);  // up to each slab
  for (std::size_t s = 0; s < slabs; ++s) cells[s + 1] = cells[s] + 1 / (factor * slabs * width[s]);
  const double all = cells.back(), count = std::max(1.0, std::round(all));
  std::vector<double> lines{low};
  std::size_t s = 0;
  for (double line = 1; line < count; ++line) {
    const double wanted = all * line / count;
    while (cells[s + 1] < wanted) ++s;
    const double share = (static_cast<double>(s) + (wanted - cells[s]) / (cells[s + 1] - cells[s])) / slabs;
    lines.push_back(low + share * (high - low));
  }
  lines.push_back(high);
  return lines;
}

}  // namespace

std::int64_t RectilinearGrid::points() const {
  std::int64_t product = 1;
  for (const std::vector<double>& l : lines) product *= static_cast<std::int64_t>(l.size());
  return product;
}

void RectilinearGrid::locate(std::size_t axis, double x, LocalIndex& cell, double& t) const {
  const std::vector<double>& l = lines[axis];
  const auto after = std::upper_bound(l.begin() + 1, l.end() - 1, x);
  cell = static_cast<LocalIndex>(after - l.begin()) - 1;
  t = std::clamp((x - *(after - 1)) / (*after - *(after - 1)), 0.0, 1.0);
}

RectilinearGrid RectilinearGrid::coarsened() const {
  constexpr double alike = 1.7;  // widths within this ratio are coarsened together
  std::array<double, 3> width{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    width[axis] = (lines[axis].back() - lines[axis].front()) / cells(axis);
    if (cells(axis) > 1) least = std::min(least, width[axis]);
  }
  RectilinearGrid coarse = *this;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (cells(axis) == 1 || width[axis] > alike * least) continue;
    coarse.lines[axis].clear();
    for (std::size_t i = 0; i + 1 < lines[axis].size(); i += 2) coarse.lines[axis].push_back(lines[axis][i]);
    coarse.lines[axis].push_back(lines[axis].back());
  }
  return coarse;
}

RectilinearGrid auxiliary_grid(const Mesh& mesh) {
  const Extent extent = extent_of(mesh);
  std::array<std::vector<double>, 3> width;
  std::array<double, 3> mean{};  // m
  for (std::size_t axis = 0; axis < 3; ++axis) {
    width[axis] = widths(mesh, extent, axis);
    double cells = 0;
    for (const double w : width[axis]) cells += 1 / w;
    mean[axis] = (extent.high[axis] - extent.low[axis]) * slabs / cells;
  }
  constexpr double coarser = 2.5;  // than the mesh: of 2, 2.5 and 3 the quickest in the whole
  const double narrow = coarser * std::min({mean[0], mean[1], mean[2]});
  RectilinearGrid grid;
  for (double wider = 1;; wider *= 1.25) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      grid.lines[axis] =
          lines_across(width[axis], wider * std::max(1.0, narrow / mean[axis]), extent.low[axis], extent.high[axis]);
    if (grid.points() <= std::max(std::int64_t{64}, 2 * mesh.global_nodes)) return grid;
  }
}

}  // namespace tenon::thermal
