// SPDX-License-Identifier: MIT
#include "engine/schema/key.h"

#include <cmath>

#include "engine/base/numbers.h"

namespace catena::schema {

namespace {

Key make_key(const std::string& name, ValueType form, const std::string& unit, const std::string& help) {
  Key key;
  key.name = name;
  key.value_type = form;
  key.unit = unit;
  key.help = help;
  return key;
}

}  // namespace

bool Limits::contains(double x) const {
  return !(lo && (lo_open ? !(x > *lo) : !(x >= *lo))) && !(hi && (hi_open ? !(x < *hi) : !(x <= *hi)));
}

namespace {

/// Formats a number without the plus sign of an exponent: 100000, 1e15 instead of 1e+05, 1e+15.
std::string number_text(double x) {
  if (x == std::floor(x) && std::fabs(x) < 1e7) return std::to_string(static_cast<long long>(x));
  std::string text = to_text(x);
  std::erase(text, '+');
  return text;
}

}  // namespace

std::string Limits::to_string() const {
  if (lo && hi && !lo_open) return number_text(*lo) + " to " + (hi_open ? "below " : "") + number_text(*hi);
  if (lo && hi) return "> " + number_text(*lo) + (hi_open ? ", below " : ", at most ") + number_text(*hi);
  if (lo) return (lo_open ? "> " : ">= ") + number_text(*lo);
  if (hi) return (hi_open ? "below " : "at most ") + number_text(*hi);
  return {};
}

Key number(const std::string& name, const std::string& unit, const std::string& help) {
  return make_key(name, ValueType::number, unit, help);
}
Key integer(const std::string& name, const std::string& unit, const std::string& help, int minimum, int maximum) {
  return make_key(name, ValueType::integer, unit, help).within(minimum, maximum);
}
Key boolean(const std::string& name, const std::string& help) { return make_key(name, ValueType::boolean, {}, help); }
Key text(const std::string& name, const std::string& help) { return make_key(name, ValueType::text, {}, help); }
Key identifier(const std::string& name, const std::string& help) {
  Key key = text(name, help);
  key.is_identifier = true;
  return key;
}
Key choice(const std::string& name, std::vector<std::string> words, const std::string& help) {
  Key key = make_key(name, ValueType::choice, {}, help);
  key.options = std::move(words);
  return key;
}
Key vector(const std::string& name, int count, const std::string& unit, const std::string& help) {
  Key key = make_key(name, ValueType::vector, unit, help);
  key.count = count;
  return key;
}
Key vec3(const std::string& name, const std::string& unit, const std::string& help) { return vector(name, 3, unit, help); }
Key direction(const std::string& name, const std::string& help) { return vec3(name, {}, help).with_range_text("not 0"); }
Key color(const std::string& name, const std::string& help) { return make_key(name, ValueType::color, {}, help).within(0, 1); }
Key numbers(const std::string& name, const std::string& unit, const std::string& help) {
  return make_key(name, ValueType::numbers, unit, help);
}
Key texts(const std::string& name, const std::string& help) { return make_key(name, ValueType::texts, {}, help); }
Key points(const std::string& name, const std::string& unit, const std::string& help) {
  return make_key(name, ValueType::points, unit, help).with_size(1, 0);
}
Key table(const std::string& name, int width, const std::string& unit, const std::string& help) {
  Key key = make_key(name, ValueType::table, unit, help).with_size(1, 0);
  key.count = width;
  return key;
}
Key rotation(const std::string& name, const std::string& help) { return make_key(name, ValueType::rotation, {}, help); }
Key null() { return make_key({}, ValueType::null, {}, {}); }
Key object(const std::string& name, Keys inner, const std::string& help) {
  Key key = make_key(name, ValueType::object, {}, help);
  key.members = std::make_shared<const Keys>(std::move(inner));
  return key;
}
Key any_of(const std::string& name, Keys choices, const std::string& help) {
  Key key = make_key(name, ValueType::any_of, choices.front().unit, help);
  key.alternatives = std::move(choices);
  return key;
}
Key reference(const std::string& name, Role role, const std::string& help) { return text(name, help).with_role(role); }
Key file(const std::string& name, const std::string& help) { return text(name, help).with_role(Role::file); }
Key core_criterion_key() {
  return choice("criterion", {"sujudi-haimes", "parallel-vectors", "vorticity"}, "Criterion that defines a vortex core line.")
      .with_default("\"sujudi-haimes\"");
}

Key core_length_key() {
  return number("min_length", "world", "Minimum length of a core line; shorter lines are discarded.")
      .positive()
      .with_default("6 voxels; formulas 0.02 L");
}

Key core_swirl_key() {
  return number("min_swirl", "",
                "Minimum mean swirl of a core line, as a fraction of that of the strongest line; weaker lines are discarded.")
      .within(0, 1)
      .with_default("0.05");
}

Key line_kind_key() {
  return choice("kind", {"vector", "line"}, "Kind of the vector field; `line`: v and -v are equivalent, as for fibre directions.")
      .with_default("\"vector\"");
}

const Key* find(const Keys& keys, std::string_view name) {
  for (const Key& key : keys)
    if (key.name == name) return &key;
  return nullptr;
}

Keys concatenate(Keys first, const Keys& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::vector<std::string_view> key_names(const Keys& keys) {
  std::vector<std::string_view> names;
  for (const Key& key : keys) names.push_back(key.name);
  return names;
}

std::vector<std::string_view> key_names(const Keys& first, const Keys& second) {
  std::vector<std::string_view> names = key_names(first);
  for (const Key& key : second) names.push_back(key.name);
  return names;
}

std::vector<std::string_view> option_names(const Key& key) { return {key.options.begin(), key.options.end()}; }

}  // namespace catena::schema
