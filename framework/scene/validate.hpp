// SPDX-License-Identifier: BSD-3-Clause
// Checks the bare tree of a scene against its schema; private to this room.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/scene/schema.hpp"
#include "framework/scene/tree.hpp"
#include "framework/scene/units.hpp"
#include "framework/scene/value_data.hpp"

namespace tenon::scene {

/// "greater than 0 kg/m^3 and at most 3 kg/m^3" in a unit of the user; empty without bounds.
std::string described(const Range& range, const Conversion& conversion, const std::string& unit);

/// The forms of a function besides the constant, as a schema of the keys table, sine, smooth_step and expression.
Schema function_schema(const Key& key);

class Validator {
 public:
  explicit Validator(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  /// What is looked at: its dotted path for messages, and where its name stands.
  struct Context {
    std::string path;
    Place place;
    Context inside(const std::string& key, const Place& at) const {
      return {path.empty() ? key : path + "." + key, at};
    }
  };

  /// `type` is the value of the key `type` if that chose the schema.
  Value mapping(const TreeNode& node, const Schema& schema, const Context& context, const std::string* type = nullptr);
  /// The value of one key; monostate after a complaint.
  Value::Data::Content content(const TreeNode& node, const Key& key, const Context& context);

 private:
  using Content = Value::Data::Content;
  Content scalar(const TreeNode& node, const Key& key, const Context& context);
  std::optional<double> quantity(const TreeNode& node, const Key& key, const Context& context);
  Content integer(const TreeNode& node, const Key& key, const Context& context);
  Content flag(const TreeNode& node, const Context& context);
  Content choice(const TreeNode& node, const Key& key, const Context& context);
  Content reals(const TreeNode& node, const Key& key, const Context& context);
  Content texts(const TreeNode& node, const Context& context);
  Content function(const TreeNode& node, const Key& key, const Context& context);
  std::optional<SpaceTimeFunction> any_function(const TreeNode& node, const Key& key, const Context& context);
  std::optional<SpaceTimeFunction> expression(const TreeNode& node, const Key& key, const Context& context);
  Content table(const TreeNode& node, const Key& key, const Context& context);
  std::optional<std::vector<std::pair<double, double>>> points(const TreeNode& node, const Key& key,
                                                               const Context& context);
  Content list(const TreeNode& node, const Key& key, const Context& context);
  Content named(const TreeNode& node, const Key& key, const Context& context);
  std::optional<Value> block(const TreeNode& node, const Key& key, const Context& context);
  const Schema& forms_of(const Key& key);
  Content default_of(const Key& key, const Context& context);
  void unknown_keys(const TreeNode& node, const Schema& schema, const Context& context, bool typed);
  void missing_keys(const TreeNode& node, const Schema& schema, const Context& context);
  void groups(const TreeNode& node, const Schema& schema, const Context& context);
  void complain(const Place& place, const Context& context, const std::string& message);

  Diagnostics& diagnostics_;
  std::map<const Key*, Content> defaults_;
  std::map<const Key*, Schema> forms_;  ///< of keys that hold functions
};

}  // namespace tenon::scene
