// SPDX-License-Identifier: BSD-3-Clause
// What a Value holds; private to this room.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "framework/scene/tree.hpp"
#include "framework/scene/value.hpp"

namespace tenon::scene {

struct NamedBlock {
  std::string name;
  Place place;
  Value value;
};

struct Value::Data {
  using Content =
      std::variant<std::monostate, double, std::int64_t, bool, std::string, std::vector<double>,
                   std::vector<std::string>, TimeFunction, SpaceTimeFunction, std::vector<std::pair<double, double>>,
                   Value, std::vector<Value>, std::vector<NamedBlock>>;
  /// One key of the schema.
  struct Slot {
    std::string name;
    bool has = false;    ///< given in the scene, or with a default
    bool given = false;  ///< given in the scene
    Place place;         ///< of the given value
    Content content;     ///< also of an absent block whose keys all have defaults
  };
  std::vector<Slot> slots;
  Place place;
};

}  // namespace tenon::scene
