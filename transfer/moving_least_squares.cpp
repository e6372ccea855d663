// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/moving_least_squares.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <numeric>

#include "framework/search/nearest_points.hpp"

namespace tenon::transfer {

namespace {

/// Before the terms of a row on its way, in the room of one of them.
struct RowHead {
  double distance = 0, spacing = 0;
  std::int32_t terms = 0;
  bool exact = false, deficient = false, among = false;
};
static_assert(sizeof(RowHead) == sizeof(Term));

/// The weights of all points, and what the fits found.
struct FittedRows {
  Rows rows;
  std::vector<FitOutcome> fits;
};

void fit_row(const Vec3& x, std::span<const NearPoint> near, bool all, const FitRules& rules,
             std::span<std::byte> result) {
  std::array<Vec3, max_neighbours> relative;
  std::array<double, max_neighbours> weight;
  std::array<Term, max_neighbours> terms;
  for (std::size_t j = 0; j < near.size(); ++j) relative[j] = near[j].point->x - x;
  const FitOutcome fit = linear_fit(std::span(relative).first(near.size()), all, rules, weight);
  std::size_t count = 0;
  for (std::size_t j = 0; j < near.size(); ++j)
    if (weight[j] != 0) {
      const CloudPoint& p = *near[j].point;
      terms[count++] = {p.id, weight[j], p.owner, p.at_owner};
    }
  const RowHead head{fit.distance, fit.spacing, static_cast<std::int32_t>(count), fit.exact, fit.deficient, fit.among};
  std::memcpy(result.data(), &head, sizeof head);
  std::memcpy(result.data() + sizeof head, terms.data(), count * sizeof(Term));
}

/// Collective. One fit for each point, to `neighbours` points of the cloud.
FittedRows fit_to(const Communicator& comm, std::span<const CloudPoint> cloud, std::span<const Vec3> points,
                  int neighbours, bool all, const FitRules& rules, const std::string& name) {
  // A head and room for all terms that there can be; then the terms move together, in their place.
  const auto width = static_cast<std::size_t>(neighbours) + 1;
  FittedRows fitted;
  std::vector<Term>& terms = fitted.rows.terms;
  terms.resize(points.size() * width);
  for_each_with_nearest(
      comm, cloud, points, neighbours, width * sizeof(Term), std::as_writable_bytes(std::span(terms)),
      [&](const Vec3& x, std::span<const NearPoint> near, std::span<std::byte> result) {
        fit_row(x, near, all, rules, result);
      },
      "transfer '" + name + "'");
  fitted.rows.begin.reserve(points.size() + 1);
  fitted.fits.reserve(points.size());
  auto end = terms.begin();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = terms.begin() + static_cast<std::ptrdiff_t>(i * width);
    RowHead head;
    std::memcpy(static_cast<void*>(&head), static_cast<const void*>(&*row), sizeof head);
    fitted.fits.push_back({head.distance, head.spacing, head.exact, head.deficient, head.among});
    end = std::copy(row + 1, row + 1 + head.terms, end);
    fitted.rows.begin.push_back(end - terms.begin());
  }
  terms.erase(end, terms.end());
  return fitted;
}

/// Puts the rows and fits of `some` in place of those that `which` names, ascending.
void replace(FittedRows& all, const FittedRows& some, std::span<const std::size_t> which) {
  Rows rows;
  rows.begin.reserve(all.rows.begin.size());
  rows.terms.reserve(all.rows.terms.size() + some.rows.terms.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    const bool here = next < which.size() && which[next] == i;
    const std::span<const Term> row = here ? some.rows.row(next) : all.rows.row(i);
    if (here) all.fits[i] = some.fits[next++];
    rows.terms.insert(rows.terms.end(), row.begin(), row.end());
    rows.begin.push_back(static_cast<std::int64_t>(rows.terms.size()));
  }
  all.rows = std::move(rows);
}

void check_options(const MovingLeastSquaresOptions& options, const std::string& name) {
  const auto greatest = static_cast<int>(max_neighbours);
  if (options.neighbours < 1 || options.neighbours > greatest || !(options.rules.trust >= 0))
    throw Error(ExitCode::usage,
                fmt::format("transfer '{}': moving least squares with {} neighbours and trust {}; at least 1 and at "
                            "most {} neighbours and a trust that is not negative are possible",
                            name, options.neighbours, options.rules.trust, greatest));
}

/// Collective.
FittedRows fit_rows(const Communicator& comm, const Items& items, std::span<const Vec3> places,
                    std::span<const Vec3> points, const MovingLeastSquaresOptions& options, const std::string& name) {
  check_options(options, name);
  assert(places.size() == items.owned.size());
  std::vector<CloudPoint> cloud;
  cloud.reserve(places.size());
  for (std::size_t k = 0; k < places.size(); ++k)
    cloud.push_back({places[k], items.ids[static_cast<std::size_t>(items.owned[k])], comm.rank(), items.owned[k]});
  const std::int64_t in_cloud = comm.sum(static_cast<std::int64_t>(cloud.size()));
  if (in_cloud == 0 && comm.any(!points.empty()))
    throw Error(ExitCode::geometry, fmt::format("transfer '{}': the cloud has no points that values could come from or "
                                                "go to",
                                                name));
  const auto fit = [&](std::span<const Vec3> to, int neighbours) {
    return fit_to(comm, cloud, to, neighbours, in_cloud <= neighbours, options.rules, name);
  };
  FittedRows fitted = fit(points, options.neighbours);
  if (in_cloud <= options.neighbours) return fitted;

  // The nearest points may stand in one line or plane though the cloud does not (a mesh with flat elements, a crowd).
  std::vector<std::size_t> deficient;
  std::vector<Vec3> again;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (fitted.fits[i].deficient) deficient.push_back(i), again.push_back(points[i]);
  if (comm.any(!deficient.empty())) replace(fitted, fit(again, static_cast<int>(max_neighbours)), deficient);
  return fitted;
}

FittedPoint fitted_point(const FitOutcome& fit) {
  return {fit.distance, fit.spacing, fit.distance > fit.spacing && !fit.among, fit.exact};
}

/// A term of a column on its way to the owner of the target.
struct Entry {
  Term term;  ///< of the target's row
  LocalIndex row;
};

/// Adds up terms of the same id, in the order in which they stand among equals, and scales the sum to `total`.
void merge_column(std::vector<Term>& column, double total) {
  std::stable_sort(column.begin(), column.end(), [](const Term& a, const Term& b) { return a.source < b.source; });
  std::size_t count = 0;
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (count > 0 && column[count - 1].source == column[i].source)
      column[count - 1].weight += column[i].weight;
    else
      column[count++] = column[i];
  }
  column.resize(count);
  const auto largest = std::max_element(column.begin(), column.end(), [](const Term& a, const Term& b) {
    return std::abs(a.weight) < std::abs(b.weight);
  });
  for (int repeat = 0; repeat < 2; ++repeat) {
    double sum = 0;
    for (const Term& term : column) sum += term.weight;
    largest->weight += total - sum;
  }
}

