// SPDX-License-Identifier: BSD-3-Clause
// Building a schema key by key.
#include "framework/scene/schema.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/scene/tree.hpp"
#include "framework/scene/validate.hpp"

namespace tenon::scene {
namespace {

Key make_key(std::string name, Key::Type type, std::string doc, std::string unit = "", Range range = {}) {
  Key key;
  key.name = std::move(name);
  key.type = type;
  key.doc = std::move(doc);
  key.unit = std::move(unit);
  key.range = range;
  return key;
}

Key make_block(std::string name, Key::Type type, Schema nested, std::string doc) {
  Key key = make_key(std::move(name), type, std::move(doc));
  key.nested = std::make_shared<const Schema>(std::move(nested));
  return key;
}

}  // namespace

const Key* Schema::find(const std::string& name) const {
  const auto found = std::find_if(keys_.begin(), keys_.end(), [&](const Key& key) { return key.name == name; });
  return found == keys_.end() ? nullptr : &*found;
}

Schema& Schema::add(Key key) {
  if (key.name.empty() || find(key.name) != nullptr)
    throw std::logic_error("schema '" + doc_ + "' has the key '" + key.name + "' twice, or a key without a name");
  for (const std::string& unit : {key.unit, key.x_unit}) {
    const std::string in_si = "1 " + (unit == temperature_difference ? std::string("K") : unit);
    if (!unit.empty() && unit != "1") parse_quantity(in_si, unit);
  }
  check_default(key);
  keys_.push_back(std::move(key));
  return *this;
}

void Schema::check_default(const Key& key) const {
  if (key.default_value.empty()) return;
  Diagnostics diagnostics;
  const Place place{nullptr, 0, 0};
  const auto tree = read_tree(key.default_value, "default", &place, diagnostics);
  if (tree) Validator(diagnostics).content(*tree, key, {key.name, place});
  if (diagnostics.any())
    throw std::logic_error("default of the key '" + key.name + "': " + diagnostics.errors().front());
}

Schema& Schema::quantity(std::string name, std::string unit, std::string doc, std::string default_value, Range range) {
  Key key = make_key(std::move(name), Key::Type::quantity, std::move(doc), std::move(unit), range);
  key.default_value = std::move(default_value);
  return add(std::move(key));
}
Schema& Schema::required_quantity(std::string name, std::string unit, std::string doc, Range range) {
  return quantity(std::move(name), std::move(unit), std::move(doc), "", range).required();
}
Schema& Schema::integer(std::string name, std::string doc, std::string default_value, Range range) {
  Key key = make_key(std::move(name), Key::Type::integer, std::move(doc), "", range);
  key.default_value = std::move(default_value);
  return add(std::move(key));
}
Schema& Schema::flag(std::string name, std::string doc, std::string default_value) {
  Key key = make_key(std::move(name), Key::Type::flag, std::move(doc));
  key.default_value = std::move(default_value);
  return add(std::move(key));
}
Schema& Schema::text(std::string name, std::string doc, std::string default_value) {
  Key key = make_key(std::move(name), Key::Type::text, std::move(doc));
  key.default_value = std::move(default_value);
  return add(std::move(key));
}
Schema& Schema::choice(std::string name, std::vector<std::string> choices, std::string doc, std::string default_value) {
  Key key = make_key(std::move(name), Key::Type::choice, std::move(doc));
  key.choices = std::move(choices);
  key.default_value = std::move(default_value);
  return add(std::move(key));
}
Schema& Schema::reals(std::string name, std::string unit, std::string doc, Range range) {
  return add(make_key(std::move(name), Key::Type::reals, std::move(doc), std::move(unit), range));
}
Schema& Schema::vector(std::string name, std::string unit, std::string doc, std::string default_value) {
  Key key = make_key(std::move(name), Key::Type::vector, std::move(doc), std::move(unit));
  key.default_value = std::move(default_value);
  return add(std::move(key));
}
Schema& Schema::texts(std::string name, std::string doc) {
  return add(make_key(std::move(name), Key::Type::texts, std::move(doc)));
}
Schema& Schema::function(std::string name, std::string unit, std::string doc) {
  return add(make_key(std::move(name), Key::Type::function, std::move(doc), std::move(unit)));
}
Schema& Schema::field_function(std::string name, std::string unit, std::string doc) {
  return add(make_key(std::move(name), Key::Type::field_function, std::move(doc), std::move(unit)));
}
Schema& Schema::table(std::string name, std::string x_name, std::string x_unit, std::string unit, std::string doc,
                      Range range) {
  Key key = make_key(std::move(name), Key::Type::table, std::move(doc), std::move(unit), range);
  key.x_name = std::move(x_name);
  key.x_unit = std::move(x_unit);
  return add(std::move(key));
}
Schema& Schema::object(std::string name, Schema nested, std::string doc) {
  return add(make_block(std::move(name), Key::Type::object, std::move(nested), std::move(doc)));
}
Schema& Schema::list(std::string name, Schema nested, std::string doc) {
  return add(make_block(std::move(name), Key::Type::list, std::move(nested), std::move(doc)));
}
Schema& Schema::named(std::string name, Schema nested, std::string doc) {
  return add(make_block(std::move(name), Key::Type::named, std::move(nested), std::move(doc)));
}

Schema& Schema::variants(std::string name, Key::Type container, std::vector<std::pair<std::string, Schema>> variants,
                         std::string doc) {
  if (container == Key::Type::object) container = Key::Type::variants;
  if (container != Key::Type::variants && container != Key::Type::named && container != Key::Type::list)
    throw std::logic_error("the variants of '" + name + "' need a mapping, named blocks or a list around them");
  if (variants.empty()) throw std::logic_error("the key '" + name + "' has no variants");
  Key key = make_key(std::move(name), container, std::move(doc));
  for (auto& [type, schema] : variants)
    key.variants.emplace_back(type, std::make_shared<const Schema>(std::move(schema)));
  return add(std::move(key));
}

Schema& Schema::required() {
  keys_.at(keys_.size() - 1).required = true;
  return *this;
}
Schema& Schema::with_default(std::string default_value) {
  Key& key = keys_.at(keys_.size() - 1);
  key.default_value = std::move(default_value);
  check_default(key);
  return *this;
}
Schema& Schema::with_range(Range range) {
  Key& key = keys_.at(keys_.size() - 1);
  key.range = range;
  check_default(key);
  return *this;
}

Schema& Schema::exactly_one(std::vector<std::string> keys) {
  groups_.push_back({std::move(keys), true});
  return *this;
}
Schema& Schema::at_most_one(std::vector<std::string> keys) {
  groups_.push_back({std::move(keys), false});
  return *this;
}

}  // namespace tenon::scene
