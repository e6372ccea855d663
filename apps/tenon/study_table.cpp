// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/study_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace tenon {

namespace {

/// Rows that differ in the mesh or step only: of a grid, those with all but the last variation alike.
std::vector<std::vector<std::size_t>> groups_of(const StudyPlan& plan) {
  std::map<std::vector<std::string>, std::size_t> place;
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t r = 0; r < plan.runs.size(); ++r) {
    std::vector<std::string> fixed;
    if (plan.grid) fixed.assign(plan.runs[r].values.begin(), plan.runs[r].values.end() - 1);
    const auto [at, fresh] = place.emplace(fixed, groups.size());
    if (fresh) groups.emplace_back();
    groups[at->second].push_back(r);
  }
  return groups;
}

/// Rows of a group that ran, coarsest first.
std::vector<std::size_t> refinement(const std::vector<std::size_t>& group, const std::vector<StudyRow>& rows,
                                    std::size_t quantity) {
  std::vector<std::size_t> good;
  for (const std::size_t r : group)
    if (rows[r].done && rows[r].size > 0 && std::isfinite(rows[r].values[quantity].value)) good.push_back(r);
  std::stable_sort(good.begin(), good.end(), [&](std::size_t a, std::size_t b) { return rows[a].size > rows[b].size; });
  return good;
}

/// Sizes that differ by round-off only do not say which is the finer.
bool finer(const StudyRow& a, const StudyRow& b) {
  constexpr double round_off = 1e-9;
  return a.size < b.size * (1 - round_off);
}

double relative(double value, double reference) {
  return std::abs(value - reference) / (reference != 0 ? std::abs(reference) : 1.0);
}

/// Errors of a quantity without a reference.
std::string extrapolate(const StudyPlan& plan, std::size_t q, const std::vector<std::size_t>& good,
                        std::vector<StudyRow>& rows) {
  const StudyQuantity& quantity = plan.quantities[q];
  for (std::size_t i = 1; i < good.size(); ++i)
    if (!finer(rows[good[i]], rows[good[i - 1]]))
      return fmt::format(
          "{}: the runs {} and {} have the same size, {:.4g}, so none is the finest; give the study a `size` that "
          "tells "
          "them apart: no error",
          quantity.name, plan.runs[good[i - 1]].folder, plan.runs[good[i]].folder, rows[good[i]].size);
  if (good.size() < 3)
    return fmt::format("{}: {} runs of different size, but an extrapolation needs three: no error", quantity.name,
                       good.size());
  double size[3], value[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t r = good[good.size() - 3 + i];
    size[i] = rows[r].size, value[i] = rows[r].values[q].value;
  }
  const Extrapolation limit = richardson(size, value);
  if (limit.monotone) {
    for (const std::size_t r : good) rows[r].values[q].error = relative(rows[r].values[q].value, limit.value);
    return fmt::format("{}: extrapolated to {:.8g} from the three finest runs, which converge with order {:.2f}",
                       quantity.name, limit.value, limit.order);
  }
  for (const std::size_t r : good)
    if (r != good.back()) rows[r].values[q].error = relative(rows[r].values[q].value, value[2]);
  return fmt::format(
      "{}: the three finest runs do not converge monotonically ({:.8g}, {:.8g}, {:.8g}), so there is no extrapolation; "
      "errors are against the finest run",
      quantity.name, value[0], value[1], value[2]);
}

std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{:.10g}", value) : "";
}

std::string comma_and(const std::string& text) {
  return fmt::format(",{}", text);
}

std::string quoted_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c == '\n' ? ' ' : c;
  }
  return result + "\"";
}

}  // namespace

Extrapolation richardson(const double (&size)[3], const double (&value)[3]) {
  Extrapolation result;
  const double coarse = value[0] - value[1], fine = value[1] - value[2];
  if (!(size[0] > size[1] && size[1] > size[2]) || !(coarse * fine > 0)) return result;
  // (h0^p - h1^p) / (h1^p - h2^p) grows with p; differences that do not shrink are below its value at p = 0.
  const double wanted = coarse / fine, r01 = size[0] / size[1], r21 = size[2] / size[1];
  const auto ratio = [&](double p) { return (std::pow(r01, p) - 1) / (1 - std::pow(r21, p)); };
  double low = 1e-3, high = 30;
  if (!(ratio(low) < wanted && wanted < ratio(high))) return result;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (ratio(middle) < wanted ? low : high) = middle;
  }
  result.order = 0.5 * (low + high);
  result.value = value[2] - fine / (std::pow(size[1] / size[2], result.order) - 1);
  result.monotone = true;
  return result;
}

std::vector<std::string> analyse(const StudyPlan& plan, std::vector<StudyRow>& rows) {
  std::vector<std::string> notes;
  for (StudyRow& row : rows) row.orders.assign(plan.quantities.size(), unknown);
  for (const std::vector<std::size_t>& group : groups_of(plan))
    for (std::size_t q = 0; q < plan.quantities.size(); ++q) {
      const StudyQuantity& quantity = plan.quantities[q];
      const std::vector<std::size_t> good = refinement(group, rows, q);
      if (!quantity.is_field && !quantity.reference) {
        for (const std::size_t r : group) rows[r].values[q].error = unknown;
        notes.push_back(extrapolate(plan, q, good, rows));
      }
      for (std::size_t i = 1; i < good.size(); ++i) {
        const StudyRow& before = rows[good[i - 1]];
        StudyRow& row = rows[good[i]];
        const double errors = before.values[q].error / row.values[q].error, sizes = before.size / row.size;
        if (errors > 0 && std::isfinite(errors) && finer(row, before))
          row.orders[q] = std::log(errors) / std::log(sizes);
      }
    }
  return notes;
}

std::string study_csv(const StudyPlan& plan, const std::vector<StudyRow>& rows) {
  std::string text = "run";
  for (const StudyVariation& v : plan.vary) text += comma_and(quoted_cell(v.name));
  text += ",size";
  for (const StudyQuantity& q : plan.quantities) {
    text += fmt::format(",{0},{0}_error,{0}_order", q.name);
    if (q.is_field) text += fmt::format(",{}_greatest_error", q.name);
  }
  text += ",seconds,set_up_seconds,steps,element_steps,element_steps_per_second,status\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const StudyRow& row = rows[r];
    text += plan.runs[r].folder;
    for (const std::string& value : plan.runs[r].values) text += comma_and(quoted_cell(value));
    text += comma_and(cell(row.size));
    for (std::size_t q = 0; q < plan.quantities.size(); ++q) {
      const Measured m = row.done ? row.values[q] : Measured{};
      for (const double number : {m.value, m.error, row.orders.empty() ? unknown : row.orders[q]})
        text += comma_and(cell(number));
      if (plan.quantities[q].is_field) text += comma_and(cell(m.greatest_error));
    }
    text += fmt::format(",{},{},{:.0f},{:.0f},{},{}\n", cell(row.seconds), cell(row.set_up), row.steps, row.work,
                        cell(row.seconds > 0 ? row.work / row.seconds : unknown), quoted_cell(row.status));
  }
  return text;
}

}  // namespace tenon
