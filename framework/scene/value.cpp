// SPDX-License-Identifier: BSD-3-Clause
// Access to the values of a validated scene.
#include "framework/scene/value.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/scene/value_data.hpp"

namespace tenon::scene {
namespace {

using Slot = Value::Data::Slot;

const Slot* find(const Value::Data& data, const std::string& key) {
  const auto found = std::find_if(data.slots.begin(), data.slots.end(), [&](const Slot& s) { return s.name == key; });
  return found == data.slots.end() ? nullptr : &*found;
}

const Slot& slot(const Value::Data& data, const std::string& key) {
  if (const Slot* found = find(data, key)) return *found;
  throw std::logic_error("the schema has no key '" + key + "' here");
}

/// The content of a key that must be there.
template <typename T>
const T& content(const Value::Data& data, const std::string& key, const char* type) {
  const Slot& found = slot(data, key);
  if (const T* value = std::get_if<T>(&found.content)) return *value;
  if (std::holds_alternative<std::monostate>(found.content))
    throw std::logic_error("key '" + key + "' is absent and has no default; ask has() first");
  throw std::logic_error("key '" + key + "' is not " + type);
}

/// The content of a list, which is empty if absent.
template <typename T>
T list_content(const Value::Data& data, const std::string& key, const char* type) {
  if (std::holds_alternative<std::monostate>(slot(data, key).content)) return {};
  return content<T>(data, key, type);
}

}  // namespace

bool Value::has(const std::string& key) const {
  return slot(*data_, key).has;
}
bool Value::given(const std::string& key) const {
  return slot(*data_, key).given;
}
double Value::real(const std::string& key) const {
  return content<double>(*data_, key, "a quantity");
}
std::int64_t Value::integer(const std::string& key) const {
  return content<std::int64_t>(*data_, key, "an integer");
}
bool Value::flag(const std::string& key) const {
  return content<bool>(*data_, key, "a flag");
}
const std::string& Value::text(const std::string& key) const {
  return content<std::string>(*data_, key, "a text");
}
std::vector<double> Value::reals(const std::string& key) const {
  return list_content<std::vector<double>>(*data_, key, "a list of quantities");
}
Vec3 Value::vector(const std::string& key) const {
  const auto& values = content<std::vector<double>>(*data_, key, "a vector");
  if (values.size() != 3) throw std::logic_error("key '" + key + "' is not a vector");
  return {values[0], values[1], values[2]};
}
std::vector<std::string> Value::texts(const std::string& key) const {
  return list_content<std::vector<std::string>>(*data_, key, "a list of words");
}
TimeFunction Value::function(const std::string& key) const {
  return content<TimeFunction>(*data_, key, "a function of time");
}
SpaceTimeFunction Value::field_function(const std::string& key) const {
  return content<SpaceTimeFunction>(*data_, key, "a function of time and place");
}
std::vector<std::pair<double, double>> Value::table(const std::string& key) const {
  return list_content<std::vector<std::pair<double, double>>>(*data_, key, "a table");
}
Value Value::child(const std::string& key) const {
  return content<Value>(*data_, key, "a mapping");
}
std::vector<Value> Value::items(const std::string& key) const {
  return list_content<std::vector<Value>>(*data_, key, "a list of mappings");
}

std::vector<std::pair<std::string, Value>> Value::entries(const std::string& key) const {
  std::vector<std::pair<std::string, Value>> result;
  if (std::holds_alternative<std::monostate>(slot(*data_, key).content)) return result;
  for (const NamedBlock& block : content<std::vector<NamedBlock>>(*data_, key, "a mapping of named blocks"))
    result.emplace_back(block.name, block.value);
  return result;
}

Where Value::where(const std::string& key) const {
  const Slot* found = key.empty() ? nullptr : find(*data_, key);
  return found != nullptr && found->given ? found->place.where() : data_->place.where();
}

Where Value::where_name(const std::string& key, const std::string& name) const {
  if (const auto* blocks = std::get_if<std::vector<NamedBlock>>(&slot(*data_, key).content))
    for (const NamedBlock& block : *blocks)
      if (block.name == name) return block.place.where();
  return where(key);
}

}  // namespace tenon::scene
