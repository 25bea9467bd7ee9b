// SPDX-License-Identifier: MIT
/// Components of the scene's entities: plain structs. Lengths and positions are in world units unless stated otherwise; colors are display
/// (sRGB) colors as written in the scene file. Members named `where` are the JSON node that an item was read from; error messages take the
/// file name and line from it.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/color.h"
#include "engine/base/haptic_state.h"
#include "engine/base/json.h"
#include "engine/base/plane.h"
#include "engine/base/threshold.h"
#include "engine/field/analytic/analytic.h"
#include "engine/field/derived/quantities.h"
#include "engine/geometry/flow/vortex_cores.h"
#include "engine/io/curves/load_curves.h"
#include "engine/io/curves/load_points.h"
#include "engine/io/mesh/load_mesh.h"
#include "engine/io/volume/load_field.h"
#include "engine/scene/entity_store.h"
#include "engine/scene/label_table.h"
#include "engine/widget/widget.h"

namespace catena::scene {

/// Name of an entity in the scene file.
struct Name {
  std::string value;  ///< Unique among entities of a kind
};

struct LabelMap;  ///< Defined in labels.h

/// Source of a field that is the surface around chosen labels of a label map (engine/field/derived/label_surface.h).
struct LabelSource {
  std::string label_map;           ///< Name of the field that holds the label map
  std::vector<double> values;      ///< Labels whose voxels are inside the surface; empty with `all_labels`
  std::vector<std::string> names;  ///< Further labels, by their names in the map's table
  bool all_labels = false;         ///< All labels but 0
  double smoothing_voxels = 0;     ///< Standard deviation of the Gaussian smoothing, voxels; 0: none
  bool operator==(const LabelSource&) const = default;
};

/// Source of a field that is derived from other fields of the scene (engine/field/derived).
struct DerivedSource {
  /// How it is derived: a quantity of one field, or one of its components; a smoothed field; a field at another one's nodes; a vector of
  /// three scalar fields; expressions of variables.
  enum class Kind { quantity, component, smooth, resample, vector, expression };
  Kind kind = Kind::quantity;                             ///< How it is derived
  field::Quantity quantity = field::Quantity::magnitude;  ///< Kind::quantity
  std::vector<std::string> sources;                       ///< Names of the fields; Kind::expression: one per variable
  std::vector<std::string> variables;                     ///< Kind::expression: their names
  std::vector<int> components;                            ///< Kind::expression: component of each, 0 to 2; -1: a scalar field
  int component = 0;                                      ///< Kind::component
  int order = 2;                                          ///< Of the differences between nodes, 2 or 4
  double sigma = 0;                                       ///< Kind::smooth: standard deviation, world units
  std::string on;                                         ///< Field whose nodes are used; empty: chosen
  std::vector<std::string> expressions;                   ///< One or three
  bool operator==(const DerivedSource&) const = default;
};

/// A field of the scene: its source (exactly one of `file`, `analytic`, `label`, `derived`) and the field itself, which is loaded on first
/// use.
struct FieldSource {
  json::Node where;                        ///< Node in the scene file
  std::optional<field::LoadRequest> file;  ///< File to load; empty: the source is no file
  /// True if the requested grid may be missing in the file, as for a replaced file (FieldOverride); any grid is then loaded.
  bool grid_is_optional = false;
  std::string pattern{};              ///< File pattern as resolved from the scene file; empty: a single file
  std::vector<std::string> series{};  ///< Files of the pattern, in order; `file` holds the one of the current step
  bool follows = false;               ///< True if steps may be added while the scene is shown (follow_files.h)
  /// With `follows`: times of the complete steps within one file; empty: the file has not been polled yet.
  std::vector<double> known_times{};
  bool has_changed_step = false;           ///< True after set_step has changed the source
  bool has_own_step = false;               ///< True if the scene file states this field's step; it then ignores the scene's step
  std::string analytic;                    ///< Name of the formula; empty: the source is no formula
  field::AnalyticParameters parameters;    ///< Parameters of `analytic`
  int resolution = 128;                    ///< Nodes per axis of the grid that represents an analytic field in images
  std::array<double, 2> box{-2, 2};        ///< Min and max coordinate of the cube in which an analytic field is sampled, on each axis
  std::optional<LabelSource> label;        ///< Labels to surround; empty: the source is no label surface
  std::optional<DerivedSource> derived;    ///< How it is derived from other fields; empty: it is not
  std::string labels_file;                 ///< File with the names and colors of a label map; empty: rows of the scene file
  LabelTable labels_table;                 ///< Names and colors of labels, values rising; empty: none
  std::shared_ptr<const LabelMap> labels;  ///< Labels of `loaded`; null: not loaded, or not a label map
  field::AnyField loaded;                  ///< Exact field, used by haptics; empty: not loaded yet
  field::AnyField rendered;                ///< Grid for images: sampled for an analytic field, else the same object as `loaded`
};

/// Scale of the field values between the points of colors and opacities, and along a scalar bar (engine/base/symlog_scale.h).
struct ValueMapping {
  /// log: logarithm of the value. symlog: logarithmic in |value| on both sides of zero, and linear near zero.
  enum class Kind { linear, log, symlog };
  Kind kind = Kind::linear;  ///< Scale; linear unless stated
  /// symlog: |value| up to which the scale is linear, in the field's unit; 0: a thousandth of the maximum |value| shown.
  double linear_below = 0;
  bool operator==(const ValueMapping&) const = default;
};

/// A color map by its name. It is stretched over a range when the values are known (color_maps.h).
struct NamedColors {
  std::string map;                             ///< Name of the map; empty: the default map of the colored object
  std::optional<std::array<double, 2>> range;  ///< [min, max] of the values; empty: range of the data
  ValueMapping mapping{};                      ///< Scale between the points; also used by explicit color tables and by opacities
  Threshold threshold{};                       ///< Values that are shown; also used with explicit color tables
  bool operator==(const NamedColors&) const = default;
  /// Returns whether nothing was specified.
  bool is_default() const { return *this == NamedColors{}; }
};

/// Piecewise-linear functions of field values, on the scale of `named.mapping`, values rising. The scene gives either extinctions (sigma
/// per world unit) or opacities (alpha per `opacity_unit`), which become sigma = -ln(1 - alpha) / opacity_unit at their points when the
/// rendered grid is known (its smallest voxel edge is the default unit). Between the points sigma is linear on the scale. An optional
/// factor that depends on the magnitude of the field's gradient (field units per world unit) multiplies sigma.
struct TransferFunction {
  /// Color at a value.
  struct ColorPoint {
    double value;  ///< Field's unit
    Color color;   ///< Display (sRGB) color
  };
  /// Extinction at a value.
  struct ExtinctionPoint {
    double value, sigma;  ///< Field's unit; per world unit
  };
  /// Opacity at a value. At most kMaxAlpha: an alpha of 1 over a length would be an infinite extinction.
  struct OpacityPoint {
    static constexpr double kMaxAlpha = 0.999;  ///< Used instead of an alpha of 1
    double value, alpha;                        ///< Field's unit; 0 to kMaxAlpha over opacity_unit
  };
  std::vector<ColorPoint> colors;            ///< Color table, values rising; empty: a color map, see `named`
  std::vector<OpacityPoint> opacities;       ///< Opacities, values rising; empty if `extinctions` are given
  double opacity_unit = 0;                   ///< World length over which an alpha applies; 0: smallest voxel edge of the rendered grid
  std::vector<ExtinctionPoint> extinctions;  ///< Extinctions, values rising; empty if `opacities` are given
  NamedColors named;                         ///< Color map used if `colors` is empty; its mapping always applies
  /// Factor on sigma at a gradient magnitude.
  struct GradientPoint {
    double gradient, factor;  ///< Field units per world unit; 0 to 1
  };
  std::vector<GradientPoint> gradient_factors;  ///< Gradients rising; empty: factor 1 everywhere
  std::string file;                             ///< Transfer file it was read from; empty: the scene file itself
};

/// Opacity requested for labels of a label map.
struct LabelOpacity {
  std::string labels;  ///< Number, range of numbers "A-B", or name, in which * stands for any letters
  double opacity = 1;  ///< Opacity of the surface, 0 (not drawn) to 1
};

/// Colors and opacities requested for a data file instead of those chosen from its values. At most one of `opacities` and `preset` is set.
struct FileColors {
  NamedColors named{};                                      ///< Color map, range and scale
  std::vector<TransferFunction::OpacityPoint> opacities{};  ///< Opacities of a volume, values rising; empty: chosen from the data
  std::string preset{};                                     ///< Name of a preset (opacity_presets.h); empty: none
  bool is_symmetric = false;                                ///< The range of the colors is symmetric about 0; without a range in `named`
  std::vector<LabelOpacity> label_opacities{};              ///< Opacities of labels; the last one that names a label holds
  /// Another data file, drawn over the first one: labels, or a statistic. The other members are then those of its colors.
  std::string overlay{};
  bool is_overlay = false;        ///< The file is drawn over another one
  std::optional<Vec3> stretch{};  ///< Stretch of the image along the axes; empty: chosen from the data
  /// Returns whether anything was requested.
  bool is_given() const { return !is_default() || !overlay.empty() || !label_opacities.empty() || stretch; }
  /// Returns whether nothing was requested but an overlay and opacities of labels.
  bool is_default() const { return named.is_default() && !makes_volume() && !is_symmetric; }
  /// Returns whether a volume was requested.
  bool makes_volume() const { return !opacities.empty() || !preset.empty(); }
};

/// Colors by value: the scene key "color_by", and the colors of a slice.
struct ColorBy {
  /// Origin of the values: another field at the same position, speed or arc length of a line, or values stored in a data file.
  enum class Source { field, speed, arc_length, value };
  Source source = Source::field;                     ///< speed: streamlines, glyphs; arc_length: streamlines, curves; value: curves, points
  std::string value_name{};                          ///< Source::value: name of the values in the data file
  Entity field;                                      ///< Source::field: scalar field, or vector field for its magnitude
  json::Node where;                                  ///< Node in the scene file
  std::vector<TransferFunction::ColorPoint> colors;  ///< Color table, values rising; empty: a color map, see `named`
  /// Color map used if `colors` is empty; default: viridis over all values (of lines and surfaces: over the rendered ones). Its mapping
  /// always applies.
  NamedColors named{};
};

/// Volume rendering of a scalar field.
struct Volume {
  /// Rule that combines the values along a ray: emission and absorption, or a single value of the ray.
  enum class Projection { composite, maximum, minimum, average };
  Entity field;                                   ///< Scalar field
  json::Node where;                               ///< Node in the scene file
  TransferFunction transfer;                      ///< Colors and opacities
  bool shaded = false;                            ///< Lighting by the gradient
  bool clipped = true;                            ///< Cut by the clip planes
  Projection projection = Projection::composite;  ///< Rule that combines the values along a ray
  std::optional<ColorBy> color_by{};              ///< Colors by another field; composite only
  double albedo = 1;                              ///< Factor on the color of scattered light, 0 to 1; look `lit`
  double anisotropy = 0;                          ///< g of the phase function, above -1 and below 1; look `lit`
  double reflected_share = 1;                     ///< Share that the gradient reflects if `shaded`, 0 to 1; look `lit`
};

/// Surface on which a scalar field has a given value.
struct Isosurface {
  Entity field;                       ///< Scalar field
  json::Node where;                   ///< Node in the scene file
  double level = 0;                   ///< Field value on the surface
  Entity level_widget{};              ///< Isolevel widget that sets `level`; none: `level` is constant
  Color color{0.8f, 0.8f, 0.9f};      ///< Color without color_by
  double opacity = 1;                 ///< Opacity of one side, 0 to 1
  bool clipped = true;                ///< Cut by the clip planes
  std::optional<ColorBy> color_by{};  ///< Empty: `color` everywhere
};

/// Time steps of a file or of a file pattern.
struct TimeSteps {
  int count = 1;  ///< Number of steps
  /// Times of all steps; of a pattern with many or large files only the times of the first and the last file; empty: not specified.
  std::vector<double> times;
  std::string time_unit;  ///< Unit of `times`; empty: not specified
};

/// Time steps of the files from which a mesh, curves or points are read.
struct FileSteps {
  std::string pattern;              ///< File pattern as resolved from the scene file; empty: a single file
  std::vector<std::string> series;  ///< Files of the pattern, in order; the source's `path` is the one of the current step
  std::vector<double> times;        ///< Times of the steps within one file (.pvd, .series), set on load; empty: one step
  int step = 0;                     ///< Current step within one file
  bool follows = false;             ///< True if steps may be added while the scene is shown (follow_files.h)
};

/// A triangle mesh of the scene: its source and the mesh itself, which is loaded on first use.
struct MeshSource {
  json::Node where;               ///< Node in the scene file
  std::string path;               ///< Path of the file to open
  FileSteps steps;                ///< Time steps of the file or pattern
  mesh::MeshTransform placement;  ///< World = scale * file + offset
  mesh::MeshPtr loaded;           ///< Mesh, shared by rendering and haptics; null: not loaded yet
};

/// Rendering of a triangle mesh.
struct SurfaceMesh {
  Entity mesh;                      ///< Mesh to render
  json::Node where;                 ///< Node in the scene file
  Color color{0.8f, 0.8f, 0.9f};    ///< Color without color_by
  bool clipped = true;              ///< Cut by the clip planes
  double opacity = 1;               ///< Opacity of one side, 0 to 1
  bool smooth_shading = false;      ///< Interpolated normals for lighting; haptic contact is with the flat triangles in any case
  bool show_edges = false;          ///< Triangle edges are rendered
  std::optional<ColorBy> color_by;  ///< Empty: `color` everywhere
};

/// Curves that are the vortex core lines of a vector field.
struct VortexCoreCurves {
  std::string field;             ///< Name of the vector field
  json::Node where;              ///< Node in the scene file that names the field
  flow::CoreOptions options;     ///< Criterion and minimum length and swirl of a core line
  flow::VortexCoresPtr cores{};  ///< Cores from which `loaded` was built; shared with links of type `vortex_core`
};

/// Curves from a file, or vortex cores of a field. Rendered as tubes; links of the chain can name them.
struct CurvesSource {
  json::Node where;                              ///< Node in the scene file
  std::string path;                              ///< Path of the file to open; empty: vortex cores
  std::optional<VortexCoreCurves> vortex_cores;  ///< Instead of a file
  FileSteps steps;                               ///< Time steps of the file or pattern
  curves::CurveSetPtr loaded;                    ///< Curves, shared by rendering and haptics; null: not loaded yet
  double radius = 0;                             ///< Radius of the tubes, world units; 0: fitted
  std::optional<Color> color;                    ///< Empty, and no color_by: color (|x|, |y|, |z|) of the direction
  std::optional<ColorBy> color_by;               ///< Empty: `color` everywhere
  bool clipped = true;                           ///< Cut by the clip planes
};

/// Points from a table. Rendered as balls; links of the chain can name them.
struct PointsSource {
  json::Node where;                 ///< Node in the scene file
  std::string path;                 ///< Path of the file to open
  FileSteps steps;                  ///< Time steps of the file or pattern
  curves::PointSetPtr loaded;       ///< Points, shared by rendering and haptics; null: not loaded yet
  double radius = 0;                ///< Radius of all balls, world units; 0: by `radius_by`, or fitted
  std::string radius_by;            ///< Column with the radius of each ball; empty: column "radius" if the table has one
  Color color{0.9f, 0.75f, 0.45f};  ///< Color without color_by
  std::optional<ColorBy> color_by;  ///< Empty: `color` everywhere
  bool clipped = true;              ///< Cut by the clip planes
};

/// Plane through a field, colored by its values, with optional contour lines.
struct Slice {
  ColorBy color_by;                        ///< Field and its colors
  json::Node where;                        ///< Node in the scene file
  Vec3 point{0.0}, normal{0.0, 0.0, 1.0};  ///< Point on the plane and normal of the plane, world
  Entity widget{};                         ///< Cutting-plane widget that moves the plane; none: fixed plane
  double opacity = 1;                      ///< Opacity of the slice, 0 to 1
  bool lit = false;                        ///< True: shaded like a surface; false: colors of the values as they are
  bool clipped = true;                     ///< Cut by the clip planes
  /// Contour lines. Exactly one of `levels`, `count` and `spacing` is set.
  struct Contours {
    json::Node where;            ///< Node in the scene file
    std::vector<double> levels;  ///< Values of the lines, rising
    int count = 0;               ///< Number of lines, evenly within the range of the colors without its ends
    double spacing = 0;          ///< Lines at all multiples of this value
    Color color{0, 0, 0};        ///< Color of the lines
    double width = 1;            ///< Width of the lines, pixels
  };
  std::optional<Contours> contours;  ///< Empty: no contour lines
  /// Line integral convolution: a texture of streaks along the streamlines of a vector field's part in the plane.
  struct FlowTexture {
    Entity field;              ///< Vector field
    json::Node where;          ///< Node in the scene file
    double length = 0;         ///< Length of a streak, world units; 0: fitted to the plane
    double strength = 0.6;     ///< Contrast of the texture, 0 to 1
    bool is_animated = false;  ///< The streaks move downstream with Scene::animation_phase
  };
  std::optional<FlowTexture> flow_texture;  ///< Empty: no texture
};
inline constexpr int kMaxContours = 1000;  ///< Maximum number of contour lines on a slice.

/// Pattern of seed points. Which members are used depends on `kind`.
struct SeedPattern {
  /// Shape on which the seeds lie.
  enum class Kind { line, plane, sphere, isosurface, evenly_spaced };
  Kind kind = Kind::line;          ///< Shape; selects the members in use
  json::Node where;                ///< Node in the scene file
  Vec3 origin{0.0};                ///< Line: first end; plane: a corner; sphere: center
  Vec3 u{0.0}, v{0.0};             ///< Line: other end (u); plane: the two edges
  int count = 1;                   ///< Number of seeds; plane: along u; evenly spaced: maximum number of lines
  int count_v = 1;                 ///< Plane: number of seeds along v
  double radius = 0;               ///< Sphere: radius, world units
  bool inside = false;             ///< Sphere: seeds in the ball instead of on the sphere
  Entity field;                    ///< Isosurface: scalar field
  double level = 0;                ///< Isosurface: its level
  double distance = 0;             ///< Evenly spaced: distance between lines, world units
  double termination_ratio = 0.5;  ///< Evenly spaced: a line ends where another is nearer than this share of `distance`
  std::vector<Vec3> start_points;  ///< Evenly spaced: seeds of the first lines; empty: found, beginning with the domain's middle
};

/// Seed points of streamlines: points, a pattern, or a widget.
struct Seeds {
  std::vector<Vec3> points;            ///< Seed points, world; with `widget`: those of its current pose
  std::optional<SeedPattern> pattern;  ///< Instead of `points`
  Entity widget{};                     ///< Seed or rake widget that sets `points`; none: fixed points
  int count = 1;                       ///< Number of points along a rake
};

/// Kind of the lines of a vector field: streamlines of one time step; path lines, along which particles move; streak lines, on which the
/// particles are that have passed a position.
enum class LineKind { stream, path, streak };

/// Streamlines, path lines or streak lines of a vector field, rendered as tubes.
struct StreamlineSet {
  Entity field;                     ///< Vector field
  json::Node where;                 ///< Node in the scene file
  Seeds seeds;                      ///< Seed points
  double radius = 0;                ///< Radius of the tubes, world units; 0: fitted to the domain
  Color color{1.0f, 0.3f, 0.2f};    ///< Color without color_by
  std::optional<ColorBy> color_by;  ///< Empty: `color` everywhere
  bool is_line_field = false;       ///< Line field ("kind": "line"): v and -v are equivalent
  double min_speed = 0;             ///< Speed at or below which a line ends, in the field's unit
  double length = 0;                ///< Maximum arc length in each direction, world units; 0: 10 L
  double tolerance = 0;             ///< Error per step, relative to L; 0: by the kind of seeds (streamlines.h)
  double arrow_spacing = 0;         ///< Distance between arrowheads along a line, world units; 0: none
  /// Length of the animated bands, world units; they advance by one length while Scene::animation_phase goes from 0 to 1; 0: none.
  double band_length = 0;
  bool clipped = true;                           ///< Cut by the clip planes
  LineKind lines = LineKind::stream;             ///< Kind of the lines
  std::optional<std::array<double, 2>> times{};  ///< Start and end of path lines and streak lines; empty: all times
  bool is_cubic_in_time = false;                 ///< Interpolation between the time steps: cubic, else linear
};

/// Arrows of a vector field at evenly spaced points; rods for a line field.
struct GlyphSet {
  /// Geometry on which the glyphs lie.
  enum class Support { box, plane, slice, isosurface, mesh };
  /// Part of a glyph that lies at its point.
  enum class Anchor { center, tail, head };
  Entity field;                      ///< Vector field
  json::Node where;                  ///< Node in the scene file
  bool is_line_field = false;        ///< Line field ("kind": "line"): v and -v are equivalent
  Support support = Support::box;    ///< Geometry on which the glyphs lie
  Entity support_entity{};           ///< Slice, isosurface or mesh on which the glyphs lie, visible or not
  Vec3 point{0.0}, normal{0, 0, 1};  ///< Support::plane: point and normal, world
  Entity widget{};                   ///< Support::plane: cutting-plane widget that moves the plane; none: fixed plane
  std::optional<field::Box> box{};   ///< Support::box: empty: domain of the field
  double spacing = 0;                ///< Distance between neighbors, world units; 0: fitted to the domain (uniform_sampling.h)
  bool constant_length = false;      ///< True: all glyphs have the length `length`; false: proportional to the magnitude
  double length = 0;                 ///< Length of the longest glyph, world units; 0: the spacing
  double reference_speed = 0;        ///< Speed at which a glyph has the length `length`; 0: maximum speed among the glyphs
  double min_speed = 0;              ///< Speed at or below which a point has no glyph
  double radius = 0;                 ///< Shaft radius of the longest glyph, world units; 0: 0.06 of its length
  Anchor anchor = Anchor::center;    ///< Part of a glyph that lies at its point
  Color color{1.0f, 0.75f, 0.2f};    ///< Color without color_by
  std::optional<ColorBy> color_by;   ///< Empty: `color` everywhere
  bool clipped = true;               ///< Cut by the clip planes
};
inline constexpr std::size_t kMaxGlyphs =
    20000;  ///< Maximum number of glyphs in a set; more are an error; a set that follows a widget has larger spacing instead

/// Short piece of the streamline through the cursor, with an arrowhead: local direction of the flow.
struct Indicator {
  Entity field;                    ///< Vector field
  json::Node where;                ///< Node in the scene file
  double length = 0;               ///< Length of the piece, world units; 0: a tenth of L
  double radius = 0;               ///< Radius, world units; 0: fitted
  Color color{1.0f, 0.85f, 0.1f};  ///< Display color
  bool starts_at_cursor = false;   ///< True: the piece begins at the cursor; false: the cursor is its middle
};

/// Probe, proxies and force of the newest haptic state, rendered as a glyph. Written by update_cursor (prepare.h).
struct Cursor {
  Vec3 probe{0.0};                     ///< Probe position, world
  std::vector<Vec3> proxies;           ///< Proxy of each link, world
  std::vector<bool> active;            ///< For each link: enabled and not released
  std::vector<double> release_ratios;  ///< For each link: 0 on its feature to 1 at release
  std::vector<LinkStatus> statuses;    ///< Status of each link
  std::vector<std::string> names;      ///< Names of the links; empty before the program is built
  Vec3 force_n{0.0};                   ///< Force on the user, world axes, newtons
  double size = 0;                     ///< Radius of the glyph, world units; 0: fitted
  bool visible = false;                ///< True: the glyph is rendered
  bool show_occluded = true;           ///< Visible through occluders
  bool drop_line = false;              ///< Thin line from the probe down to the bottom of the rendered domain
  /// Three rods that cross at the probe; proxies and force are not rendered, so that the image does not show the contact.
  bool crosshair = false;
  bool pseudo_haptic = false;  ///< True for a device without force: lag and color show the force
};

/// One link of the chain. The constraint type reads its own keys from `node`.
struct Link {
  std::string name, type;  ///< Name of the link; name of its constraint type
  json::Node node;         ///< Item of "chain" with all its keys
};

/// A mode of operation: while its switch is on, its links run in its order and all others are off. haptics/build reads the switch.
struct Mode {
  std::string name;                ///< Name of the mode
  std::vector<std::string> links;  ///< Names of its links, in the order of the chain
  json::Node node;                 ///< Item of "modes" with all its keys, including the switch
};

/// A widget that the user can grab (engine/widget/widget.h), with its pose after the last tick. Slices, clip planes, seeds and levels can
/// be bound to it.
struct Widget {
  json::Node where;                          ///< Node in the scene file
  widget::Spec spec;                         ///< Spec stated in the scene; resolve_widget (scene.h) adds the missing sizes
  widget::Report report;                     ///< Report of the last tick
  Entity field;                              ///< Isolevel: scalar field
  std::vector<std::string> along_links;      ///< Ruler: names of the links that its ends stay on
  Color color{1.0f, 0.75f, 0.2f};            ///< Display color
  bool is_complete = false;                  ///< True after resolve_widget has completed `spec`
  std::optional<widget::Pose> applied_pose;  ///< Pose last applied to the objects bound to the widget
  std::optional<double> applied_value;       ///< Isolevel: value last applied to the bound isosurfaces
};

/// Parameters of the force that the links make together (force law: haptics/chain/program.h).
struct Coupling {
  double stiffness_n_per_m = 500;  ///< Stiffness of links that state none, N/m
  double damping_ns_per_m = 0;     ///< Damping of the probe's velocity, N s/m
  double max_force_n = 8;          ///< Limit of the total force, newtons
  std::optional<double> ramp_s;    ///< Ramp time of a force step of max_force_n, seconds; empty: 0 in replay, 0.02 with a device
  double rotational_stiffness_nm_per_rad = 0.5;   ///< Rotational stiffness of aligning links that state none, N m/rad
  double rotational_damping_nms_per_rad = 0;      ///< Damping of the tool's rotation, N m s/rad
  CouplingMethod method = CouplingMethod::chain;  ///< Proxy chain, or a baseline method
  CouplingForce force = CouplingForce::paper;     ///< CouplingMethod::chain only: force law
};

/// Tuning targets for image and haptics, met by measured error and time curves (engine/app/tuning/plan). At most one of each pair is set.
struct TuningTargets {
  std::optional<double> max_image_error;  ///< Maximum error of an image, 1/255, root mean square over covered pixels
  std::optional<double> max_image_ms;     ///< Maximum time of an image, ms
  std::optional<double> max_proxy_error;  ///< Maximum deviation of a proxy from its line, world units
  std::optional<double> max_tick_us;      ///< Maximum time of a tick, us
  /// Returns whether there is a target for images.
  bool has_image_targets() const { return max_image_error || max_image_ms; }
  /// Replaces the targets for images.
  void set_image_targets(const TuningTargets& other) { max_image_error = other.max_image_error, max_image_ms = other.max_image_ms; }
  /// Returns whether there is a target for haptics.
  bool has_haptic_targets() const { return max_proxy_error || max_tick_us; }
  bool operator==(const TuningTargets&) const = default;
};

/// Mapping from the device's workspace (meters) to the world.
struct Workspace {
  double meters_per_unit = 1;  ///< Device meters per world unit
  Vec3 origin{0.0};            ///< World position of the middle of the device's workspace
  Mat3 rotation{1.0};          ///< Rotation from device axes to world axes
  bool is_explicit = false;    ///< True if the scene file states the scale; false: 1 in replay, else fitted to the device
};

/// The camera. World units.
struct Camera {
  Vec3 position{0.0, -8.0, 3.0}, target{0.0}, up{0.0, 0.0, 1.0};  ///< Position, point it looks at, up direction
  double fovy_deg = 30;                                           ///< Vertical angle of view, degrees
  bool orthographic = false;                                      ///< True: parallel projection
  double ortho_height = 1;                                        ///< Orthographic: height of the image, world units
  bool is_explicit = false;  ///< True if the scene file states the camera; false: fitted to the visible objects
};

/// Clip plane: only the side to which its normal points is rendered. A clip box consists of six of them.
struct ClipPlane : Plane {
  Entity widget{};              ///< Cutting plane or box widget that moves the plane; none: fixed plane
  int box_face = -1;            ///< Face of the box widget: 0..5 for -x +x -y +y -z +z; -1: not a box
  bool keep_back_side = false;  ///< Cutting plane: keep the side that its normal points away from
};

/// Edges of a bounding box, as a spatial reference. A radius of 0 is fitted to the visible objects.
struct BoundingBox {
  Entity field;                   ///< Field whose box is shown; none: box of everything visible
  json::Node where;               ///< Node in the scene file
  Color color{0.7f, 0.7f, 0.7f};  ///< Color of the edges
  double radius = 0;              ///< Radius of the edges, world units; 0: fitted
};

/// Three edges with ticks and numbers, chosen on the outline of the box in the image.
struct Axes {
  Entity field;                                     ///< Field whose box is used; none: box of everything visible
  json::Node where;                                 ///< Node in the scene file
  std::array<std::string, 3> names{"x", "y", "z"};  ///< Labels at the ends of the axes
  Color color{0.7f, 0.7f, 0.7f};                    ///< Color of the axes
  int ticks = 5;                                    ///< Approximate number of ticks per axis
  double radius = 0;                                ///< Radius of the edges, world units; 0: fitted
};

/// A checkerboard perpendicular to z.
struct Ground {
  std::optional<double> z;         ///< Height of the board; empty: just below the visible objects
  double size = 0, tile_size = 0;  ///< Edge of the whole board; edge of a tile; world units, 0: fitted
  std::array<Color, 2> colors{Color{0.42f, 0.42f, 0.44f}, Color{0.32f, 0.32f, 0.34f}};  ///< Colors of alternate tiles
};

/// Depth cue: colors blend into the fog color as the view depth goes from near to far.
struct Fog {
  std::optional<Color> color;       ///< Fog color; empty: color of the background
  std::optional<double> near, far;  ///< View depths, world units; empty: nearest and farthest visible depth
  double max_opacity = 0.8;         ///< Share of the fog color at `far`, 0 to 1
};

/// Light from all sides.
struct EnvironmentLight {
  Color sky{0.2f, 0.2f, 0.2f}, ground{0.2f, 0.2f, 0.2f};  ///< From above (+z) and from below; in between they are mixed
};

/// Occlusion of the environment's light.
struct AmbientOcclusion {
  double reach = 0;     ///< Distance at which an occluder counts by 1/e, world units; 0: a tenth of the diagonal
  double strength = 1;  ///< Share of the occlusion that is applied, 0 to 1
};

/// Space in which colors and light are added: `plain`: the display encoding; `lit`: linear radiance. automatic: `lit` if the scene states
/// `environment`, `ambient_occlusion` or `shadows`.
enum class Look { automatic, plain, lit };

/// A directional light. Without any light the scene has a headlight.
struct Light {
  Vec3 direction{0.0, 0.0, 1.0};  ///< Toward the light, world axes; with follows_camera: right, up, toward the camera
  Color color{1, 1, 1};           ///< Display color
  double intensity = 1;           ///< Factor on `color`
  bool follows_camera = false;    ///< True: fixed to the camera; false: fixed in the world
  double angular_size_deg = 0;    ///< Diameter as seen from the scene, degrees; makes shadows soft
};

/// What lights the scene.
struct Illumination {
  std::vector<Light> lights;                          ///< Empty: a headlight, unless has_headlight is false
  bool has_headlight = true;                          ///< False: the scene states its lights, possibly none
  std::optional<EnvironmentLight> environment_light;  ///< Empty: gray
  std::optional<AmbientOcclusion> ambient_occlusion;  ///< Empty: none
  bool shadows = false;                               ///< The lights cast shadows
  Look look = Look::automatic;                        ///< Space in which light is added
  std::optional<bool> line_halos;                     ///< Lines darken what is behind them, beside them; empty: with the default light
  /// Returns whether the scene states no light, so that the look `lit` has its default one.
  bool is_unstated() const { return lights.empty() && has_headlight && !environment_light && !ambient_occlusion && !shadows; }
};

/// Current time step and playback speed (time_steps.h).
struct TimeLine {
  int step = 0;                       ///< Current step, counted from 0
  double steps_per_second = 5;        ///< Steps per second during playback
  std::array<double, 2> range{0, 1};  ///< Times of the first and the last step where no data have steps
  int steps = 0;                      ///< Number of steps where no data have steps; 0: none
};

/// Background of the image.
struct Background {
  Color color{0, 0, 0};      ///< Display color
  bool transparent = false;  ///< True: images have an alpha channel and `color` is ignored
};

}  // namespace catena::scene
