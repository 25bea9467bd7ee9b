/// A key of the scene file, stated once: what it takes, its unit, its range, its default, and one sentence for a person. A component of
/// the scene (a volume, a link of the chain, a light ...) is a list of them. Its reader and writer (table.h), the JSON Schema
/// (documents.h), the tables of docs/scene.md, the files that a scene names and the window's controls all come from it.
///
///   schema::number("radius", "world", "Its radius.").positive().required()
///   schema::word("shading", {"flat", "smooth"}, "How it is lit.")
///
/// Made at start-up, read from any thread.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace catena::schema {

/// The shape of a value.
enum class ValueType {
  number,
  integer,
  boolean,
  text,
  choice,    ///< one of `words`
  vector,    ///< `count` numbers: [x, y, z], a quaternion, an interval
  color,     ///< [r, g, b], display (sRGB) components from 0 to 1
  numbers,   ///< a list of any length
  texts,     ///< a list of strings, of names for instance
  points,    ///< a list of [x, y, z]
  table,     ///< rows of `count` numbers, the first of each rising
  rotation,  ///< three rows, nine numbers, or {"axis", "angle_deg"}
  null,      ///< null
  object,    ///< `inner`
  any_of,    ///< one of `choices`, which have no names
};

/// What of the scene a value names or stands for.
enum class Role { none, scalar_field, vector_field, any_field, mesh, curves, points, widget, level, file };

/// Bounds of a number, or of each number of a vector. An open bound does not belong to the range.
struct Limits {
  std::optional<double> lo, hi;           ///< least and greatest number; none: no bound
  bool lo_open = false, hi_open = false;  ///< the bound itself does not belong to it
  /// Whether a number lies within them.
  bool contains(double x) const;
  /// "> 0", "0 to 1", "at most 8"; empty: any.
  std::string to_string() const;
};

/// One key. Plain data: the functions below make it, and its own functions return a changed copy.
struct Key {
  std::string name;                          ///< as the file has it
  ValueType value_type = ValueType::number;  ///< the shape of its value
  std::string unit;                          ///< "world" (world units), "value" (of the field), "N/m" ...
  std::string help;                          ///< one sentence
  std::string range_text = {};               ///< in words, where the limits do not say it: "rising", "not 0"
  std::string default_text = {};             ///< the default in words; JSON text where it is a value
  Limits limits = {};                        ///< of a number, or of each of several
  int count = 0;                             ///< of a vector's numbers, of a row's
  int min_size = 0;                          ///< items of a list
  int max_size = 0;                          ///< items of a list, bytes of a text; 0: any number
  Role role = Role::none;                    ///< what of the scene it names
  bool is_required = false;                  ///< the file must have it
  bool is_recommended = false;               ///< a new component states it though it need not: without it the component means little
  /// How a new one begins in the window: JSON text, "0.1 L" (a share of the length of all that is there), "hand" (a place where the hand
  /// is) or "hand + 0.1 L"; empty: places begin at the hand, lengths with 0.02 L, words with the first one.
  std::string initial_value = {};
  bool is_identifier = false;                            ///< [a-z][a-z0-9_]*
  bool has_default = true;                               ///< what is left out means `fallback`
  bool accepts_field_map = false;                        ///< a number that may be an object {"field", "map", ...} instead
  bool accepts_widget = false;                           ///< or {"widget": NAME}
  std::vector<std::string> options = {};                 ///< of Form::word
  std::vector<Key> alternatives = {};                    ///< any_of
  std::shared_ptr<const std::vector<Key>> members = {};  ///< object

