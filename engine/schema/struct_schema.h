// SPDX-License-Identifier: MIT
/// Keys of one struct with the members that store their values: generates the struct's reader and writer. T is the struct, C the context
/// that reading needs in addition (the scene). A key is bound to a member, or to a reference that a function returns for the struct, and is
/// then read and written automatically; or it has a custom reader. Conditions on several keys are checks, which run after all keys have
/// been read.
///
///   StructSchema<Light, Scene>()
///       .bind(direction("direction", "Towards the light.").required(), &Light::direction)
///       .bind(number("intensity", "", "Factor on the color of the light.").non_negative(), &Light::intensity)
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/schema/values.h"

namespace catena::schema {

/// Keys with their values as JSON text.
using Members = std::vector<std::pair<std::string, std::string>>;

/// Schema of a struct T. Built at program start, then read-only: any thread.
template <class T, class C>
class StructSchema {
 public:
  /// Reads one or several keys of `object` into T.
  using Read = std::function<Outcome(C&, const json::Node& object, T&)>;
  /// Returns the value of a key as JSON text; empty: the key is not written.
  using Write = std::function<std::string(const C&, const T&)>;
  /// Returns several keys with their values.
  using WriteMany = std::function<Members(const C&, const T&)>;

  /// Binds a key. `access`: a pointer to a member, or a function from (const) T& to a reference. When the key states no default, its
  /// default is the value in a default-constructed T.
  template <class Access>
  StructSchema& bind(Key key, Access access) {
    const T defaults{};
    const auto& value = std::invoke(access, defaults);
    const std::string default_text = to_json_text(key, value);
    if (key.default_text.empty() && key.has_default && !key.is_required && key.value_type != ValueType::text)
      key.default_text = default_text;
    rows_.push_back({[key, access](C&, const json::Node& object, T& out) { return read_value(key, object, std::invoke(access, out)); },
                     [key, access, default_text](const C&, const T& in) {
                       std::string text = to_json_text(key, std::invoke(access, in));
                       return key.is_required || text != default_text ? text : std::string();
                     }});
    keys_.push_back(std::move(key));
    return *this;
  }

  /// Adds a key with a custom reader and an optional writer. `read` is called whether or not the key is present.
  StructSchema& custom(Key key, Read read, Write write = {}) {
    rows_.push_back({std::move(read), std::move(write)});
    keys_.push_back(std::move(key));
    return *this;
  }
  /// Adds a key that is read together with another key.
  StructSchema& companion(Key key, Write write = {}) {
    rows_.push_back({{}, std::move(write)});
    keys_.push_back(std::move(key));
    return *this;
  }
  /// Adds keys that `read` reads together, at the position of the first of them in the table.
  StructSchema& group(const Keys& keys, Read read, WriteMany write = {}) {
    for (const Key& key : keys) {
      rows_.push_back({std::exchange(read, {}), {}, std::exchange(write, {})});
      keys_.push_back(key);
    }
    return *this;
  }
  /// Adds a check that runs after all keys have been read.
  StructSchema& check(Read check) {
    checks_.push_back(std::move(check));
    return *this;
  }

  /// Returns the keys in the order in which they were added.
  const Keys& keys() const { return keys_; }

  /// Reads all keys of the object. Error: a key is unknown, or a value is missing, of the wrong type or out of range.
  Outcome read(C& context, const json::Node& object, T& out) const {
    CATENA_CHECK(json::check_known_keys(object, key_names(keys_)));
    return read_own_keys(context, object, out);
  }
  /// Like read(), for an object that also has keys of another schema: unknown keys are not reported.
  Outcome read_own_keys(C& context, const json::Node& object, T& out) const {
    for (const Row& row : rows_)
      if (row.read) CATENA_CHECK(row.read(context, object, out));
    for (const Read& check : checks_) CATENA_CHECK(check(context, object, out));
    return Done{};
  }
  /// Returns a JSON object on one line with the required keys and those that differ from their defaults.
  std::string write(const C& context, const T& in) const {
    std::string text;
    const auto add = [&](const std::string& key, const std::string& value) {
      if (!value.empty()) text += (text.empty() ? "\"" : ", \"") + key + "\": " + value;
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (rows_[i].write) add(keys_[i].name, rows_[i].write(context, in));
      if (!rows_[i].write_many) continue;
      for (const auto& [key, value] : rows_[i].write_many(context, in)) add(key, value);
    }
    return "{" + text + "}";
  }

 private:
  /// Reader and writer of one key.
  struct Row {
    Read read;
    Write write;
    WriteMany write_many = {};
  };

  /// Returns a value as JSON text; a choice by its name.
  template <class V>
  static std::string to_json_text(const Key& key, const V& value) {
    if (key.value_type == ValueType::choice)
      if constexpr (std::is_enum_v<V> || std::is_same_v<V, bool>) return write_value(key.options[static_cast<std::size_t>(value)]);
    if constexpr (std::is_enum_v<V>)
      return {};
    else
      return write_value(value);
  }
  template <class V>
  static std::string to_json_text(const Key& key, const std::optional<V>& value) {
    return value ? to_json_text(key, *value) : std::string();
  }

  Keys keys_;
  std::vector<Row> rows_;
  std::vector<Read> checks_;
};

}  // namespace catena::schema
