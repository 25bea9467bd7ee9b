// SPDX-License-Identifier: MIT
/// Key of the scene file, described in a single place: value type, unit, range, default, and one sentence of help. A section of the scene
/// (a volume, a link of the chain, a light ...) is a list of keys. Its reader and writer (struct_schema.h), the JSON Schema and the tables
/// of docs/reference/scene.md (documents.h), the list of files that a scene names, and the controls of the window are all generated from
/// it.
///
///   schema::number("radius", "world", "Radius of the sphere.").positive().required()
///   schema::choice("shading", {"flat", "smooth"}, "Shading of the surface.")
///
/// Keys are made at program start and read from any thread.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/export.h"

namespace catena::schema {

/// Type of a value.
enum class ValueType {
  number,
  integer,
  boolean,
  text,
  choice,    ///< one of `options`
  vector,    ///< `count` numbers: [x, y, z], a quaternion, an interval
  color,     ///< [r, g, b], display (sRGB) components from 0 to 1
  numbers,   ///< list of numbers of any length
  texts,     ///< list of strings, for example of names
  points,    ///< list of [x, y, z]
  table,     ///< rows of `count` numbers; the first number increases from row to row
  rotation,  ///< three rows, nine numbers, or {"axis", "angle_deg"}
  null,      ///< the literal null
  object,    ///< object with the keys `members`
  any_of,    ///< one of `alternatives`, which have no names
};

/// Kind of scene item that a value names or stands for; none: an ordinary value.
enum class Role { none, scalar_field, vector_field, any_field, mesh, curves, points, widget, level, file };

/// Bounds of a number, or of each number of a vector. An open bound does not belong to the range.
struct CATENA_EXPORT Limits {
  std::optional<double> lo, hi;           ///< lower and upper bound; nullopt: unbounded
  bool lo_open = false, hi_open = false;  ///< true: the bound itself is excluded
  /// Returns true when a number is in the range.
  bool contains(double x) const;
  /// Returns the range as text: "> 0", "0 to 1", "at most 8"; empty: unbounded.
  std::string to_string() const;
};

/// Description of one key. Plain data: the functions below create it; its member functions return a changed copy.
struct Key {
  std::string name;                          ///< name in the file
  ValueType value_type = ValueType::number;  ///< type of the value
  std::string unit;                          ///< "world" (world units), "value" (unit of the field), "N/m" ...
  std::string help;                          ///< one sentence
  std::string range_text = {};               ///< range in words, where the limits do not express it: "increasing", "not 0"
  std::string default_text = {};             ///< default in words, or JSON text when it is a value
  Limits limits = {};                        ///< limits of a number, or of each of several
  int count = 0;                             ///< number of numbers in a vector, or in a row of a table
  int min_size = 0;                          ///< minimum number of items of a list
  int max_size = 0;                          ///< maximum number of items of a list, or bytes of a text; 0: unlimited
  Role role = Role::none;                    ///< kind of scene item that the value names
  bool is_required = false;                  ///< the key must be present in the file
  /// An optional key that new items nevertheless include, because without it they have little effect.
  bool is_recommended = false;
  /// Initial value for a new item in the window: JSON text, "0.1 L" (a fraction of L, the length of the whole scene), "hand" (position of
  /// the probe) or "hand + 0.1 L". Empty: positions start at the probe, lengths at 0.02 L, choices with the first option.
  std::string initial_value = {};
  bool is_identifier = false;                            ///< the text must match [a-z][a-z0-9_]*
  bool has_default = true;                               ///< an absent key means the default of the struct
  bool accepts_field_map = false;                        ///< a number that may be replaced by an object {"field", "map", ...}
  bool accepts_widget = false;                           ///< the value may be replaced by {"widget": NAME}
  std::vector<std::string> options = {};                 ///< names allowed for ValueType::choice
  std::vector<Key> alternatives = {};                    ///< allowed types for ValueType::any_of
  std::shared_ptr<const std::vector<Key>> members = {};  ///< keys for ValueType::object

  /// Returns a copy that must be present in the file.
  Key required() const {
    return with([](Key& k) { k.is_required = true; });
  }
  /// Returns a copy that new items include.
  Key recommended() const {
    return with([](Key& k) { k.is_recommended = true; });
  }
  /// Returns a copy whose number must be > 0.
  Key positive() const { return with_limits({0.0, {}, true}); }
  /// Returns a copy whose number must be >= 0.
  Key non_negative() const { return with_limits({0.0, {}}); }
  /// Returns a copy whose number must be from lo to hi, both included.
  Key within(double lo, double hi) const { return with_limits({lo, hi}); }
  /// Returns a copy with these limits.
  Key with_limits(const Limits& l) const {
    return with([&](Key& k) { k.limits = l; });
  }
  /// Returns a copy with the range in words.
  Key with_range_text(const std::string& text) const {
    return with([&](Key& k) { k.range_text = text; });
  }
  /// Returns a copy whose absence means something other than the default of the struct.
  Key without_default() const {
    return with([](Key& k) { k.has_default = false; });
  }
  /// Returns a copy with the default in words or as JSON text.
  Key with_default(const std::string& text) const {
    return with([&](Key& k) { k.default_text = text; });
  }
  /// Returns a copy with the initial value for a new item in the window.
  Key with_initial_value(const std::string& text) const {
    return with([&](Key& k) { k.initial_value = text; });
  }
  /// Returns a copy that names a scene item of this kind.
  Key with_role(Role r) const {
    return with([&](Key& k) { k.role = r; });
  }
  /// Returns a copy that has from lo to hi items; hi 0: unlimited.
  Key with_size(int lo, int hi) const {
    return with([&](Key& k) { k.min_size = lo, k.max_size = hi; });
  }
  /// Returns a copy that may be replaced by an object that maps a field to the number.
  Key or_field() const {
    return with([](Key& k) { k.accepts_field_map = true; });
  }
  /// Returns a copy that may be replaced by the name of a widget.
  Key or_widget() const {
    return with([](Key& k) { k.accepts_widget = true; });
  }

