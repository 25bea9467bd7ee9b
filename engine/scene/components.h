/// The components: plain structs that say what an entity is. Field's terms; world units; display (sRGB) colours as written.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/color.h"
#include "engine/base/haptic_state.h"
#include "engine/base/json.h"
#include "engine/base/plane.h"
#include "engine/field/analytic/analytic.h"
#include "engine/geometry/curves/point_set.h"
#include "engine/geometry/flow/vortex_cores.h"
#include "engine/io/curves/load_curves.h"
#include "engine/io/mesh/load_mesh.h"
#include "engine/io/volume/load_field.h"
#include "engine/scene/entity_store.h"
#include "engine/scene/label_table.h"
#include "engine/widget/widget.h"

namespace catena::scene {

/// What a scene calls an entity.
struct Name {
  std::string value;  ///< unique among entities of a kind
};

struct LabelMap;  ///< labels.h

/// The surface of labels of another field (engine/field/derived/label_surface.h), as a field of its own.
struct LabelSource {
  std::string label_map;           ///< the label map's name
  std::vector<double> values;      ///< the labels whose voxels are inside; empty with `any`
  std::vector<std::string> names;  ///< of the map's table
  bool all_labels = false;         ///< every label but 0
  double smoothing_voxels = 0;     ///< voxels
  bool operator==(const LabelSource&) const = default;
};

/// A field of the scene: where it comes from, and the field itself once something has asked for it.
struct FieldSource {
  json::Node where;                        ///< its place in the scene file, for messages
  std::optional<field::LoadRequest> file;  ///< either this
  bool grid_is_optional = false;           ///< a replaced file may lack the grid that the first one had
  std::string pattern{};                   ///< the name in the scene, where it stands for several files; empty: one file
  std::vector<std::string> series{};       ///< the files of a pattern, in order; `file` has the one of the scene's step
  bool follows = false;                    ///< steps may be added while it is shown (follow.h)
  std::vector<double> known_times{};       ///< with `follows`: of the steps within one file that are whole; empty: not looked at yet
  bool has_changed_step = false;           ///< it has gone from one step to another
  bool has_own_step = false;               ///< it states its step, and does not follow the scene's
  std::string analytic;                    ///< or this
  field::AnalyticParameters parameters;    ///< of `analytic`
  int resolution = 128;                    ///< analytic fields are drawn from a sampled grid: nodes an axis
  std::array<double, 2> box{-2, 2};        ///< least and greatest coordinate of the cube that it is sampled in, world units
  std::optional<LabelSource> label;        ///< or this
  std::string labels_file;                 ///< the table that a label map's names and colours come from; empty: the scene's own
  LabelTable labels_table;                 ///< values rising; empty: none
  std::shared_ptr<const LabelMap> labels;  ///< with `loaded`: what the voxels of a field that is read by the nearest of them stand for
  field::AnyField loaded;                  ///< exact (the hand's)
  field::AnyField rendered;                ///< a grid (the eye's); the same object for files
};

/// The scale on which values lie between the points of colours and opacities, and along a colour bar (engine/base/symlog_scale.h).
struct ValueMapping {
  /// log: by the logarithm of the value; symlog: the same away from zero on both sides, and linear about zero.
  enum class Kind { linear, log, symlog };
  Kind kind = Kind::linear;  ///< linear unless stated
  double linear_below = 0;   ///< symlog: linear up to this size of a value, the field's unit; 0: a thousandth of the greatest that is shown
  bool operator==(const ValueMapping&) const = default;
};

/// A colour map by its name, laid over a range once the values are known (color_maps.h).
struct NamedColors {
  std::string map;                             ///< empty: the default of what is coloured
  std::optional<std::array<double, 2>> range;  ///< empty: that of the values
  ValueMapping mapping{};                      ///< of a table of colours, too, and of opacities
  bool operator==(const NamedColors&) const = default;
  /// Whether nothing of it was stated.
  bool is_default() const { return *this == NamedColors{}; }
};

/// Piecewise-linear maps over field values, on the scale of `named.mapping`, values rising. The scene gives either extinctions (sigma per
/// world unit) or opacities (alpha per opacity_length), which become sigma = -ln(1 - alpha) / opacity_length at their points once the drawn
/// grid is known (its smallest voxel edge is the default unit). Between the points sigma is linear on the scale. A factor that follows the
/// length of the field's gradient (field units per world unit) multiplies sigma.
struct TransferFunction {
  /// A colour at a value.
  struct ColorPoint {
    double value;  ///< the field's unit
    Color color;   ///< where nothing else gives one
  };
  /// An extinction at a value.
  struct ExtinctionPoint {
    double value, sigma;  ///< the field's unit; per world unit
  };
  /// An opacity at a value. At most kMaxAlpha: an alpha of 1 over a length would be an infinite extinction.
  struct OpacityPoint {
    static constexpr double kMaxAlpha = 0.999;  ///< what an alpha of 1 counts as
    double value, alpha;                        ///< the field's unit; 0 to kMaxAlpha over opacity_length
  };
  std::vector<ColorPoint> colors;            ///< values rising
  std::vector<OpacityPoint> opacities;       ///< either these
  double opacity_unit = 0;                   ///< world length; 0: the smallest voxel edge of the drawn grid
  std::vector<ExtinctionPoint> extinctions;  ///< or these; values rising
  NamedColors named;                         ///< where `colors` is empty; its mapping always
  /// A factor at a length of the gradient.
  struct GradientPoint {
    double gradient, factor;  ///< field units per world unit; 0 to 1
  };
  std::vector<GradientPoint> gradient_factors;  ///< gradients rising, factors 0..1; empty: 1 everywhere
  std::string file;                             ///< that it was read from; empty: the scene's own
};

/// Colours that follow values. The one shape of "color_by", and what a slice shows of its own field.
struct ColorBy {
  /// What gives the values.
  enum class Source { field, speed, arc_length, value };
  Source source = Source::field;                     ///< lines alone know speed and arc length, what comes from a file its values
  std::string value_name{};                          ///< the name that the file has for it
  Entity field;                                      ///< at the same place of the world: a scalar, or the magnitude of a vector
  json::Node where;                                  ///< its place in the file, for messages
  std::vector<TransferFunction::ColorPoint> colors;  ///< values rising; empty: as `named` says
  NamedColors named{};  ///< viridis, all values (lines, surfaces: the drawn ones), where it does not say; mapping
};

/// A scalar field that rays go through.
struct Volume {
  /// What a ray makes of its values: emission and absorption, or the look of one value.
  enum class Projection { composite, maximum, minimum, average };
  Entity field;                                   ///< the field that it shows
  json::Node where;                               ///< its place in the file, for messages
  TransferFunction transfer;                      ///< colours and opacities
  bool shaded = false;                            ///< lit by the gradient
  bool clipped = true;                            ///< the clip planes count
  Projection projection = Projection::composite;  ///< what a ray makes of its values
  std::optional<ColorBy> color_by{};              ///< composite only
};

/// The surface on which a scalar field has one value.
struct Isosurface {
  Entity field;                       ///< the field that it shows
  json::Node where;                   ///< its place in the file, for messages
  double level = 0;                   ///< the value
  Entity level_widget{};              ///< the isolevel widget whose value the level follows
  Color color{0.8f, 0.8f, 0.9f};      ///< where nothing else gives one
  double opacity = 1;                 ///< 0 to 1, of one side
  bool clipped = true;                ///< the clip planes count
  std::optional<ColorBy> color_by{};  ///< none: `color` everywhere
};

/// The steps in time of a file, or of a pattern.
struct TimeSteps {
  int count = 1;              ///< how many there are
  std::vector<double> times;  ///< of all steps; of a pattern those of its first and its last file; empty: none is stated
  std::string time_unit;      ///< of `times`; empty: not stated
};

/// The steps in time of what a mesh, curves or points are read from.
struct FileSteps {
  std::string pattern;              ///< the name in the scene, where it stands for several files; empty: one file
  std::vector<std::string> series;  ///< the files of a pattern, in order; `path` is that of the scene's step; empty: one file
  std::vector<double> times;        ///< of the steps within one file (.pvd, .series), once it is loaded; empty: it has one
  int step = 0;                     ///< which step within one file
  bool follows = false;             ///< steps may be added while it is shown (follow.h)
};

/// A triangle mesh of the scene: where it comes from, and the mesh itself once something has asked for it.
struct MeshSource {
  json::Node where;               ///< its place in the file, for messages
  std::string path;               ///< the file, as the program opens it
  FileSteps steps;                ///< of the file, or of the pattern
  mesh::MeshTransform placement;  ///< world = scale * file + offset
  mesh::MeshPtr loaded;           ///< felt and drawn: one object
};

/// A mesh that is drawn.
struct SurfaceMesh {
  Entity mesh;                      ///< the mesh that it shows
  json::Node where;                 ///< its place in the file, for messages
  Color color{0.8f, 0.8f, 0.9f};    ///< where nothing else gives one
  bool clipped = true;              ///< the clip planes count
  double opacity = 1;               ///< 0 to 1, of one side
  bool smooth_shading = false;      ///< "shading": the felt mesh is flat
  bool show_edges = false;          ///< the triangles' edges are drawn, too
  std::optional<ColorBy> color_by;  ///< none: `color` everywhere
};

/// The core lines of the vortices of a field, as curves.
struct VortexCoreCurves {
  std::string field;             ///< the name of the vector field
  json::Node where;              ///< the place that names it, for messages
  flow::CoreOptions options;     ///< how they are told
  flow::VortexCoresPtr cores{};  ///< what `loaded` was made of: what a link `vortex_core` feels, too
};

/// Curves from a file, or traced in a field: drawn as tubes, and felt by links that name them.
struct CurvesSource {
  json::Node where;                              ///< its place in the file, for messages
  std::string path;                              ///< the file, as the program opens it; empty: they are traced
  std::optional<VortexCoreCurves> vortex_cores;  ///< instead of a file
  FileSteps steps;                               ///< of the file, or of the pattern
  curves::CurveSetPtr loaded;                    ///< felt and drawn: one object; none before something asks for it
  double radius = 0;                             ///< of the tubes; 0: fitted
  std::optional<Color> color;                    ///< none, and no color_by: by the direction, (|x|, |y|, |z|)
  std::optional<ColorBy> color_by;               ///< none: `color` everywhere
  bool clipped = true;                           ///< the clip planes count
};

/// Points from a table: drawn as balls, and felt by links that name them.
struct PointsSource {
  json::Node where;                 ///< its place in the file, for messages
  std::string path;                 ///< the file, as the program opens it
  FileSteps steps;                  ///< of the file, or of the pattern
  curves::PointSetPtr loaded;       ///< felt and drawn: one object; none before something asks for it
  double radius = 0;                ///< of all balls; 0: by `radius_by`, or fitted
  std::string radius_by;            ///< the column that says each ball's; empty: the column "radius", where the table has one
  Color color{0.9f, 0.75f, 0.45f};  ///< where nothing else gives one
  std::optional<ColorBy> color_by;  ///< none: `color` everywhere
  bool clipped = true;              ///< the clip planes count
};

/// A plane through a field, coloured by its values, with lines of constant value.
struct Slice {
  ColorBy color_by;                        ///< the field, and its colours
  json::Node where;                        ///< its place in the file, for messages
  Vec3 point{0.0}, normal{0.0, 0.0, 1.0};  ///< a place on the plane and an arrow across it, world
  Entity widget{};                         ///< the cutting plane that the plane follows
  double opacity = 1;                      ///< 0 to 1
  bool lit = false;                        ///< lit, or the plain colours of the values
  bool clipped = true;                     ///< the clip planes count
  /// Lines of constant value.
  struct Contours {
    json::Node where;            ///< its place in the file, for messages
    std::vector<double> levels;  ///< rising; or
    int count = 0;               ///< so many within the colours' range, its ends left out; or
    double spacing = 0;          ///< all multiples
    Color color{0, 0, 0};        ///< of the lines
    double width = 1;            ///< pixels
  };
  std::optional<Contours> contours;  ///< none: no lines
};
inline constexpr int kMaxContours = 1000;  ///< On one slice.

/// Seeds that are not listed one by one. Which members mean something follows from the kind.
struct SeedPattern {
  /// Where the seeds lie.
  enum class Kind { line, plane, sphere, isosurface, evenly_spaced };
  Kind kind = Kind::line;          ///< which of the members count
  json::Node where;                ///< its place in the file, for messages
  Vec3 origin{0.0};                ///< a line's first end, a plane's corner, a sphere's centre
  Vec3 u{0.0}, v{0.0};             ///< a line's other end (u); a plane's edges
  int count = 1;                   ///< of seeds; a plane's along u; evenly spaced: the most lines
  int count_v = 1;                 ///< a plane's along v
  double radius = 0;               ///< of a sphere
  bool inside = false;             ///< the ball rather than the sphere
  Entity field;                    ///< of an isosurface
  double level = 0;                ///< of an isosurface
  double distance = 0;             ///< evenly spaced: of the lines, world units
  double termination_ratio = 0.5;  ///< evenly spaced: lines end nearer than this share of the distance
  std::vector<Vec3> start_points;  ///< evenly spaced: where the first lines begin; empty: the middle of the domain
};

/// Where streamlines begin.
struct Seeds {
  std::vector<Vec3> points;            ///< listed one by one, world
  std::optional<SeedPattern> pattern;  ///< instead of points
  Entity widget{};                     ///< the seed or rake that the points follow
  int count = 1;                       ///< of the points along a rake
};

/// Tubes along streamlines.
struct StreamlineSet {
  Entity field;                     ///< the field that it shows
  json::Node where;                 ///< its place in the file, for messages
  Seeds seeds;                      ///< where they begin
  double radius = 0;                ///< 0: fitted to the domain
  Color color{1.0f, 0.3f, 0.2f};    ///< where nothing else gives one
  std::optional<ColorBy> color_by;  ///< none: `color` everywhere
  bool is_line_field = false;       ///< "kind": "line"
  double min_speed = 0;             ///< the lines end where the field is slower; its unit
  double length = 0;                ///< 0: 10 L, each direction
  double tolerance = 0;             ///< times L; 0: by the seeds' kind (lines.h)
  double arrow_spacing = 0;         ///< arrowheads every so far along a line, world units; 0: none
  double band_length = 0;           ///< bands of this length run along the lines as the scene's phase goes from 0 to 1; 0: none
  bool clipped = true;              ///< the clip planes count
};

/// Arrows of a vector field, evenly placed; of a line field, rods.
struct GlyphSet {
  /// What the glyphs lie on.
  enum class Support { box, plane, slice, isosurface, mesh };
  /// What of a glyph lies at its place.
  enum class Anchor { center, tail, head };
  Entity field;                      ///< the field that it shows
  json::Node where;                  ///< its place in the file, for messages
  bool is_line_field = false;        ///< "kind": "line"
  Support support = Support::box;    ///< what they lie on
  Entity support_entity{};           ///< the slice, the isosurface or the mesh that they lie on, drawn or not
  Vec3 point{0.0}, normal{0, 0, 1};  ///< of a plane of their own
  Entity widget{};                   ///< the cutting plane that this plane follows
  std::optional<field::Box> box{};   ///< empty: the field's domain
  double spacing = 0;                ///< world units; 0: fitted to the domain (even_places.h)
  bool constant_length = false;      ///< "scale": "constant": all as long as the longest
  double length = 0;                 ///< of the longest, world units; 0: the spacing
  double reference_speed = 0;        ///< the speed that has this length; 0: the greatest that is drawn
  double min_speed = 0;              ///< speeds up to this have none
  double radius = 0;                 ///< of the longest one's shaft, world units; 0: a share of its length
  Anchor anchor = Anchor::center;    ///< what of it lies at its place
  Color color{1.0f, 0.75f, 0.2f};    ///< where nothing else gives one
  std::optional<ColorBy> color_by;   ///< none: `color` everywhere
  bool clipped = true;               ///< the clip planes count
};
inline constexpr std::size_t kMaxGlyphs = 20000;  ///< of one set

/// A short piece of the streamline through the cursor, with an arrowhead: what the flow does here.
struct Indicator {
  Entity field;                    ///< the field that it shows
  json::Node where;                ///< its place in the file, for messages
  double length = 0;               ///< world units; 0: a tenth of L
  double radius = 0;               ///< 0: fitted
  Color color{1.0f, 0.85f, 0.1f};  ///< where nothing else gives one
  bool starts_at_cursor = false;   ///< the piece begins at the cursor; else the cursor is its middle
};

/// The cursor: what the hand holds, as the last tick left it. ImageWriteResult by the cursor system, drawn as a glyph.
struct Cursor {
  Vec3 probe{0.0};                     ///< the hand, world
  std::vector<Vec3> proxies;           ///< by link, world
  std::vector<bool> active;            ///< by link: it holds
  std::vector<double> release_ratios;  ///< by link: 0 on its feature .. 1 where the hand has left it
  std::vector<LinkStatus> statuses;    ///< by link
  std::vector<std::string> names;      ///< of the links, once the chain is made
  Vec3 force_n{0.0};                   ///< on the hand, world axes, newtons
  double size = 0;                     ///< glyph radius, world units; 0: fitted
  bool visible = false;                ///< drawn at all
  bool show_occluded = true;           ///< shines through what hides it
  bool drop_line = false;              ///< a line leads down to the floor of what is drawn
  bool crosshair = false;              ///< three rods that cross at the hand, and nothing that says what is felt
  bool pseudo_haptic = false;          ///< nothing pushes the hand: lag and colour show the force
};

/// One link of the chain; its own keys are read by the constraint that it names.
struct Link {
  std::string name, type;  ///< the link's name; the constraint's word
  json::Node node;         ///< all of its keys
};

/// A mode of operation: while its switch is on, these links run in this order. The switch is read by haptics/build.
struct Mode {
  std::string name;                ///< its name
  std::vector<std::string> links;  ///< names of links, in the order of the chain
  json::Node node;                 ///< all of its keys, the switch with them
};

/// A thing that the hand takes hold of (engine/widget/widget.h); its pose as the last tick left it. Slices, clips, seeds and levels follow
/// it.
struct Widget {
  json::Node where;                          ///< its place in the file, for messages
  widget::Spec spec;                         ///< as stated; resolve_widget (scene.h) completes it
  widget::Report report;                     ///< as the last tick left it
  Entity field;                              ///< isolevel
  std::vector<std::string> along_links;      ///< ruler: names of links
  Color color{1.0f, 0.75f, 0.2f};            ///< where nothing else gives one
  bool is_complete = false;                  ///< resolve_widget has been here
  std::optional<widget::Pose> applied_pose;  ///< the pose that its followers have
  std::optional<double> applied_value;       ///< and the isolevel's value
};

/// How the links make one force, as the scene says it (haptics/chain/program.h has the law).
struct Coupling {
  double stiffness_n_per_m = 500;                 ///< of links that do not say, N/m
  double damping_ns_per_m = 0;                    ///< of the hand, N s/m
  double max_force_n = 8;                         ///< of the whole force, newtons
  std::optional<double> ramp_s;                   ///< seconds over which a switch fades; none: the default
  double rotational_stiffness_nm_per_rad = 0.5;   ///< of links that align and do not say, N m/rad
  double rotational_damping_nms_per_rad = 0;      ///< N m s/rad
  CouplingMethod method = CouplingMethod::chain;  ///< the proxy chain, or a baseline
  CouplingForce force = CouplingForce::paper;     ///< of the chain
};

/// What may be given up for what, by measured curves (engine/app/tuning/plan): of each pair one at most.
struct TuningTargets {
  std::optional<double> max_image_error;  ///< of the picture, 1/255, root mean square over what is covered
  std::optional<double> max_image_ms;     ///< of a picture, ms
  std::optional<double> max_proxy_error;  ///< of the places that links hold, world units
  std::optional<double> max_tick_us;      ///< of a tick, us
  /// Whether it asks anything of the picture.
  bool has_image_targets() const { return max_image_error || max_image_ms; }
  /// Whether it asks anything of the hand.
  bool has_haptic_targets() const { return max_proxy_error || max_tick_us; }
  bool operator==(const TuningTargets&) const = default;
};

/// How the hand's metres lie in the world.
struct Workspace {
  double meters_per_unit = 1;  ///< metres of hand a world unit
  Vec3 origin{0.0};            ///< world place of the hand's origin
  Mat3 rotation{1.0};          ///< world from hand
  bool is_explicit = false;    ///< false: fitted to the scene
};

/// The eye. World units.
struct Camera {
  Vec3 position{0.0, -8.0, 3.0}, target{0.0}, up{0.0, 0.0, 1.0};  ///< where it is, what it looks at, what is up
  double fovy_deg = 30;                                           ///< vertical angle of view, degrees
  bool orthographic = false;                                      ///< no perspective
  double ortho_height = 1;                                        ///< orthographic: world units from bottom to top
  bool is_explicit = false;                                       ///< false: fitted to what is drawn
};

/// What is drawn lies on the side of the plane to which the normal points. A clip box is six of them.
struct ClipPlane : Plane {
  Entity widget{};              ///< the cutting plane or box that it follows
  int box_face = -1;            ///< of a box: 0..5, -x +x -y +y -z +z
  bool keep_back_side = false;  ///< of a cutting plane: what its normal points away from is kept
};

/// Help for the eye: what shows where things stand. Sizes of 0 are fitted to what is drawn.
struct BoundingBox {
  Entity field;                   ///< none: everything that is drawn
  json::Node where;               ///< its place in the file, for messages
  Color color{0.7f, 0.7f, 0.7f};  ///< where nothing else gives one
  double radius = 0;              ///< of the edges, world units; 0: fitted
};

/// Three edges of the box with ticks and numbers, of its outline in the picture.
struct Axes {
  Entity field;                                     ///< none: everything that is drawn
  json::Node where;                                 ///< its place in the file, for messages
  std::array<std::string, 3> names{"x", "y", "z"};  ///< at the ends of the axes
  Color color{0.7f, 0.7f, 0.7f};                    ///< where nothing else gives one
  int ticks = 5;                                    ///< about so many an axis
  double radius = 0;                                ///< of the edges, world units; 0: fitted
};

/// A checkerboard across z.
struct Ground {
  std::optional<double> z;         ///< z; none: just below what is drawn
  double size = 0, tile_size = 0;  ///< of the whole; of one square; world units, 0: fitted
  std::array<Color, 2> colors{Color{0.42f, 0.42f, 0.44f}, Color{0.32f, 0.32f, 0.34f}};  ///< of the squares in turn
};

/// Depth cue: colours turn to the fog's as the view depth goes from start to end.
struct Fog {
  std::optional<Color> color;       ///< none: the background's
  std::optional<double> near, far;  ///< view depth, world units; none: the nearest and farthest of what is drawn
  double max_opacity = 0.8;         ///< share of the fog at the end
};

/// A light from far away. Without one there is a headlight.
struct Light {
  Vec3 direction{0.0, 0.0, 1.0};  ///< towards the light; camera: right, up, towards the eye
  Color color{1, 1, 1};           ///< display colour
  double intensity = 1;           ///< factor on its colour
  bool follows_camera = false;    ///< it goes with the camera; else it rests in the world
};

/// Steps in time (steps.h).
struct TimeLine {
  int step = 0;                 ///< the step that is shown, from 0
  double steps_per_second = 5;  ///< steps a second while it plays
};

/// What stands behind all that is drawn.
struct Background {
  Color color{0, 0, 0};      ///< where nothing else gives one
  bool transparent = false;  ///< pictures with an alpha channel; the colour does not count
};

}  // namespace catena::scene
