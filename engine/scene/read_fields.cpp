// SPDX-License-Identifier: MIT
/// Reads "fields": grids from files, analytic fields, and surfaces of labels.
#include <algorithm>
#include <filesystem>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/io/formats.h"
#include "engine/scene/labels.h"
#include "engine/scene/readers.h"
#include "engine/scene/time_steps.h"
#include "engine/scene/units.h"

namespace catena::scene {
namespace {

namespace fs = std::filesystem;
using field::LoadRequest;

constexpr int kMaxSeed = (1 << 30) - 1;
constexpr int kMaxNodes = 1024;  // along each axis of a sampled analytic field

std::string field_fault(const std::string& path) {
  return file_problem(path, io::find_reader(path, io::DataKind::volume) != nullptr, io::describe_expected(io::DataKind::volume), true);
}

// ---- fields from files ----

Key file_key(bool with_layout) {
  std::vector<std::string_view> endings;
  for (const std::string_view ending : io::readable_extensions(io::DataKind::volume))
    if (io::needs_layout(ending) == with_layout) endings.push_back(ending);
  return schema::file("file", "Data file: " + join_alternatives(endings) +
                                  (with_layout ? "." : "; or a pattern that matches a series of files, one per time step."))
      .required();
}

Keys grid_keys() {
  Keys keys{
      file_key(false),
      schema::text("grid", "Name of the grid in the file.").with_default("the first grid that can be read"),
      schema::any_of("valid", {schema::text("", ""), schema::null()},
                     "Name of the BoolGrid that masks the field; `null`: no mask. Only the default grid may be missing from the file.")
          .with_default("\"valid\""),
      schema::integer("step", "", "Time step of the field.", 0, 1'000'000).with_default("`step` of `time`"),
      schema::choice("axes", {"zyx", "xyz"}, "Order of the array's indices (`.npy`, `.npz`); `zyx`: the last index is x.")
          .with_default("`zyx`"),
      schema::vec3("spacing", "world", "Edge lengths of a voxel (`.npy`, `.npz`).").positive().with_default("`[1, 1, 1]`"),
      schema::vec3("origin", "world", "Position of the centre of the first voxel (`.npy`, `.npz`).").with_default("`[0, 0, 0]`"),
      unit_key(),
      schema::text("package", "Debian package that contains the file; named in the error message when the file is missing.")};
  return schema::concatenate(std::move(keys), grid_source_keys());
}

/// Layout of a file without a header, as given in the scene.
using LayoutTable = schema::StructSchema<field::RawLayout, const std::string>;

const LayoutTable& layout_table() {
  static const auto table = [] {
    LayoutTable t;
    t.companion(file_key(true));
    t.custom(schema::vec3("shape", "voxels", "Number of voxels along x, y and z.").within(2, 65536).required(),
             [](const std::string&, const json::Node& node, field::RawLayout& layout) -> Outcome {
               const json::Node* shape = node.find("shape");
               if (shape == nullptr)
                 return json::error_at(node, "key \"shape\" is missing; a .raw file was expected to state [nx, ny, nz]");
               CATENA_TRY(const Vec3 size, json::as_vec3(*shape, "shape"));
               for (int i = 0; i < 3; ++i)
                 if (!(size[i] >= 2 && size[i] <= 65536 && std::floor(size[i]) == size[i]))
                   return json::error_at(*shape,
                                         "\"shape\" holds " + to_text(size[i]) + "; three whole numbers from 2 to 65536 were expected");
               layout.shape = {static_cast<int>(size.x), static_cast<int>(size.y), static_cast<int>(size.z)};
               return Done{};
             });
    t.bind(schema::vec3("spacing", "world", "Edge lengths of a voxel.").positive(), &field::RawLayout::spacing);
    t.bind(schema::vec3("origin", "world", "Position of the centre of the first voxel."), &field::RawLayout::origin);
    t.custom(schema::choice("type", {"float32", "float64", "uint8", "int8", "uint16", "int16", "uint32", "int32", "float32x3"},
                            "Data type of a voxel; `float32x3`: vectors.")
                 .with_default("`float32`"),
             [](const std::string&, const json::Node& node, field::RawLayout& layout) -> Outcome {
               const Key& key = *schema::find(layout_table().keys(), "type");
               int index = 0;
               CATENA_CHECK(schema::read_choice(key, node, index));
               layout.type = key.options[static_cast<std::size_t>(index)];
               return Done{};
             });
    t.companion(unit_key());
    for (const Key& key : grid_source_keys()) t.companion(key);
    t.check([](const std::string&, const json::Node& node, field::RawLayout& layout) -> Outcome {
      if (layout.spacing.x > 0 && layout.spacing.y > 0 && layout.spacing.z > 0) return Done{};
      return json::error_at(*node.find("spacing"), "\"spacing\" is not positive; three finite numbers > 0 were expected");
    });
    return t;
  }();
  return table;
}

/// Reads "axes", "spacing" and "origin", which a NumPy array does not define.
Outcome read_array_keys(const json::Node& node, LoadRequest& request) {
  CATENA_TRY(const std::string axes, json::get_string(node, "axes", "zyx"));
  if (axes != "zyx" && axes != "xyz")
    return json::error_at(*node.find("axes"), "\"axes\" is " + in_quotes(axes) + "; \"zyx\" or \"xyz\" was expected");
  request.axes_xyz = axes == "xyz";
  for (const char* key : {"axes", "spacing", "origin"})
    if (node.find(key) != nullptr && !io::is_numpy_file(request.path))
      return json::error_at(
          *node.find(key), in_quotes(key) + " is given for a file that is not a NumPy array; it was expected for .npy and .npz files only");
  if (const json::Node* spacing = node.find("spacing")) {
    CATENA_TRY(request.spacing, json::as_vec3(*spacing, "spacing"));
    if (!(request.spacing.x > 0 && request.spacing.y > 0 && request.spacing.z > 0))
      return json::error_at(*spacing, "\"spacing\" is not positive; three finite numbers > 0 were expected");
  }
  if (const json::Node* origin = node.find("origin")) {
    CATENA_TRY(request.origin, json::as_vec3(*origin, "origin"));
  }
  return Done{};
}

/// Reads the time step of a field, and selects the file of that step if the path is a pattern.
Outcome read_series(const json::Node& node, int scene_step, LoadRequest& request, FieldSource& source) {
  source.has_own_step = node.find("step") != nullptr;
  CATENA_TRY(const int step, json::get_integer(node, "step", scene_step, 0, 1'000'000));
  if (!is_pattern(request.path)) {
    request.step = step;
    return Done{};
  }
  source.pattern = request.path;
  source.series = expand_pattern(request.path);
  if (source.series.empty())
    return json::error_at(*node.find("file"),
                          "field " + in_quotes(node.label) + ": no file matches the pattern " + in_quotes(request.path));
  request.path = source.series[static_cast<std::size_t>(std::min(step, static_cast<int>(source.series.size()) - 1))];
  return Done{};
}

Outcome read_file_source(const Scene& scene, const json::Node& node, bool replaced, FieldSource& source) {
  const std::string& scene_path = scene.path;
  CATENA_TRY(const std::string file, json::require_string(node, "file"));
  LoadRequest request;
  request.path = resolve_path(scene_path, file);
  if (!io::needs_layout(file)) CATENA_CHECK(read_series(node, scene.time.step, request, source));
  if (io::needs_layout(file)) {
    CATENA_CHECK(layout_table().read(scene_path, node, request.raw.emplace()));
  } else {
    CATENA_CHECK(json::check_known_keys(node, schema::key_names(grid_keys())));
    CATENA_TRY(request.grid, json::get_string(node, "grid", {}));
    if (const json::Node* grid = node.find("grid"); grid != nullptr && request.grid.empty())
      return json::error_at(*grid, "\"grid\" is empty; the name of a grid was expected");
    if (const json::Node* valid = node.find("valid"); valid != nullptr && valid->is_null()) {
      request.mask_grid.reset();
    } else if (valid != nullptr) {
      if (valid->kind != json::Kind::string || valid->string.empty())
        return json::error_at(*valid, "\"valid\" is not a name; the name of a BoolGrid, or null for none, was expected");
      request.mask_grid = valid->string;
      request.mask_required = true;
    }
    CATENA_CHECK(read_array_keys(node, request));
  }
  CATENA_TRY(const std::string package, json::get_string(node, "package", {}));
  if (const std::string problem = field_fault(request.path); !replaced && !problem.empty() && !is_known_file(scene, request.path))
    return json::error_at(*node.find("file"), "field " + in_quotes(node.label) + ": file " + problem +
                                                  (package.empty() ? "" : "; the Debian package " + in_quotes(package) + " contains it"));
  source.file = std::move(request);
  return read_grid_source(scene_path, node, source);
}

// ---- analytic fields ----

Keys formula_keys() {
  std::vector<std::string> names;
  for (const std::string_view name : field::analytic_names()) names.emplace_back(name);
  return {schema::choice("analytic", std::move(names), "Name of the formula.").required(),
          schema::number("scale", "", "Factor by which the values are multiplied.").with_range_text("not 0").with_default("1"),
          schema::direction("direction", "Direction of the field `uniform`, the only one that accepts this key.").with_default("[1, 0, 0]"),
          schema::vec3("center", "world", "Position of the formula's origin.").with_default("[0, 0, 0]"),
          schema::integer("seed", "", "Seed of the random numbers of `vortices`, the only field that accepts this key.", 0, kMaxSeed)
              .with_default("1"),
          schema::integer("dimensions", "",
                          "Dimensions of `vortices`, the only field that accepts this key; 2: vectors in the x-y plane, independent of z.",
                          2, 3)
              .with_default("3"),
          schema::text("part", "Grid of a formula that has several: `density`, `transmural` or `fibre` of `left-ventricle`."),
          schema::text("grid", "Synonym of `part`."),
          sampling_keys()[0],
          sampling_keys()[1],
          unit_key()};
}

Outcome read_analytic_source(const json::Node& node, FieldSource& source) {
  CATENA_CHECK(json::check_known_keys(node, schema::key_names(formula_keys())));
  CATENA_TRY(source.analytic, json::require_string(node, "analytic"));
  const json::Node& name = *node.find("analytic");
  if (!field::is_analytic(source.analytic)) {
    const auto names = field::analytic_names();
    return json::error_at(name, "unknown analytic field " + in_quotes(source.analytic) + "; one of " + join_words(names) + " was expected" +
                                    suggestion(source.analytic, names));
  }
  CATENA_TRY(source.parameters.scale, json::get_number(node, "scale", 1));
  if (source.parameters.scale == 0) return json::error_at(*node.find("scale"), "\"scale\" is 0; a finite number other than 0 was expected");

  if (const json::Node* direction_node = node.find("direction")) {
    if (source.analytic != "uniform")
      return json::error_at(*direction_node,
                            "\"direction\" does not belong to " + in_quotes(source.analytic) + "; it was expected for \"uniform\" only");
    CATENA_TRY(source.parameters.direction, json::as_vec3(*direction_node, "direction"));
    if (norm(source.parameters.direction) == 0)
      return json::error_at(*direction_node, "\"direction\" is zero; a vector other than [0, 0, 0] was expected");
  }

  CATENA_TRY(source.parameters.center, json::get_vec3(node, "center", Vec3(0.0)));
  for (const char* key : {"seed", "dimensions"})
    if (const json::Node* value = node.find(key); value != nullptr && source.analytic != "vortices")
      return json::error_at(
          *value, in_quotes(key) + " does not belong to " + in_quotes(source.analytic) + "; it was expected for \"vortices\" only");
  CATENA_TRY(source.parameters.seed, json::get_integer(node, "seed", 1, 0, kMaxSeed));
  CATENA_TRY(source.parameters.dimensions, json::get_integer(node, "dimensions", 3, 2, 3));

  // "part" selects one grid of the files that `generate` writes
  const json::Node* part = node.find("part");
  if (part != nullptr && node.find("grid") != nullptr)
    return json::error_at(*part, "both \"part\" and \"grid\" are given; one of them was expected");
  const char* part_key = part != nullptr ? "part" : "grid";
  CATENA_TRY(const std::string word, json::get_string(node, part_key, {}));
  if (const json::Node* part_node = node.find(part_key)) {
    const auto parts = field::analytic_parts(source.analytic);
    if (std::count(parts.begin(), parts.end(), word) == 0)
      return json::error_at(*part_node, "unknown part " + in_quotes(word) + " of " + in_quotes(source.analytic) + "; one of " +
                                            join_words(parts) + " was expected");
    if (word != source.analytic) source.parameters.part = word;
  }

  return read_sampling(node, source);
}

Outcome read_source(const Scene& scene, const json::Node& node, bool replaced, FieldSource& source) {
  CATENA_CHECK(json::expect_object(node, node.label));
  source.where = node;
  const bool file = node.find("file") != nullptr, analytic = node.find("analytic") != nullptr, label = node.find("label") != nullptr;
  const bool derived = node.find("derived") != nullptr, expression = node.find("expression") != nullptr;
  const int given = int(file) + int(analytic) + int(label) + int(derived) + int(expression);
  if (given != 1)
    return json::error_at(node,
                          "field " + in_quotes(node.label) + " has " + (given > 1 ? "several" : "none") +
                              " of \"file\", \"analytic\", \"label\", \"derived\" and \"expression\"; exactly one of them was expected");
  if (label) return read_label_source(node, source);
  if (derived || expression) return read_derived_source(node, source);
  return file ? read_file_source(scene, node, replaced, source) : read_analytic_source(node, source);
}

// ---- --field NAME=FILE[:GRID] ----

/// Returns the source of the field with that name; a new one if there is none.
FieldSource& source_named(Scene& scene, const std::string& name) {
  Entity entity = find_field(scene, name);
  if (!entity) {
    entity = scene.entities.create();
    scene.entities.emplace<Name>(entity, {name});
    scene.entities.emplace<FieldSource>(entity);
  }
  return scene.entities.get<FieldSource>(entity);
}

/// Replaces the source of a field by a field that the caller created in memory.
Outcome take_in_memory_field(Scene& scene, const FieldOverride& with) {
  if (!is_identifier(with.name)) return Error{"field " + in_quotes(with.name) + ": a name like [a-z][a-z0-9_]* was expected"};
  FieldSource& source = source_named(scene, with.name);
  const FieldSource defaults;
  source.file.reset();
  source.label.reset();
  source.derived.reset();
  source.analytic.clear();
  source.loaded = with.in_memory_field;
  source.rendered = {};
  load_label_map(source);
  const Bounds bounds = with.in_memory_field.get()->world_bounds();
  const double lo = std::min({bounds.lo.x, bounds.lo.y, bounds.lo.z}), hi = std::max({bounds.hi.x, bounds.hi.y, bounds.hi.z});
  source.box = lo < hi ? std::array{lo, hi} : defaults.box;
  return Done{};
}

Outcome apply_override(Scene& scene, const FieldOverride& with) {
  if (with.in_memory_field.get() != nullptr) return take_in_memory_field(scene, with);
  const std::string text = "--field " + with.name + "=" + with.file + (with.grid.empty() ? "" : ":" + with.grid);
  const auto failed = [&](const std::string& what) { return Error{one_line(text + ": " + what)}; };
  if (!is_identifier(with.name)) return failed(in_quotes(with.name) + " is not a valid name; a name like [a-z][a-z0-9_]* was expected");
  if (const std::string problem = field_fault(with.file); !problem.empty()) return failed("file " + problem);

  FieldSource& source = source_named(scene, with.name);
  LoadRequest request = source.file.value_or(LoadRequest{});
  if (io::needs_layout(with.file) && !request.raw)
    return failed("the shape of a .raw file is not known; a field of the scene that states it was expected");
  if (!io::needs_layout(with.file)) request.raw.reset();
  request.path = with.file;
  request.mask_required = false;
  source.grid_is_optional = with.grid.empty();
  if (!with.grid.empty()) request.grid = with.grid;
  source.file = request;
  source.analytic.clear();
  source.label.reset();
  source.derived.reset();
  source.where = json::Node{};
  return Done{};
}

}  // namespace

Key unit_key() {
  return schema::text("unit", "Unit shown after values, such as `\"m/s\"`. Values are not converted.")
      .with_size(0, 24)
      .with_default("the unit in the file");
}

Keys sampling_keys() {
  const FieldSource defaults;
  return {schema::integer("resolution", "nodes", "Nodes per axis of the grid that stands for the formula in images.", 2, kMaxNodes)
              .with_default(std::to_string(defaults.resolution)),
          schema::vector("box", 2, "world", "Minimum and maximum coordinate, on each axis, of the cube that is sampled for images.")
              .with_range_text("increasing")
              .with_default("[-2, 2]")};
}

Outcome read_sampling(const json::Node& node, FieldSource& source) {
  CATENA_TRY(source.resolution, json::get_integer(node, "resolution", source.resolution, 2, kMaxNodes));
  if (const json::Node* box = node.find("box")) {
    const bool pair = box->kind == json::Kind::array && box->items.size() == 2 && box->items[0].kind == json::Kind::number &&
                      box->items[1].kind == json::Kind::number;
    if (!pair || !(box->items[0].number < box->items[1].number))
      return json::error_at(*box, "\"box\" is not an interval; two finite numbers [LO, HI] with LO < HI were expected");
    source.box = {box->items[0].number, box->items[1].number};
  }
  return Done{};
}

std::string resolve_path(const std::string& scene_path, const std::string& file) {
  const fs::path path(file);
  return path.is_absolute() ? file : (fs::path(scene_path).parent_path() / path).string();
}

bool is_identifier(std::string_view text) {
  if (text.empty() || text[0] < 'a' || text[0] > 'z') return false;
  return std::all_of(text.begin(), text.end(), [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

Outcome check_name(const std::string& kind, const std::string& name, const json::Node& node) {
  if (is_identifier(name)) return Done{};
  return json::error_at(node, kind + " name " + in_quotes(name) + " is not allowed; a name like [a-z][a-z0-9_]* was expected");
}

Outcome read_fields(Scene& scene, const json::Node* fields, const std::vector<FieldOverride>& overrides) {
  if (fields != nullptr) {
    CATENA_CHECK(json::expect_object(*fields, "fields"));
    for (const auto& [name, node] : fields->members) {
      CATENA_CHECK(check_name("field", name, node));
      const auto has_name = [&name = name](const FieldOverride& o) { return o.name == name; };
      const bool replaced = std::any_of(overrides.begin(), overrides.end(), has_name);
      FieldSource source;
      CATENA_CHECK(read_source(scene, node, replaced, source));
      const Entity entity = scene.entities.create();
      scene.entities.emplace<Name>(entity, {name});
      scene.entities.emplace<FieldSource>(entity, std::move(source));
      CATENA_CHECK(read_unit(scene, entity, node));
    }
  }
  for (const FieldOverride& with : overrides) CATENA_CHECK(apply_override(scene, with));
  CATENA_CHECK(check_derived_sources(scene));
  return check_label_sources(scene);
}

Part fields_part() {
  schema::Section component{"fields",
                            "Map of names to fields: grids from files, formulas and surfaces of labels. A field has exactly one of "
                            "`file`, `analytic`, `label`, `derived` and `expression`.",
                            schema::Section::Layout::map};
  component.variants = {
      {"file", "Grid from a file that describes its own layout.", grid_keys()},
      {"raw", "Grid from a file without a header: little-endian numbers, x varying fastest.", layout_table().keys()},
      {"analytic", "Analytic formula. Haptics evaluates the formula exactly; images show a grid sampled from it.", formula_keys()},
      {"label",
       "Surface of labels of a label map, for images and haptics: the field is 1 inside the labels and 0 outside, with the surface at "
       "level 0.5.",
       label_keys()},
      {"derived", "Quantity of another field, made when something needs it: of a grid at its nodes, of a formula exactly.", derived_keys()},
      {"expression", "Expression of other fields, of the position and of the time, evaluated at nodes.", expression_keys()}};
  return {component, nullptr};
}

}  // namespace catena::scene
