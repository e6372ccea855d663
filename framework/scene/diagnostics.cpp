// SPDX-License-Identifier: BSD-3-Clause
// Collects the complaints about a scene in the order of their places.
#include <algorithm>
#include <climits>
#include <tuple>

#include "framework/base/error.hpp"
#include "framework/scene/value.hpp"

namespace tenon::scene {
namespace {

/// The command line comes after the file.
auto order_of(const Where& where) {
  return std::make_tuple(where.line == 0 ? INT_MAX : where.line, where.column, std::cref(where.file).get());
}

}  // namespace

std::string to_string(const Where& where) {
  if (where.line == 0) return where.file.empty() ? "--set" : "--set " + where.file;
  return where.file + ":" + std::to_string(where.line) + ":" + std::to_string(where.column);
}

void Diagnostics::error(const Where& where, const std::string& message) {
  Entry entry{where, to_string(where) + ": " + message};
  // entries_ and errors_ run in parallel, sorted by place. An alias that is used twice complains once.
  const auto begins = std::lower_bound(entries_.begin(), entries_.end(), where,
                                       [](const Entry& e, const Where& w) { return order_of(e.where) < order_of(w); });
  auto at = begins;
  for (; at != entries_.end() && order_of(at->where) == order_of(where); ++at)
    if (at->text == entry.text) return;
  errors_.insert(errors_.begin() + (at - entries_.begin()), entry.text);
  entries_.insert(at, std::move(entry));
}

void Diagnostics::warning(const Where& where, const std::string& message) {
  std::string text = to_string(where) + ": warning: " + message;
  if (std::find(warnings_.begin(), warnings_.end(), text) == warnings_.end()) warnings_.push_back(std::move(text));
}

void Diagnostics::throw_if_any() const {
  constexpr std::size_t shown = 100;
  if (errors_.empty()) return;
  std::string text;
  for (std::size_t i = 0; i < std::min(errors_.size(), shown); ++i) text += (i == 0 ? "" : "\n") + errors_[i];
  if (errors_.size() > shown) text += "\n... and " + std::to_string(errors_.size() - shown) + " more errors";
  throw Error(ExitCode::usage, text);
}

}  // namespace tenon::scene
