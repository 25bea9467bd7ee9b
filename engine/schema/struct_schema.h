/// The keys of one struct and where their values go: from a table come its reader and its writer. C is what reading needs besides (the
/// scene). A key is bound to a member, or to what a function makes of the struct, and then read and written without more; or it is read by
/// hand. What keys must say together are checks, made after all keys have been read.
///
///   Table<Light, Scene>()
///       .bind(direction("direction", "Towards the light.").required(), &Light::direction)
///       .bind(number("intensity", "", "Its strength.").non_negative(), &Light::intensity)
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/schema/values.h"

namespace catena::schema {

/// Keys with their values as JSON text.
using Members = std::vector<std::pair<std::string, std::string>>;

template <class T, class C>
class StructSchema {
 public:
  using Read = std::function<Outcome(C&, const json::Node& object, T&)>;
  /// The value as JSON text; empty: the key is not written.
  using Write = std::function<std::string(const C&, const T&)>;
  using WriteMany = std::function<Members(const C&, const T&)>;

  /// `access`: a pointer to a member, or a function from (const) T& to a reference. Its default is that of a T, where the key has no words
  /// for it.
  template <class Access>
  StructSchema& bind(Key key, Access access) {
    const T made{};
    const auto& value = std::invoke(access, made);
    const std::string usual = to_json_text(key, value);
    if (key.default_text.empty() && key.has_default && !key.is_required && key.value_type != ValueType::text) key.default_text = usual;
    rows_.push_back({[key, access](C&, const json::Node& object, T& out) { return read_value(key, object, std::invoke(access, out)); },
                     [key, access, usual](const C&, const T& in) {
                       std::string text = to_json_text(key, std::invoke(access, in));
                       return key.is_required || text != usual ? text : std::string();
                     }});
    keys_.push_back(std::move(key));
    return *this;
  }

  /// Read by `read`, which is called whether the key is there or not; written by `write`, if at all.
  StructSchema& custom(Key key, Read read, Write write = {}) {
    rows_.push_back({std::move(read), std::move(write)});
    keys_.push_back(std::move(key));
    return *this;
  }
  /// Read together with another key.
  StructSchema& companion(Key key, Write write = {}) {
    rows_.push_back({{}, std::move(write)});
    keys_.push_back(std::move(key));
    return *this;
  }
  /// Keys that `read` reads together; the first one's place in the table is where that happens.
  StructSchema& group(const Keys& keys, Read read, WriteMany write = {}) {
    for (const Key& key : keys) {
      rows_.push_back({std::exchange(read, {}), {}, std::exchange(write, {})});
      keys_.push_back(key);
    }
    return *this;
  }
  /// A key that scenes had once: it is read, but no longer told of.
  StructSchema& deprecated(const std::string& key) {
    deprecated_.push_back(key);
    return *this;
  }
  StructSchema& check(Read check) {
    checks_.push_back(std::move(check));
    return *this;
  }

  const Keys& keys() const { return keys_; }

  /// Every key of the object is known and within its range.
  Outcome read(C& context, const json::Node& object, T& out) const {
    std::vector<std::string_view> names = key_names(keys_);
    for (const std::string& key : deprecated_)
      if (object.find(key) != nullptr) names.push_back(key);
    CATENA_CHECK(json::check_known_keys(object, names));
    return read_own_keys(context, object, out);
  }
  /// Of an object that has other keys, too, which another table knows.
  Outcome read_own_keys(C& context, const json::Node& object, T& out) const {
    for (const Row& row : rows_)
      if (row.read) CATENA_CHECK(row.read(context, object, out));
    for (const Read& check : checks_) CATENA_CHECK(check(context, object, out));
    return Done{};
  }
  /// A JSON object on one line with what must be stated and what differs from the default.
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
  struct Row {
    Read read;
    Write write;
    WriteMany write_many = {};
  };

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
  std::vector<std::string> deprecated_;
};

}  // namespace catena::schema
