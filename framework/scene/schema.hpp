// SPDX-License-Identifier: BSD-3-Clause
// The description of a scene file from which validation and the scene reference both come.
#pragma once

#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/scene/value.hpp"

namespace tenon::scene {

class Schema;

/// Bounds of a number, in SI.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;  ///< the bound itself is not allowed
  bool contains(double value) const {
    return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
  }
  static Range positive() { return {0, std::numeric_limits<double>::infinity(), true, false}; }
  static Range not_negative() { return {0, std::numeric_limits<double>::infinity(), false, false}; }
};

/// What one key holds.
struct Key {
  enum class Type {
    quantity,  ///< number with a unit; `unit` is the SI unit that it must be convertible to ("1": plain number)
    integer,
    flag,
    text,
    choice,    ///< one of `choices`
    reals,     ///< list of quantities of one unit
    vector,    ///< three quantities of one unit
    texts,     ///< list of words, or one word
    function,  ///< of time: quantity, or {table: [[t, v], ...]}, {sine: {...}}, {smooth_step: {...}}, {expression: ...}
    field_function,  ///< of time and place: as function, and its expression may use x, y, z
    table,           ///< points [[x, value], ...], x ascending in unit `x_unit`; a lone quantity is one point at x = 0
    object,          ///< nested mapping of schema `nested`
    list,            ///< list of mappings of schema `nested`
    named,           ///< mapping of named blocks, each of schema `nested`
    variants         ///< mapping of one of several schemas, chosen by its key `type`; see `variants`
  };
  std::string name;
  Type type = Type::text;
  std::string doc;             ///< one sentence for the reference
  std::string unit;            ///< SI unit of quantities
  std::string x_name, x_unit;  ///< what a table is over, as "plastic strain", and its SI unit
  Range range;
  bool required = false;
  std::string default_value;  ///< as it would be written in a scene; empty: none
  std::vector<std::string> choices;
  std::shared_ptr<const Schema> nested;
  /// For Type::variants and for named blocks of several types: value of `type` -> schema.
  std::vector<std::pair<std::string, std::shared_ptr<const Schema>>> variants;
};

/// The keys of one mapping. Mistakes in a schema (a key twice, a default that its own key refuses) are
/// std::logic_error. Units are SI; "delta_K" is K for differences of temperature, where 5 degC would be ambiguous.
class Schema {
 public:
  explicit Schema(std::string doc) : doc_(std::move(doc)) {}

  /// Adds a key; returns it for `required`, `range` ... to be set by the caller.
  Schema& quantity(std::string name, std::string unit, std::string doc, std::string default_value = "",
                   Range range = {});
  Schema& required_quantity(std::string name, std::string unit, std::string doc, Range range = {});
  Schema& integer(std::string name, std::string doc, std::string default_value = "", Range range = {});
  Schema& flag(std::string name, std::string doc, std::string default_value);
  Schema& text(std::string name, std::string doc, std::string default_value = "");
  Schema& choice(std::string name, std::vector<std::string> choices, std::string doc, std::string default_value);
  Schema& reals(std::string name, std::string unit, std::string doc, Range range = {});
  Schema& vector(std::string name, std::string unit, std::string doc, std::string default_value = "");
  Schema& texts(std::string name, std::string doc);
  Schema& function(std::string name, std::string unit, std::string doc);
  Schema& field_function(std::string name, std::string unit, std::string doc);
  Schema& table(std::string name, std::string x_name, std::string x_unit, std::string unit, std::string doc,
                Range range = {});
  Schema& object(std::string name, Schema nested, std::string doc);
  Schema& list(std::string name, Schema nested, std::string doc);
  Schema& named(std::string name, Schema nested, std::string doc);
  /// Mapping, or named blocks, or list whose entries have a key `type` that chooses the schema.
  Schema& variants(std::string name, Key::Type container, std::vector<std::pair<std::string, Schema>> variants,
                   std::string doc);
  /// Make the key added last required, or give it a default (as written in a scene) or a range.
  Schema& required();
  Schema& with_default(std::string default_value);
  Schema& with_range(Range range);
  /// Exactly one, or at most one, of these keys must be given.
  Schema& exactly_one(std::vector<std::string> keys);
  Schema& at_most_one(std::vector<std::string> keys);

  const std::string& doc() const { return doc_; }
  /// The key of this name, or nullptr.
  const Key* find(const std::string& name) const;
  const std::vector<Key>& keys() const { return keys_; }
  struct Group {
    std::vector<std::string> keys;
    bool one_needed;
  };
  const std::vector<Group>& groups() const { return groups_; }

 private:
  Schema& add(Key key);
  void check_default(const Key& key) const;
  std::string doc_;
  std::vector<Key> keys_;
  std::vector<Group> groups_;
};

/// A change from the command line: "components.mechanics.end_time" = "5 us".
struct Override {
  std::string path, value;
};

/// Reads YAML text, applies the overrides, validates against the schema, converts units. All complaints go to
/// `diagnostics`; the returned tree is meaningful only if there are none. Never throws on bad text. Local.
Value parse_scene(const std::string& text, const std::string& file, const std::vector<Override>& overrides,
                  const Schema& schema, Diagnostics& diagnostics);

/// The scene reference as Markdown; of one section (a top-level key or a dotted path) if given. Throws Error(usage)
/// with the nearest section if there is none.
std::string scene_reference(const Schema& schema, const std::string& section = "");

/// Converts "7.85 g/cm^3" to the SI unit `to`; plain numbers are SI. Throws std::invalid_argument saying what was
/// expected.
double parse_quantity(const std::string& text, const std::string& to);

}  // namespace tenon::scene