/// Rows of the owned items from what arrived, in any order.
Rows assemble(const Items& items, std::span<const Entry> arrived) {
  std::vector<std::int64_t> begin(static_cast<std::size_t>(items.size()) + 1, 0);
  for (const Entry& e : arrived) ++begin[static_cast<std::size_t>(e.row) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  Rows rows;
  rows.terms.resize(arrived.size());
  std::vector<std::int64_t> next(begin.begin(), begin.end() - 1);
  for (const Entry& e : arrived) rows.terms[static_cast<std::size_t>(next[static_cast<std::size_t>(e.row)]++)] = e.term;
  // Only owned items have terms, and they ascend, so their rows follow each other.
  for (const LocalIndex item : items.owned) {
    const auto i = static_cast<std::size_t>(item);
    sort_by_source(std::span(rows.terms)
                       .subspan(static_cast<std::size_t>(begin[i]), static_cast<std::size_t>(begin[i + 1] - begin[i])));
    rows.begin.push_back(begin[i + 1]);
  }
  return rows;
}

}  // namespace

Rows moving_least_squares_rows(const Communicator& comm, const Items& items, std::span<const Vec3> cloud,
                               std::span<const Vec3> targets, const MovingLeastSquaresOptions& options,
                               const std::string& name, std::vector<FittedPoint>& fitted) {
  FittedRows all = fit_rows(comm, items, cloud, targets, options, name);
  fitted.clear();
  for (const FitOutcome& fit : all.fits) fitted.push_back(fitted_point(fit));
  return std::move(all.rows);
}

Rows moving_least_squares_transpose(const Communicator& comm, const Items& items, std::span<const Vec3> cloud,
                                    std::span<const SpreadPoint> points, const MovingLeastSquaresOptions& options,
                                    const std::string& name, std::vector<FittedPoint>& fitted) {
  std::vector<Vec3> places;
  places.reserve(points.size());
  for (const SpreadPoint& p : points) places.push_back(p.x);
  const FittedRows all = fit_rows(comm, items, cloud, places, options, name);
  std::vector<Entry> entries;
  std::vector<int> to;
  std::vector<Term> column;
  fitted.clear();
  for (std::size_t first = 0, last = 0; first < points.size(); first = last) {
    column.clear();
    double total = 0;
    for (last = first; last < points.size() && points[last].source == points[first].source; ++last) {
      fitted.push_back(fitted_point(all.fits[last]));
      for (Term term : all.rows.row(last)) term.weight *= points[last].part, column.push_back(term);
      total += points[last].part;
    }
    merge_column(column, total);
    const SpreadPoint& from = points[first];
    for (const Term& target : column) {
      entries.push_back({{from.source, target.weight, from.owner, from.at_owner}, target.at_owner});
      to.push_back(target.owner);
    }
  }
  const ExchangePlan plan = ExchangePlan::to_ranks(comm, to, name + " transpose");
  std::vector<Entry> arrived(static_cast<std::size_t>(plan.received()));
  plan.forward(std::span<const Entry>(entries), std::span<Entry>(arrived));
  return assemble(items, arrived);
}

}  // namespace tenon::transfer