 private:
  template <class Change>
  Key with(Change&& change) const {
    Key k = *this;
    change(k);
    return k;
  }
};

/// Keys in the order in which the documents list them.
using Keys = std::vector<Key>;

/// Makes a key for a number; `unit` "" means none.
CATENA_EXPORT Key number(const std::string& name, const std::string& unit, const std::string& help);
/// Makes a key for an integer from `minimum` to `maximum`.
CATENA_EXPORT Key integer(const std::string& name, const std::string& unit, const std::string& help, int minimum, int maximum);
/// Makes a key for true or false.
CATENA_EXPORT Key boolean(const std::string& name, const std::string& help);
/// Makes a key for any text.
CATENA_EXPORT Key text(const std::string& name, const std::string& help);
/// Makes a key for a name that other keys may refer to: [a-z][a-z0-9_]*.
CATENA_EXPORT Key identifier(const std::string& name, const std::string& help);
/// Makes a key for one of `words`.
CATENA_EXPORT Key choice(const std::string& name, std::vector<std::string> words, const std::string& help);
/// Makes a key for three numbers.
CATENA_EXPORT Key vec3(const std::string& name, const std::string& unit, const std::string& help);
/// Makes a key for a vector of any length except 0.
CATENA_EXPORT Key direction(const std::string& name, const std::string& help);
/// Makes a key for `count` numbers.
CATENA_EXPORT Key vector(const std::string& name, int count, const std::string& unit, const std::string& help);
/// Makes a key for a color [r, g, b], 0 to 1.
CATENA_EXPORT Key color(const std::string& name, const std::string& help);
/// Makes a key for a list of any number of numbers.
CATENA_EXPORT Key numbers(const std::string& name, const std::string& unit, const std::string& help);
/// Makes a key for a list of strings.
CATENA_EXPORT Key texts(const std::string& name, const std::string& help);
/// Makes a key for a list of at least one [x, y, z].
CATENA_EXPORT Key points(const std::string& name, const std::string& unit, const std::string& help);
/// Makes a key for a list of at least one row of `width` numbers.
CATENA_EXPORT Key table(const std::string& name, int width, const std::string& unit, const std::string& help);
/// Makes a key for a rotation in a form that json::as_rotation reads.
CATENA_EXPORT Key rotation(const std::string& name, const std::string& help);
/// Makes the literal null, as one of several alternatives.
CATENA_EXPORT Key null();
/// Makes a key for an object with keys of its own.
CATENA_EXPORT Key object(const std::string& name, Keys inner, const std::string& help);
/// Makes a key that accepts several types; the first of `choices` is the usual one.
CATENA_EXPORT Key any_of(const std::string& name, Keys choices, const std::string& help);
/// Makes a key for the name of a field, mesh, curves, points or widget.
CATENA_EXPORT Key reference(const std::string& name, Role role, const std::string& help);
/// Makes a key for a file name, relative to the folder of the scene file.
CATENA_EXPORT Key file(const std::string& name, const std::string& help);
/// Key for the criterion by which vortex core lines are found (engine/geometry/flow/vortex_cores.h).
CATENA_EXPORT Key core_criterion_key();
/// Key for the minimum length of a core line.
CATENA_EXPORT Key core_length_key();
/// Key for the minimum mean swirl of a core line, relative to that of the strongest one.
CATENA_EXPORT Key core_swirl_key();
/// Key "kind" of a vector field: vectors, or lines without a direction.
CATENA_EXPORT Key line_kind_key();

/// Returns the key with a name; null: there is none.
CATENA_EXPORT const Key* find(const Keys& keys, std::string_view name);
/// Returns the keys of `first`, followed by those of `second`.
CATENA_EXPORT Keys concatenate(Keys first, const Keys& second);
/// Returns the names of the keys, for json::check_known_keys.
CATENA_EXPORT std::vector<std::string_view> key_names(const Keys& keys);
/// Returns the names of both lists in order.
CATENA_EXPORT std::vector<std::string_view> key_names(const Keys& first, const Keys& second);
/// Returns the options of a choice, for json::get_choice.
CATENA_EXPORT std::vector<std::string_view> option_names(const Key& key);

/// One of several kinds of items of a section: a streamline among links, a raw file among fields.
struct Variant {
  /// Name: the value of "type", or the key whose presence distinguishes it from the others.
  std::string name;
  std::string help;  ///< one or two sentences
  Keys keys = {};    ///< keys in addition to those of the section
};

/// Section of the scene file: the value at one of its top-level keys.
struct Section {
  /// Form of the value.
  enum class Layout {
    object,  ///< one object
    list,    ///< an array of objects
    map,     ///< an object of named objects: names -> objects
    on_off,  ///< true, false, or an object
    value    ///< a single value, described by the only key in `keys`
  };
  std::string name;                ///< top-level key: "isosurfaces"
  std::string help;                ///< one or two sentences
  Layout layout = Layout::object;  ///< form of the value
  Keys keys = {};                  ///< keys of the object, or of each item
  int max_items = 0;               ///< maximum number of items of a list; 0: unlimited
  /// Kinds of items; empty: all items are alike. "type" selects one where `keys` contains that key.
  std::vector<Variant> variants = {};
};

}  // namespace catena::schema
