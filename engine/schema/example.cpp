// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "engine/base/numbers.h"
#include "engine/schema/documents.h"

namespace catena::schema {
namespace {

/// Returns a number within the limits of the key, near 1 unless they exclude that.
double example_number(const Key& key, double step) {
  const Limits& l = key.limits;
  if (l.lo && l.hi) {
    const double middle = (*l.lo + *l.hi) / 2, rounded = std::floor(middle / step) * step;
    return l.contains(1) ? 1 : l.contains(rounded) ? rounded : l.contains(*l.hi) ? *l.hi : middle;
  }
  if (l.lo) return std::max(*l.lo + step, 1.0);
  return l.hi ? std::min(*l.hi - step, 1.0) : 1;
}

std::string repeated(const std::string& item, int count) {
  std::string list;
  for (int i = 0; i < count; ++i) list += (i > 0 ? ", " : "") + item;
  return "[" + list + "]";
}

/// Returns the name of a scene item of this kind, as it occurs in the examples of the documents.
std::string example_name(Role role) {
  switch (role) {
    case Role::scalar_field:
    case Role::any_field:
      return "\"density\"";
    case Role::vector_field:
      return "\"flow\"";
    case Role::mesh:
      return "\"skull\"";
    case Role::curves:
      return "\"fibres\"";
    case Role::points:
      return "\"stars\"";
    case Role::widget:
      return "\"cut\"";
    case Role::file:
      return "\"data.vdb\"";
    case Role::level:
    case Role::none:
      break;
  }
  return "\"name\"";
}

}  // namespace

std::string example_value(const Key& key) {
  const std::string& text = key.default_text;
  const bool is_list = key.value_type == ValueType::vector || key.value_type == ValueType::color;
  if (is_list && text.starts_with('[')) return text;
  switch (key.value_type) {
    case ValueType::number: {
      // the default, or the number with which its description begins
      const std::string first = text.substr(0, text.find_first_of(" ;,:"));
      const auto value = parse_double(first);
      return value && *value != 0 && key.limits.contains(*value) ? first : to_text(example_number(key, 0.5));
    }
    case ValueType::integer:
      return to_text(example_number(key, 1));
    case ValueType::boolean:
      return text == "true" ? "false" : "true";
    case ValueType::text:
      return example_name(key.role);
    case ValueType::choice:
      return key.options.empty() ? "\"\"" : "\"" + key.options.back() + "\"";
    case ValueType::vector: {
      if (key.count == 2) {
        const double lo = key.limits.lo ? *key.limits.lo + (key.limits.lo_open ? 0.5 : 0) : 0;
        return "[" + to_text(lo) + ", " + to_text(key.limits.hi ? *key.limits.hi : lo + 1) + "]";
      }
      if (key.limits.lo && *key.limits.lo >= 0) return repeated(to_text(example_number(key, 0.5)), key.count);
      if (key.name == "min") return repeated("0", key.count);
      if (key.name == "max") return repeated("1", key.count);
      std::string list = repeated("0", key.count);
      return "[1" + list.substr(2);
    }
    case ValueType::color:
      return "[1, 0.5, 0]";
    case ValueType::numbers:
      return "[0.2, 0.5]";
    case ValueType::texts:
      return "[\"first\", \"second\"]";
    case ValueType::points:
      return "[[0, 0, 0], [1, 0, 0]]";
    case ValueType::table: {
      const std::string others = repeated("0.5", key.count - 1);
      const std::string columns = key.count > 1 ? ", " + others.substr(1) : "]";
      return "[[0" + columns + ", [1" + columns + "]";
    }
    case ValueType::rotation:
      return R"({"axis": [0, 0, 1], "angle_deg": 90})";
    case ValueType::null:
      return "null";
    case ValueType::object: {
      // the required keys, or the first one
      std::string members;
      for (const Key& member : *key.members)
        if (member.is_required) members += (members.empty() ? "\"" : ", \"") + member.name + "\": " + example_value(member);
      if (members.empty() && !key.members->empty())
        members = "\"" + key.members->front().name + "\": " + example_value(key.members->front());
      return "{" + members + "}";
    }
    case ValueType::any_of:
      return key.alternatives.empty() ? "[]" : example_value(key.alternatives.front());
  }
  return "null";
}

}  // namespace catena::schema