  /// A copy: the file must have the key.
  Key required() const {
    return with([](Key& k) { k.is_required = true; });
  }
  /// A copy: new components state the key.
  Key recommended() const {
    return with([](Key& k) { k.is_recommended = true; });
  }
  /// A copy: more than 0.
  Key positive() const { return with_limits({0.0, {}, true}); }
  /// A copy: 0 or more.
  Key non_negative() const { return with_limits({0.0, {}}); }
  /// A copy: from lo to hi, both included.
  Key within(double lo, double hi) const { return with_limits({lo, hi}); }
  /// A copy with these limits.
  Key with_limits(const Limits& l) const {
    return with([&](Key& k) { k.limits = l; });
  }
  /// The range in words.
  Key with_range_text(const std::string& text) const {
    return with([&](Key& k) { k.range_text = text; });
  }
  /// Left out it means something else than its value at the start.
  Key without_default() const {
    return with([](Key& k) { k.has_default = false; });
  }
  /// The default, in words or as JSON text.
  Key with_default(const std::string& text) const {
    return with([&](Key& k) { k.default_text = text; });
  }
  /// A copy that begins like this in the window.
  Key with_initial_value(const std::string& text) const {
    return with([&](Key& k) { k.initial_value = text; });
  }
  /// A copy that names such a thing of the scene.
  Key with_role(Role r) const {
    return with([&](Key& k) { k.role = r; });
  }
  /// A copy that takes from lo to hi items; hi 0: any number.
  Key with_size(int lo, int hi) const {
    return with([&](Key& k) { k.min_size = lo, k.max_size = hi; });
  }
  /// A copy that may be an object which follows a field.
  Key or_field() const {
    return with([](Key& k) { k.accepts_field_map = true; });
  }
  /// A copy that may name a widget.
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

/// Keys in the order of the documents.
using Keys = std::vector<Key>;

/// A number with a unit; "" has none.
Key number(const std::string& name, const std::string& unit, const std::string& help);
/// A whole number from `least` to `most`.
Key integer(const std::string& name, const std::string& unit, const std::string& help, int least, int most);
/// True or false.
Key boolean(const std::string& name, const std::string& help);
/// Any text.
Key text(const std::string& name, const std::string& help);
/// A name that others may use: [a-z][a-z0-9_]*.
Key identifier(const std::string& name, const std::string& help);
/// One of `words`.
Key choice(const std::string& name, std::vector<std::string> words, const std::string& help);
/// Three numbers.
Key vec3(const std::string& name, const std::string& unit, const std::string& help);
/// An arrow of any length but 0.
Key direction(const std::string& name, const std::string& help);
/// `count` numbers.
Key vector(const std::string& name, int count, const std::string& unit, const std::string& help);
/// [r, g, b], 0 to 1.
Key color(const std::string& name, const std::string& help);
/// A list of numbers of any length.
Key numbers(const std::string& name, const std::string& unit, const std::string& help);
/// A list of texts.
Key texts(const std::string& name, const std::string& help);
/// A list of [x, y, z].
Key points(const std::string& name, const std::string& unit, const std::string& help);
/// A list of rows of `width` numbers.
Key table(const std::string& name, int width, const std::string& unit, const std::string& help);
/// A rotation, as json::as_rotation reads it.
Key rotation(const std::string& name, const std::string& help);
/// The word null, as one of several choices.
Key null();
/// An object with keys of its own.
Key object(const std::string& name, Keys inner, const std::string& help);
/// Several forms in one key; the first is the usual one.
Key any_of(const std::string& name, Keys choices, const std::string& help);
/// The name of a field, a mesh, curves, points, a widget.
Key reference(const std::string& name, Role role, const std::string& help);
/// A file's name, relative to the scene's file.
Key file(const std::string& name, const std::string& help);
/// How the core lines of vortices are traced (engine/geometry/flow/vortex_cores.h).
Key core_criterion_key();
/// The least length of a core line.
Key core_length_key();
/// Its least swirl, of the strongest one's.
Key core_swirl_key();
/// "kind" of a vector field: vectors, or lines without a direction.
Key line_kind_key();

/// The key of that name; null: none.
const Key* find(const Keys& keys, std::string_view name);
/// `first`, then `second`.
Keys concatenate(Keys first, const Keys& second);
/// The names of the keys, for json::check_known_keys.
std::vector<std::string_view> key_names(const Keys& keys);
/// Of both, in order.
std::vector<std::string_view> key_names(const Keys& first, const Keys& second);
/// The words of a choice as json::get_choice takes them.
std::vector<std::string_view> option_names(const Key& key);

/// What an item of a component may be: a streamline among links, a raw file among fields.
struct Variant {
  std::string name;  ///< its word: of "type", or of the key that tells it from the others
  std::string help;  ///< one or two sentences
  Keys keys = {};    ///< beside the component's own
};

/// A part of the scene file: what stands at one of its top-level keys.
struct Section {
  /// What stands at the key.
  enum class Layout {
    object,
    list,    ///< an array of objects
    map,     ///< names -> objects
    on_off,  ///< true, false, or an object
    value    ///< `keys` has one key: the part itself
  };
  std::string name;                ///< "isosurfaces"
  std::string help;                ///< one or two sentences
  Layout layout = Layout::object;  ///< what stands at its key
  Keys keys = {};                  ///< of the object, or of each item
  int max_items = 0;               ///< items of a list; 0: any number
  /// Empty, or each item is one of these; told by "type" where `keys` has that.
  std::vector<Variant> variants = {};
};

}  // namespace catena::schema
