/// The components: plain structs that say what an entity is. Field's terms; world units; display (sRGB) colours as written.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/json.h"
#include "engine/curves/load.h"
#include "engine/curves/points.h"
#include "engine/exchange/haptic_state.h"
#include "engine/field/analytic.h"
#include "engine/field/load.h"
#include "engine/geometry/color.h"
#include "engine/geometry/plane.h"
#include "engine/mesh/load.h"
#include "engine/scene/label_table.h"
#include "engine/scene/world.h"
#include "engine/widget/widget.h"

namespace catena::scene {

struct Name {
  std::string value;
};

struct LabelMap;  ///< labels.h

/// The surface of labels of another field (engine/field/label_surface.h), as a field of its own.
struct LabelSource {
  std::string of;  ///< the label map's name
  std::vector<double> values;
  std::vector<std::string> names;  ///< of the map's table
  bool any = false;                ///< every label but 0
  double smooth = 0;               ///< voxels
  bool operator==(const LabelSource&) const = default;
};

/// A field of the scene: where it comes from, and the field itself once something has asked for it.
struct FieldSource {
  json::Node where;                        ///< its place in the scene file, for messages
  std::optional<field::LoadRequest> file;  ///< either this
  bool grid_is_a_wish = false;             ///< a replaced file may lack the grid that the first one had
  std::vector<std::string> series{};       ///< the files of a pattern, in order; `file` has the one of the scene's step
  bool stepped = false;                    ///< it has gone from one step to another
  bool own_step = false;                   ///< it states its step, and does not follow the scene's
  std::string analytic;                    ///< or this
  field::AnalyticParameters parameters;
  int resolution = 128;  ///< analytic fields are drawn from a sampled grid: nodes an axis
  std::array<double, 2> box{-2, 2};
  std::optional<LabelSource> label;  ///< or this
  std::string labels_file;           ///< the table that a label map's names and colours come from; empty: the scene's own
  LabelTable labels_table;
  std::shared_ptr<const LabelMap> labels;  ///< with `loaded`: what the voxels of a field that is read by the nearest of them stand for
  field::AnyField loaded;                  ///< exact (the hand's)
  field::AnyField drawn;                   ///< a grid (the eye's); the same object for files
};

/// A colour map by its name, laid over a range once the values are known (color_maps.h).
struct NamedColors {
  std::string map;                             ///< empty: the default of what is coloured
  std::optional<std::array<double, 2>> range;  ///< empty: that of the values
};

/// Piecewise-linear maps over field values, values rising. The scene gives either extinctions (sigma per world unit) or
/// opacities (alpha per opacity_unit), which become sigma = -ln(1 - alpha) / opacity_unit at their points once the drawn
/// grid is known (its smallest voxel edge is the default unit). Between the points sigma is linear. A factor that follows the
/// length of the field's gradient (field units per world unit) multiplies sigma.
struct TransferFunction {
  struct ColorPoint {
    double value;
    Color color;
  };
  struct ExtinctionPoint {
    double value, sigma;
  };
  struct OpacityPoint {
    double value, alpha;
  };
  std::vector<ColorPoint> colors;
  std::vector<OpacityPoint> opacities;
  double opacity_unit = 0;  ///< world length; 0: the smallest voxel edge of the drawn grid
  std::vector<ExtinctionPoint> extinctions;
  NamedColors named;  ///< where `colors` is empty
  struct GradientPoint {
    double gradient, factor;
  };
  std::vector<GradientPoint> gradient_factors;  ///< gradients rising, factors 0..1; empty: 1 everywhere
  std::string file;                             ///< that it was read from; empty: the scene's own
};

/// Colours that follow values. The one shape of "color_by", and what a slice shows of its own field.
struct ColorBy {
  enum class What { field, speed, arc_length, value };
  What what = What::field;  ///< lines alone know speed and arc length, what comes from a file its values
  std::string value{};      ///< the name that the file has for it
  Entity field;             ///< at the same place of the world: a scalar, or the magnitude of a vector
  json::Node where;
  std::vector<TransferFunction::ColorPoint> colors;  ///< values rising; empty: as `named` says
  NamedColors named{};                               ///< viridis, all values (lines, surfaces: the drawn ones), where it does not say
};

struct Volume {
  /// What a ray makes of its values: emission and absorption, or the look of one value.
  enum class Projection { composite, maximum, minimum, average };
  Entity field;
  json::Node where;
  TransferFunction transfer;
  bool shade = false;
  bool clipped = true;  ///< the clip planes count
  Projection projection = Projection::composite;
  std::optional<ColorBy> color_by{};  ///< composite only
};

struct Isosurface {
  Entity field;
  json::Node where;
  double level = 0;
  Entity level_from{};  ///< the isolevel widget whose value the level follows
  Color color{0.8f, 0.8f, 0.9f};
  double opacity = 1;
  bool clipped = true;  ///< the clip planes count
  std::optional<ColorBy> color_by{};
};

/// A triangle mesh of the scene: where it comes from, and the mesh itself once something has asked for it.
struct MeshSource {
  json::Node where;
  std::string path;
  mesh::Placement placement;  ///< world = scale * file + offset
  mesh::MeshPtr loaded;       ///< felt and drawn: one object
};

/// A mesh that is drawn.
struct SurfaceMesh {
  Entity mesh;
  json::Node where;
  Color color{0.8f, 0.8f, 0.9f};
  bool clipped = true;  ///< the clip planes count
  double opacity = 1;
  bool smooth = false;  ///< "shading": the felt mesh is flat
  bool edges = false;
  std::optional<ColorBy> color_by;
};

/// Curves from a file: drawn as tubes, and felt by links that name them.
struct DrawnCurves {
  json::Node where;
  std::string path;
  curves::CurveSetPtr loaded;  ///< felt and drawn: one object; none before something asks for it
  double radius = 0;           ///< of the tubes; 0: fitted
  std::optional<Color> color;  ///< none, and no color_by: by the direction, (|x|, |y|, |z|)
  std::optional<ColorBy> color_by;
  bool clipped = true;  ///< the clip planes count
};

/// Points from a table: drawn as balls, and felt by links that name them.
struct DrawnPoints {
  json::Node where;
  std::string path;
  curves::PointSetPtr loaded;  ///< felt and drawn: one object; none before something asks for it
  double radius = 0;           ///< of all balls; 0: by `radius_by`, or fitted
  std::string radius_by;       ///< the column that says each ball's; empty: the column "radius", where the table has one
  Color color{0.9f, 0.75f, 0.45f};
  std::optional<ColorBy> color_by;
  bool clipped = true;  ///< the clip planes count
};

/// A plane through a field, coloured by its values, with lines of constant value.
struct Slice {
  ColorBy shown;
  json::Node where;
  Vec3 point{0.0}, normal{0.0, 0.0, 1.0};
  Entity widget{};  ///< the cutting plane that the plane follows
  double opacity = 1;
  bool lit = false;
  bool clipped = true;  ///< the clip planes count
  struct Contours {
    json::Node where;
    std::vector<double> levels;  ///< rising; or
    int count = 0;               ///< so many within the colours' range, its ends left out; or
    double spacing = 0;          ///< all multiples
    Color color{0, 0, 0};
    double width = 1;  ///< pixels
  };
  std::optional<Contours> contours;
};
inline constexpr int kMaxContours = 1000;

/// Seeds that are not listed one by one. Which members mean something follows from the kind.
struct SeedPattern {
  enum class Kind { line, plane, sphere, isosurface, evenly_spaced };
  Kind kind = Kind::line;
  json::Node where;
  Vec3 origin{0.0};         ///< a line's first end, a plane's corner, a sphere's centre
  Vec3 u{0.0}, v{0.0};      ///< a line's other end (u); a plane's edges
  int count = 1;            ///< of seeds; a plane's along u; evenly spaced: the most lines
  int count_v = 1;          ///< a plane's along v
  double radius = 0;        ///< of a sphere
  bool inside = false;      ///< the ball rather than the sphere
  Entity field;             ///< of an isosurface
  double level = 0;         ///< of an isosurface
  double distance = 0;      ///< evenly spaced: of the lines, world units
  double test = 0.5;        ///< evenly spaced: lines end nearer than this share of the distance
  std::vector<Vec3> start;  ///< evenly spaced: where the first lines begin; empty: the middle of the domain
};

struct Seeds {
  std::vector<Vec3> points;
  std::optional<SeedPattern> pattern;  ///< instead of points
  Entity widget{};                     ///< the seed or rake that the points follow
  int count = 1;                       ///< of the points along a rake
};

/// Tubes along streamlines.
struct StreamlineSet {
  Entity field;
  json::Node where;
  Seeds seeds;
  double radius = 0;  ///< 0: fitted to the domain
  Color color{1.0f, 0.3f, 0.2f};
  std::optional<ColorBy> color_by;
  bool line = false;  ///< "kind": "line"
  double min_speed = 0;
  double length = 0;     ///< 0: 10 L, each direction
  double tolerance = 0;  ///< times L; 0: by the seeds' kind (lines.h)
  double arrows = 0;     ///< arrowheads every so far along a line, world units; 0: none
  double pulse = 0;      ///< bands of this length run along the lines as the scene's phase goes from 0 to 1; 0: none
  bool clipped = true;   ///< the clip planes count
};

/// Arrows of a vector field, evenly placed; of a line field, rods.
struct GlyphSet {
  enum class On { box, plane, slice, isosurface, mesh };
  enum class At { center, tail, head };
  Entity field;
  json::Node where;
  bool line = false;  ///< "kind": "line"
  On on = On::box;
  Entity base{};                     ///< the slice, the isosurface or the mesh that they lie on, drawn or not
  Vec3 point{0.0}, normal{0, 0, 1};  ///< of a plane of their own
  Entity widget{};                   ///< the cutting plane that this plane follows
  std::optional<field::Box> box{};   ///< empty: the field's domain
  double spacing = 0;                ///< world units; 0: fitted to the domain (even_places.h)
  bool constant = false;             ///< "scale": "constant": all as long as the longest
  double length = 0;                 ///< of the longest, world units; 0: the spacing
  double full_speed = 0;             ///< the speed that has this length; 0: the greatest that is drawn
  double min_speed = 0;              ///< speeds up to this have none
  double radius = 0;                 ///< of the longest one's shaft, world units; 0: a share of its length
  At at = At::center;                ///< what of it lies at its place
  Color color{1.0f, 0.75f, 0.2f};
  std::optional<ColorBy> color_by;
  bool clipped = true;  ///< the clip planes count
};
inline constexpr std::size_t kMaxGlyphs = 20000;  ///< of one set

/// A short piece of the streamline through the cursor, with an arrowhead: what the flow does here.
struct Indicator {
  Entity field;
  json::Node where;
  double length = 0;  ///< world units; 0: a tenth of L
  double radius = 0;  ///< 0: fitted
  Color color{1.0f, 0.85f, 0.1f};
  bool ahead = false;  ///< the piece begins at the cursor; else the cursor is its middle
};

/// The cursor: what the hand holds, as the last tick left it. Written by the cursor system, drawn as a glyph.
struct Cursor {
  Vec3 probe{0.0};
  std::vector<Vec3> proxies;
  std::vector<bool> active;
  std::vector<double> leaving;  ///< by link: 0 on its feature .. 1 where the hand has left it
  std::vector<exchange::Status> statuses;
  std::vector<std::string> names;  ///< of the links, once the chain is made
  Vec3 force_n{0.0};
  double size = 0;  ///< glyph radius, world units; 0: fitted
  bool visible = false;
  bool ghost = true;           ///< shines through what hides it
  bool drop_line = false;      ///< a line leads down to the floor of what is drawn
  bool crosshair = false;      ///< three rods that cross at the hand, and nothing that says what is felt
  bool pseudo_haptic = false;  ///< nothing pushes the hand: lag and colour show the force
};

/// One link of the chain; its own keys are read by the constraint that it names.
struct Link {
  std::string name, type;
  json::Node node;
};

/// A mode of operation: while its switch is on, these links run in this order. The switch is read by haptics/extract.
struct Mode {
  std::string name;
  std::vector<std::string> links;
  json::Node node;
};

/// A thing that the hand takes hold of (engine/widget/widget.h); its pose as the last tick left it. Slices, clips, seeds and levels follow
/// it.
struct Widget {
  json::Node where;
  widget::Spec spec;  ///< as stated; use_widget (scene.h) completes it
  widget::Report state;
  Entity field;                    ///< isolevel
  std::vector<std::string> along;  ///< ruler: names of links
  Color color{1.0f, 0.75f, 0.2f};
  bool complete = false;                 ///< use_widget has been here
  std::optional<widget::Pose> followed;  ///< the pose that its followers have
  std::optional<double> followed_value;  ///< and the isolevel's value
};

using exchange::CouplingMethod;

struct Coupling {
  double stiffness_n_per_m = 500;
  double damping_ns_per_m = 0;
  double max_force_n = 8;
  std::optional<double> ramp_s;
  double rotational_stiffness_nm_per_rad = 0.5;
  double rotational_damping_nms_per_rad = 0;
  CouplingMethod method = CouplingMethod::chain;
};

/// What may be given up for what, by measured curves (engine/app/plan): of each pair one at most.
struct Plan {
  std::optional<double> error;       ///< of the picture, 1/255, root mean square over what is covered
  std::optional<double> time;        ///< of a picture, ms
  std::optional<double> hand_error;  ///< of the places that links hold, world units
  std::optional<double> hand_time;   ///< of a tick, us
  bool of_eye() const { return error || time; }
  bool of_hand() const { return hand_error || hand_time; }
  bool operator==(const Plan&) const = default;
};

struct Workspace {
  double metres_per_unit = 1;
  Vec3 origin{0.0};
  Mat3 rotation{1.0};  ///< world from hand
  bool given = false;
};

struct Camera {
  Vec3 position{0.0, -8.0, 3.0}, target{0.0}, up{0.0, 0.0, 1.0};
  double fovy_deg = 30;
  bool orthographic = false;
  double height = 1;   ///< orthographic: world units from bottom to top
  bool given = false;  ///< false: fitted to what is drawn
};

/// What is drawn lies on the side of the plane to which the normal points. A clip box is six of them.
struct ClipPlane : Plane {
  Entity widget{};      ///< the cutting plane or box that it follows
  int box_face = -1;    ///< of a box: 0..5, -x +x -y +y -z +z
  bool behind = false;  ///< of a cutting plane: what its normal points away from is kept
};

/// Help for the eye: what shows where things stand. Sizes of 0 are fitted to what is drawn.
struct BoundingBox {
  Entity field;  ///< none: everything that is drawn
  json::Node where;
  Color color{0.7f, 0.7f, 0.7f};
  double radius = 0;
};

/// Three edges of the box with ticks and numbers, of its outline in the picture.
struct Axes {
  Entity field;  ///< none: everything that is drawn
  json::Node where;
  std::array<std::string, 3> names{"x", "y", "z"};
  Color color{0.7f, 0.7f, 0.7f};
  int ticks = 5;  ///< about so many an axis
  double radius = 0;
};

/// A checkerboard across z.
struct Ground {
  std::optional<double> at;  ///< z; none: just below what is drawn
  double size = 0, tile = 0;
  std::array<Color, 2> colors{Color{0.42f, 0.42f, 0.44f}, Color{0.32f, 0.32f, 0.34f}};
};

/// Depth cue: colours turn to the fog's as the view depth goes from start to end.
struct Fog {
  std::optional<Color> color;        ///< none: the background's
  std::optional<double> start, end;  ///< view depth, world units; none: the nearest and farthest of what is drawn
  double most = 0.8;                 ///< share of the fog at the end
};

/// A light from far away. Without one there is a headlight.
struct Light {
  Vec3 direction{0.0, 0.0, 1.0};  ///< towards the light; camera: right, up, towards the eye
  Color color{1, 1, 1};
  double intensity = 1;
  bool with_camera = false;
};

/// Steps in time (steps.h).
struct TimeLine {
  int step = 0;
  double per_second = 5;
};

struct Background {
  Color color{0, 0, 0};
  bool transparent = false;
};

}  // namespace catena::scene
